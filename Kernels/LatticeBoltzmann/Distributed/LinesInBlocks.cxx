#include "LatticeBoltzmann/Distributed/LinesInBlocks.h"

#include "Device/Errors.h"
#include "LatticeBoltzmann/LatticeShared.h"
#include "LatticeBoltzmann/Steady/LinesOfLinks.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int Ways[18][3] = LATTICE_WAYS;
constexpr int PairsAtOnce = 3;
constexpr int SaysOfLast = 4, SaysOfFirst = 2; ///< numbers of a line, as BlockLines.cl has them

VoxelBox Moved(VoxelBox box, int pair)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    box.first[axis] += Ways[2 * pair][axis];
  }
  return box;
}

/// Voxels of block `to` that lines of the pair come into from block `from`.
VoxelBox Entered(const BlockPartition& partition, int pair, std::size_t from, std::size_t to)
{
  const bool both = partition.blocks[from].VoxelCount() > 0 && partition.blocks[to].VoxelCount() > 0;
  return both && from != to ? Common(Moved(partition.blocks[from], pair), partition.blocks[to]) : VoxelBox();
}

/// Takes away the blocks that wait for no other one, again and again.
/// @throws InvalidInput where some are left that wait for each other
void CheckOrder(const BlockPartition& partition, int pair)
{
  std::vector<std::size_t> left;
  for (std::size_t block = 0; block < partition.blocks.size(); ++block)
  {
    left.push_back(block);
  }
  while (!left.empty())
  {
    const auto waits = [&](std::size_t block) {
      return std::any_of(left.begin(), left.end(),
        [&](std::size_t other) { return Entered(partition, pair, other, block).VoxelCount() > 0; });
    };
    const auto end = std::stable_partition(left.begin(), left.end(), waits);
    Require(
      end != left.end(), "Blocks of ranks wait for each other's light: cut the grid by planes, one after the other.");
    left.erase(end, left.end());
  }
}

/// Floats of the block's voxels.
std::vector<float> OwnOf(const LatticeBox& box, const std::vector<float>& known)
{
  std::vector<float> own;
  for (std::size_t i = 0; i < box.Count(); ++i)
  {
    own.push_back(known[box.Known(i)]);
  }
  return own;
}
}

LinesInBlocks::LinesInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const LatticeBox& box, const LatticeSettings& settings, const LatticeVoxels& voxels, const Lattice* lattice)
  : TheDevice(device)
  , Others(communicator)
  , Partition(partition)
  , Box(box)
  , Settings(settings)
  , Voxels(voxels)
  , Densities(lattice)
{
  communicator.Together([&] {
    for (int pair = 0; pair < settings.directions / 2; ++pair)
    {
      CheckOrder(partition, pair);
      this->Pairs.push_back(this->ContactsOf(pair));
      this->MostLines = std::max(this->MostLines, this->Pairs.back().range[0] * this->Pairs.back().range[1]);
    }
    if (box.Count() > 0)
    {
      this->Load();
    }
  });
}

/// The work-item that follows the line through a voxel of the block.
std::size_t LinesInBlocks::LineOf(int pair, std::array<int, 3> voxel) const
{
  const int* way = Ways[2 * pair];
  const std::array<int, 3>& size = this->Box.own.size;
  std::vector<int> moving, still;
  int back = std::numeric_limits<int>::max();
  for (int a = 0; a < 3; ++a)
  {
    (way[a] != 0 ? moving : still).push_back(a);
    back = way[a] == 0 ? back : std::min(back, way[a] > 0 ? voxel[a] : size[a] - 1 - voxel[a]);
  }
  for (const int a : moving)
  {
    voxel[a] -= back * way[a];
  }
  const std::size_t range = LinesOfPair(size, pair)[0];
  if (moving.size() == 1)
  {
    return voxel[still[1]] * range + voxel[still[0]];
  }
  const int a = moving[0], b = moving[1], firstB = way[b] > 0 ? 0 : size[b] - 1;
  return voxel[still[0]] * range + (voxel[b] == firstB ? voxel[a] : size[a] + voxel[b]);
}

