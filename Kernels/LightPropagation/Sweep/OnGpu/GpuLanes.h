#pragma once

#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"
#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tyndall
{
/// Lane of a plan's rays that march one way; positions in buffers are not yet filled in.
/// @param way  0 forward along the axis, 1 backward
SweepLane LaneOf(const SweepPlan& plan, int way);

/// Floats of the sides for one ray and plane (LanePlane.cl).
std::size_t SideFloats(const SweepLane& lane);

/// Angular functions in the directions of these rays, followed by beams, [ray][function].
std::vector<float> FunctionsAlong(const SweepPlan& plan, int way, const AngularValues& angular);

/// Lanes that cross planes in the same launches: lanes of open axes, or both ways along one periodic axis.
struct LaneBatch
{
  int first = 0, count = 0; ///< first lane and number of lanes
  bool around = false;      ///< along a periodic axis, whose rays wrap around
  std::size_t plan = 0;     ///< index of the lanes' plan, if they wrap around
  std::size_t maps = 0;     ///< floats of the batch's maps
  std::size_t sides = 0;    ///< floats of the sides of its planes, if light is given or counted by cells of the faces
  bool hasArrays = false;   ///< each lane writes to its own arrays, which are summed afterwards
};

/// Lanes and batches of a sweep on GPUs, with their positions in the buffers. Computed once, on the host.
struct GpuLanes
{
  /// @param volume  the channels that are swept together
  /// @param atOnce  run the lanes of all open axes in the same launches, and likewise both ways along a periodic axis;
  /// false: one lane after the other. Ignored on a device that streams volumes, where lanes follow one another and all
  /// add to the deposit
  GpuLanes(const Device& device, const SweepVolume& volume, std::vector<AxisBundles> rays,
    const std::array<bool, 3>& periodic, bool atOnce);

  std::vector<SweepPlan> plans; ///< one for each entry of the request's rays that is not empty; open axes first
  std::vector<SweepLane> lanes;
  std::vector<LaneBatch> batches;
  std::vector<BundleInfo> bundles;
  std::vector<CrossingInfo> crossings;
  std::vector<float> functions;   ///< in the ray's direction, [ray][function, then beam]; empty without angular moments
  std::vector<std::size_t> ends;  ///< by lane: index of the first sum over rows of its maps, [ray][channel][v]
  std::vector<std::size_t> sides; ///< by lane: index of the first sum over rows of power that leaves sideways
  std::size_t endRows = 0, sideRows = 0;
  std::size_t escaped = 0; ///< floats of all lanes' tallies, see SweepLane::escaped
  int rays = 0;            ///< of all lanes
  int channels;            ///< channels swept together
  int functionCount;       ///< number of angular functions; 1: fluence only
  int floatsOfDeposit;     ///< floats that a lane writes per voxel and channel
  /// Largest size of a batch's maps, floats: batches of open axes, batches on a periodic axis
  std::size_t mostMapsOpen = 0, mostMapsAround = 0;
  /// Most lanes of a batch with its own arrays, and of a batch on a periodic axis
  int mostWithArrays = 0, mostAround = 0;

  /// Floats of the lanes' own arrays. @param stride  floats per channel
  std::size_t ArrayFloats(std::size_t stride) const;
  std::string Options() const; ///< build options for LaneSums.cl
  const SweepPlan& PlanOf(std::size_t lane) const { return this->plans[this->PlanOfLane[lane]]; }
  std::size_t EndRows(int lane) const;
  std::size_t SideRows(int lane) const;

private:
  void LayPlan(const SweepPlan& plan, const AngularValues* angular);
  void LayLane(const SweepPlan& plan, int way, int firstBundle, int firstCrossing);
  void LayBatches(bool atOnce);
  void Place(LaneBatch& batch, std::size_t stride);

  std::vector<std::size_t> PlanOfLane;
};
}
