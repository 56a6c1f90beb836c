#include "LatticeBoltzmann/Distributed/LinesInBlocks.h"

#include "Distribution/BoxExchange.h"
#include "LatticeBoltzmann/LatticeShared.h"
#include "LatticeBoltzmann/Steady/LinesOfLinks.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int PairsAtOnce = 3;
constexpr std::size_t Says = 8, Hears = 3, SaysOfSweep = 2; ///< numbers of a piece, as BlockLines.cl has them

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
  , Comm(communicator)
  , Box(box)
  , Settings(settings)
  , Voxels(voxels)
  , Densities(lattice)
{
  communicator.Collective([&] {
    if (box.Count() > 0)
    {
      this->FindLines(partition, settings.periodic);
      this->Load(partition, settings.periodic);
    }
  });
  this->TellWhoJoins(partition);
  this->LearnParts();
}

void LinesInBlocks::FindLines(const BlockPartition& partition, const std::array<bool, 3>& periodic)
{
  for (int pair = 0; pair < this->Settings.directions / 2; ++pair)
  {
    this->Pairs.push_back(this->LinesFrom(PiecesOfLines(partition, periodic, pair)));
    this->MostPieces = std::max(this->MostPieces, this->Pairs.back().range[0] * this->Pairs.back().range[1]);
  }
}

/// Those that this rank joins.
LinesInBlocks::Pair LinesInBlocks::LinesFrom(const PiecesOfLines& pieces) const
{
  Pair pair;
  pair.range = pieces.Range(this->Comm.Rank());
  const std::vector<PiecesOfLines::Line> lines = pieces.LinesFrom(this->Comm.Rank());
  std::vector<Shared> byRank(this->Comm.Ranks());
  for (const PiecesOfLines::Line& line : lines)
  {
    for (const PiecesOfLines::Piece& piece : line.pieces)
    {
      byRank[piece.rank].pieces.push_back(piece.number);
    }
  }
  std::vector<std::size_t> next; // place of the first piece of a rank that is not placed yet
  std::size_t all = 0;
  for (std::size_t rank = 0; rank < byRank.size(); ++rank)
  {
    next.push_back(all);
    all += byRank[rank].pieces.size();
    if (!byRank[rank].pieces.empty())
    {
      pair.heardOf.push_back({ static_cast<int>(rank), std::move(byRank[rank].pieces) });
    }
  }
  for (const PiecesOfLines::Line& line : lines)
  {
    pair.lines.push_back({ {}, line.closed });
    for (const PiecesOfLines::Piece& piece : line.pieces)
    {
      pair.lines.back().places.push_back(next[piece.rank]++);
    }
  }
  return pair;
}

/// Which of its pieces a rank has to tell whom about: of each pair how many, and which.
void LinesInBlocks::TellWhoJoins(const BlockPartition& partition)
{
  if (this->Box.Count() == 0)
  {
    return;
  }
  std::vector<std::vector<std::size_t>> toEach(this->Comm.Ranks());
  for (const Pair& pair : this->Pairs)
  {
    std::vector<std::vector<std::size_t>> ofPair(toEach.size());
    for (const Shared& shared : pair.heardOf)
    {
      ofPair[shared.rank] = shared.pieces;
    }
    for (std::size_t rank = 0; rank < toEach.size(); ++rank)
    {
      toEach[rank].push_back(ofPair[rank].size());
      toEach[rank].insert(toEach[rank].end(), ofPair[rank].begin(), ofPair[rank].end());
    }
  }
  const std::vector<std::vector<std::size_t>> ofEach = NumbersOfEach(this->Comm, partition, toEach);
  for (std::size_t rank = 0; rank < ofEach.size(); ++rank)
  {
    auto next = ofEach[rank].begin();
    for (auto pair = this->Pairs.begin(); pair != this->Pairs.end() && next != ofEach[rank].end(); ++pair)
    {
      const auto first = next + 1;
      next = first + static_cast<std::ptrdiff_t>(*next);
      if (first != next)
      {
        pair->joinedBy.push_back({ static_cast<int>(rank), { first, next } });
      }
    }
  }
}