LinesInBlocks::Pair LinesInBlocks::ContactsOf(int number) const
{
  const std::size_t self = static_cast<std::size_t>(this->Others.Rank());
  const VoxelBox& block = this->Partition.blocks[self];
  Pair pair;
  pair.range = LinesOfPair(this->Box.own.size, number);
  // Both count the voxels that are entered; of the block before they are one way further on.
  const auto contact = [&](std::size_t rank, const VoxelBox& entered, bool isBefore) {
    Contact found = { static_cast<int>(rank), {} };
    Grid grid;
    grid.size = entered.size;
    for (std::size_t i = 0; i < entered.VoxelCount(); ++i)
    {
      std::array<int, 3> voxel = grid.VoxelAt(i);
      for (int a = 0; a < 3; ++a)
      {
        voxel[a] += entered.first[a] - block.first[a] - (isBefore ? 0 : Ways[2 * number][a]);
      }
      found.lines.push_back(this->LineOf(number, voxel));
    }
    return found;
  };
  for (std::size_t rank = 0; rank < this->Partition.blocks.size(); ++rank)
  {
    if (const VoxelBox here = Entered(this->Partition, number, rank, self); here.VoxelCount() > 0)
    {
      pair.before.push_back(contact(rank, here, true));
    }
    if (const VoxelBox there = Entered(this->Partition, number, self, rank); there.VoxelCount() > 0)
    {
      pair.behind.push_back(contact(rank, there, false));
    }
  }
  return pair;
}

void LinesInBlocks::Load()
{
  const char* what = "lines of the lattice";
  const std::size_t count = this->Box.Count();
  this->Straight = ExactValues(this->TheDevice, count, what);
  this->Even = ExactValues(this->TheDevice, count, what);
  this->Arriving = ExactValues(this->TheDevice, count, what);
  this->Straight.Write(GoesStraight(this->Box, this->Voxels));
  this->Passes = Buffer<float>(this->TheDevice, OwnOf(this->Box, this->Voxels.passes), "how links pass light");
  this->Squared = Buffer<float>(this->TheDevice, OwnOf(this->Box, this->Voxels.squared), "n^2");
  const auto values = [&](std::size_t number) { return ExactValues(this->TheDevice, number, what); };
  for (int slot = 0; slot < std::min<int>(PairsAtOnce, static_cast<int>(this->Pairs.size())); ++slot)
  {
    this->Slots.push_back(
      { values(2 * count), values(SaysOfLast * this->MostLines), values(SaysOfLast * this->MostLines),
        values(SaysOfFirst * this->MostLines), values(SaysOfFirst * this->MostLines) });
  }
}

/// @param values  numbers of a line
/// @return by line; 0 where none come
LinesInBlocks::Values LinesInBlocks::TakeFrom(const std::vector<Contact>& contacts, int tag, int values)
{
  Values ofLines(values * this->MostLines, 0.0);
  for (const Contact& contact : contacts)
  {
    const Values message = this->Others.Receive<double>(contact.rank, tag);
    this->Failure.broken = this->Failure.broken || message.size() != values * contact.lines.size();
    for (std::size_t i = 0; i < contact.lines.size() && !this->Failure.broken; ++i)
    {
      std::copy_n(message.begin() + static_cast<std::ptrdiff_t>(values * i), values,
        ofLines.begin() + static_cast<std::ptrdiff_t>(values * contact.lines[i]));
    }
  }
  return ofLines;
}

