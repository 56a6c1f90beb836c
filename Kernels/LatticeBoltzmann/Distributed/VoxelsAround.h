#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Field.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// A rank's block with some layers of its neighbours' voxels, as far as the grid goes, and values of these. Round a
/// periodic axis the grid goes on: voxels beyond its end are those of its other side, the block's own ones as well.
class VoxelsAround
{
public:
  VoxelsAround(
    Communicator& communicator, const BlockPartition& partition, const std::array<bool, 3>& periodic, int layers);

  /// In voxels of the whole grid, beyond its ends too; without any where the block is empty.
  const VoxelBox& Own() const { return this->Partition.blocks[this->Others.Rank()]; }
  const VoxelBox& Known() const { return this->Boxes[this->Others.Rank()]; }
  Grid KnownGrid() const; ///< of no voxels where the block is empty
  /// The block among these. Beyond all its faces across periodic axes others lie.
  LatticeBox Box() const;

  /// Of values of each own voxel those of all known ones. All ranks call it.
  std::vector<float> Spread(const std::vector<float>& own, int components) const;
  /// The same of a field, which is `own` where it has no values.
  Field Spread(const Field& own, std::vector<float>& values) const;

private:
  VoxelBox Image(const VoxelBox& box, const std::array<int, 3>& periods) const;

  Communicator& Others;
  const BlockPartition& Partition;
  const std::array<bool, 3> Periodic;
  std::vector<VoxelBox> Boxes;             ///< by rank
  std::vector<std::array<int, 3>> Periods; ///< so many of which away from the grid some box has voxels, along each axis
};

/// A block's medium and index, and uncollided light that is given, with those of the voxels around it.
struct MediumAround
{
  /// All ranks make one together.
  MediumAround(const VoxelsAround& voxels, const Medium& own, const Field& ior, const UncollidedImage& image);
  MediumAround(const MediumAround&) = delete;
  MediumAround& operator=(const MediumAround&) = delete;

  Medium medium;
  Field index;
  UncollidedImage uncollided;

private:
  std::vector<float> Absorption, Scattering, Emission, G, Index, Fluence, Directions;
};
}
