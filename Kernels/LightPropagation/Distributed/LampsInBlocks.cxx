#include "LightPropagation/Distributed/LampsInBlocks.h"

#include "Device/GroupSize.h"
#include "Distribution/BoxExchange.h"
#include "LightPropagation/Uncollided/LampOnGrid.h"
#include "LightPropagation/Uncollided/LampShares.h"
#include "LightPropagation/Uncollided/LampSums.h"
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
constexpr int Reach = 2; ///< voxels beside a block that beams in it may lie over, and one for rounding
constexpr std::size_t BeamsPerLaunch = 1 << 14; ///< keeps a launch well below a tenth of a second

/// Where a beam sets off, the nearest voxel of the grid; about: whoever has it takes its first step.
std::array<int, 3> FirstVoxel(const BeamRow& row, int beam, const glm::dvec3& point, const Grid& grid)
{
  const double tangents[] = { row.tangentU + static_cast<double>(beam) * row.widthU, row.tangentV };
  const double along = row.up ? point[row.axis] + row.begin : point[row.axis] - row.begin;
  std::array<double, 3> place = {};
  place[row.axis] = row.up ? std::floor(along + 1e-6) : std::ceil(along - 1e-6) - 1.0;
  for (int k = 0; k < 2; ++k)
  {
    const int aside = (row.axis + 1 + k) % 3;
    place[aside] = std::floor(point[aside] + tangents[k] * row.begin);
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
  const VolumeLayout& layout, const Buffer<float>& sigma_t)
  : TheDevice(device)
  , Others(communicator)
  , Partition(partition)
  , Own(partition.blocks[communicator.Rank()])
  , Rounds(communicator, partition)
  , OwnStride(layout.Stride())
{
  for (const VoxelBox& block : partition.blocks)
  {
    this->Stored.push_back(block.VoxelCount() > 0 ? Grown(block, Reach, partition.whole) : VoxelBox());
  }
  std::vector<float> own = this->Has() ? sigma_t.Read() : std::vector<float>();
  std::vector<float> stored;
  for (const ChannelGroup& group : layout.Groups())
  {
    std::vector<float> ofGroup(this->Own.VoxelCount());
    std::copy_n(own.begin() + static_cast<std::ptrdiff_t>(this->Has() ? layout.ExtinctionFirst(group.first) : 0),
      ofGroup.size(), ofGroup.begin());
    const std::vector<float> around = ValuesInBox(communicator, partition, this->Stored, ofGroup, 1);
    stored.insert(stored.end(), around.begin(), around.end());
  }
  communicator.Together([&] {
    if (this->Has())
    {
      this->SigmaT = Buffer<float>(device, stored, "sigma_t around a block");
    }
  });
}

/// The beams of one lamp that a rank follows.
class LampsInBlocks::Beams
{
public:
  Beams(LampsInBlocks& lamps, const SweepVolume& volume, const Light& light)
    : All(lamps)
    , Volume(volume)
    , Lamp(light, lamps.Partition.whole, { false, false, false })
    , Box(lamps.Stored[lamps.Others.Rank()])
    , SigmaFirst(volume.sigma_t_first / std::max<std::size_t>(lamps.OwnStride, 1) * this->Box.VoxelCount())
  {
    lamps.Others.Together([&] {
      if (lamps.Has())
      {
        this->Sums =
          std::make_unique<LampSums>(lamps.TheDevice, volume.deposit, this->Box.VoxelCount(), lamps.Partition.whole);
        this->Kernel =
          this->Lamp.Kernel(lamps.TheDevice, "follow_lamp_in_block", kernel_source::LampInBlock, volume.deposit);
      }
    });
  }

  SweepTally Run(const Monitor& monitor)
  {
    const std::vector<glm::dvec3> points = this->Lamp.Points();
    const double all = static_cast<double>(points.size());
    for (std::size_t p = 0; p < points.size(); ++p)
    {
      this->Follow(points[p], 1.0 / all, OfPart(monitor, p / all, (p + 1) / all));
    }
    this->ShareSums();
    // As in one memory.
    const double correction = this->AllInside && this->Shares.shone > 0.0 ? 1.0 / this->Shares.shone : 1.0;
    this->PutDown(correction);
    return this->Shares.Times(this->Lamp.TheLight().power, this->Volume.channels, correction);
  }

private:
  void Follow(const glm::dvec3& point, double part, const Monitor& monitor);
  std::vector<BeamOnItsWay> SettingOff(const std::vector<BeamRow>& rows, const glm::dvec3& point) const;
  std::vector<BeamOnItsWay> FollowInBlock(const std::vector<BeamRow>& rows, const LampInfo& info,
    const Buffer<BeamRow>& rowBuffer, const std::vector<BeamOnItsWay>& beams, const Monitor& monitor);
  void ShareSums();
  std::vector<cl_long> CellsOfAll();
  void PutDown(double correction);

  LampsInBlocks& All;
  const SweepVolume& Volume;
  LampOnGrid Lamp;
  const VoxelBox& Box;
  std::size_t SigmaFirst;
  std::unique_ptr<LampSums> Sums; ///< of the stored voxels; null without any
  cl::Kernel Kernel;
  LampShares Shares;
  bool AllInside = true;
};

/// From one point, until no beam is left anywhere.
void LampsInBlocks::Beams::Follow(const glm::dvec3& point, double part, const Monitor& monitor)
{
  this->AllInside = this->AllInside && this->Lamp.IsInside(point);
  std::vector<BeamRow> rows;
  Buffer<BeamRow> rowBuffer;
  const LampInfo info = this->Lamp.Describe(point, part, this->Box, this->All.Own);
  this->All.Rounds.UntilAllEnd<BeamOnItsWay>(
    [&](int round, std::vector<BeamOnItsWay>&& arrived, const Monitor& ofRound) {
      if (round == 0)
      {
        rows = this->Lamp.Rows(point, FirstPass(this->All.Partition.whole));
        arrived = this->SettingOff(rows, point);
        rowBuffer = Buffer<BeamRow>(this->All.TheDevice, rows.empty() ? std::vector<BeamRow>(1) : rows, "beams");
      }
      return this->FollowInBlock(rows, info, rowBuffer, arrived, ofRound);
    },
    monitor);
}

std::vector<BeamOnItsWay> LampsInBlocks::Beams::SettingOff(
  const std::vector<BeamRow>& rows, const glm::dvec3& point) const
{
  std::vector<BeamOnItsWay> own;
  for (std::size_t r = 0; r < rows.size() && this->All.Has(); ++r)
  {
    for (int b = 0; b < rows[r].count; ++b)
    {
      if (Holds(this->All.Own, FirstVoxel(rows[r], b, point, this->All.Partition.whole).data()))
      {
        own.push_back({ static_cast<cl_int>(r), b, 0, 0, 0, 0.0f, 0.0f, {}, 0 });
      }
    }
  }
  return own;
}

/// @return those that have left the block for another
std::vector<BeamOnItsWay> LampsInBlocks::Beams::FollowInBlock(const std::vector<BeamRow>& rows, const LampInfo& info,
  const Buffer<BeamRow>& rowBuffer, const std::vector<BeamOnItsWay>& beams, const Monitor& monitor)
{
  Device& device = this->All.TheDevice;
  std::vector<BeamOnItsWay> gone;
  for (std::size_t first = 0, count; first < beams.size(); first += count)
  {
    count = std::min(BeamsPerLaunch, beams.size() - first);
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
      this->Shares.Count(rows[after[b].row], found.data() + b * LampRowSums);
      if (!after[b].ended)
      {
        gone.push_back(after[b]);
      }
    }
    Report(monitor, static_cast<double>(first + count) / static_cast<double>(beams.size()));
  }
  return gone;
}

