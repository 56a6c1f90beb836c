#include "BeamNearness.h"

#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
// As beam_info in BeamNearness.cl.
struct BeamInfo
{
  cl_int size[3], periodic[3], up[3];
  cl_float spacing[3], lengths[3], thin;
};
}

BeamNearness::BeamNearness(Device& device, const SweepVolume& volume, Kind kind)
  : TheDevice(device)
  , Volume(volume)
  , TheKind(kind)
  , OfBeams(volume)
{
  const std::size_t all = volume.first + volume.channels * volume.stride;
  const char* what = "the light of a beam";
  this->Path = Buffer<float>(device, all + SweepPadding, what);
  this->Entering = Buffer<float>(device, 6 * all + SweepPadding, what);
  this->Path.Fill(0.0f);
  this->Entering.Fill(0.0f);
  this->OfBeams.path = &this->Path;
  this->OfBeams.entering = &this->Entering;
  if (kind == Kind::Octant)
  {
    this->Flux = Buffer<float>(device, 3 * all + SweepPadding, what);
    this->Flux.Fill(0.0f);
    this->OfBeams.flux = &this->Flux;
  }
}

void BeamNearness::Add(const std::array<double, 3>& omega, const std::array<bool, 3>& periodic)
{
  const SweepVolume& volume = this->Volume;
  BeamInfo info = {};
  for (int a = 0; a < 3; ++a)
  {
    info.size[a] = volume.grid.size[a];
    info.periodic[a] = periodic[a];
    info.up[a] = omega[a] >= 0.0;
    info.spacing[a] = static_cast<float>(volume.grid.spacing[a]);
    info.lengths[a] = static_cast<float>(volume.grid.spacing[a] / std::max(std::abs(omega[a]), 1e-6));
  }
  info.thin = ThinForNearness;
  const bool octant = this->TheKind == Kind::Octant;
  const bool netFlux = octant && volume.flux;
  cl::Kernel add = this->TheDevice.Kernel("add_beam", { kernel_source::BeamNearness },
    "-DOCTANT=" + std::to_string(octant) + " -DNET_FLUX=" + std::to_string(netFlux));
  With(add, info, *volume.sigma_t, cl_ulong(volume.sigma_t_first), this->Path, this->Entering,
    octant ? this->Flux : this->Path, *volume.path, *volume.nearness, netFlux ? *volume.flux : *volume.path,
    cl_ulong(volume.first), cl_ulong(volume.stride));
  this->TheDevice.Queue().enqueueNDRangeKernel(
    add, cl::NullRange, cl::NDRange(volume.grid.VoxelCount(), volume.channels), cl::NullRange);
  this->TheDevice.Finish();
}
}
