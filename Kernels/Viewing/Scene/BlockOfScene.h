#pragma once

#include "Medium/Medium.h"
#include "Medium/VoxelBox.h"
#include "Refraction/Index/IndexField.h"
#include "Viewing/Scene/GridBlock.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewShared.h"

#include <array>
#include <vector>

namespace tyndall
{
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
