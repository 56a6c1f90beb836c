#pragma once

#include "Device/Monitor.h"
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"
#include "LightPropagation/Sweep/Slices/SliceStream.h"
#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// Streams a volume in host memory for one lane of a sweep on GPUs. A lane is the rays that march in one sense along an
/// axis; they cross slices of the volume one after another. A slot is a device buffer for one slice; two slots
/// alternate (numerics.md, section 4.10).
class LaneSlices
{
public:
  /// Returns null if the volume is not streamed because it is in device memory or is swept in place
  /// (SliceStream::Make()). Otherwise changes the memory layout in `lane` to that of a slot, the device buffer for one
  /// slice.
  /// @param plan  the plan of the lane's axis
  static std::unique_ptr<LaneSlices> Make(
    Device& device, const SweepPlan& plan, SweepLane& lane, SweepWorkspace& workspace);

  VolumeArrays Arrays() const { return this->Stream->Arrays(); } ///< device arrays that hold the slots, one slice each

  /// Queues the crossing of the lane's planes [from, to), whose slice of the volume is in the slot (device buffer) that
  /// `launch` gives. The planes wait for the events `after`; the last plane signals `done`.
  using Planes =
    std::function<void(PlaneLaunch launch, int from, int to, const std::vector<cl::Event>* after, cl::Event* done)>;
  /// Copies all slices of the volume, one after another, to the slots and back, and crosses all planes.
  /// @param launch  arguments of the launch, except plane and slot
  void Cross(const SweepVolume& volume, const PlaneLaunch& launch, const Planes& cross);

private:
  LaneSlices(const SweepPlan& plan, const SweepLane& lane);

  /// Sweep plan of the lane's axis, in which all rays of the lane form one unit of work, i.e. cross the planes
  /// together.
  SweepPlan Plan;
  std::unique_ptr<SliceStream> Stream;
  SliceStream::Schedule Schedule;
};

/// Arrays over rays that the plane kernels (SweepOnGpu.cl) read and write.
struct PlaneRays
{
  const Buffer<SweepLane>& lanes;
  const Buffer<BundleInfo>& bundles;
  const Buffer<CrossingInfo>& crossings;
  const Buffer<cl_float4>& entering;
  /// Power of the rays, W, before planes with even index, and before planes with odd index; planes are counted from
  /// where rays start
  std::array<const Buffer<float>*, 2> maps;
  const Buffer<float>&directed,
    &functions; ///< source along each ray, and angular functions; used only with angular moments
  const Buffer<float>& escaped;
  const Buffer<float>&sidesIn, &sidesOut; ///< power of the rays at the sides, W; used only with SIDES
};

/// Values of the compiler option SIDES of the plane kernels. The rays that enter and leave through the sides of the box
/// are either not stored, or they are stored for one of two reasons: the box is a block (subdomain), or light is given
/// or summed per cell of the domain's faces.
enum
{
  SidesNotStored = 0,
  SidesOfBlock = 1,
  SidesOfDomain = 2
};

/// Kernels that carry the rays of several lanes (each the rays of one sense along an axis) through planes on a GPU, one
/// launch per plane.
class PlaneKernels
{
public:
  struct Size
  {
    int u = 0, v = 0;     ///< largest extents of a plane of any lane, voxels
    int lanes = 1;        ///< number of lanes that run concurrently
    std::size_t rays = 0; ///< number of rays of all lanes that run concurrently, times channels
  };

  /// @param sides  compiler option SIDES (SidesNotStored, SidesOfBlock or SidesOfDomain)
  PlaneKernels(Device& device, const SweepDescription& sweep, int sides, const Size& size);

  /// Queues the crossing of planes 0 to planes - 1, counted from where rays start.
  /// @param arrays  the volume's arrays, or the lanes' own arrays
  /// @param slices  streams the slices of a volume in host memory; null: the volume is not streamed
  void Cross(const SweepVolume& volume, const PlaneLaunch& launch, const VolumeArrays& arrays, LaneSlices* slices,
    const PlaneRays& rays, int planes, const Monitor& monitor);

private:
  Device& TheDevice;
  /// FindDirected computes the source along each ray, only with angular moments
  cl::Kernel CrossPlane, FindDirected;
  cl::NDRange All;
  double Seconds; ///< upper estimate of the time for one plane, s
};
}
