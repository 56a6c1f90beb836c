#pragma once

#include "LightPropagation/Sweep/Pipelined/BlockSweep.h"
#include "Medium/BoxFaces.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// Move of a bundle's member in one stage of a crossing, voxels along u and v.
std::array<int, 2> MoveOf(const BundleInfo& bundle, int member, const CrossingInfo& crossing, int stage);

/// Light by cells of the domain's faces in the sweep of a block: adds incident light and counts what leaves. Same
/// computation as SweepFaces.cl and SweepMaps.cl, but on the host, where the block's rays at faces are.
class BlockSweep::ByCells
{
public:
  /// @param sweep  must outlive this object
  ByCells(const BlockSweep& sweep, const LightByCells& cells);

  void Enter(RaysAtFaces& in) const; ///< adds incident light to the incoming rays
  /// Counts escaped power by cell.
  /// @param out       outgoing rays
  /// @param boundary  further incident light; some of it passes an edge of the domain without crossing a voxel
  /// @param tally     only light of `cells.in` that passes such an edge is added
  void Leave(const RaysAtFaces& out, const SweepBoundary& boundary, SweepTally& tally) const;

private:
  using Voxel = std::array<int, 3>; ///< indexed in the whole grid
  /// A ray, of one bundle and channel, that moves sideways in a plane.
  struct Aside
  {
    std::size_t bundle = 0;
    int member = 0, channel = 0, plane = 0; ///< plane: in the order of the march
    int du = 0, dv = 0;
    double part = 1.0; ///< of its power that moves
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