void LinesInBlocks::Load(const BlockPartition& partition, const std::array<bool, 3>& periodic)
{
  const char* what = "lines of the lattice";
  const std::size_t count = this->Box.Count();
  const auto values = [&](std::size_t number) { return ExactValues(this->TheDevice, number, what); };
  this->Straight = values(count);
  this->Even = values(count);
  this->Arriving = values(count);
  this->Straight.Write(GoesStraight(this->Box, this->Voxels));
  this->Passes = Buffer<float>(this->TheDevice, OwnOf(this->Box, this->Voxels.passes), "how links pass light");
  this->Squared = Buffer<float>(this->TheDevice, OwnOf(this->Box, this->Voxels.squared), "n^2");
  if (!this->Voxels.endless.empty())
  {
    this->Endless = Buffer<float>(this->TheDevice, OwnOf(this->Box, this->Voxels.endless), "lines without an end");
  }
  const int pairs = static_cast<int>(this->Pairs.size());
  for (int slot = 0; slot < std::min(PairsAtOnce, pairs); ++slot)
  {
    this->Slots.push_back(
      { values(2 * count), values(count), values(Says * this->MostPieces), values(Hears * this->MostPieces) });
  }
  for (int pair = 0; pair < pairs; ++pair)
  {
    Pair& of = this->Pairs[pair];
    of.below = values(2 * of.range[0] * of.range[1]);
    of.below.Write(this->Below(PiecesOfLines(partition, periodic, pair), partition.blocks[this->Comm.Rank()], pair));
  }
}

/// As BlockLines.cl has it; 1 where a piece begins at a face of the grid.
LinesInBlocks::Values LinesInBlocks::Below(const PiecesOfLines& pieces, const VoxelBox& block, int pair) const
{
  const std::array<std::size_t, 2>& range = this->Pairs[pair].range;
  Values below(2 * range[0] * range[1], 1.0);
  pieces.ForPieces(this->Comm.Rank(), [&](std::size_t piece, std::array<int, 3> voxel) {
    bool isFace = false;
    for (int axis = 0; axis < 3; ++axis)
    {
      voxel[axis] -= block.first[axis] + LatticeWays[2 * pair][axis];
      const bool isOut = voxel[axis] < 0 || voxel[axis] >= block.size[axis];
      isFace = isFace || (isOut && !(this->Box.innerFaces >> (2 * axis + (voxel[axis] < 0 ? 0 : 1)) & 1));
    }
    if (!isFace)
    {
      const std::size_t known = this->Box.Known(voxel);
      below[2 * piece] = this->Voxels.passes[known];
      below[2 * piece + 1] = this->Voxels.squared[known];
    }
  });
  return below;
}

/// What pieces do to light, to those who join them. It does not change from sweep to sweep.
void LinesInBlocks::LearnParts()
{
  this->Failure = {};
  const int pairs = static_cast<int>(this->Pairs.size());
  if (pairs > 0)
  {
    this->Failure.Attempt([&] { this->Even.Fill(0.0); });
  }
  for (int pair = 0; pair < pairs; ++pair)
  {
    this->GoUp(pair, this->Slots.front(), 0.0, { SaysOfSweep, Says - SaysOfSweep, Says });
    const Values heard = this->Take(this->Pairs[pair].heardOf, 2 * pair, Says - SaysOfSweep);
    this->Failure.Attempt([&] {
      for (auto next = heard.begin(); next != heard.end(); next += Says - SaysOfSweep)
      {
        this->Pairs[pair].parts.push_back({ next[0], next[1], next[2], next[3], next[4], next[5] });
      }
    });
  }
  this->Comm.Collective([&] { this->Failure.Throw(); });
}

/// Numbers of the pieces that others are to know of; nothing where something has gone wrong.
/// @param values  side by side: of all of this rank's pieces, by number; or where `part.of` is 0 of those that go to
///   others, in that order
void LinesInBlocks::Give(const std::vector<Shared>& to, int tag, Part part, const Values& values)
{
  auto next = values.begin();
  for (const Shared& other : to)
  {
    Values message;
    this->Failure.Attempt([&] {
      for (const std::size_t piece : other.pieces)
      {
        const auto first =
          part.of > 0 ? values.begin() + static_cast<std::ptrdiff_t>(piece * part.of + part.first) : next;
        next = first + static_cast<std::ptrdiff_t>(part.count);
        message.insert(message.end(), first, next);
      }
    });
    this->Comm.Send(other.rank, tag, this->Failure.broken ? Values() : message);
  }
}

/// @return `width` numbers of each piece, side by side; of no use where something has gone wrong
LinesInBlocks::Values LinesInBlocks::Take(const std::vector<Shared>& from, int tag, std::size_t width)
{
  Values all;
  for (const Shared& other : from)
  {
    const Values message = this->Comm.Receive<double>(other.rank, tag);
    this->Failure.broken = this->Failure.broken || message.size() != width * other.pieces.size();
    this->Failure.Attempt([&] { all.insert(all.end(), message.begin(), message.end()); });
  }
  return all;
}