void LinesInBlocks::GiveTo(const std::vector<Contact>& contacts, int tag, int values, const Values& ofLines)
{
  for (const Contact& contact : contacts)
  {
    Values message;
    for (std::size_t i = 0; i < contact.lines.size() && !this->Failure.broken; ++i)
    {
      const auto first = ofLines.begin() + static_cast<std::ptrdiff_t>(values * contact.lines[i]);
      message.insert(message.end(), first, first + values);
    }
    this->Others.Send(contact.rank, tag, message);
  }
}

/// With its first arguments, up to `shines`.
cl::Kernel LinesInBlocks::Kernel(const char* name, int pair, double shines) const
{
  cl::Kernel lines = this->TheDevice.Kernel(
    name, kernel_source::BlockLines, OptionsOfLines(this->TheDevice, this->Settings, this->Voxels));
  With(lines, this->Densities->Info(), this->Straight.Handle(), this->Passes, this->Squared, this->Even.Handle(),
    cl_int(pair));
  SetExact(this->TheDevice, lines, 6, shines);
  return lines;
}

void LinesInBlocks::Run(cl::Kernel& kernel, int pair)
{
  const std::array<std::size_t, 2>& range = this->Pairs[pair].range;
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(range[0], range[1]));
  this->TheDevice.Finish();
}

void LinesInBlocks::GoUp(int pair, Slot& slot, double shines)
{
  const int tag = 2 * pair;
  const Values before = this->TakeFrom(this->Pairs[pair].before, tag, SaysOfLast);
  Values last;
  this->Failure.Attempt([&] {
    slot.before.Write(before);
    cl::Kernel up = this->Kernel("lines_up", pair, shines);
    SetFrom(up, 7, slot.before.Handle(), slot.behind.Handle(), slot.last.Handle());
    this->Run(up, pair);
    last = slot.last.Read();
  });
  this->GiveTo(this->Pairs[pair].behind, tag, SaysOfLast, last);
}

void LinesInBlocks::GoDown(int pair, Slot& slot, double shines, bool writes)
{
  const int tag = 2 * pair + 1;
  const Values after = this->TakeFrom(this->Pairs[pair].behind, tag, SaysOfFirst);
  Values first;
  this->Failure.Attempt([&] {
    slot.after.Write(after);
    cl::Kernel down = this->Kernel("lines_down", pair, shines);
    SetFrom(down, 7, slot.before.Handle(), slot.behind.Handle(), slot.after.Handle(), slot.first.Handle(),
      this->Arriving.Handle(), this->Densities->Densities(), cl_int(writes));
    this->Run(down, pair);
    first = slot.first.Read();
  });
  this->GiveTo(this->Pairs[pair].before, tag, SaysOfFirst, first);
}

SteadySystem::Values LinesInBlocks::Sweep(
  const SteadySystem::Values& even, double shines, bool writes, const Monitor& monitor)
{
  this->Failure = {};
  const int pairs = this->Box.Count() > 0 ? static_cast<int>(this->Pairs.size()) : 0;
  this->Failure.Attempt([&] {
    if (pairs > 0)
    {
      this->Even.Write(even);
      this->Arriving.Fill(0.0);
    }
  });
  for (int begin = 0; begin < pairs; begin += PairsAtOnce)
  {
    const int end = std::min(begin + PairsAtOnce, pairs);
    for (int pair = begin; pair < end; ++pair)
    {
      this->GoUp(pair, this->Slots[pair - begin], shines);
    }
    for (int pair = begin; pair < end; ++pair)
    {
      this->GoDown(pair, this->Slots[pair - begin], shines, writes);
    }
    this->Work += end - begin;
    this->Failure.Attempt([&] { Report(monitor, 1.0 - 1.0 / (1.0 + 0.01 * this->Work)); }); // as SteadyInMemory does
  }
  SteadySystem::Values arrives;
  this->Others.Together([&] {
    if (this->Failure.error)
    {
      std::rethrow_exception(this->Failure.error);
    }
    if (pairs > 0 && !this->Failure.broken)
    {
      arrives = this->Arriving.Read();
    }
  });
  return arrives;
}
}
