#include "LightPropagation/Uncollided/Lamps/LampsInBlocks.h"

#include "Device/GroupSize.h"
#include "LightPropagation/Uncollided/Lamps/LampOnGrid.h"
#include "LightPropagation/Uncollided/Lamps/LampPasses.h"
#include "LightPropagation/Uncollided/Lamps/LampShares.h"
#include "LightPropagation/Uncollided/Lamps/LampSums.h"
#include "Medium/BoxFaces.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

namespace tyndall
{
static const int* WhereIs(const BeamOnItsWay& beam)
{
  return beam.voxel;
}

namespace
{
constexpr int Reach = 2; ///< halo in voxels: a beam may extend one voxel beyond the block, and one more by rounding
constexpr std::size_t BeamsPerLaunch = 1 << 14; ///< keeps a launch well below a tenth of a second

/// The voxel of the grid nearest to a beam's start. An approximation suffices: the rank that owns it takes the first
/// step.
std::array<int, 3> FirstVoxel(const BeamRow& row, int beam, const Grid& grid, const std::array<bool, 3>& periodic)
{
  const double begins[] = { row.startU + static_cast<double>(beam) * row.openU, row.startV };
  std::array<double, 3> place = {};
  place[row.axis] = row.up ? std::floor(row.from + 1e-6) : std::ceil(row.from - 1e-6) - 1.0;
  for (int k = 0; k < 2; ++k)
  {
    const int aside = (row.axis + 1 + k) % 3;
    place[aside] = std::floor(begins[k]);
    place[aside] -= periodic[aside] ? std::floor(place[aside] / grid.size[aside]) * grid.size[aside] : 0.0;
  }
  std::array<int, 3> voxel = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    voxel[axis] = static_cast<int>(std::clamp(place[axis], 0.0, grid.size[axis] - 1.0));
  }
  return voxel;
}
}

LampsInBlocks::LampsInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const std::array<bool, 3>& periodic, const VolumeLayout& layout, const Buffer<float>& sigma_t)
  : TheDevice(device)
  , Comm(communicator)
  , Partition(partition)
  , Own(partition.blocks[communicator.Rank()])
  , Stored(communicator, partition, periodic, Reach)
  , Rounds(communicator, partition, 1, periodic)
  , OwnStride(layout.Stride())
{
  std::vector<float> own;
  communicator.Collective([&] { own = this->Has() ? sigma_t.Read() : own; });
  std::vector<float> stored;
  for (const ChannelGroup& group : layout.Groups())
  {
    std::vector<float> ofGroup(this->Own.VoxelCount());
    std::copy_n(own.begin() + static_cast<std::ptrdiff_t>(this->Has() ? layout.ExtinctionFirst(group.first) : 0),
      ofGroup.size(), ofGroup.begin());
    const std::vector<float> around = this->Stored.Spread(ofGroup, 1);
    stored.insert(stored.end(), around.begin(), around.end());
  }
  communicator.Collective([&] {
    if (this->Has())
    {
      this->SigmaT = Buffer<float>(device, stored, "sigma_t around a block");
    }
  });
}

/// The beams of one lamp that a rank traces.
class LampsInBlocks::Beams
{
public:
  Beams(LampsInBlocks& lamps, const SweepVolume& volume, const Light& light)
    : All(lamps)
    , Volume(volume)
    , Lamp(light, lamps.Partition.whole, lamps.Stored.Periodic())
    , Box(lamps.Stored.Known())
    , SigmaFirst(volume.sigma_t_first / std::max<std::size_t>(lamps.OwnStride, 1) * this->Box.VoxelCount())
  {
    lamps.Comm.Collective([&] {
      if (lamps.Has())
      {
        this->Sums = std::make_unique<LampSums>(
          lamps.TheDevice, this->Lamp, volume.deposit, this->Box.VoxelCount(), lamps.Partition.whole);
        this->Kernel =
          this->Lamp.Kernel(lamps.TheDevice, "follow_lamp_in_block", kernel_source::LampInBlock, volume.deposit);
      }
    });
  }

  SweepTally Run(const Monitor& monitor)
  {
    const FollowPass follow = [this](const Pass& pass, double factor, const Monitor& ofPass) {
      this->FollowPoints(pass, factor, ofPass);
    };
    const std::array<bool, 3>& periodic = this->All.Stored.Periodic();
    const double even = FollowInPasses(this->All.Partition.whole, periodic, this->Shares, follow, monitor);
    const LampFactors factors = this->PutDown(even);
    return this->Shares.Times(this->Lamp.TheLight().power, this->Volume.channels, factors);
  }

private:
  void FollowPoints(const Pass& pass, double factor, const Monitor& monitor);
  void Follow(const std::vector<BeamRow>& rows, const Monitor& monitor);
  std::vector<BeamOnItsWay> SettingOff(const std::vector<BeamRow>& rows) const;
  std::vector<BeamOnItsWay> FollowInBlock(const std::vector<BeamRow>& rows, const LampInfo& info,
    const Buffer<BeamRow>& rowBuffer, const std::vector<BeamOnItsWay>& beams, const Monitor& monitor);
  std::size_t BeamsTogether(const BeamRow& row) const;
  void AddToShares();
  std::vector<cl_long> CellsOfAll();
  double ExtinctionOfAll();
  LampFactors PutDown(double even);

