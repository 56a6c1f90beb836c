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
/// A rank's block with some layers of its neighbours' voxels, as far as the grid goes, and values of these. Round a
/// periodic axis the grid goes on: voxels beyond its end are those of its other side, the block's own ones as well.
class Halo
{
public:
  Halo(Communicator& communicator, const BlockPartition& partition, const std::array<bool, 3>& periodic, int layers);

  /// In voxels of the whole grid, beyond its ends too; without any where the block is empty.
  const VoxelBox& Own() const { return this->Partition.blocks[this->Comm.Rank()]; }
  const VoxelBox& Known() const { return this->Boxes[this->Comm.Rank()]; }
  Grid KnownGrid() const; ///< of no voxels where the block is empty
  const std::array<bool, 3>& Periodic() const { return this->Around; }
  const Grid& Whole() const { return this->Partition.whole; }

  /// Of values of each own voxel those of all known ones. All ranks call it.
  std::vector<float> Spread(const std::vector<float>& own, int components) const;
  /// The same of a field, which is `own` where it has no values.
  Field Spread(const Field& own, std::vector<float>& values) const;
  /// The other way round: of what each rank has found for its known voxels the sums for this rank's own ones, in whole
  /// numbers, so that the order of ranks does not matter. All ranks call it.
  std::vector<std::int64_t> Gather(const std::vector<std::int64_t>& known) const;

private:
  VoxelBox Image(const VoxelBox& box, const std::array<int, 3>& periods) const;
  std::vector<VoxelBox> Images(const std::array<int, 3>& periods) const;
  VoxelBox PlaceOf(const VoxelBox& image, const std::array<int, 3>& periods) const;

  Communicator& Comm;
  const BlockPartition& Partition;
  const std::array<bool, 3> Around;        ///< the periodic axes
  std::vector<VoxelBox> Boxes;             ///< by rank
  std::vector<std::array<int, 3>> Periods; ///< so many of which away from the grid some box has voxels, along each axis
};
}
