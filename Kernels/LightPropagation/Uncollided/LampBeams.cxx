#include "LightPropagation/Uncollided/LampBeams.h"

#include "Device/GroupSize.h"
#include "LightPropagation/Uncollided/LampOnGrid.h"
#include "LightPropagation/Uncollided/LampPyramids.h"
#include "LightPropagation/Uncollided/LampShares.h"
#include "LightPropagation/Uncollided/LampSums.h"
#include "TyndallKernelSources.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>

namespace tyndall
{
namespace
{
constexpr int RowsPerLaunch = 256;      ///< keeps a launch well below a tenth of a second for rows of a thousand voxels
constexpr double LayersPerLaunch = 4e6; ///< of beams that go round a periodic axis: the same
constexpr int PassesAtMost = 9;         ///< in all
constexpr int EvenFrom = 3;             ///< passes, after which the light of a box without faces is spread evenly
constexpr double LeftAtMost = 5e-4;     ///< of the power: then no further pass

/// The beams of one lamp, from all points that stand for it.
class LampBeams
{
public:
  LampBeams(Device& device, const SweepVolume& volume, const Light& light, const std::array<bool, 3>& periodic)
    : TheDevice(device)
    , Volume(volume)
    , Lamp(light, volume.grid, periodic)
    , Periodic(periodic)
    , Sums(device, volume.deposit, volume.stride, volume.grid)
  {
  }

  SweepTally Run(const Monitor& monitor)
  {
    this->FollowAll(monitor);
    // All directions of a lamp inside the box were followed: so it is known what beams on the cone's border missed.
    const double correction = this->AllInside && this->Shares.shone > 0.0 ? 1.0 / this->Shares.shone : 1.0;
    this->Sums.AddTo(this->Volume, this->Lamp, correction);
    if (this->Volume.deposit.faceOut)
    {
      this->Sums.AddCellsTo(this->Volume, this->Volume.faceFirst, this->Lamp, correction);
    }
    if (this->Even > 0.0)
    {
      this->SpreadEvenly(correction);
    }
    return this->Shares.Times(this->Lamp.TheLight().power, this->Volume.channels, correction);
  }

private:
  /// Round periodic axes in passes (numerics.md, section 5.3): beams that are still in the box where one pass ends go
  /// on as others, fewer, that share its power.
  void FollowAll(const Monitor& monitor)
  {
    Pass pass = FirstPass(this->Volume.grid);
    this->FollowPoints(pass, 1.0, OfPart(monitor, 0.0, 0.5));
    const bool endless = this->Periodic[0] && this->Periodic[1] && this->Periodic[2];
    for (int done = 1; done<PassesAtMost&& this->Shares.onTheWay> LeftAtMost * this->Shares.shone; ++done)
    {
      if (endless && done >= EvenFrom)
      {
        std::swap(this->Even, this->Shares.onTheWay);
        return;
      }
      const Monitor ofPass = OfPart(monitor, 1.0 - std::exp2(-done), 1.0 - std::exp2(-done - 1));
      const double wanted = this->Shares.onTheWay;
      this->Shares.onTheWay = 0.0;
      pass = pass.Next();
      this->FollowPoints({ pass.begin, pass.begin }, 1.0, {}); // what these beams have left where the pass begins
      const double found = this->Shares.onTheWay;
      if (!(found > 0.0))
      {
        this->Shares.onTheWay = wanted;
        return;
      }
      this->Shares.onTheWay = 0.0;
      this->FollowPoints(pass, wanted / found, ofPass);
    }
  }

  void FollowPoints(const Pass& pass, double factor, const Monitor& monitor)
  {
    // From far a rectangle is a point.
    const std::vector<glm::dvec3> points =
      pass.begin == 0 ? this->Lamp.Points() : std::vector<glm::dvec3>{ this->Lamp.Middle() };
    const double all = static_cast<double>(points.size());
    for (std::size_t p = 0; p < points.size(); ++p)
    {
      this->Follow(points[p], pass, factor / all, [&](double done) { Report(monitor, (p + done) / all); });
    }
  }

  /// In a box without faces thin light crosses all places alike in the end.
  void SpreadEvenly(double correction)
  {
    const SweepVolume& volume = this->Volume;
    const std::vector<float> sigma = volume.sigma_t->Read();
    const auto first = sigma.begin() + volume.sigma_t_first;
    const double sum = std::accumulate(first, first + volume.grid.VoxelCount(), 0.0);
    if (!(sum > 0.0))
    {
      this->Shares.onTheWay = this->Even; // nothing ever takes it
      return;
    }
    for (int c = 0; c < volume.channels; ++c)
    {
      cl::Kernel add = this->Kernel("add_evenly", kernel_source::LampSums);
      With(add, *volume.deposit.path, cl_ulong(volume.first + c * volume.stride),
        static_cast<float>(this->Lamp.TheLight().power[c] * correction * this->Even / sum));
      this->TheDevice.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(volume.grid.VoxelCount()));
    }
  }

  cl::Kernel Kernel(const char* name, std::string_view source)
  {
    return this->Lamp.Kernel(this->TheDevice, name, source, this->Volume.deposit);
  }

  void Follow(const glm::dvec3& point, const Pass& pass, double part, const std::function<void(double)>& report)
  {
    this->AllInside = this->AllInside && this->Lamp.IsInside(point);
    const std::vector<BeamRow> rows = this->Lamp.Rows(point, pass);
    if (rows.empty())
    {
      return;
    }
    const Buffer<BeamRow> rowBuffer(this->TheDevice, rows, "the beams of a lamp");
    Buffer<float> sums(this->TheDevice, rows.size() * LampRowSums, "sums");
    cl::Kernel kernel = this->Kernel("follow_lamp", kernel_source::LampBeams);
    const VoxelBox box = { { 0, 0, 0 }, this->Volume.grid.size };
    const LampInfo info = this->Lamp.Describe(point, part, box, box);
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

  /// Rows of a launch. Round a periodic axis it may be far.
  std::size_t RowsTogether(const BeamRow& row) const
  {
    const double layers = this->Periodic[row.axis] ? static_cast<double>(row.count) * row.layers : 1.0;
    return static_cast<std::size_t>(std::clamp(LayersPerLaunch / layers, 1.0, static_cast<double>(RowsPerLaunch)));
  }

  Device& TheDevice;
  const SweepVolume& Volume;
  LampOnGrid Lamp;
  std::array<bool, 3> Periodic;
  LampSums Sums;
  LampShares Shares;
  double Even = 0.0; ///< of the power, to be spread over the whole box
  bool AllInside = true;
};
}

SweepTally DepositLamp(Device& device, const SweepVolume& volume, const Light& light,
  const std::array<bool, 3>& periodic, const Monitor& monitor)
{
  return LampBeams(device, volume, light, periodic).Run(monitor);
}
}
