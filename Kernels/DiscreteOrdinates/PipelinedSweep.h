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
/// Outgoing power and reflected radiance in each cell of the faces of this rank's block. The values are exchanged with
/// arrays for the faces of the whole grid, which every rank holds.
class CellsOfBlock
{
public:
  /// @param own  grid of the block; of one voxel if the block is empty
  /// @param ofWhole  must outlive this
  CellsOfBlock(Device& device, const Domain& domain, const Grid& own, const std::array<bool, 3>& periodic,
    const LightOfCells& ofWhole);
  CellsOfBlock(const CellsOfBlock&) = delete;
  CellsOfBlock& operator=(const CellsOfBlock&) = delete;

  const LightOfCells& Seen() const { return this->OfBlock; }
  /// Copies the incident radiance from the cells of the whole grid to the cells of the block.
  void LetIn();
  /// Adds the outgoing power of the blocks of all ranks to the cells of the whole grid. Collective.
  /// @param leave  function that adds this block's outgoing power to Seen().out, which is zero when it is called
  void LetOut(const std::function<void()>& leave);

private:
  Device& TheDevice;
  const Domain& TheDomain;
  const LightOfCells& OfWhole;
  Buffer<float> Out, In;
  const LightOfCells OfBlock;
  /// Two indices of each cell of the block's faces: among the cells of the block, and among those of the whole grid.
  std::vector<std::array<std::size_t, 2>> Places;
};

/// Upwind sweep of a decomposed grid, pipelined over ranks. The directions of an octant are swept block by block in
/// downwind order, several octants concurrently. Radiance crosses between blocks unchanged, so that it equals that of a
/// serial sweep bit for bit. Radiance that leaves at the end of a periodic axis is sent to the block at the other end,
/// where it is incident in the next sweep. Every rank holds the cells of all reflecting faces.
class PipelinedSweep : public OrdinateSweep
{
public:
  /// Collective. All arguments must outlive this.
  /// @param grid  grid of this rank's block; if the block is empty, a grid of one voxel that exchanges no light with
  ///   blocks
  /// @param faces  boundary conditions of the whole grid
  /// @throws InvalidInput on every rank if the blocks have a cyclic sweep order
  PipelinedSweep(
    Device& device, const Domain& domain, const Grid& grid, const OrdinateGroups& groups, const SweptFaces& faces);

  /// Sweeps the whole grid once. Collective.
  /// @return powers summed over ranks
  /// @throws on every rank if any rank throws
  FacePowers Apply(
    const OrdinateArrays& arrays, const IncomingRadiance& incoming, bool shines, const Monitor& monitor) override;
  void Forget() override;

private:
  struct Octant
  {
    /// Marching axis of the octant and signs of its directions. The list of bundles is empty, because it is not used.
    ParallelBundles way;
    int first = 0, groups = 0;
    std::vector<BlockContact> senders, receivers;
    /// Contacts with other blocks across the ends of periodic axes: blocks from which radiance wraps around to this
    /// block, and blocks to which radiance of this block wraps around.
    std::vector<BlockContact> aroundFrom, aroundTo;
    /// By element of aroundFrom: radiance received from that block, incident in the next sweep; empty: none.
    std::vector<std::vector<float>> waiting;
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
  std::optional<CellsOfBlock> Cells; ///< light by cell of the block's faces; set if faces reflect
  std::vector<Octant> Octants;
  std::vector<int> Order; ///< order in which this rank sweeps the octants
  UpwindSweep Sweep;
  HeldFailure Failure; ///< first failure of the current sweep
};
}
