#pragma once

#include "Distribution/BlockPartition.h"
#include "LightPropagation/Sweep/Pipelined/BlockContact.h"
#include "LightPropagation/Sweep/Pipelined/BlockCrossing.h"
#include "LightPropagation/Sweep/Pipelined/ParallelBundles.h"
#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include "Device/Monitor.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// Light by cells of the faces of the whole grid, of a sweep's channels, [channel][cell] (BoxFaces.h).
struct LightByCells
{
  const float* in = nullptr; ///< W / (length^2 sr) that comes in, the same from all directions; null: nothing
  double* left = nullptr;    ///< W that leaves, added to; null: not wanted
  bool spreads = false;      ///< Deposit::spreadsAside
};

/// Sweeps one block of a grid along one set of parallel bundles: the rays that come in from other blocks and from
/// outside the grid in, those that go out. Every ray crosses every voxel as it would in the whole grid.
class BlockSweep
{
public:
  /// @param rank  whose block it is, of one voxel at least
  /// @param periodic  axes: rays do not leave the grid at their ends, nor come in
  /// @param volume  the block's: its grid, channels and what it takes light down in
  /// @param workspace  must stay
  BlockSweep(Device& device, const BlockPartition& partition, int rank, const ParallelBundles& rays,
    const std::array<bool, 3>& periodic, const SweepVolume& volume, BlockWorkspace& workspace);
  BlockSweep(const BlockSweep&) = delete;
  BlockSweep& operator=(const BlockSweep&) = delete;

  /// Round a periodic axis: rays have gone through so many planes of the whole grid when they come in at its end.
  void BeginLap(int planes);

  /// What comes in from outside the grid; the others' places are dark.
  /// @param boundary  empty: nothing
  RaysAtFaces FromOutside(const SweepBoundary& boundary, const LightByCells& cells) const;
  /// Of the whole grid, W by face, by this set of bundles.
  std::array<Rgb, 6> PowerIn(const SweepBoundary& boundary) const;

  /// @param in  is used up
  /// @param tally  what leaves the grid from this block is added to, or goes round the axis
  RaysAtFaces Cross(const SweepVolume& volume, RaysAtFaces in, const SweepBoundary& boundary, const LightByCells& cells,
    SweepTally& tally, const Monitor& monitor);

  /// What goes through a contact with another block, in an order that both ranks know, behind what `message` holds; and
  /// the other way round.
  /// @param at  where it begins; moved behind it
  void Pack(const BlockContact& contact, const RaysAtFaces& out, std::vector<float>& message) const;
  void Unpack(const BlockContact& contact, const std::vector<float>& message, std::size_t& at, RaysAtFaces& in) const;

  std::size_t Values(const std::vector<BlockContact>& contacts) const; ///< that messages have for rays that come in
  int Axis() const { return this->Bundles.axis; }
  std::size_t Bytes() const; ///< of rays at faces, in and out, on the host

private:
  struct Light
  {
    Rgb u, v, along; ///< W that a ray brings through each kind of face
  };
  Light LightOf(const SweepBoundary& boundary, std::size_t bundle, const Member& member) const;
  int DirectionOf(const Member& member) const;
  void LayPattern();
  bool IsAtEnd(int axis, bool entry) const; ///< the block's face where rays come in, or leave, is the grid's
  bool IsOuter(int axis, bool entry) const { return !this->Periodic[axis] && this->IsAtEnd(axis, entry); }
  template <class Act>
  void ForRaysFrom(const SweepBoundary& boundary, const Act& act) const;
  void FillSides(const Light& light, std::size_t ray, int channel, RaysAtFaces& rays) const;
  std::vector<cl_float4> LightBeyond(const SweepBoundary& boundary) const;
  int OuterSides() const;
  void CountLeft(const std::vector<float>& aside, const RaysAtFaces& out, SweepTally& tally) const;
  class ByCells;
  template <class Visit>
  void ForEachPlace(const BlockContact& contact, bool out, const Visit& visit) const;

  ParallelBundles Bundles;
  std::array<bool, 3> Periodic;
  Grid Whole;
  VoxelBox Block;
  SweepPlan Plan;
  RaysOfBlock Rays;
  std::unique_ptr<BlockCrossing> Carrier;
  std::vector<CrossingInfo> Crossings;      ///< [plane of the block][bundle]
  std::vector<std::array<double, 2>> Moves; ///< of a bundle along its own u and v through the whole grid, voxels
  int LapPlanes = 0;                        ///< that rays have gone through already
  std::size_t SideFloats = 0;               ///< of one ray and plane
  std::size_t RayCount = 0;                 ///< members of all bundles, times channels
};
}
