#pragma once

#include "DiscreteOrdinates/UpwindSweep.h"
#include "Distribution/Domain.h"
#include "Distribution/HeldFailure.h"
#include "LightPropagation/Sweep/Pipelined/BlockContact.h"
#include "LightPropagation/Sweep/Pipelined/SweepSchedule.h"

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace tyndall
{
/// Light by cells of the faces of this rank's block, and of the whole grid, which all ranks know.
class CellsOfBlock
{
public:
  /// @param own  the block's grid, or one voxel where it has none
  /// @param ofWhole  must stay
  CellsOfBlock(Device& device, const Domain& domain, const Grid& own, const std::array<bool, 3>& periodic,
    const LightOfCells& ofWhole);
  CellsOfBlock(const CellsOfBlock&) = delete;
  CellsOfBlock& operator=(const CellsOfBlock&) = delete;

  const LightOfCells& Seen() const { return this->OfBlock; }
  /// Copies incident radiance from the cells of the whole grid to those of the block.
  void LetIn();
  /// Adds outgoing power of the blocks of all ranks to the cells of the whole grid. Collective.
  /// @param leave  adds to Seen().out, which is empty
  void LetOut(const std::function<void()>& leave);

private:
  Device& TheDevice;
  const Domain& TheDomain;
  const LightOfCells& OfWhole;
  Buffer<float> Out, In;
  const LightOfCells OfBlock;
  std::vector<std::array<std::size_t, 2>> Places; ///< cell of the block, cell of the whole grid
};

/// The upwind sweep of a decomposed grid, pipelined over ranks: each octant of directions passes the blocks in the
/// order of its light, several octants at once. Radiance that leaves a block enters the next one as it would in one
/// memory, bit for bit. Radiance that leaves through the end of a periodic axis is sent to the block at the other end,
/// for the next sweep. Every rank knows the cells of all reflecting faces.
class PipelinedSweep : public OrdinateSweep
{
public:
  /// Collective. All that is given must stay.
  /// @param grid  of this rank's block, or of one voxel where that is empty: that is swept alone
  /// @param faces  of the whole grid
  /// @throws InvalidInput on each rank where blocks wait for each other in a cycle
  PipelinedSweep(
    Device& device, const Domain& domain, const Grid& grid, const OrdinateGroups& groups, const SweptFaces& faces);

  /// Collective.
  /// @return powers of all ranks
  /// @throws on every rank what any of them throws
  FacePowers Apply(const Buffer<float>& radiance, const Buffer<float>& sigma_t, const Buffer<float>& scale,
    const IncomingRadiance& incoming, const Monitor& monitor) override;

private:
  struct Octant
  {
    ParallelBundles way; ///< without rays
    int first = 0, groups = 0;
    std::vector<BlockContact> senders, receivers;
    std::vector<BlockContact> aroundFrom, aroundTo; ///< across the ends of periodic axes
    std::vector<std::vector<float>> waiting;        ///< from these, incident in the next sweep; empty: nothing
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
  const Domain& TheDomain;
  const Grid TheGrid;
  std::optional<CellsOfBlock> Cells; ///< where faces reflect
  std::vector<Octant> Octants;
  std::vector<int> Order; ///< of this rank
  UpwindSweep Sweep;
  HeldFailure Failure; ///< of a sweep
};
}
