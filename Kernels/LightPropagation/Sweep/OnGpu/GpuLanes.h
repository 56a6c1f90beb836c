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
/// Lane of those rays of a sweep plan that march in one sense. Its indices into buffers are not yet set.
/// @param way  sense of marching: 0 forward along the axis, 1 backward
SweepLane LaneOf(const SweepPlan& plan, int way);

/// Number of floats per ray and plane in the arrays that hold the rays which enter or leave a lane's planes sideways
/// (SweepOnGpuShared.h).
std::size_t SideFloats(const SweepLane& lane);

/// For each ray of a sweep plan that marches in one sense (`way`, 0 forward, 1 backward): the values of the angular
/// functions in the ray's direction, then those of the angular distributions of AngularBasis::beams.
std::vector<float> FunctionsAlong(const SweepPlan& plan, int way, const AngularValues& angular);

/// Batch of lanes (each the rays of one sense along an axis) that cross planes in the same launches: some lanes of open
/// axes, or both lanes of one periodic axis.
struct LaneBatch
{
  int first = 0, count = 0; ///< index of the first lane, and number of lanes
  bool around = false;      ///< whether the marching axis is periodic, so that rays wrap around
  std::size_t plan = 0;     ///< index of the sweep plan of the lanes' axis, if rays wrap around
  std::size_t maps = 0;     ///< number of floats in the batch's maps, which hold the power of each ray
  /// Number of floats for the rays that enter or leave the batch's planes sideways, which are stored if light is given
  /// or summed per cell of the faces
  std::size_t sides = 0;
  /// Whether each lane has its own output arrays (path integrals, fluxes and currents), which are summed afterwards.
  bool hasArrays = false;
};

/// Lanes (each the rays of one sense along an axis) of a sweep on GPUs, their grouping into batches that run
/// concurrently, and the indices of their data in the buffers. Computed once, on the host.
struct GpuLanes
{
  /// @param volume  channels that are swept together
  /// @param atOnce  whether the lanes of all open axes run in the same launches, and likewise both senses along a
  /// periodic axis; false: lanes run one after another. Ignored on a device that streams volumes, where lanes run one
  /// after another and all add to the deposit
  GpuLanes(const Device& device, const SweepVolume& volume, std::vector<AxisBundles> rays,
    const std::array<bool, 3>& periodic, bool atOnce);

  std::vector<SweepPlan> plans; ///< plans of the axes along which rays march; open axes first
  std::vector<SweepLane> lanes;
  std::vector<LaneBatch> batches;
  std::vector<BundleInfo> bundles;
  std::vector<CrossingInfo> crossings;
  /// For each ray: the values of the angular functions in its direction, then those of the angular distributions of
  /// AngularBasis::beams. Empty without angular moments
  std::vector<float> functions;
  /// For each lane: index at which LanePowers stores the power of the lane's rays behind the last plane, summed over
  /// each row, [ray][channel][v]
  std::vector<std::size_t> ends;
  /// For each lane: index at which LanePowers stores the lane's power that escapes sideways, summed over each side,
  /// [plane][side][channel]
  std::vector<std::size_t> sides;
  std::size_t endRows = 0, sideRows = 0;
  std::size_t escaped = 0; ///< number of floats of the power that escapes sideways from all lanes (SweepLane::escaped)
  int rays = 0;            ///< number of rays of all lanes
  int channels;            ///< number of channels swept together
  int functionCount;       ///< number of angular functions; 1: fluence only
  int floatsOfDeposit;     ///< number of floats that a lane writes per voxel and channel
  /// Number of floats of the largest maps (power of each ray) that any batch on open axes needs, and that any batch on
  /// a periodic axis needs
  std::size_t mostMapsOpen = 0, mostMapsAround = 0;
  /// Largest number of lanes in a batch whose lanes have their own output arrays: among all such batches, and among
  /// those on a periodic axis
  int mostWithArrays = 0, mostAround = 0;

  /// Number of floats of the lanes' own output arrays, which lanes need to run concurrently.
  /// @param stride  floats per channel
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
