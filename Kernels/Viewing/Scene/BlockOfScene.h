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
/// One rank's block of a decomposed domain, as this rank renders it.
///
/// The block's arrays hold its own voxels and ghost cells of the neighbouring blocks, since light between voxel centres
/// is interpolated from both sides.
struct GridBlock
{
  Grid whole;
  /// Index, in the whole grid, of the first voxel of the block's arrays.
  std::array<int, 3> first = {};
  /// The block's own voxels, [begin, end) in indices of the whole grid.
  std::array<int, 3> begin = {}, end = {};
  /// Whether this block shows the background to rays that miss the domain; true for one block.
  bool showsBackgroundBeside = false;

  std::size_t OwnVoxels() const
  {
    return static_cast<std::size_t>(this->end[0] - this->begin[0]) * (this->end[1] - this->begin[1]) *
      (this->end[2] - this->begin[2]);
  }
};

/// The block of one rank, described for rendering.
/// @param held  voxels of the rank's arrays, ghost cells included
GridBlock BlockOfRank(const BlockPartition& partition, int rank, const VoxelBox& held);
/// The block of one rank whose arrays hold its own voxels only.
inline GridBlock BlockOfRank(const BlockPartition& partition, int rank)
{
  return BlockOfRank(partition, rank, partition.blocks[rank]);
}

/// Restricts values on the faces of the domain (BoxFaces.h) to the faces of a block's arrays; values on faces inside
/// the domain are 0.
/// @param ofWhole     values of all face cells of the domain
/// @param components  values per cell
/// @param size        voxels of the block's arrays along each axis
std::vector<float> FacesOfBlock(
  const std::vector<float>& ofWhole, int components, const GridBlock& block, const std::array<int, 3>& size);

/// Indices of the blocks, sorted from front to back as seen by the camera: no camera ray crosses a block before one
/// that precedes it in the list. Blocks that occlude each other cyclically have no such order; those of a k-d partition
/// never do.
std::vector<int> FrontToBack(const std::vector<GridBlock>& blocks, const Camera& camera);

/// Properties of the whole domain on which the picture of each block depends.
struct SharedScene
{
  IndexRange index;      ///< range of the refractive index in the domain
  bool coloured = false; ///< whether extinction differs between the channels in some block
  /// per channel, smallest straightOn (the fraction of scattering that the solver treats as unscattered) of the
  /// scattering voxels
  std::array<double, 3> straightOn = { 1.0, 1.0, 1.0 };
  double largestError = 0.0; ///< largest standard error of fluence, W / length^2; 0 if it is not known
};

/// SharedScene of one block. The reduction over all blocks by minimum, maximum and logical or gives the SharedScene of
/// the domain.
/// @param ior  refractive index of the block's voxels, one component; null: 1
SharedScene SharedSceneOf(
  const Medium& medium, const SolvedLight& light, const Field& ior, const ViewSettings& settings);

/// Smallest straightOn of the voxels that scatter in a channel; 1 if none does or if straightOn is not known.
/// straightOn is the fraction of scattering that the solver treats as unscattered.
double LeastStraightOn(const Medium& medium, const SolvedLight& light, int channel);
/// Largest SolvedLight::fluenceError, W / length^2; 0 if it is not known.
double LargestError(const Medium& medium, const SolvedLight& light);

/// A block as it is rendered. The composite of all blocks' pictures equals the picture of the whole domain up to
/// rounding.
struct BlockOfScene
{
  GridBlock block;
  VoxelBox known; ///< voxels whose refractive index is given (KnownBox): those of the block's arrays and a wider halo
  SharedScene shared;
};

/// Crops the refractive index from the box `known` of a block to its arrays; empty if the index is not given.
/// @param size  voxels of the block's arrays along each axis
std::vector<float> HeldIndex(const Field& known, const BlockOfScene& block, const std::array<int, 3>& size);

/// The box of voxels that the arrays of a block must cover: its own voxels and a halo. If the correction for light at
/// the surface is shown, the box extends VoxelsBehindSurface voxels inwards from a face of the domain.
/// @param own      the block's own voxels, not empty
/// @param moments  whether light is shown by angular moments
/// @param surface  whether outgoing radiance at the surface (SolvedLight::surface) may be shown
VoxelBox HeldBox(const VoxelBox& own, const Grid& whole, const ViewSettings& settings, bool moments, bool surface);

/// The box of voxels whose refractive index must be known if it varies: HeldBox and a wider halo.
/// @param own   the block's own voxels
/// @param held  the block's HeldBox
VoxelBox KnownBox(const VoxelBox& own, const VoxelBox& held, const Grid& whole, const ViewSettings& settings);

/// Number of voxels behind a face of the box on which the correction for light at the surface depends. Sufficient if a
/// voxel's optical thickness reaches ThickAtSurface.
constexpr int VoxelsBehindSurface = 6;

/// Kernel parameters that describe a block.
BlockInfo BlockInfoOf(const GridBlock& block);

/// Whether a face (0: -x, 1: +x, ...) of a block's arrays lies on the boundary of the domain.
/// @param size  voxels of the arrays along each axis
bool IsOnFace(const GridBlock& block, const std::array<int, 3>& size, int face);
}
