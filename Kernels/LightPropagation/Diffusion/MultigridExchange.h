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
/// What the ranks of a distributed multigrid exchange (MultigridSolver.h): ghost voxels of the finest level, and the
/// second level's cells, which the first rank holds for the whole grid and each rank for its own voxels. All functions
/// are collective, except for those that return layouts.
class MultigridExchange
{
public:
  /// @param domain  must outlive this object
  /// @param finest, coarser  first two levels of the whole grid
  MultigridExchange(Device& device, const Domain& domain, const std::array<bool, 3>& periodic,
    const MultigridLevel& finest, const MultigridLevel& coarser);

  const MultigridLevel& Finest() const { return this->OfBlock; }    ///< this rank's block with its ghost voxels
  const MultigridLevel& Touched() const { return this->OfTouched; } ///< cells that contain voxels of the block

  /// Fills the ghost voxels of an array of the finest level.
  void FillGhosts(Buffer<float>& rows) const;
  void FillGhosts(ExactValues& ofVoxels) const; ///< in an array by voxel
  /// Sums values of touched cells over the ranks, in their order.
  /// @param arrays  number of arrays of the level
  /// @return rows of the whole level on the first rank; elsewhere empty
  std::vector<float> Sum(const Buffer<float>& ofTouched, int arrays) const;
  /// Copies values from the first rank to the touched cells.
  /// @param whole  used on the first rank
  void Distribute(const Buffer<float>& whole, Buffer<float>& ofTouched) const;

private:
  bool IsFirst() const { return this->TheDomain.Rank() == 0; }

  Device& TheDevice;
  const Domain& TheDomain;
  MultigridLevel OfBlock, OfTouched, Coarser;
  std::vector<VoxelBox> TouchedBoxes; ///< by rank
  std::unique_ptr<GhostCells> Ghosts;
  Buffer<cl_int> Owned, Copied; ///< places in rows of the ghost voxels of others, and of this rank's
};
}
