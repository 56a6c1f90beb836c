#pragma once

#include "Device/ExactValues.h"
#include "Distribution/Domain.h"
#include "Distribution/Halo.h"
#include "LightPropagation/Diffusion/MultigridLayout.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// Communication of a multigrid solver on several ranks (MultigridSolver.h): exchange of ghost voxels of the finest
/// level, and of cells of the second level. The first rank holds these cells for the whole grid; every rank holds the
/// cells that contain its own voxels ("touched" cells). All functions are collective, except for those that return
/// layouts.
class MultigridExchange
{
public:
  /// @param domain  must outlive this object
  /// @param finest, coarser  layouts of the first two levels of the whole grid
  MultigridExchange(Device& device, const Domain& domain, const std::array<bool, 3>& periodic,
    const MultigridLevel& finest, const MultigridLevel& coarser);

  /// Layout of this rank's block with its ghost voxels.
  const MultigridLevel& Finest() const { return this->OfBlock; }
  /// Layout of the cells of the multigrid's second level that contain voxels of this rank's block.
  const MultigridLevel& Touched() const { return this->OfTouched; }

  /// Copies the values of ghost voxels from the ranks that own them, in an array in the row layout (MultigridLevel) of
  /// the finest level.
  void FillGhosts(Buffer<float>& rows) const;
  /// Copies the values of ghost voxels from the ranks that own them, in an array with one value per voxel of the block
  /// with its ghosts, x fastest.
  void FillGhosts(ExactValues& ofVoxels) const;
  /// Sums values of touched cells (cells of the second level that contain voxels of the rank) over all ranks, in the
  /// order of ranks.
  /// @param arrays  number of consecutive arrays in `ofTouched`
  /// @return rows of the whole second level on the first rank; empty on all other ranks
  std::vector<float> Sum(const Buffer<float>& ofTouched, int arrays) const;
  /// Copies values of the second level from the first rank to the touched cells (those that contain voxels of the rank)
  /// of all ranks.
  /// @param whole  rows of the whole second level, read on the first rank only
  void Distribute(const Buffer<float>& whole, Buffer<float>& ofTouched) const;

private:
  bool IsFirst() const { return this->TheDomain.Rank() == 0; }

  Device& TheDevice;
  const Domain& TheDomain;
  MultigridLevel OfBlock, OfTouched, Coarser;
  std::vector<VoxelBox> TouchedBoxes; ///< by rank, the box of the second level's cells that contain voxels of that rank
  std::unique_ptr<GhostCells> Ghosts;
  /// Indices, in the row layout, of this rank's voxels that are ghosts on other ranks, and of this rank's ghosts.
  Buffer<cl_int> Owned, Copied;
};
}
