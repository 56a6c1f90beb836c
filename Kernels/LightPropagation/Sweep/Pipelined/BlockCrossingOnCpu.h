#pragma once

#include "LightPropagation/Sweep/Pipelined/BlockCrossing.h"

namespace tyndall
{
/// Carries a block's rays with the kernels of Sweep/OnCpu and SIDES (SweepSides.cl). Maps are padded as in SweepPlan.
class BlockCrossingOnCpu final : public BlockCrossing
{
public:
  /// @param sizeY  extent of the block along y, voxels
  BlockCrossingOnCpu(Device& device, const RaysOfBlock& rays, int sizeY, BlockWorkspace& workspace);

  std::size_t MapFloats() const override;
  std::size_t RowOfMap(const BundleInfo& bundle, std::size_t slot, int v) const override;
  void LayPattern(int planes) override;
  std::vector<float> Cross(const SweepVolume& volume, const std::vector<cl_float4>& beyond, int outerSides,
    RaysAtFaces& rays, const Monitor& monitor) override;

private:
  void WriteBeyond(const std::vector<cl_float4>& beyond);
  cl::Kernel Kernel();
  SweepInfo InfoOf(const SweepVolume& volume) const;
  void Launch(const SweepVolume& volume, int outerSides, const Monitor& monitor);

  Device& TheDevice;
  RaysOfBlock Rays;
  const SweepPlan& Plan; ///< plan of the rays
  int SizeY;
  BlockWorkspace& Workspace;

  Buffer<float> Outside, Radiance, Sideways, Coefficients;
  Buffer<BundleInfo> Bundles;
  Buffer<UnitInfo> Units;
  Buffer<cl_int2> Schedule;
  Buffer<CrossingInfo> Crossings;
  Buffer<OwnLightInfo> OwnLight;
  Buffer<cl_int> FunctionPlaces;
};
}
