#pragma once

#include "Distribution/BlockPartition.h"
#include "LightPropagation/Distributed/BlockContact.h"
#include "LightPropagation/Distributed/ParallelBundles.h"
#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Sweep/SweepWorkspace.h"

#include "Device/Monitor.h"

#include <vector>

namespace tyndall
{
/// Rays at the faces of a block, W: those that come in or those that go out.
struct RaysAtFaces
{
  std::vector<float> maps;  ///< at the end of the axis, as SweepPlan lays maps out, one way
  std::vector<float> sides; ///< [plane in the order of the march][ray][cell], as SweepSides.cl has them
};

/// What sweeps of one rank's blocks share: contents are undefined between them.
struct BlockWorkspace
{
  SweepWorkspace sweep;
  Buffer<float> sidesIn, sidesOut;
};

/// Sweeps one block of a grid along one set of parallel bundles: the rays that come in from other blocks and from
/// outside the grid in, those that go out. Every ray crosses every voxel as it would in the whole grid.
class BlockSweep
{
public:
  /// @param rank  whose block it is, of one voxel at least
  /// @param volume  the block's: its grid, channels and what it takes light down in
  /// @param workspace  must stay
  BlockSweep(Device& device, const BlockPartition& partition, int rank, const ParallelBundles& rays,
    const SweepVolume& volume, BlockWorkspace& workspace);

  /// What comes in from outside the grid; the others' places are dark.
  /// @param boundary  empty: nothing
  RaysAtFaces FromOutside(const SweepBoundary& boundary) const;
  /// Of the whole grid, W by face, by this set of bundles.
  std::array<Rgb, 6> PowerIn(const SweepBoundary& boundary) const;

  /// @param in  is used up
  /// @param tally  what leaves the grid from this block is added to
  RaysAtFaces Cross(const SweepVolume& volume, RaysAtFaces in, const SweepBoundary& boundary, SweepTally& tally,
    const Monitor& monitor);

  /// What goes through a contact with another block, in an order that both ranks know, behind what `message` holds; and
  /// the other way round.
  /// @param at  where it begins; moved behind it
  void Pack(const BlockContact& contact, const RaysAtFaces& out, std::vector<float>& message) const;
  void Unpack(const BlockContact& contact, const std::vector<float>& message, std::size_t& at, RaysAtFaces& in) const;

  std::size_t Bytes() const; ///< of rays at faces, in and out, on the host

private:
  struct Light
  {
    Rgb u, v, along; ///< W that a ray brings through each kind of face
  };
  Light LightOf(const SweepBoundary& boundary, std::size_t bundle, const Member& member) const;
  int DirectionOf(const Member& member) const;
  bool IsOuter(int axis, bool entry) const; ///< the block's face where rays come in, or leave, is the grid's
  template <class Act>
  void ForRaysFrom(const SweepBoundary& boundary, const Act& act) const;
  void FillSides(const Light& light, std::size_t ray, int channel, RaysAtFaces& rays) const;
  void WriteBeyond(const SweepBoundary& boundary);
  void Launch(const SweepVolume& volume, const Monitor& monitor);
  cl::Kernel Kernel(const SweepVolume& volume);
  void CountLeft(const RaysAtFaces& out, SweepTally& tally) const;
  template <class AtFaces, class Visit>
  void ForEachRay(const BlockContact& contact, bool out, AtFaces& rays, const Visit& visit) const;

  Device& TheDevice;
  ParallelBundles Bundles;
  Grid Whole;
  VoxelBox Block;
  BlockWorkspace& Workspace;
  SweepPlan Plan;
  std::vector<CrossingInfo> Crossings;      ///< [plane of the block][bundle]
  std::vector<std::array<double, 2>> Moves; ///< of a bundle along its own u and v through the whole grid, voxels
  std::size_t SideFloats = 0;               ///< of one ray and plane
  std::size_t RayCount = 0;                 ///< members of all bundles, times channels

  Buffer<float> Outside, Radiance, Sideways, Coefficients;
  Buffer<BundleInfo> BundlesOnDevice;
  Buffer<UnitInfo> Units;
  Buffer<cl_int2> Schedule;
  Buffer<CrossingInfo> CrossingsOnDevice;
  Buffer<OwnLightInfo> OwnLight;
};
}
