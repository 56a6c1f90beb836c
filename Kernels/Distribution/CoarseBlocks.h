#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/Coarsening.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// A distributed grid and a coarser grid over the same box (Coarsening.h), which is distributed too: a rank owns the
/// coarse voxels whose centres lie in its block. A coarse voxel that straddles two blocks needs fine voxels of the
/// neighbour. A rank with a thin or empty block may own no coarse voxels. On one rank both grids are whole.
class CoarseBlocks
{
public:
  /// @param communicator  must outlive this
  /// @param coarse  grid over the same box, nowhere finer
  CoarseBlocks(Communicator& communicator, const BlockPartition& fine, const Grid& coarse);
  /// Coarsens by two along each axis.
  CoarseBlocks(Communicator& communicator, const BlockPartition& fine)
    : CoarseBlocks(communicator, fine, Coarsening(fine.whole).Coarse())
  {
  }

  Communicator& Comm() const { return this->TheCommunicator; }
  const BlockPartition& Fine() const { return this->FinePartition; }
  const BlockPartition& Coarse() const { return this->CoarsePartition; }
  /// The coarsening ratio of the whole grids.
  double Ratio() const { return this->Whole.Ratio(); }
  /// The coarsening from the fine voxels that overlap this rank's coarse voxels, some of which other ranks may own, to
  /// these coarse voxels.
  const Coarsening& Own() const { return this->OwnPart; }
  bool HasOwn() const { return this->OwnBox().VoxelCount() > 0; } ///< whether this rank owns coarse voxels

  /// Whether some coarse voxel straddles two ranks' blocks; the same on all ranks.
  bool Straddle() const { return this->AnyStraddles; }
  /// Values of the fine voxels that Own() averages over. Collective.
  /// @param values  `components` per voxel of this rank's block
  std::vector<float> Around(const std::vector<float>& values, int components) const;
  /// Means over this rank's coarse voxels. Collective.
  std::vector<float> Average(const std::vector<float>& values, int components) const;

  /// The coarsening from this rank's fine voxels to the coarse voxels that contain them (Parent) and one layer of
  /// coarse voxels around these, between which refinement interpolates.
  const Coarsening& Seen() const { return this->SeenPart; }
  /// Values of the coarse voxels of Seen(). Collective.
  /// @param values  `components` per coarse voxel of this rank
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
