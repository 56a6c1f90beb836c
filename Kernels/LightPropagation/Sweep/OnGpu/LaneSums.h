#pragma once

#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include <functional>

namespace tyndall
{
/// Output arrays (path integrals, net flux, partial currents) of lanes that run concurrently, or whose rays wrap around
/// an axis. A lane is the rays of one sense along an axis. The arrays of a lane have the layout of Deposit; those of
/// the next lane follow. AddUp() adds the lanes' arrays to the deposit in the order of the lanes, so results are
/// identical, bit for bit, to those of lanes that add to the deposit one after another.
class LaneArrays
{
public:
  /// @param lanes  must outlive this object
  /// @param to  deposit of the volume; without net flux if the angular moments include it
  LaneArrays(Device& device, const GpuLanes& lanes, const VolumeLayout& layout, const Deposit& to);

  void Clear(const LaneBatch& batch);
  /// Adds the deposits of a batch, i.e. of lanes that ran concurrently, to the deposit of the volume.
  /// @param launch  arguments of any launch of the batch
  void AddUp(const LaneBatch& batch, const PlaneLaunch& launch, const SweepVolume& volume);

  Buffer<float> path, flux, currents;
  Buffer<float> lost; ///< rounding errors of `path` (compensated summation), for rays that wrap around a periodic axis

private:
  void AddUpMoments(const LaneBatch& batch, const PlaneLaunch& launch, const SweepVolume& volume);

  Device& TheDevice;
  const GpuLanes& Lanes;
  VolumeLayout Layout;
  Deposit To;
};

/// Power that escapes from a sweep on GPUs: through the faces parallel to the marching axis, and with the rays behind
/// the last plane. Rows are summed on the device, the sums of rows on the host in double precision.
class LanePowers
{
public:
  /// @param lanes  must outlive this object
  LanePowers(Device& device, const GpuLanes& lanes);

  /// Power that escapes sideways, W, as the plane kernels write it for each lane: [plane][-u, +u, -v,
  /// +v][channel][position along the face].
  const Buffer<float>& Escaped() const { return this->OfPlanes; }

  using MapsOfLane = std::function<const Buffer<float>&(const SweepLane&)>;

  /// Sums each row of rays in `maps` (power of each ray behind the last plane), and each row of the power that escaped
  /// sideways, for the planes that the batch has just crossed.
  void AddUp(const LaneBatch& batch, const MapsOfLane& maps);
  /// Adds the power that escaped through the faces parallel to the marching axis, from the sums of AddUp(), to
  /// SweepTally::out.
  void CountSides(const LaneBatch& batch, SweepTally& tally) const;
  /// Adds the power that escaped through the far ends of the batch's axes to SweepTally::out.
  void CountEnds(const LaneBatch& batch, SweepTally& tally) const;
  Rgb OfEnds(const LaneBatch& batch) const; ///< power of the rays behind the last plane, sum over the batch's lanes, W

private:
  Rgb OfEnds(int lane, const std::vector<float>& sums) const;

  Device& TheDevice;
  const GpuLanes& Lanes;
  Buffer<float> OfPlanes, Sides, Ends;
};
}
