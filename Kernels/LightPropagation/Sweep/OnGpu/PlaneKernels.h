#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace tyndall
{
/// What the kernels of planes read and write (SweepOnGpu.cl); of what there is none any buffer stands for it.
struct PlaneArrays
{
  const Buffer<float>&sigma_t, &source, &octants, &path, &lost, &flux, &currents;
};

/// And of the rays.
struct PlaneRays
{
  const Buffer<SweepLane>& lanes;
  const Buffer<BundleInfo>& bundles;
  const Buffer<CrossingInfo>& crossings;
  const Buffer<cl_float4>& entering;
  std::array<const Buffer<float>*, 2> maps; ///< before planes of even numbers, and of odd ones
  const Buffer<float>&directed, &functions; ///< with angular moments
  const Buffer<float>& escaped;
};

/// The kernels that carry the rays of lanes through planes on a GPU, a launch a plane.
class PlaneKernels
{
public:
  struct Size
  {
    int u = 0, v = 0;     ///< voxels, the most of any lane
    int lanes = 1;        ///< side by side
    std::size_t rays = 0; ///< of all these, times channels
  };

  /// @param options  as SweepOnGpu.cl has them
  /// @param directs  what shines along the rays is found from angular moments before each plane
  PlaneKernels(Device& device, const std::string& options, bool directs, const Size& size);

  /// What comes in and goes out beside planes, where the options say SIDES; outerSides as there.
  void SetSides(const Buffer<float>& in, const Buffer<float>& out, int outerSides);

  /// Planes from, to, counted from where rays start.
  /// @param after  events that these wait for; null: none
  /// @param done   is told when they are; null: nobody asks
  /// @param crossed  called with the number of planes behind which the launches are
  void Launch(PlaneLaunch launch, const PlaneArrays& in, const PlaneRays& rays, int from, int to,
    const std::vector<cl::Event>* after, cl::Event* done, const std::function<void(int)>& crossed);

private:
  Device& TheDevice;
  cl::Kernel Cross, Find;
  cl::NDRange All;
  double Seconds; ///< of a plane, at most
};
}