  LampsInBlocks& All;
  const SweepVolume& Volume;
  LampOnGrid Lamp;
  const VoxelBox& Box;
  std::size_t SigmaFirst;
  std::unique_ptr<LampSums> Sums; ///< of the block and its halo; null on a rank without voxels
  cl::Kernel Kernel;
  LampShares Shares; ///< of all ranks, over all passes
  LampShares Found;  ///< of this rank, since the last AddToShares()
};

/// As LampBeams::FollowPoints(). Collective.
void LampsInBlocks::Beams::FollowPoints(const Pass& pass, double factor, const Monitor& monitor)
{
  const std::vector<LampPoint>& points = this->Lamp.PointsOf(pass);
  const double all = static_cast<double>(points.size());
  for (std::size_t p = 0, next; p < points.size(); p = next)
  {
    const std::vector<BeamRow> rows = this->Lamp.Rows(pass, factor, p, next);
    this->Follow(rows, OfPart(monitor, p / all, next / all));
  }
  this->AddToShares();
}

/// Traces these rows until no rank has any of their beams left. Collective.
void LampsInBlocks::Beams::Follow(const std::vector<BeamRow>& rows, const Monitor& monitor)
{
  Buffer<BeamRow> rowBuffer;
  const LampInfo info = this->Lamp.Describe(this->Box, this->All.Own);
  this->All.Rounds.UntilAllEnd<BeamOnItsWay>(
    [&](int round, std::vector<BeamOnItsWay>&& arrived, const Monitor& ofRound) {
      if (round == 0)
      {
        arrived = this->SettingOff(rows);
        rowBuffer = Buffer<BeamRow>(this->All.TheDevice, rows.empty() ? std::vector<BeamRow>(1) : rows, "beams");
      }
      return this->FollowInBlock(rows, info, rowBuffer, arrived, ofRound);
    },
    monitor);
}

std::vector<BeamOnItsWay> LampsInBlocks::Beams::SettingOff(const std::vector<BeamRow>& rows) const
{
  std::vector<BeamOnItsWay> own;
  for (std::size_t r = 0; r < rows.size() && this->All.Has(); ++r)
  {
    for (int b = 0; b < rows[r].count; ++b)
    {
      const std::array<int, 3> voxel = FirstVoxel(rows[r], b, this->All.Partition.whole, this->All.Stored.Periodic());
      if (Holds(this->All.Own, voxel.data()))
      {
        own.push_back({ static_cast<cl_int>(r), b, 0, 0, 0, 0.0f, 0.0f, {}, 0.0f, {}, 0 });
      }
    }
  }
  return own;
}

/// @return beams that have left the block for another
std::vector<BeamOnItsWay> LampsInBlocks::Beams::FollowInBlock(const std::vector<BeamRow>& rows, const LampInfo& info,
  const Buffer<BeamRow>& rowBuffer, const std::vector<BeamOnItsWay>& beams, const Monitor& monitor)
{
  Device& device = this->All.TheDevice;
  std::vector<BeamOnItsWay> gone;
  for (std::size_t first = 0, count; first < beams.size(); first += count)
  {
    count = std::min(this->BeamsTogether(rows[beams[first].row]), beams.size() - first);
    const auto begin = beams.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<BeamOnItsWay> some(begin, begin + static_cast<std::ptrdiff_t>(count));
    const Buffer<BeamOnItsWay> onDevice(device, some, "beams");
    const Buffer<float> sums(device, count * LampRowSums, "sums");
    With(this->Kernel, info, this->All.SigmaT, cl_ulong(this->SigmaFirst), this->Sums->Sums(),
      cl_ulong(this->Sums->Stride()), this->Sums->Cells(), rowBuffer, onDevice, cl_int(count), sums);
    device.Queue().enqueueNDRangeKernel(
      this->Kernel, cl::NullRange, cl::NDRange(LampOnGrid::HasAtomics(device) ? count : 1), GroupOfLargeItems(device));
    device.Finish();
    const std::vector<BeamOnItsWay> after = onDevice.Read();
    const std::vector<float> found = sums.Read();
    for (std::size_t b = 0; b < count; ++b)
    {
      this->Found.Count(rows[after[b].row], found.data() + b * LampRowSums);
      if (!after[b].ended)
      {
        gone.push_back(after[b]);
      }
    }
    Report(monitor, static_cast<double>(first + count) / static_cast<double>(beams.size()));
  }
  return gone;
}

