#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "Medium/Field.h"
#include "Medium/Medium.h"

#include <vector>

namespace tyndall
{
/// A rank's block with some layers of its neighbours' voxels, as far as the grid goes, and values of these.
class VoxelsAround
{
public:
  VoxelsAround(Communicator& communicator, const BlockPartition& partition, int layers);

  /// In voxels of the whole grid; without any where the block is empty.
  const VoxelBox& Own() const { return this->Partition.blocks[this->Others.Rank()]; }
  const VoxelBox& Known() const { return this->Boxes[this->Others.Rank()]; }
  Grid KnownGrid() const; ///< of no voxels where the block is empty
  /// The block among these.
  LatticeBox Box() const;

  /// Of values of each own voxel those of all known ones. All ranks call it.
  std::vector<float> Spread(const std::vector<float>& own, int components) const;
  /// The same of a field, which is `own` where it has no values.
  Field Spread(const Field& own, std::vector<float>& values) const;

private:
  Communicator& Others;
  const BlockPartition& Partition;
  std::vector<VoxelBox> Boxes; ///< by rank
};

/// A block's medium, and index, with those of the voxels around it.
struct MediumAround
{
  /// All ranks make one together.
  MediumAround(const VoxelsAround& voxels, const Medium& own, const Field& ior);
  MediumAround(const MediumAround&) = delete;
  MediumAround& operator=(const MediumAround&) = delete;

  Medium medium;
  Field index;

private:
  std::vector<float> Absorption, Scattering, Emission, G, Index;
};
}
