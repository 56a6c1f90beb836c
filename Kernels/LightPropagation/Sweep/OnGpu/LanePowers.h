#pragma once

#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"
#include "LightPropagation/Sweep/SweepTally.h"

#include <functional>

namespace tyndall
{
/// Power that leaves a sweep on GPUs: sideways, and in its maps behind the last plane. Rows are summed on the device,
/// the sums of rows on the host in double precision.
class LanePowers
{
public:
  /// @param lanes  must outlive this object
  LanePowers(Device& device, const GpuLanes& lanes);

  /// Power that leaves sideways, W, written by the plane kernels; see SweepLane::escaped.
  const Buffer<float>& Escaped() const { return this->OfPlanes; }

  using MapsOfLane = std::function<const Buffer<float>&(const SweepLane&)>;

  /// Sums the rows of the planes that were crossed last.
  void AddUp(const LaneBatch& batch, const MapsOfLane& maps);
  /// Adds the power that left through the sides of the box, from the sums of AddUp().
  void CountSides(const LaneBatch& batch, SweepTally& tally) const;
  /// Adds the power that left through the far ends of the batch's axes.
  void CountEnds(const LaneBatch& batch, SweepTally& tally) const;
  Rgb OfEnds(const LaneBatch& batch) const; ///< power in the maps behind the last plane, all lanes

private:
  Rgb OfEnds(int lane, const std::vector<float>& sums) const;

  Device& TheDevice;
  const GpuLanes& Lanes;
  Buffer<float> OfPlanes, Sides, Ends;
};
}
