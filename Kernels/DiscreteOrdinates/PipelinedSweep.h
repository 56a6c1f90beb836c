#pragma once

#include "DiscreteOrdinates/UpwindSweep.h"
#include "Distribution/Communicator.h"
#include "Distribution/Domain.h"
#include "LightPropagation/Sweep/Pipelined/SweepSchedule.h"

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace tyndall
{
/// Light by cell of the faces of this rank's block, and of the whole grid, which all ranks hold.
class CellsOfBlock
{
public:
  /// @param own  grid of the block, or one voxel if it is empty
  /// @param ofWhole  must outlive this
  CellsOfBlock(Device& device, const Domain& domain, const Grid& own, const std::array<bool, 3>& periodic,
    const LightOfCells& ofWhole);
  CellsOfBlock(const CellsOfBlock&) = delete;
  CellsOfBlock& operator=(const CellsOfBlock&) = delete;

  const LightOfCells& Seen() const { return this->OfBlock; }
  /// Copies incident radiance from the cells of the whole grid to those of the block.
  void LetIn();
  /// Adds outgoing power of the blocks of all ranks to the cells of the whole grid. Collective.
  /// @param leave  adds outgoing power to Seen().out, which is zero before
  void LetOut(const std::function<void()>& leave);

private:
  Device& TheDevice;
  const Domain& TheDomain;
  const LightOfCells& OfWhole;
  Buffer<float> Out, In;
  const LightOfCells OfBlock;
  std::vector<std::array<std::size_t, 2>> Places; ///< cell of the block, cell of the whole grid
};

/// Upwind sweep of a decomposed grid, pipelined over ranks. Each octant of directions visits the blocks in downwind
/// order, several octants at a time. Radiance between blocks is passed on bit for bit, as in a serial sweep. Radiance
/// that leaves at the end of a periodic axis is sent to the block at the other end, for the next sweep. Every rank
/// holds the cells of all reflecting faces.
class PipelinedSweep : public OrdinateSweep
{
public:
  /// Collective. All arguments must outlive this.
  /// @param grid  of this rank's block; of one voxel if that is empty, which is then swept alone
  /// @param faces  of the whole grid
  /// @throws InvalidInput on every rank if the blocks have a cyclic sweep order
  PipelinedSweep(
    Device& device, const Domain& domain, const Grid& grid, const OrdinateGroups& groups, const SweptFaces& faces);

  /// Collective.
  /// @return powers summed over ranks
  /// @throws on every rank if any rank throws
  FacePowers Apply(const Buffer<float>& radiance, const Buffer<float>& sigma_t, const Buffer<float>& scale,
    const IncomingRadiance& incoming, const Monitor& monitor) override;

private:
  struct Octant
  {
    ParallelBundles way; ///< direction only, without rays
    int first = 0, groups = 0;
    std::vector<BlockContact> senders, receivers;
    std::vector<BlockContact> aroundFrom, aroundTo; ///< across the ends of periodic axes
    std::vector<std::vector<float>> waiting;        ///< received from aroundFrom, incident in the next sweep
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
  std::optional<CellsOfBlock> Cells; ///< if faces reflect
  std::vector<Octant> Octants;
  std::vector<int> Order; ///< of the octants on this rank
  UpwindSweep Sweep;
  HeldFailure Failure; ///< of the current sweep
};
}
