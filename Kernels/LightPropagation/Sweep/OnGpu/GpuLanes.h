#pragma once

#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tyndall
{
/// The rays of a plan that go one way, but for where what they need is in buffers.
/// @param way  0 forward along the axis, 1 backward
SweepLane LaneOf(const SweepPlan& plan, int way);

/// Of a ray and plane: what is beside it (VoxelSides.cl).
std::size_t SideFloats(const SweepLane& lane);

/// Their angular functions, then beams, [ray][function].
std::vector<float> FunctionsAlong(const SweepPlan& plan, int way, const AngularValues& angular);

/// Lanes that cross planes in the same launches: of open axes, or the ways of one periodic axis.
struct LaneBatch
{
  int first = 0, count = 0; ///< of the lanes
  bool around = false;      ///< along a periodic axis: rays go round
  std::size_t plan = 0;     ///< of these, where they go around
  std::size_t maps = 0;     ///< floats of its maps
  std::size_t sides = 0;    ///< and of what is beside its planes, where light comes and goes by cells
  bool hasArrays = false;   ///< each lane puts what it finds into arrays of its own, for these to be added up
};

/// What marches in a sweep for GPUs, and where it is in the buffers: worked out once on the host.
struct GpuLanes
{
  /// @param atOnce  lanes of open axes go in the same launches, as do both ways of a periodic axis; else one by one.
  /// Not on a device that streams, where all lanes add to the deposit
  GpuLanes(const Device& device, const VolumeLayout& layout, const SweepRequest& request,
    const std::array<bool, 3>& periodic, bool atOnce);

  std::vector<SweepPlan> plans; ///< one of each entry of the request's rays that has any; open axes first
  std::vector<SweepLane> lanes;
  std::vector<LaneBatch> batches;
  std::vector<BundleInfo> bundles;
  std::vector<CrossingInfo> crossings;
  std::vector<float> functions;   ///< [ray][function, then beam] along it, where light has angular moments
  std::vector<std::size_t> ends;  ///< of each lane, where sums of its maps' rows begin, [ray][channel][v]
  std::vector<std::size_t> sides; ///< and those of the rows of what leaves sideways
  std::size_t endRows = 0, sideRows = 0;
  std::size_t escaped = 0;                          ///< floats, see SweepLane
  int rays = 0;                                     ///< of all lanes
  int channels;                                     ///< that are swept together
  int functionCount;                                ///< of the light's angular moments; 1: fluence alone
  int floatsOfDeposit;                              ///< that a lane finds in a voxel, of a channel
  std::size_t mostMapsOpen = 0, mostMapsAround = 0; ///< floats, of a batch of open axes and of one that goes round
  int mostWithArrays = 0, mostAround = 0;           ///< lanes of a batch that has arrays, and of one that goes round

  /// That lanes write to, of their own. @param stride  of a channel
  std::size_t ArrayFloats(std::size_t stride) const;
  std::string Options() const; ///< of LaneSums.cl
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
