#include "LightPropagation/Uncollided/Lamps/LampBeams.h"

#include "Device/GroupSize.h"
#include "LightPropagation/Uncollided/Lamps/LampOnGrid.h"
#include "LightPropagation/Uncollided/Lamps/LampPasses.h"
#include "LightPropagation/Uncollided/Lamps/LampPyramids.h"
#include "LightPropagation/Uncollided/Lamps/LampShares.h"
#include "LightPropagation/Uncollided/Lamps/LampSums.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <string_view>

namespace tyndall
{
namespace
{
constexpr int RowsPerLaunch = 256; ///< keeps a launch well below a tenth of a second for rows of a thousand voxels
constexpr int BeamsOfRow = 64;     ///< rows with fewer beams are launched in larger numbers

/// The beams of one lamp, from all points that stand for it.
class LampBeams
{
public:
  LampBeams(Device& device, const SweepVolume& volume, const Light& light, const std::array<bool, 3>& periodic)
    : TheDevice(device)
    , Volume(volume)
    , Lamp(light, volume.grid, periodic)
    , Periodic(periodic)
    , Sums(device, this->Lamp, volume.deposit, volume.stride, volume.grid)
  {
  }

  SweepTally Run(const Monitor& monitor)
  {
    const FollowPass follow = [this](const Pass& pass, double factor, const Monitor& ofPass) {
      this->FollowPoints(pass, factor, ofPass);
    };
    const double even = FollowInPasses(this->Volume.grid, this->Periodic, this->Shares, follow, monitor);
    const VoxelBox box = { { 0, 0, 0 }, this->Volume.grid.size };
    const double taken = this->Sums.FitToVacuum(this->Volume, this->Lamp, box);
    const LampFactors factors = this->Lamp.Factors(this->Shares, taken, even);
    this->Sums.AddTo(this->Volume, this->Lamp, factors.taken);
    if (this->Volume.deposit.faceOut)
    {
      this->Sums.AddCellsTo(this->Volume, this->Volume.faceFirst, this->Lamp, factors.out);
    }
    if (even > 0.0 && !this->Sums.SpreadEvenly(this->Volume, this->Lamp, factors.out * even, Extinction(this->Volume)))
    {
      this->Shares.onTheWay = even; // no voxel absorbs it
    }
    return this->Shares.Times(this->Lamp.TheLight().power, this->Volume.channels, factors);
  }

private:
  void FollowPoints(const Pass& pass, double factor, const Monitor& monitor)
  {
    const std::vector<LampPoint>& points = this->Lamp.PointsOf(pass);
    const double all = static_cast<double>(points.size());
    for (std::size_t p = 0, next; p < points.size(); p = next)
    {
      const std::vector<BeamRow> rows = this->Lamp.Rows(pass, factor, p, next);
      this->Follow(rows, [&](double done) { Report(monitor, (p + done * (next - p)) / all); });
    }
  }

  cl::Kernel Kernel(const char* name, std::string_view source)
  {
    return this->Lamp.Kernel(this->TheDevice, name, source, this->Volume.deposit);
  }

  void Follow(const std::vector<BeamRow>& rows, const std::function<void(double)>& report)
  {
    if (rows.empty())
    {
      return;
    }
    const Buffer<BeamRow> rowBuffer(this->TheDevice, rows, "the beams of a lamp");
    Buffer<float> sums(this->TheDevice, rows.size() * LampRowSums, "sums");
    cl::Kernel kernel = this->Kernel("follow_lamp", kernel_source::LampBeams);
    const VoxelBox box = { { 0, 0, 0 }, this->Volume.grid.size };
    const LampInfo info = this->Lamp.Describe(box, box);
    for (std::size_t first = 0, count; first < rows.size(); first += count)
    {
      count = std::min<std::size_t>(this->RowsTogether(rows[first]), rows.size() - first);
      With(kernel, info, *this->Volume.sigma_t, cl_ulong(this->Volume.sigma_t_first), this->Sums.Sums(),
        cl_ulong(this->Volume.stride), this->Sums.Cells(), rowBuffer, cl_int(count), cl_int(first), sums);
      this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
        cl::NDRange(LampOnGrid::HasAtomics(this->TheDevice) ? count : 1), GroupOfLargeItems(this->TheDevice));
      this->TheDevice.Finish();
      report(static_cast<double>(first + count) / rows.size());
    }
    const std::vector<float> found = sums.Read();
    for (std::size_t r = 0; r < rows.size(); ++r)
    {
      this->Shares.Count(rows[r], found.data() + r * LampRowSums);
    }
  }

  /// Number of rows per launch, fewer where beams travel far around a periodic axis.
  std::size_t RowsTogether(const BeamRow& row) const
  {
    const double layers = this->Periodic[row.axis] ? static_cast<double>(row.count) * row.layers : 1.0;
    const double most = static_cast<double>(RowsPerLaunch) * std::max(BeamsOfRow / row.count, 1);
    return static_cast<std::size_t>(std::clamp(LampOnGrid::LayersPerLaunch / layers, 1.0, most));
  }

  Device& TheDevice;
  const SweepVolume& Volume;
  LampOnGrid Lamp;
  std::array<bool, 3> Periodic;
  LampSums Sums;
  LampShares Shares;
};
}

SweepTally DepositLamp(Device& device, const SweepVolume& volume, const Light& light,
  const std::array<bool, 3>& periodic, const Monitor& monitor)
{
  return LampBeams(device, volume, light, periodic).Run(monitor);
}
}