/// With its first arguments, up to `endless`.
cl::Kernel LinesInBlocks::Kernel(const char* name, int pair, double shines) const
{
  cl::Kernel lines = this->TheDevice.Kernel(
    name, kernel_source::BlockLines, OptionsOfLines(this->TheDevice, this->Settings, this->Voxels));
  With(lines, this->Densities->Info(), this->Straight.Handle(), this->Passes, this->Squared, this->Even.Handle(),
    cl_int(pair));
  SetExact(this->TheDevice, lines, 6, shines);
  SetFrom(lines, 7, this->Pairs[pair].below.Handle(), this->Endless);
  return lines;
}

void LinesInBlocks::Run(cl::Kernel& kernel, int pair)
{
  const std::array<std::size_t, 2>& range = this->Pairs[pair].range;
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(range[0], range[1]));
  this->TheDevice.Finish();
}

void LinesInBlocks::GoUp(int pair, Slot& slot, double shines, Part says)
{
  const std::vector<Shared>& joinedBy = this->Pairs[pair].joinedBy;
  Values said;
  this->Failure.Attempt([&] {
    cl::Kernel up = this->Kernel("pieces_up", pair, shines);
    SetFrom(up, 9, slot.behind.Handle(), slot.share.Handle(), slot.says.Handle());
    this->Run(up, pair);
    said = joinedBy.empty() ? Values() : slot.says.Read();
  });
  this->Give(joinedBy, 2 * pair, says, said);
}

/// The lines that begin here, or are cut here.
void LinesInBlocks::Join(int pair)
{
  const Pair& of = this->Pairs[pair];
  const Values heard = this->Take(of.heardOf, 2 * pair, SaysOfSweep);
  Values joined;
  this->Failure.Attempt([&] {
    joined.resize(heard.size() / SaysOfSweep * Hears);
    for (const Line& line : of.lines)
    {
      std::vector<PieceOfLine> parts;
      std::vector<SentByPiece> sent;
      for (const std::size_t place : line.places)
      {
        parts.push_back(of.parts[place]);
        sent.push_back({ heard[SaysOfSweep * place], heard[SaysOfSweep * place + 1] });
      }
      const std::vector<ComesToPiece> comes = JoinLine(parts, sent, line.closed);
      for (std::size_t k = 0; k < comes.size(); ++k)
      {
        const auto to = joined.begin() + static_cast<std::ptrdiff_t>(Hears * line.places[k]);
        to[0] = comes[k].up;
        to[1] = comes[k].down;
        to[2] = comes[k].sentBeyond;
      }
    }
  });
  this->Give(of.heardOf, 2 * pair + 1, { 0, Hears, 0 }, joined);
}

void LinesInBlocks::SolveCg(int pair, Slot& slot, double shines, bool writes)
{
  const std::vector<Shared>& joinedBy = this->Pairs[pair].joinedBy;
  const Values heard = this->Take(joinedBy, 2 * pair + 1, Hears);
  this->Failure.Attempt([&] {
    Values joined(Hears * this->MostPieces, 0.0);
    auto next = heard.begin();
    for (const Shared& other : joinedBy)
    {
      for (const std::size_t piece : other.pieces)
      {
        std::copy_n(next, Hears, joined.begin() + static_cast<std::ptrdiff_t>(Hears * piece));
        next += Hears;
      }
    }
    slot.joined.Write(joined);
    cl::Kernel down = this->Kernel("pieces_down", pair, shines);
    SetFrom(down, 9, slot.behind.Handle(), slot.share.Handle(), slot.joined.Handle(), this->Arriving.Handle(),
      this->Densities->Densities(), cl_int(writes));
    this->Run(down, pair);
  });
}

SteadySystem::Values LinesInBlocks::Sweep(
  const SteadySystem::Values& even, double shines, bool writes, const Monitor& monitor)
{
  this->Failure = {};
  const int pairs = static_cast<int>(this->Pairs.size());
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
      this->GoUp(pair, this->Slots[pair - begin], shines, { 0, SaysOfSweep, Says });
    }
    for (int pair = begin; pair < end; ++pair)
    {
      this->Join(pair);
    }
    for (int pair = begin; pair < end; ++pair)
    {
      this->SolveCg(pair, this->Slots[pair - begin], shines, writes);
    }
    this->Work += end - begin;
    this->Failure.Attempt([&] { Report(monitor, 1.0 - 1.0 / (1.0 + 0.01 * this->Work)); }); // as SteadyInMemory does
  }
  SteadySystem::Values arrives;
  this->Comm.Collective([&] {
    this->Failure.Throw();
    if (pairs > 0 && !this->Failure.broken)
    {
      arrives = this->Arriving.Read();
    }
  });
  return arrives;
}
}
