#include "LatticeBoltzmann/Distributed/SteppedInBlocks.h"

#include "Distribution/BoxExchange.h"
#include "LatticeBoltzmann/LatticeShared.h"

#include <algorithm>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr int StepTag = 0;
}

SteppedInBlocks::SteppedInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const LatticeSettings& settings, const VoxelBox& box, Lattice* lattice)
  : TheDevice(device)
  , Comm(communicator)
  , Settings(settings)
  , Own(partition.blocks[communicator.Rank()])
  , Box(box)
  , TheLattice(lattice)
{
  this->FindParcels(partition);
  communicator.Collective([&] { this->FindProbes(partition); });
}

/// @param voxel  of the lattice, from -1 on, one beyond its end
cl_ulong SteppedInBlocks::PlaceOf(int direction, const Voxel& voxel) const
{
  const LatticeInfo& info = this->TheLattice->Info();
  const auto at = [](int place) { return static_cast<cl_ulong>(place); };
  return at(direction) * info.stride + at(voxel[2] + 1) * at(info.layer) + at(voxel[1] + 1) * at(info.row) +
    at(voxel[0] + LatticeFirst);
}

/// act(direction, where it comes from: voxel of the lattice or beside it, voxel of the whole grid) for each density
/// that comes into it from outside.
template <class Act>
void SteppedInBlocks::ForComing(const BlockPartition& partition, const Act& act) const
{
  Grid grid;
  grid.size = this->Box.size;
  for (std::size_t i = 0; this->Has() && i < this->Box.VoxelCount(); ++i)
  {
    for (int d = 0; d < this->Settings.directions; ++d)
    {
      Voxel from = grid.VoxelAt(i), inWhole;
      bool isOutside = false, isBeyond = false;
      for (int axis = 0; axis < 3; ++axis)
      {
        const int size = partition.whole.size[axis];
        from[axis] -= LatticeWays[d][axis];
        isBeyond = isBeyond || from[axis] < 0 || from[axis] >= this->Box.size[axis];
        inWhole[axis] = this->Box.first[axis] + from[axis];
        isOutside = isOutside || (!this->Settings.periodic[axis] && (inWhole[axis] < 0 || inWhole[axis] >= size));
        inWhole[axis] = (inWhole[axis] + size) % size;
      }
      if (isBeyond && !isOutside)
      {
        act(d, from, inWhole);
      }
    }
  }
}

/// Each rank asks for what comes into its lattice: directions, and voxels of the whole grid.
void SteppedInBlocks::FindParcels(const BlockPartition& partition)
{
  const std::size_t ranks = partition.blocks.size();
  std::vector<std::vector<std::size_t>> asks(ranks);
  std::vector<std::vector<cl_ulong>> gets(ranks), sends(ranks);
  this->Comm.Collective([&] {
    this->ForComing(partition, [&](int direction, const Voxel& from, const Voxel& inWhole) {
      const auto owner = std::find_if(partition.blocks.begin(), partition.blocks.end(),
        [&](const VoxelBox& other) { return Holds(other, inWhole.data()); });
      const auto rank = static_cast<std::size_t>(owner - partition.blocks.begin());
      asks[rank].push_back(static_cast<std::size_t>(direction));
      asks[rank].push_back(partition.whole.IndexOf(inWhole));
      gets[rank].push_back(this->PlaceOf(direction, from));
    });
  });
  const std::vector<std::vector<std::size_t>> asked =
    this->Has() ? NumbersOfEach(this->Comm, partition, asks) : std::vector<std::vector<std::size_t>>(ranks);
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    for (auto next = asked[rank].begin(); next != asked[rank].end(); next += 2)
    {
      Voxel voxel = partition.whole.VoxelAt(next[1]);
      std::transform(voxel.begin(), voxel.end(), this->Box.first.begin(), voxel.begin(), std::minus<int>());
      sends[rank].push_back(this->PlaceOf(static_cast<int>(next[0]), voxel));
    }
  }
  const auto packed = [&](const std::vector<std::vector<cl_ulong>>& byRank) {
    Parcels parcels;
    std::vector<cl_ulong> all;
    for (const std::vector<cl_ulong>& ofRank : byRank)
    {
      parcels.counts.push_back(ofRank.size());
      all.insert(all.end(), ofRank.begin(), ofRank.end());
    }
    parcels.places = all.empty() ? Buffer<cl_ulong>() : Buffer<cl_ulong>(this->TheDevice, all, "light between blocks");
    return parcels;
  };
  this->Comm.Collective([&] {
    this->Sends = packed(sends);
    this->Gets = packed(gets);
  });
}

