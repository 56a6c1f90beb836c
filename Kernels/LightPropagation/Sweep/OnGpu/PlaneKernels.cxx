#include "LightPropagation/Sweep/OnGpu/PlaneKernels.h"

#include "Device/Sizes.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
namespace
{
/// Work-items per group along u, whose voxels are mostly contiguous, and along v.
constexpr std::size_t GroupU = 32, GroupV = 4;
constexpr double GpuSecondsPerRay = 1e-10; ///< per ray and voxel; only determines how often to wait
}

PlaneKernels::PlaneKernels(Device& device, const std::string& options, bool directs, const Size& size)
  : TheDevice(device)
  , Cross(device.Kernel("cross_plane", kernel_source::SweepOnGpu, options))
  , All(RoundUp(Count(size.u), GroupU), RoundUp(Count(size.v), GroupV), Count(size.lanes))
  , Seconds(GpuSecondsPerRay * size.u * size.v * static_cast<double>(size.rays))
{
  if (directs)
  {
    this->Find = device.Kernel("find_directed", kernel_source::SweepOnGpu, options);
  }
}

void PlaneKernels::SetSides(const Buffer<float>& in, const Buffer<float>& out, int outerSides)
{
  constexpr cl_uint BehindTheOthers = 17; // index of the first argument after those that Launch sets
  SetFrom(this->Cross, BehindTheOthers, in, out, cl_int(outerSides));
}

void PlaneKernels::Launch(PlaneLaunch launch, const PlaneArrays& in, const PlaneRays& rays, int from, int to,
  const std::vector<cl::Event>* after, cl::Event* done, const std::function<void(int)>& crossed)
{
  const cl::NDRange group(GroupU, GroupV, 1);
  for (launch.plane = from; launch.plane < to; ++launch.plane)
  {
    if (this->Find())
    {
      With(this->Find, launch, rays.lanes, in.source, rays.functions, rays.directed);
      this->TheDevice.Queue().enqueueNDRangeKernel(this->Find, cl::NullRange, this->All, group, after);
    }
    With(this->Cross, launch, rays.lanes, in.sigma_t, in.source, in.octants, in.path, in.lost, in.flux, in.currents,
      *rays.maps[launch.plane % 2], *rays.maps[1 - launch.plane % 2], rays.entering, rays.bundles, rays.crossings,
      rays.directed, rays.functions, rays.escaped);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      this->Cross, cl::NullRange, this->All, group, after, launch.plane + 1 == to ? done : nullptr);
    after = nullptr; // later launches are ordered by the queue
    this->TheDevice.Queued(this->Seconds);
    crossed(launch.plane + 1);
  }
}
}
