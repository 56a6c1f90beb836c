#pragma once

#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include "Device/Monitor.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// Power of the rays at the faces of a block, W: either all that enter, or all that leave.
struct RaysAtFaces
{
  std::vector<float> maps; ///< rays at the end of the marching axis, in the layout of BlockCrossing
  /// Rays at the other faces, [plane in the order of the march][ray][cell], see SweepSides.cl
  std::vector<float> sides;
};

/// Scratch memory shared by the sweeps of one rank. Contents are undefined between sweeps.
struct BlockWorkspace
{
  SweepWorkspace sweep;
  Buffer<float> sidesIn, sidesOut;
  Buffer<float> otherMaps, directed; ///< for GPU kernels: maps of every other plane, and the source along the rays
};

/// The rays of a block that march one way along an axis.
struct RaysOfBlock
{
  const SweepPlan& plan; ///< plan of the block, without periodic axes; must outlive this
  int way = 0;           ///< 0 forward along the axis, 1 backward
  bool around = false;   ///< the domain's axis is periodic: rays enter the block repeatedly

  /// Floats of the sides per ray and plane.
  std::size_t SideFloats() const { return std::size_t(this->plan.plane.sizeU) + this->plan.plane.sizeV + 1; }
  std::size_t Sides() const { return this->plan.eachWay.radiance * this->plan.Planes() * this->SideFloats(); }
};

/// Carries rays through a block. Implemented with kernels for CPUs or for GPUs, each with its own layout of ray maps.
class BlockCrossing
{
public:
  virtual ~BlockCrossing() = default;

  virtual std::size_t MapFloats() const = 0;
  /// Index in a map of the first ray of row v; its columns follow.
  /// @param slot  index within the bundle, [member][channel]
  virtual std::size_t RowOfMap(const BundleInfo& bundle, std::size_t slot, int v) const = 0;

  /// Sets the ray pattern for rays that have crossed `planes` planes of the whole grid when they enter at its end.
  virtual void LayPattern(int planes) = 0;

  /// @param beyond  power of incident light from outside the domain, W, [ray][channel]: through u's, v's face. Needed
  /// because some light enters and leaves at an edge of the domain without crossing a voxel
  /// @param outerSides  bit i: light that crosses side i of -u, +u, -v, +v leaves the domain
  /// @param rays  on entry, the incoming rays; on return, the outgoing ones
  /// @return power that left the domain sideways, W, [plane, or part of it][-u, +u, -v, +v][channel]
  virtual std::vector<float> Cross(const SweepVolume& volume, const std::vector<cl_float4>& beyond, int outerSides,
    RaysAtFaces& rays, const Monitor& monitor) = 0;
};

/// Create the implementations. @param workspace  must outlive the result; its sides are large enough
std::unique_ptr<BlockCrossing> MakeBlockCrossingOnCpu(
  Device& device, const RaysOfBlock& rays, BlockWorkspace& workspace);
std::unique_ptr<BlockCrossing> MakeBlockCrossingOnGpu(
  Device& device, const RaysOfBlock& rays, BlockWorkspace& workspace);
}
