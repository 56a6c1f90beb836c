#pragma once

#include "LightPropagation/Sweep/OnGpu/LaneSlices.h"
#include "LightPropagation/Sweep/OnGpu/PlaneKernels.h"
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"
#include "LightPropagation/Sweep/Pipelined/BlockCrossing.h"

#include <memory>
#include <string>

namespace tyndall
{
/// By the kernels of Sweep/OnGpu with SIDES (VoxelSides.cl): a lane, which adds to what is there. A map is
/// [ray][channel][v][u]. What of the block is in host memory goes through the device in slices.
class BlockCrossingOnGpu final : public BlockCrossing
{
public:
  BlockCrossingOnGpu(Device& device, const RaysOfBlock& rays, BlockWorkspace& workspace);

  std::size_t MapFloats() const override;
  std::size_t RowOfMap(const BundleInfo& bundle, std::size_t slot, int v) const override;
  void LayPattern(int planes) override;
  std::vector<float> Cross(const SweepVolume& volume, const std::vector<cl_float4>& beyond, int outerSides,
    RaysAtFaces& rays, const Monitor& monitor) override;

private:
  std::string Options(bool shines, bool octants) const;
  std::unique_ptr<LaneSlices> MakeSlices();
  PlaneLaunch LaunchOf(const SweepVolume& volume) const;
  void Launch(const SweepVolume& volume, int outerSides, const Monitor& monitor);
  std::vector<float> SumsOfSides();
  /// That rays are in before plane k, counted from the block's first one.
  const Buffer<float>& Maps(int k) const;

  Device& TheDevice;
  RaysOfBlock Rays;
  const SweepPlan& Plan; ///< theirs
  BlockWorkspace& Workspace;
  SweepLane Lane;
  std::unique_ptr<LaneSlices> Slices; ///< null: the block lies on the device, or is swept where it lies

  Buffer<SweepLane> Lanes; ///< the one
  Buffer<BundleInfo> Bundles;
  Buffer<CrossingInfo> Crossings;
  Buffer<float> Functions;   ///< along the rays, where light has angular moments
  Buffer<cl_float4> Beyond;  ///< see Cross
  Buffer<float> Left, Sides; ///< W that leaves sideways, see SweepLane::escaped, and the sums of its rows
};
}
