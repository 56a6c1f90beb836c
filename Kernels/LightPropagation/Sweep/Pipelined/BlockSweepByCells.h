#pragma once

#include "LightPropagation/Sweep/Pipelined/BlockSweep.h"
#include "Medium/BoxFaces.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// Of a member that moves as the bundle's crossing has it in a stage: voxels along u and v.
std::array<int, 2> MoveOf(const BundleInfo& bundle, int member, const CrossingInfo& crossing, int stage);

/// The cells of the whole grid's faces in a block's sweep: what comes in through each, and what leaves. As
/// SweepFaces.cl and SweepMaps.cl have it of a whole grid, on the host, where a block's rays at faces are.
class BlockSweep::ByCells
{
public:
  /// @param sweep  must stay
  ByCells(const BlockSweep& sweep, const LightByCells& cells);

  void Enter(RaysAtFaces& in) const; ///< adds to rays that come in
  /// @param out       rays that go out
  /// @param boundary  what comes in besides: some of it goes through an edge of the grid, without a voxel
  /// @param tally     only what of `cells.in` goes so is added to
  void Leave(const RaysAtFaces& out, const SweepBoundary& boundary, SweepTally& tally) const;

private:
  using Voxel = std::array<int, 3>; ///< of the whole grid
  /// A ray of a bundle and channel that moves aside in a plane.
  struct Aside
  {
    std::size_t bundle = 0;
    int member = 0, channel = 0, plane = 0; ///< plane: of the march
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
