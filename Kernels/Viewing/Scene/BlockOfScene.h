#pragma once

#include "Distribution/BlockPartition.h"
#include "Medium/Grid.h"
#include "Medium/Medium.h"
#include "Medium/VoxelBox.h"
#include "Refraction/Index/IndexField.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewShared.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// A block of a domain that is decomposed over several ranks, each of which renders its own block.
///
/// Its arrays hold its own voxels and, towards neighbouring blocks, a layer of ghost cells: between the centres of two
/// voxels of different blocks, light is interpolated from both.
struct GridBlock
{
  Grid whole;
  std::array<int, 3> first = {};           ///< index in the whole grid of the arrays' first voxel
  std::array<int, 3> begin = {}, end = {}; ///< its own voxels, [begin, end) in indices of the whole grid
  bool showsBackgroundBeside = false;      ///< shows the background to rays that miss the domain; true for one block

  std::size_t OwnVoxels() const
  {
    return static_cast<std::size_t>(this->end[0] - this->begin[0]) * (this->end[1] - this->begin[1]) *
      (this->end[2] - this->begin[2]);
  }
};

/// The block of one rank.
/// @param held  voxels of its arrays
GridBlock BlockOfRank(const BlockPartition& partition, int rank, const VoxelBox& held);
/// The same for arrays that hold its own voxels alone.
inline GridBlock BlockOfRank(const BlockPartition& partition, int rank)
{
  return BlockOfRank(partition, rank, partition.blocks[rank]);
}

/// Restricts values on the faces of the domain (BoxFaces.h) to a block; 0 on block faces inside the domain.
/// @param ofWhole     values of all face cells of the domain
/// @param components  values per cell
/// @param size        of the block's arrays, voxels
std::vector<float> FacesOfBlock(
  const std::vector<float>& ofWhole, int components, const GridBlock& block, const std::array<int, 3>& size);

/// Indices of the blocks, sorted from front to back: no camera ray crosses a block after one that is later in the list.
/// Blocks that occlude each other cyclically have no such order; those of a k-d partition never do.
std::vector<int> FrontToBack(const std::vector<GridBlock>& blocks, const Camera& camera);

/// Properties of the whole domain that the pictures of its blocks depend on; the same for all blocks.
struct SharedScene
{
  IndexRange index;      ///< range of the refractive index in the domain
  bool coloured = false; ///< extinction differs between the channels in some block
  /// smallest straightOn of the scattering voxels of all blocks, per channel
  std::array<double, 3> straightOn = { 1.0, 1.0, 1.0 };
};

/// SharedScene of one block, to be reduced over the blocks by minimum, maximum and logical or.
/// @param ior  refractive index of the block's voxels, one component; null: 1
SharedScene SharedSceneOf(
  const Medium& medium, const SolvedLight& light, const Field& ior, const ViewSettings& settings);

/// Smallest straightOn of the voxels that scatter in a channel; 1 if none does or if straightOn is not known.
double LeastStraightOn(const Medium& medium, const SolvedLight& light, int channel);

/// A block that is rendered such that the pictures of all blocks combine to the picture of the whole domain, to
/// rounding.
struct BlockOfScene
{
  GridBlock block;
  VoxelBox known; ///< voxels whose refractive index is given: the block's arrays and more (KnownBox)
  SharedScene shared;
};

/// Crops the known refractive index to the block's arrays; empty if the index is not given.
std::vector<float> HeldIndex(const Field& known, const BlockOfScene& block, const std::array<int, 3>& size);

/// The box of voxels that the arrays of a block must cover: its own voxels and a halo; at a face of the domain also
/// VoxelsBehindSurface voxels inwards, if the light at the surface is shown.
/// @param own      the block's own voxels, not empty
/// @param moments  light is shown by angular moments
/// @param surface  outgoing radiance at the surface (SolvedLight::surface) may be shown
VoxelBox HeldBox(const VoxelBox& own, const Grid& whole, const ViewSettings& settings, bool moments, bool surface);

/// The box of voxels whose refractive index must be known if it varies: HeldBox and a wider halo.
VoxelBox KnownBox(const VoxelBox& own, const VoxelBox& held, const Grid& whole, const ViewSettings& settings);

/// Number of voxels behind a face that the surface light depends on; more than enough if one voxel reaches
/// ThickAtSurface.
constexpr int VoxelsBehindSurface = 6;

/// The kernels' description of a block.
BlockInfo BlockInfoOf(const GridBlock& block);

/// Whether a face (0: -x, 1: +x, ...) of a block's arrays lies on the boundary of the domain.
/// @param size  of the arrays, voxels
bool IsOnFace(const GridBlock& block, const std::array<int, 3>& size, int face);
}
