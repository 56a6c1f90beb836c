#pragma once

#include "DiscreteOrdinates/Distributed/CellsOfBlock.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/UpwindSweep.h"
#include "Distribution/HeldFailure.h"
#include "LightPropagation/Sweep/Pipelined/BlockContact.h"
#include "LightPropagation/Sweep/Pipelined/SweepSchedule.h"

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace tyndall
{
/// The upwind sweep of a grid whose blocks lie on several ranks: directions of an octant go from block to block in the
/// order that light does, those of some octants while others are under way elsewhere. What leaves a block's voxels
/// through a face enters those of the next block as it would in one memory: the same radiance bit for bit. What leaves
/// through the end of a periodic axis goes to the block on the other side, and comes in there in the next sweep. Cells
/// of the grid's faces that give back light are known on all ranks.
class UpwindSweepInBlocks : public OrdinateSweep
{
public:
  /// All ranks make one together, and all of it must stay.
  /// @param grid  of this rank's block, or of one voxel where it has none: that is swept alone
  /// @param faces  of the whole grid
  /// @throws InvalidInput on each where blocks wait for each other
  UpwindSweepInBlocks(Device& device, const OrdinatesRanks& ranks, const Grid& grid, const OrdinateGroups& groups,
    const SweptFaces& faces);

  /// All ranks call it.
  /// @return of all ranks
  /// @throws on every rank what any of them throws
  FacePowers Apply(const Buffer<float>& radiance, const Buffer<float>& sigma_t, const Buffer<float>& scale,
    const IncomingRadiance& incoming, const Monitor& monitor) override;

private:
  struct Octant
  {
    ParallelBundles way; ///< without rays
    int first = 0, groups = 0;
    std::vector<BlockContact> senders, receivers;
    std::vector<BlockContact> aroundFrom, aroundTo; ///< past the ends of periodic axes
    std::vector<std::vector<float>> waiting;        ///< from these, to come in with the next sweep; empty: nothing
  };
  using Faces = std::array<std::vector<float>, 3>;

  void FindContacts(Octant& octant, const SweptFaces& faces) const;
  SweptFaces FacesOfBlock(const SweptFaces& ofWhole);
  void TakeFrom(const Octant& octant, int number);
  void Enter(const Octant& octant, const BlockContact& contact, const std::vector<float>& message, Faces& faces) const;
  void GiveTo(const Octant& octant, int number);
  void TakeFromAround();
  template <class Visit>
  void ForFace(const Octant& octant, const BlockContact& contact, const VoxelBox& cells, const Visit& visit) const;

  Device& TheDevice;
  const OrdinatesRanks& Ranks;
  const Grid TheGrid;
  std::optional<CellsOfBlock> Cells; ///< where faces give back light
  std::vector<Octant> Octants;
  std::vector<int> Order; ///< of this rank
  UpwindSweep Sweep;
  HeldFailure Failure; ///< of a sweep
};
}
