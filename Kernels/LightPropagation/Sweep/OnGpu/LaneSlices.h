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

  PlaneArrays Arrays() const; ///< the slots

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
}
