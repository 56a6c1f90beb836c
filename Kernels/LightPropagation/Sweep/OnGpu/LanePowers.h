#pragma once

#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"
#include "LightPropagation/Sweep/SweepTally.h"

#include <functional>

namespace tyndall
{
/// Power that leaves a sweep for GPUs sideways, and what is in its maps behind the last plane: counted on the device
/// row by row, on the host in double.
class LanePowers
{
public:
  /// @param lanes  must stay
  LanePowers(Device& device, const GpuLanes& lanes);

  const Buffer<float>& Escaped() const { return this->OfPlanes; } ///< where planes put it, see SweepLane

  using MapsOfLane = std::function<const Buffer<float>&(const SweepLane&)>;

  /// Of the planes that were crossed last.
  void AddUp(const LaneBatch& batch, const MapsOfLane& maps);
  /// Adds what left through the sides of the box, as was added up.
  void CountSides(const LaneBatch& batch, SweepTally& tally) const;
  /// Adds what left through the far ends of the batch's axes.
  void CountEnds(const LaneBatch& batch, SweepTally& tally) const;
  Rgb OfEnds(const LaneBatch& batch) const; ///< there, of all lanes

private:
  Rgb OfEnds(int lane, const std::vector<float>& sums) const;

  Device& TheDevice;
  const GpuLanes& Lanes;
  Buffer<float> OfPlanes, Sides, Ends;
};
}