/// Of the whole grid's those in the block.
void SteppedInBlocks::FindProbes(const BlockPartition& partition)
{
  const std::vector<std::size_t> ofWhole = ProbesOf(partition.whole, this->Settings);
  this->LooksAtAll = ofWhole.empty();
  std::vector<cl_int> own;
  Grid grid;
  grid.size = this->Box.size;
  for (const std::size_t probe : ofWhole)
  {
    Voxel voxel = partition.whole.VoxelAt(probe);
    if (Holds(this->Own, voxel.data()))
    {
      std::transform(voxel.begin(), voxel.end(), this->Box.first.begin(), voxel.begin(), std::minus<int>());
      own.push_back(static_cast<cl_int>(grid.IndexOf(voxel)));
    }
  }
  this->Probes = own.empty() ? Buffer<cl_int>() : Buffer<cl_int>(this->TheDevice, own, "probes");
}

/// What voxels around the lattice send into it; nothing in each message where something has gone wrong.
void SteppedInBlocks::Exchange()
{
  std::vector<float> out, in;
  this->Failure.Attempt([&] {
    out = this->Sends.places.Size() > 0 ? this->TheLattice->At(this->Sends.places, this->TheLattice->Sent()) : out;
    in.reserve(this->Gets.places.Size());
  });
  auto next = out.begin();
  for (std::size_t rank = 0; rank < this->Sends.counts.size(); ++rank)
  {
    const auto count = static_cast<std::ptrdiff_t>(this->Failure.broken ? 0 : this->Sends.counts[rank]);
    if (this->Sends.counts[rank] > 0)
    {
      this->Comm.Send(static_cast<int>(rank), StepTag, std::vector<float>(next, next + count));
      next += count;
    }
  }
  for (std::size_t rank = 0; rank < this->Gets.counts.size(); ++rank)
  {
    if (this->Gets.counts[rank] > 0)
    {
      const std::vector<float> message = this->Comm.Receive<float>(static_cast<int>(rank), StepTag);
      this->Failure.broken = this->Failure.broken || message.size() != this->Gets.counts[rank];
      this->Failure.Attempt([&] { in.insert(in.end(), message.begin(), message.end()); });
    }
  }
  this->Failure.Attempt([&] {
    if (!in.empty())
    {
      this->TheLattice->Put(in, this->Gets.places, this->TheLattice->Sent());
    }
  });
}

void SteppedInBlocks::Step(int steps, double done, const Monitor& monitor)
{
  this->Failure = {};
  const int each = this->Settings.blockSize > 0 ? this->Settings.stepsPerExchange : 1;
  for (int step = 0; step < steps && this->Has(); step += each)
  {
    this->Exchange();
    this->Failure.Attempt([&] {
      this->TheLattice->Step(std::min(each, steps - step), step + each >= steps);
      this->TheDevice.Finish();
      Report(monitor, done);
    });
  }
  this->Comm.Collective([&] { this->Failure.Throw(); });
}

void SteppedInBlocks::FillAround()
{
  this->Failure = {};
  this->Exchange();
  this->Comm.Collective([&] { this->Failure.Throw(); });
}

std::vector<float> SteppedInBlocks::Probed() const
{
  if (this->LooksAtAll || !this->Has())
  {
    return this->Fluence();
  }
  return this->Probes.Size() > 0 ? this->TheLattice->FluenceAt(this->Probes) : std::vector<float>();
}

std::vector<float> SteppedInBlocks::Fluence() const
{
  return this->Has() ? PartOf(this->TheLattice->Fluence(), this->Box, this->Own, 1) : std::vector<float>();
}
}
