#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/Field.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// A rank's block with a halo of `layers` layers of ghost voxels, clipped at the ends of the grid, and the exchange of
/// their values. Along a periodic axis the halo wraps around; ghost voxels may then be images of the block's own
/// voxels.
class Halo
{
public:
  Halo(Communicator& communicator, const BlockPartition& partition, const std::array<bool, 3>& periodic, int layers);

  /// The block, and the block with its halo, in voxels of the whole grid; the halo may reach beyond the grid's ends.
  /// Empty if the block is empty.
  const VoxelBox& Own() const { return this->Partition.blocks[this->Comm.Rank()]; }
  const VoxelBox& Known() const { return this->Boxes[this->Comm.Rank()]; }
  Grid KnownGrid() const; ///< without voxels if the block is empty
  const std::array<bool, 3>& Periodic() const { return this->Around; }
  const Grid& Whole() const { return this->Partition.whole; }

  /// Extends values of the own voxels to the halo. Collective.
  /// @param own  `components` per own voxel, x fastest
  /// @return the same for all known voxels
  std::vector<float> Spread(const std::vector<float>& own, int components) const;
  /// The same for a field, whose values go to `values`; returns `own` if it has no values.
  Field Spread(const Field& own, std::vector<float>& values) const;
  /// The transpose of Spread: for each own voxel, the sum over ranks of what they found for it. The numbers are
  /// integers, so the order of ranks does not matter. Collective.
  std::vector<std::int64_t> Gather(const std::vector<std::int64_t>& known) const;

private:
  VoxelBox Image(const VoxelBox& box, const std::array<int, 3>& periods) const;
  std::vector<VoxelBox> Images(const std::array<int, 3>& periods) const;
  VoxelBox PlaceOf(const VoxelBox& image, const std::array<int, 3>& periods) const;

  Communicator& Comm;
  const BlockPartition& Partition;
  const std::array<bool, 3> Around; ///< periodic axes
  std::vector<VoxelBox> Boxes;      ///< by rank
  std::vector<std::array<int, 3>>
    Periods; ///< shifts, in whole grid periods along each axis, at which some rank's box has voxels
};
}
