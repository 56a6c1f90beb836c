#pragma once

#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Sweep/SweepWorkspace.h"

#include "Device/Monitor.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// Rays at the faces of a block, W: those that come in or those that go out.
struct RaysAtFaces
{
  std::vector<float> maps;  ///< at the end of the axis, one way, as BlockCrossing lays them out
  std::vector<float> sides; ///< [plane in the order of the march][ray][cell], as SweepSides.cl has them
};

/// What sweeps of one rank's blocks share: contents are undefined between them.
struct BlockWorkspace
{
  SweepWorkspace sweep;
  Buffer<float> sidesIn, sidesOut;
  Buffer<float> otherMaps, directed; ///< of kernels for GPUs: planes' maps in turn, and what shines along the rays
};

/// Rays of a block of a grid, one way along an axis.
struct RaysOfBlock
{
  const SweepPlan& plan; ///< of the block, without periodic axes; must stay
  int way = 0;           ///< 0 forward along the axis, 1 backward
  bool around = false;   ///< the grid's axis is periodic: rays come again and again

  std::size_t SideFloats() const; ///< of one ray and plane
  std::size_t Sides() const;      ///< floats
};

/// Carries the rays of a block through it: by kernels for CPUs or for GPUs, which lay out maps of rays each in its own
/// way (BlockCrossingOnCpu.h, BlockCrossingOnGpu.h).
class BlockCrossing
{
public:
  virtual ~BlockCrossing() = default;

  virtual std::size_t MapFloats() const = 0;
  /// Where the rays of row v are in a map, column by column.
  /// @param slot  of the bundle, [member][channel]
  virtual std::size_t RowOfMap(const BundleInfo& bundle, std::size_t slot, int v) const = 0;

  /// How planes are crossed by rays that have gone through so many of the whole grid when they come in at its end.
  virtual void LayPattern(int planes) = 0;

  /// @param beyond  W of light from beyond the grid, [ray][channel]: through u's, v's face. Some comes in at an edge of
  ///                the grid and leaves at another without a voxel
  /// @param outerSides  bit i: light that goes through side i of -u, +u, -v, +v leaves the grid
  /// @param rays  that come in; then those that go out
  /// @return W that left the grid, [plane, or part of it][-u, +u, -v, +v][channel]
  virtual std::vector<float> Cross(const SweepVolume& volume, const std::vector<cl_float4>& beyond, int outerSides,
    RaysAtFaces& rays, const Monitor& monitor) = 0;
};

/// What suits the device.
/// @param workspace  must stay
std::unique_ptr<BlockCrossing> MakeBlockCrossing(
  Device& device, const RaysOfBlock& rays, const SweepVolume& volume, BlockWorkspace& workspace);

/// The arrays that kernels of a sweep take: others stand for those that are not there, which kernels do not touch.
struct BlockArrays
{
  BlockArrays(const RaysOfBlock& rays, const SweepVolume& volume, const BlockWorkspace& workspace);

  const Buffer<float>&path, &lost, &flux, &currents, &source, &octants;
};
}