/// Of this rank to those of all.
void LampsInBlocks::Beams::ShareSums()
{
  std::vector<double> values = { this->Shares.shone };
  values.insert(values.end(), this->Shares.in.begin(), this->Shares.in.end());
  values.insert(values.end(), this->Shares.out.begin(), this->Shares.out.end());
  values = this->All.Others.Sum(values);
  this->Shares.shone = values[0];
  std::copy_n(values.begin() + 1, 6, this->Shares.in.begin());
  std::copy_n(values.begin() + 7, 6, this->Shares.out.begin());
}

/// Sums of the block's voxels, from all ranks whose beams lay over them, into the deposit.
void LampsInBlocks::Beams::PutDown(double correction)
{
  const LampsInBlocks& all = this->All;
  const std::vector<cl_long> found = this->Sums ? this->Sums->Sums().Read() : std::vector<cl_long>();
  std::vector<cl_long> own;
  // A rank without voxels may not know what the others want.
  const int parts =
    static_cast<int>(all.Others.Largest({ static_cast<double>(LampSums::Parts(this->Volume.deposit)) })[0]);
  for (int part = 0; part < parts; ++part)
  {
    const std::size_t count = this->Box.VoxelCount();
    const auto begin = found.begin() + static_cast<std::ptrdiff_t>(part * count);
    const std::vector<std::int64_t> ofPart(begin, begin + static_cast<std::ptrdiff_t>(count));
    const std::vector<std::int64_t> inBlock = SumsInBlock(all.Others, all.Partition, all.Stored, ofPart);
    own.insert(own.end(), inBlock.begin(), inBlock.end());
    own.resize((part + 1) * this->Volume.stride, 0);
  }
  const std::vector<cl_long> cells = this->CellsOfAll();
  all.Others.Together([&] {
    LampSums sums(all.TheDevice, this->Volume.deposit, this->Volume.stride, all.Partition.whole);
    if (all.Has())
    {
      sums.Sums().Write(own.data());
      sums.AddTo(this->Volume, this->Lamp, correction);
    }
    if (!cells.empty())
    {
      const std::size_t faceFirst = this->Volume.firstChannel * BoxFaceCellCount(all.Partition.whole);
      sums.Cells().Write(cells.data());
      sums.AddCellsTo(this->Volume, faceFirst, this->Lamp, correction);
    }
    all.TheDevice.Finish(); // the sums go
  });
}

/// What leaves by cells of the whole grid's faces, which each rank knows; empty where nobody asks.
std::vector<cl_long> LampsInBlocks::Beams::CellsOfAll()
{
  if (!this->Volume.deposit.faceOut)
  {
    return {};
  }
  std::vector<double> values(BoxFaceCellCount(this->All.Partition.whole), 0.0);
  if (this->Sums)
  {
    const std::vector<cl_long> own = this->Sums->Cells().Read();
    std::copy(own.begin(), own.end(), values.begin());
  }
  values = this->All.Others.Sum(values);
  return { values.begin(), values.end() };
}

SweepTally LampsInBlocks::Deposit(const SweepVolume& volume, const Light& light, const Monitor& monitor)
{
  return Beams(*this, volume, light).Run(monitor);
}
}
