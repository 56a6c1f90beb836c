#pragma once

#include "Medium/Medium.h"
#include "Medium/VoxelBox.h"
#include "Refraction/Index/IndexRange.h"
#include "Viewing/Scene/GridBlock.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewShared.h"

#include <array>
#include <vector>

namespace tyndall
{
/// What pictures of a block take from the whole grid, the same for all of its blocks.
struct SharedScene
{
  IndexRange index;                                     ///< of the whole
  bool coloured = false;                                ///< extinction differs between channels in any block
  std::array<double, 3> straightOn = { 1.0, 1.0, 1.0 }; ///< least that goes straight on, where any block scatters
};

/// What a block has to say for it; joined over blocks: least, largest and any.
/// @param ior  of the block's voxels, one component; null: 1
SharedScene SharedSceneOf(
  const Medium& medium, const SolvedLight& light, const Field& ior, const ViewSettings& settings);

/// Least of the voxels that scatter in a channel; 1 where none does, or it is not known.
double LeastStraightOn(const Medium& medium, const SolvedLight& light, int channel);

/// A block whose pictures are those of the whole to rounding, together with those of the other blocks.
struct BlockOfScene
{
  GridBlock block;
  VoxelBox known; ///< voxels of the whole whose refractive index is given: the block's arrays and more (KnownBox)
  SharedScene shared;
};

/// Of the known index that of the block's arrays; empty where it is not given.
std::vector<float> HeldIndex(const Field& known, const BlockOfScene& block, const std::array<int, 3>& size);

/// The voxels that the arrays of a block need: its own, layers of its neighbours', and where it is at a face of the
/// whole VoxelsBehindSurface from there on, if light at the surface is shown.
/// @param own      not empty
/// @param moments  light is shown by angular moments
/// @param surface  light at the surface may be shown
VoxelBox HeldBox(const VoxelBox& own, const Grid& whole, const ViewSettings& settings, bool moments, bool surface);

/// The same for the refractive index, where it varies: these and more.
VoxelBox KnownBox(const VoxelBox& own, const VoxelBox& held, const Grid& whole, const ViewSettings& settings);

/// Voxels behind a face of the box that light at the surface looks at: more than enough where one is ThickAtSurface.
constexpr int VoxelsBehindSurface = 6;

/// As kernels have it.
BlockInfo BlockInfoOf(const GridBlock& block);

/// Whether a face (-x, +x, ...) of a block's arrays is on that of the whole.
/// @param size  voxels of the arrays
bool IsOnFace(const GridBlock& block, const std::array<int, 3>& size, int face);
}
