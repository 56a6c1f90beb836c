#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace tyndall
{
/// Arrays over voxels that the plane kernels read and write (SweepOnGpu.cl). Any buffer may be given for an array that
/// the options do not use.
struct PlaneArrays
{
  const Buffer<float>&sigma_t, &source, &octants, &path, &lost, &flux, &currents;
};

/// Arrays over rays that the plane kernels read and write (SweepOnGpu.cl).
struct PlaneRays
{
  const Buffer<SweepLane>& lanes;
  const Buffer<BundleInfo>& bundles;
  const Buffer<CrossingInfo>& crossings;
  const Buffer<cl_float4>& entering;
  std::array<const Buffer<float>*, 2> maps; ///< rays before planes with even index, and before planes with odd index
  const Buffer<float>&directed, &functions; ///< used only with angular moments
  const Buffer<float>& escaped;
};

/// Kernels that carry the rays of lanes through planes on a GPU, one launch per plane.
class PlaneKernels
{
public:
  struct Size
  {
    int u = 0, v = 0;     ///< largest extents of a plane of any lane, voxels
    int lanes = 1;        ///< that run concurrently
    std::size_t rays = 0; ///< rays of all these lanes, times channels
  };

  /// @param options  see SweepOnGpu.cl
  /// @param directs  the source in each ray's direction is computed from angular moments before each plane
  PlaneKernels(Device& device, const std::string& options, bool directs, const Size& size);

  /// Sets the buffers of rays that enter and leave through the sides of the planes; for options with SIDES.
  /// @param outerSides  see VoxelSides.cl and `cross_plane`
  void SetSides(const Buffer<float>& in, const Buffer<float>& out, int outerSides);

  /// Queues the planes [from, to), counted from where rays start.
  /// @param after  events that the launches wait for; null: none
  /// @param done   event signalled when they have finished; null: not needed
  /// @param crossed  called with the number of planes that have been crossed
  void Launch(PlaneLaunch launch, const PlaneArrays& in, const PlaneRays& rays, int from, int to,
    const std::vector<cl::Event>* after, cl::Event* done, const std::function<void(int)>& crossed);

private:
  Device& TheDevice;
  cl::Kernel Cross, Find;
  cl::NDRange All;
  double Seconds; ///< upper estimate for one plane
};
}
