#pragma once

#include "LightPropagation/Sweep/Pipelined/BlockCrossing.h"
#include "LightPropagation/Sweep/Pipelined/SweepSchedule.h"
#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "Medium/BoxFaces.h"

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace tyndall
{
/// Light per cell of the domain's faces, for the channels of a sweep, [channel][cell] (BoxFaces.h).
struct LightByCells
{
  const float* in = nullptr; ///< isotropic incident radiance, W / (length^2 sr); null: none
  double* left = nullptr;    ///< escaped power, W, which the sweep adds to; null: not computed
  /// Whether escaped power is spread over the cells that a ray represents (Deposit::spreadsAside)
  bool spreads = false;
};

/// Sweep of one block (subdomain) for one set of parallel bundles, i.e. rays of one marching axis and octant. Input:
/// the rays that enter the block from other blocks and from outside the domain; output: the rays that leave it. Every
/// ray crosses every voxel exactly as in a sweep of the whole domain.
class BlockSweep
{
public:
  /// @param rank  rank that owns the block; the block has at least one voxel
  /// @param periodic  periodic axes of the domain: at their ends rays neither leave nor enter the domain
  /// @param volume  grid, channels and deposit of the block
  /// @param workspace  must outlive this object
  BlockSweep(Device& device, const BlockPartition& partition, int rank, const ParallelBundles& rays,
    const std::array<bool, 3>& periodic, const SweepVolume& volume, BlockWorkspace& workspace);
  BlockSweep(const BlockSweep&) = delete;
  BlockSweep& operator=(const BlockSweep&) = delete;

  /// Begins a lap around a periodic axis.
  /// @param planes  number of planes of the domain that rays have crossed in earlier laps
  void BeginLap(int planes);

  /// Returns the power of the rays that enter the block from outside the domain; 0 for rays from other blocks.
  /// @param boundary  empty: no incident light
  RaysAtFaces FromOutside(const SweepBoundary& boundary, const LightByCells& cells) const;
  /// Incident power that the rays of this set of bundles carry through each face of the whole domain, W.
  std::array<Rgb, 6> PowerIn(const SweepBoundary& boundary) const;

  /// Carries the rays `in` through the block.
  /// @param in  incoming rays; consumed
  /// @param tally  receives the power that leaves the domain from this block, or wraps around the marching axis
  /// @return outgoing rays
  RaysAtFaces Cross(const SweepVolume& volume, RaysAtFaces in, const SweepBoundary& boundary, const LightByCells& cells,
    SweepTally& tally, const Monitor& monitor);

  /// Pack() appends to `message` the power of the rays that cross a contact (the voxel faces shared with another
  /// block), in the order of the contact's cells in the whole domain. Unpack() reads them from the message.
  /// @param at  index of the contact's first value in `message`; on return, the index after its last value
  void Pack(const BlockContact& contact, const RaysAtFaces& out, std::vector<float>& message) const;
  void Unpack(const BlockContact& contact, const std::vector<float>& message, std::size_t& at, RaysAtFaces& in) const;

  /// Number of incoming rays that cross `contacts` (voxel faces shared with other blocks), which is the number of
  /// values in the messages from these blocks.
  std::size_t Values(const std::vector<BlockContact>& contacts) const;
  int Axis() const { return this->Bundles.axis; }
  /// Host memory of the incoming and outgoing rays at the block's faces.
  std::size_t Bytes() const { return 2 * (this->Carrier->MapFloats() + this->Rays.Sides()) * sizeof(float); }

private:
  struct Light
  {
    /// Power of a ray that enters through a face normal to u, to v, or to the marching axis, W
    Rgb u, v, along;
  };
  Light LightOf(const SweepBoundary& boundary, std::size_t bundle, const Member& member) const;
  int DirectionOf(const Member& member) const;
  void LayPattern();
  /// Whether the block's face where rays enter (`entry`) or leave along `axis` is a face of the domain.
  bool IsAtEnd(int axis, bool entry) const;
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
  template <class Visit>
  void ForEachPlaceAlong(const BlockContact& contact, const Visit& visit) const;
  template <class Act>
  void ForRaysThatMove(int k, BlockContact::Kind kind, const Act& act) const;

  ParallelBundles Bundles;
  std::array<bool, 3> Periodic;
  Grid Whole;
  VoxelBox Block;
  SweepPlan Plan;
  RaysOfBlock Rays;
  std::unique_ptr<BlockCrossing> Carrier;
  std::vector<CrossingInfo> Crossings; ///< moves and segments of rays, [plane of the block][bundle]
  /// Sideways moves of each bundle's rays through the whole domain, voxels along the bundle's u and v
  std::vector<std::array<double, 2>> Moves;
  /// Number of planes of the domain that rays have crossed in earlier laps around a periodic axis.
  int LapPlanes = 0;
  std::size_t SideFloats = 0; ///< number of floats per ray and plane in RaysAtFaces::sides
  std::size_t RayCount = 0;   ///< number of rays per voxel of a plane: directions of all bundles, times channels
};

/// Sideways move, for one direction (member) of a bundle, in one stage of crossing a plane, voxels along u and v.
std::array<int, 2> MoveOf(const BundleInfo& bundle, int member, const CrossingInfo& crossing, int stage);

/// Adds incident light, and sums escaped power, per cell of the domain's faces in the sweep of a block. It computes the
/// same as SweepSides.cl and SweepMaps.cl, but on the host, where the powers of the rays at the block's faces are
/// stored.
class BlockSweep::ByCells
{
public:
  /// @param sweep  must outlive this object
  ByCells(const BlockSweep& sweep, const LightByCells& cells);

  void Enter(RaysAtFaces& in) const; ///< adds the light incident per cell to the incoming rays
  /// Sums escaped power per cell of the domain's faces.
  /// @param out       outgoing rays
  /// @param boundary  incident light that is uniform over each face; some of it passes an edge of the domain without
  /// crossing a voxel
  /// @param tally     receives only the light of `cells.in` that passes such an edge
  void Leave(const RaysAtFaces& out, const SweepBoundary& boundary, SweepTally& tally) const;

private:
  using Voxel = std::array<int, 3>; ///< indices of a voxel in the whole domain
  /// The rays of one direction (member) of a bundle and one channel, which move sideways in a plane.
  struct Aside
  {
    std::size_t bundle = 0;
    int member = 0, channel = 0, plane = 0; ///< plane: index in marching order
    int du = 0, dv = 0;
    double part = 1.0; ///< fraction of each ray's power that moves
    std::size_t ray = 0;
  };
  template <class Act>
  void ForAside(const Act& act) const;
  template <class Act>
  void ForEnds(const Act& act) const;
  void EnterAside(const Aside& ray, RaysAtFaces& in) const;
  void LeaveAside(const Aside& ray, const RaysAtFaces& out) const;
  void PassEdges(const Aside& ray, const SweepBoundary& boundary, SweepTally& tally) const;
  void PassEdge(const Aside& ray, int through, int from, double alike, SweepTally& tally) const;
  void LeaveThrough(const Aside& ray, int axis, const Voxel& voxel, double power) const;
  Voxel VoxelAt(const Aside& ray, int u, int v) const;
  int Edge(int axis, bool entry) const;
  int EntryFaceOf(int axis) const;
  std::size_t CellOf(int face, const Voxel& voxel, int channel) const;
  double LightOf(int face, const Voxel& voxel, int channel) const;
  double MeanLight(int face, const Voxel& voxel, int aside, int move, int channel) const;

  const BlockSweep& Sweep;
  const LightByCells& Cells;
  std::array<BoxFaceLayout, 6> Faces;
  std::size_t CellCount;
};
}
