#pragma once

#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include "Device/Monitor.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// Power of the rays at the faces of a block, W: either of all rays that enter, or of all that leave.
struct RaysAtFaces
{
  /// Power of the rays at an end of the marching axis; BlockCrossing::RowOfMap() gives the index of each row
  std::vector<float> maps;
  /// Power of the rays at the faces parallel to the marching axis, [plane in marching order][ray][cell]. The cells of a
  /// plane are those of the face normal to v, those of the face normal to u, and one for rays that cross both faces at
  /// once.
  std::vector<float> sides;
};

/// Scratch memory shared by the sweeps of one rank. Its contents are undefined between sweeps.
struct BlockWorkspace
{
  SweepWorkspace sweep;
  Buffer<float> sidesIn, sidesOut;
  /// For GPU kernels: otherMaps has the power of the rays before planes with odd index, W (sweep.maps has it before
  /// planes with even index); directed has the source along each ray, W / (length^3 sr)
  Buffer<float> otherMaps, directed;
};

/// Rays of a block that march in one sense along an axis.
struct RaysOfBlock
{
  const SweepPlan& plan; ///< sweep plan of the block, without periodic axes; must outlive this object
  int way = 0;           ///< sense of marching: 0 forward along the axis, 1 backward
  /// Whether the marching axis of the domain is periodic, so that rays enter the block repeatedly
  bool around = false;

  /// Number of floats per ray and plane in RaysAtFaces::sides.
  std::size_t SideFloats() const { return std::size_t(this->plan.plane.sizeU) + this->plan.plane.sizeV + 1; }
  std::size_t Sides() const { return this->plan.eachWay.radiance * this->plan.Planes() * this->SideFloats(); }
};

/// Carries rays through a block (subdomain). Implemented with kernels for CPUs and for GPUs, each with its own layout
/// of ray maps.
class BlockCrossing
{
public:
  virtual ~BlockCrossing() = default;

  virtual std::size_t MapFloats() const = 0;
  /// Index in the maps (power of each ray) of the first ray of row v; the other rays of the row follow.
  /// @param slot  index within the bundle, [member][channel]
  virtual std::size_t RowOfMap(const BundleInfo& bundle, std::size_t slot, int v) const = 0;

  /// Sets the moves and segments of rays that crossed `planes` planes of the domain in earlier laps around a periodic
  /// axis.
  virtual void LayPattern(int planes) = 0;

  /// Carries rays through all planes of the block and adds to the volume's deposit.
  /// @param beyond  power of light incident from outside the domain, W, [ray][channel]: through the face normal to u,
  /// and through the face normal to v. Needed because some light enters and leaves at an edge of the domain without
  /// crossing a voxel
  /// @param outerSides  bit i: light that crosses side i of -u, +u, -v, +v leaves the domain
  /// @param rays  on entry, the incoming rays; on return, the outgoing ones
  /// @return power that left the domain sideways, W, as consecutive arrays [-u, +u, -v, +v][channel] whose sum is the
  ///   total
  virtual std::vector<float> Cross(const SweepVolume& volume, const std::vector<cl_float4>& beyond, int outerSides,
    RaysAtFaces& rays, const Monitor& monitor) = 0;
};

/// Creates a BlockCrossing with kernels for a CPU, or for a GPU.
/// @param workspace  must outlive the result; its buffers sidesIn and sidesOut must hold RaysOfBlock::Sides() floats
std::unique_ptr<BlockCrossing> MakeBlockCrossingOnCpu(
  Device& device, const RaysOfBlock& rays, BlockWorkspace& workspace);
std::unique_ptr<BlockCrossing> MakeBlockCrossingOnGpu(
  Device& device, const RaysOfBlock& rays, BlockWorkspace& workspace);
}
