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
/// Streams a volume in host memory for one lane of a sweep on GPUs: the lane crosses slices one after the other,
/// through two slots on the device (numerics.md, section 4.10).
class LaneSlices
{
public:
  /// Returns null if the volume is swept in place, see SliceStream::Make. Otherwise changes the layout in `lane` to
  /// that of the slots.
  /// @param plan  the plan of the lane's axis
  static std::unique_ptr<LaneSlices> Make(
    Device& device, const SweepPlan& plan, SweepLane& lane, SweepWorkspace& workspace);

  VolumeArrays Arrays() const { return this->Stream->Arrays(); } ///< the slots

  /// Queues the lane's planes [from, to), whose slice lies in the slot given by `launch`. They wait for the events
  /// `after`; the last one signals `done`.
  using Planes =
    std::function<void(PlaneLaunch launch, int from, int to, const std::vector<cl::Event>* after, cl::Event* done)>;
  /// Crosses all planes. @param launch  values of the launch other than plane and slot
  void Cross(const SweepVolume& volume, const PlaneLaunch& launch, const Planes& cross);

private:
  LaneSlices(const SweepPlan& plan, const SweepLane& lane);

  SweepPlan Plan; ///< has one unit, the lane
  std::unique_ptr<SliceStream> Stream;
  SliceStream::Schedule Schedule;
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
  const Buffer<float>&sidesIn, &sidesOut; ///< used only with SIDES
};

/// Values of the option SIDES of these kernels: rays that enter and leave through the sides of the box are not stored;
/// the box is a block of a larger domain; or it is the domain, with light given and counted by cells of its faces.
enum
{
  SidesNotStored = 0,
  SidesOfBlock = 1,
  SidesOfDomain = 2
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

  /// @param sides  the option SIDES, see SweepOnGpu.cl
  PlaneKernels(Device& device, const SweepDescription& sweep, int sides, const Size& size);

  /// Queues the planes [0, planes), counted from where rays start.
  /// @param arrays  the volume's arrays, or the lanes' own
  /// @param slices  null: the volume is not streamed
  void Cross(const SweepVolume& volume, const PlaneLaunch& launch, const VolumeArrays& arrays, LaneSlices* slices,
    const PlaneRays& rays, int planes, const Monitor& monitor);

private:
  Device& TheDevice;
  cl::Kernel CrossPlane, FindDirected; ///< the second one only with angular moments
  cl::NDRange All;
  double Seconds; ///< upper estimate for one plane
};
}
