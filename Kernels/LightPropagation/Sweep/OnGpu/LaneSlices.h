#pragma once

#include "LightPropagation/Sweep/OnGpu/PlaneKernels.h"
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"
#include "LightPropagation/Sweep/Slices/SliceStream.h"
#include "LightPropagation/Sweep/SweepPlan.h"

#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// The slices of a volume in host memory that one lane of a sweep for GPUs crosses one after the other, through two
/// slots on the device (numerics.md, section 4.10).
class LaneSlices
{
public:
  /// Null where the volume is swept where it lies, see SliceStream::Make; else the lane is described as slots lie.
  /// @param plan  of the lane's axis
  static std::unique_ptr<LaneSlices> Make(
    Device& device, const SweepPlan& plan, SweepLane& lane, SweepWorkspace& workspace);

  PlaneArrays Arrays() const; ///< the slots

  /// The lane's planes from, to, whose slice lies in a slot that the launch tells; they wait for some events, and the
  /// last one tells one that it is done.
  using Planes =
    std::function<void(PlaneLaunch launch, int from, int to, const std::vector<cl::Event>* after, cl::Event* done)>;
  /// All planes. @param launch  what else is told
  void Cross(const SweepVolume& volume, const PlaneLaunch& launch, const Planes& cross);

private:
  LaneSlices(const SweepPlan& plan, const SweepLane& lane);

  SweepPlan Plan; ///< with one unit: the lane
  std::unique_ptr<SliceStream> Stream;
  SliceStream::Schedule Schedule;
};
}
