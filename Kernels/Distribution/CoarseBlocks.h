#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/Coarsening.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// A grid in blocks, one a rank, and a coarser grid (Coarsening.h) in blocks of its own: a rank
/// has the coarse voxels whose centres lie in its block. Where blocks end amid coarse voxels these need fine voxels of
/// neighbours. Of a rank that has none, or thin blocks, there may be no coarse voxels. One rank has both grids whole.
class CoarseBlocks
{
public:
  /// @param communicator  must stay
  /// @param coarse  over the same box, nowhere finer
  CoarseBlocks(Communicator& communicator, const BlockPartition& fine, const Grid& coarse);
  /// Of half the voxels an axis.
  CoarseBlocks(Communicator& communicator, const BlockPartition& fine)
    : CoarseBlocks(communicator, fine, Coarsening(fine.whole).Coarse())
  {
  }

  Communicator& Comm() const { return this->TheCommunicator; }
  const BlockPartition& Fine() const { return this->FinePartition; }
  const BlockPartition& Coarse() const { return this->CoarsePartition; }
  /// Of the whole grids.
  double Ratio() const { return this->Whole.Ratio(); }
  /// Of all the fine voxels that this rank's coarse ones are in part, which may be those of other ranks, to these.
  const Coarsening& Own() const { return this->OwnPart; }
  bool HasOwn() const { return this->OwnBox().VoxelCount() > 0; } ///< coarse voxels

  /// Whether some coarse voxel lies in the blocks of two ranks. The same on all.
  bool Straddle() const { return this->AnyStraddles; }
  /// Values of the fine voxels that Own() averages over. All ranks call it.
  /// @param values  `components` for each voxel of this rank's block
  std::vector<float> Around(const std::vector<float>& values, int components) const;
  /// Means over this rank's coarse voxels. All ranks call it.
  std::vector<float> Average(const std::vector<float>& values, int components) const;

  /// From this rank's fine voxels to the coarse ones in which they lie (Parent) and a layer of voxels round these,
  /// between which it refines.
  const Coarsening& Seen() const { return this->SeenPart; }
  /// Values of the latter. All ranks call it.
  /// @param values  `components` for each of this rank's coarse voxels
  std::vector<float> SeenOf(const std::vector<float>& values, int components) const;

private:
  const VoxelBox& OwnBox() const { return this->CoarsePartition.blocks[this->TheCommunicator.Rank()]; }

  Communicator& TheCommunicator;
  BlockPartition FinePartition, CoarsePartition;
  Coarsening Whole;
  std::vector<VoxelBox> AroundBoxes, SeenBoxes; ///< by rank
  bool AnyStraddles = false;
  Coarsening OwnPart, SeenPart;
};
}
