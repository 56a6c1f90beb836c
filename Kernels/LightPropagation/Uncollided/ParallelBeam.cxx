#include "LightPropagation/Uncollided/ParallelBeam.h"

#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Uncollided/ParallelBeamShared.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr int RaysPerEdge = 2; ///< rays per edge of a voxel
/// Rays per edge if first moments are wanted: with few rays an oblique beam enters some voxels through one face and
/// their neighbours through another, and each voxel seems to be lit from one side only.
constexpr int RaysPerThickEdge = 8;

}

SweepTally SweepBeam(
  const UncollidedVolume& volume, const Light& light, bool firstMoments, const Deposit& deposit, const Monitor& monitor)
{
  const Grid& grid = volume.domain.Whole();
  const std::array<double, 3> omega = DirectionOf(light);
  const std::vector<int> axes = MarchingAxes(grid, omega);
  Rgb power = light.power; // each marching axis carries an equal part of the beam
  for (double& ofChannel : power)
  {
    ofChannel /= static_cast<double>(axes.size());
  }
  const int raysPerEdge = firstMoments ? RaysPerThickEdge : RaysPerEdge;
  SweepTally tally;
  for (std::size_t a = 0; a < axes.size(); ++a)
  {
    const SweepRequest request = { deposit,
      { { axes[a], BeamAlong(axes[a], grid, volume.periodic, omega, raysPerEdge) } } };
    const double all = static_cast<double>(axes.size());
    const Monitor ofAxis = OfPart(monitor, a / all, (a + 1) / all);
    Add(tally,
      volume.makeSweep(request)->Apply(
        nullptr, [&](int, int) { return power; }, ofAxis));
  }
  return tally;
}

void AddWithFirstMoments(
  const UncollidedVolume& volume, const Light& light, const Deposit& ofBeam, const BeyondFaces& beyond)
{
  const std::array<double, 3> omega = DirectionOf(light);
  const Grid& grid = volume.layout.grid;
  BeamInfo info = {};
  for (int a = 0; a < 3; ++a)
  {
    info.size[a] = grid.size[a];
    info.periodic[a] = volume.periodic[a];
    info.up[a] = omega[a] >= 0.0;
    info.spacing[a] = static_cast<float>(grid.spacing[a]);
    info.lengths[a] = static_cast<float>(grid.spacing[a] / std::max(std::abs(omega[a]), 1e-6));
  }
  info.thin = ThinForFirstMoments;
  info.beyond = beyond.info;
  cl::Kernel add = volume.device.Kernel("add_beam", kernel_source::ParallelBeam);
  for (const ChannelGroup& group : volume.layout.Groups())
  {
    const SweepVolume to = GroupVolume(volume.layout, group, volume.sigma_t, volume.deposit);
    With(add, info, *to.sigma_t, cl_ulong(to.sigma_t_first), *ofBeam.path, *ofBeam.partialCurrents,
      beyond.values ? *beyond.values : *ofBeam.path, cl_ulong(group.first), *to.deposit.path, *to.deposit.firstMoments,
      cl_ulong(to.first), cl_ulong(to.stride));
    volume.device.Queue().enqueueNDRangeKernel(
      add, cl::NullRange, cl::NDRange(grid.VoxelCount(), to.channels), cl::NullRange);
  }
  volume.device.Finish(); // the beam's arrays are released
}

SweepTally DepositBeam(const UncollidedVolume& volume, const Light& light, const Monitor& monitor)
{
  if (!volume.deposit.firstMoments)
  {
    return SweepBeam(volume, light, false, volume.deposit, monitor);
  }
  Buffer<float> path, partialCurrents;
  volume.domain.Collective([&] {
    path = Buffer<float>(volume.device, volume.layout.Floats(), "the light of a beam");
    partialCurrents = Buffer<float>(volume.device, volume.layout.Floats(6), "the light of a beam");
    path.Fill(0.0f);
    partialCurrents.Fill(0.0f);
  });
  Deposit deposit = volume.deposit;
  deposit.firstMoments = nullptr;
  deposit.path = &path;
  deposit.partialCurrents = &partialCurrents;
  const SweepTally tally = SweepBeam(volume, light, true, deposit, monitor);
  const BeyondFaces beyond = volume.fetchBeyond ? volume.fetchBeyond(partialCurrents) : BeyondFaces();
  if (volume.layout.grid.VoxelCount() > 0)
  {
    AddWithFirstMoments(volume, light, deposit, beyond);
  }
  return tally;
}
}
