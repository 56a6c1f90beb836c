#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/Coarsening.h"

#include <vector>

namespace tyndall
{
/// A distributed grid and a distributed coarser grid over the same box (Coarsening.h): a rank owns the coarse voxels
/// whose centres lie in its block. A coarse voxel that straddles two blocks averages fine voxels of both ranks. A rank
/// with a thin or empty block may own no coarse voxels. On one rank, the blocks are the whole grids.
class CoarseBlocks
{
public:
  /// Distributes a coarse grid over the ranks of a fine grid.
  /// @param communicator  must outlive this object
  /// @param fine    partition of the fine grid
  /// @param coarse  grid over the same box, along no axis finer than the fine grid
  CoarseBlocks(Communicator& communicator, const BlockPartition& fine, const Grid& coarse);
  /// Creates the coarse grid by coarsening the fine grid by two along each axis.
  CoarseBlocks(Communicator& communicator, const BlockPartition& fine)
    : CoarseBlocks(communicator, fine, Coarsening(fine.whole).Coarse())
  {
  }

  Communicator& Comm() const { return this->TheCommunicator; }
  const BlockPartition& Fine() const { return this->FinePartition; }
  const BlockPartition& Coarse() const { return this->CoarsePartition; }
  /// Smallest ratio, over the three axes, of coarse to fine spacing of the whole grids (Coarsening::Ratio).
  double Ratio() const { return this->Whole.Ratio(); }
  /// Map (Coarsening) between this rank's coarse voxels and the fine voxels that they overlap. Other ranks may own some
  /// of these fine voxels.
  const Coarsening& Own() const { return this->OwnPart; }
  bool HasOwn() const { return this->OwnBox().VoxelCount() > 0; } ///< whether this rank owns coarse voxels

  /// Whether any coarse voxel of the grid straddles two ranks' blocks; the same on all ranks.
  bool Straddle() const { return this->AnyStraddles; }
  /// Values of the fine voxels that this rank's coarse voxels overlap (all voxels of Own()), gathered from the ranks
  /// that own them. Collective.
  /// @param values  values of this rank's block, `components` per fine voxel
  std::vector<float> Around(const std::vector<float>& values, int components) const;
  /// Means of fine values over this rank's coarse voxels. Collective.
  /// @param values  values of this rank's block, `components` per fine voxel
  std::vector<float> Average(const std::vector<float>& values, int components) const;

  /// Map (Coarsening) between this rank's fine voxels and the coarse voxels that contain them (Parent). One layer of
  /// coarse voxels around these is included, since refinement interpolates between coarse voxels.
  const Coarsening& Seen() const { return this->SeenPart; }
  /// Box of the coarse voxels of Seen(); it contains this rank's coarse voxels and, within the grid, their neighbours.
  const VoxelBox& SeenBox() const { return this->SeenBoxes[this->TheCommunicator.Rank()]; }
  /// Values of the coarse voxels of Seen(), gathered from the ranks that own them. Collective.
  /// @param values  values of this rank's coarse voxels, `components` per voxel
  std::vector<float> SeenOf(const std::vector<float>& values, int components) const;

private:
  const VoxelBox& OwnBox() const { return this->CoarsePartition.blocks[this->TheCommunicator.Rank()]; }

  Communicator& TheCommunicator;
  BlockPartition FinePartition, CoarsePartition;
  Coarsening Whole;
  /// By rank: box of the fine voxels that the rank's coarse voxels overlap (Own()), and box of the coarse voxels from
  /// which its fine voxels are interpolated (Seen()).
  std::vector<VoxelBox> AroundBoxes, SeenBoxes;
  bool AnyStraddles = false;
  Coarsening OwnPart, SeenPart;
};
}
