#pragma once

#include "LightPropagation/Sweep/OnGpu/LaneSlices.h"
#include "LightPropagation/Sweep/OnGpu/PlaneKernels.h"
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"
#include "LightPropagation/Sweep/Pipelined/BlockCrossing.h"

#include <memory>
#include <string>

namespace tyndall
{
/// Carries a block's rays with the kernels of Sweep/OnGpu and SIDES (VoxelSides.cl), as one lane that adds to the
/// deposit. Maps are [ray][channel][v][u]. Arrays in host memory are streamed through the device in slices.
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
  /// Maps that hold the rays before plane k, counted from the block's first plane.
  const Buffer<float>& Maps(int k) const;

  Device& TheDevice;
  RaysOfBlock Rays;
  const SweepPlan& Plan; ///< plan of the rays
  BlockWorkspace& Workspace;
  SweepLane Lane;
  std::unique_ptr<LaneSlices> Slices; ///< null: the block lies on the device or is swept in place

  Buffer<SweepLane> Lanes; ///< one element: Lane
  Buffer<BundleInfo> Bundles;
  Buffer<CrossingInfo> Crossings;
  Buffer<float> Functions;   ///< angular functions in the rays' directions, if there are angular moments
  Buffer<cl_float4> Beyond;  ///< see Cross
  Buffer<float> Left, Sides; ///< power that leaves sideways, W, see SweepLane::escaped; sums of its rows
};
}
