#include "LightPropagation/Uncollided/UncollidedLamp.h"

#include "Device/Device.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Uncollided/Lamps/LampBeams.h"
#include "LightPropagation/Uncollided/NarrowLight.h"
#include "LightPropagation/Uncollided/ParallelBeamShared.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tyndall
{
namespace
{
/// Computes the uncollided flux of a directional light by sweeps along its direction, with 2 x 2 parallel rays per
/// voxel (numerics.md, section 5.3); with 8 x 8 if the deposit has first moments.
///
/// @return incident power, escaped power, and power in transit along periodic axes, W
SweepTally DepositBeam(const UncollidedVolume& volume, const Light& light, const Monitor& monitor);

// DepositBeam() consists of the two steps below. They also work on arrays that cover only a block of the grid.

/// Sweeps along the beam of a directional light.
/// @param volume  its deposit is not used
/// @param firstMoments  whether AddWithFirstMoments() follows, which needs more rays
/// @param deposit  receives the light of the beam
SweepTally SweepBeam(const UncollidedVolume& volume, const Light& light, bool firstMoments, const Deposit& deposit,
  const Monitor& monitor);

/// Adds a beam's deposit to the path and first moments of the volume's deposit. First moments are computed from the
/// powers that enter each voxel and its neighbours through their faces.
/// @param ofBeam  path and partial currents of the beam
/// @param beyond  partial currents of the beam beyond the block's faces, if the layout's grid is a block
void AddWithFirstMoments(
  const UncollidedVolume& volume, const Light& light, const Deposit& ofBeam, const BeyondFaces& beyond = {});

namespace
{
constexpr int RaysPerEdge = 2; ///< rays per edge of a voxel's face
/// Rays per edge of a voxel's face if first moments are computed. With few rays of an oblique beam, all rays of a voxel
/// may enter through the same face, and the voxel would seem to be lit from one side only.
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
    Launch(volume.device, add, cl::NDRange(grid.VoxelCount(), to.channels));
  }
  volume.device.Finish(); // the kernels must end before the beam's arrays are released
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
  AddWithFirstMoments(volume, light, deposit, beyond);
  return tally;
}
}

UncollidedLamp::UncollidedLamp(const Light& lamp)
  : Lamp(lamp)
{
}

SweepTally UncollidedLamp::AddTo(const UncollidedVolume& volume, const Monitor& monitor) const
{
  if (Sum(this->Lamp.power) == 0.0)
  {
    return {};
  }
  const bool parallel = this->Lamp.type == LightType::Directional;
  std::optional<NarrowLight> light;
  volume.domain.Collective([&] { // a rank without voxels has no basis, and no light of its own
    if (volume.basis)
    {
      light.emplace(volume, !parallel);
    }
  });
  UncollidedVolume apart = volume;
  apart.deposit = light ? light->To() : volume.deposit;
  const SweepTally tally = this->Put(apart, monitor);
  if (light && parallel)
  {
    light->AddAlong(DirectionOf(this->Lamp));
  }
  else if (light)
  {
    light->AddAlongFlux();
  }
  return tally;
}

/// Deposits path integrals, net flux and first moments of the lamp's light, without angular moments.
SweepTally UncollidedLamp::Put(const UncollidedVolume& volume, const Monitor& monitor) const
{
  if (this->Lamp.type == LightType::Directional)
  {
    return DepositBeam(volume, this->Lamp, monitor);
  }
  const auto add = [this, &volume](const SweepVolume& ofChannels, int first, const Monitor& ofGroup) {
    Light light = this->Lamp;
    light.power = OfGroup(this->Lamp.power, first);
    if (Sum(light.power) == 0.0)
    {
      return SweepTally();
    }
    return DepositLamp(volume.device, volume.domain, ofChannels, light, volume.periodic, ofGroup);
  };
  return AddByGroups(volume, monitor, add);
}
}