/// Number of beams per launch, fewer where beams travel far around a periodic axis within the block.
std::size_t LampsInBlocks::Beams::BeamsTogether(const BeamRow& row) const
{
  const bool all = this->All.Own.size[row.axis] == this->All.Partition.whole.size[row.axis];
  const double layers = all && this->All.Stored.Periodic()[row.axis] ? row.layers : 1.0;
  const double most = static_cast<double>(BeamsPerLaunch);
  return static_cast<std::size_t>(std::clamp(LampOnGrid::LayersPerLaunch / layers, 1.0, most));
}

/// Adds the tallies of all ranks' beams to the shares. Collective.
void LampsInBlocks::Beams::AddToShares()
{
  std::vector<double> values = { this->Found.shone, this->Found.onTheWay };
  values.insert(values.end(), this->Found.in.begin(), this->Found.in.end());
  values.insert(values.end(), this->Found.out.begin(), this->Found.out.end());
  values = this->All.Comm.Sum(values);
  this->Shares.shone += values[0];
  this->Shares.onTheWay += values[1];
  for (std::size_t face = 0; face < 6; ++face)
  {
    this->Shares.in[face] += values[2 + face];
    this->Shares.out[face] += values[8 + face];
  }
  this->Found = {};
}

/// Adds the sums of the block's voxels, gathered from all ranks whose beams crossed them, to the deposit. Collective.
/// @param even  fraction of the power to be spread uniformly
LampFactors LampsInBlocks::Beams::PutDown(double even)
{
  const LampsInBlocks& all = this->All;
  std::vector<cl_long> found, own;
  all.Comm.Collective([&] { found = this->Sums ? this->Sums->Sums().Read() : found; });
  // A rank without voxels may not know which arrays the other ranks' deposits have.
  const int parts =
    static_cast<int>(all.Comm.Largest({ static_cast<double>(LampSums::Parts(this->Lamp, this->Volume.deposit)) })[0]);
  for (int part = 0; part < parts; ++part)
  {
    const std::size_t count = this->Box.VoxelCount();
    const auto begin = found.begin() + static_cast<std::ptrdiff_t>(part * count);
    const std::vector<std::int64_t> ofPart(begin, begin + static_cast<std::ptrdiff_t>(count));
    const std::vector<std::int64_t> inBlock = all.Stored.Gather(ofPart);
    own.insert(own.end(), inBlock.begin(), inBlock.end());
    own.resize((part + 1) * this->Volume.stride, 0);
  }
  const std::vector<cl_long> cells = this->CellsOfAll();
  const double extinction = even > 0.0 ? this->ExtinctionOfAll() : 0.0;
  std::unique_ptr<LampSums> sums;
  double taken = 0.0;
  all.Comm.Collective([&] {
    sums = std::make_unique<LampSums>(
      all.TheDevice, this->Lamp, this->Volume.deposit, this->Volume.stride, all.Partition.whole);
    if (all.Has())
    {
      sums->Sums().Write(own.data());
      taken = sums->FitToVacuum(this->Volume, this->Lamp, all.Own);
    }
  });
  taken = all.Comm.Sum({ taken })[0];
  const LampFactors factors = this->Lamp.Factors(this->Shares, taken, even);
  all.Comm.Collective([&] {
    if (all.Has())
    {
      sums->AddTo(this->Volume, this->Lamp, factors.taken);
      sums->SpreadEvenly(this->Volume, this->Lamp, factors.out * even, extinction);
    }
    if (!cells.empty())
    {
      const std::size_t faceFirst = this->Volume.firstChannel * BoxFaceCellCount(all.Partition.whole);
      sums->Cells().Write(cells.data());
      sums->AddCellsTo(this->Volume, faceFirst, this->Lamp, factors.out);
    }
    all.TheDevice.Finish(); // the sums are released
  });
  this->Shares.onTheWay += extinction > 0.0 ? 0.0 : even; // no voxel absorbs it
  return factors;
}

double LampsInBlocks::Beams::ExtinctionOfAll()
{
  double own = 0.0;
  this->All.Comm.Collective([&] { own = this->All.Has() ? Extinction(this->Volume) : 0.0; });
  return this->All.Comm.Sum({ own })[0];
}

/// Escaped power by cell of the whole grid's faces, summed over ranks; empty if not wanted. Collective.
std::vector<cl_long> LampsInBlocks::Beams::CellsOfAll()
{
  if (!this->Volume.deposit.faceOut)
  {
    return {};
  }
  std::vector<double> values(BoxFaceCellCount(this->All.Partition.whole), 0.0);
  this->All.Comm.Collective([&] {
    if (this->Sums)
    {
      const std::vector<cl_long> own = this->Sums->Cells().Read();
      std::copy(own.begin(), own.end(), values.begin());
    }
  });
  values = this->All.Comm.Sum(values);
  return { values.begin(), values.end() };
}

SweepTally LampsInBlocks::Deposit(const SweepVolume& volume, const Light& light, const Monitor& monitor)
{
  return Beams(*this, volume, light).Run(monitor);
}
}
