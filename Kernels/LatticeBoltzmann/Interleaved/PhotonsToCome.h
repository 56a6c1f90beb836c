#pragma once

#include "Lights/UncollidedImage.h"
#include "Medium/Grid.h"
#include "Medium/Medium.h"
#include "Medium/VoxelBox.h"
#include "Photons/Marching/PhotonPacking.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Something like the light of photons that are yet to march, from which a problem has its units and channels, and says
/// what they are. It varies from voxel to voxel, in colour too where photons have several.
struct PhotonsToCome
{
  /// @param packed  all photons, or as many as a rank has: their power is that of all
  /// @param given  channels that their light will have
  /// @param box  the voxels of the whole grid that are wanted
  PhotonsToCome(const PackedPhotons& packed, int given, const Grid& whole, const VoxelBox& box);

  UncollidedImage Image() const; ///< its arrays are these

  int channels;
  std::vector<float> fluence; ///< [voxel][channel]
  std::array<Rgb, 6> escaped = {};
};

/// What a channel of a problem takes of photons' light.
struct PhotonChannelMap
{
  PhotonChannelMap() = default;
  /// @param photons  in whose place the problem is put
  /// @param solved  what the problem has made of them
  /// @param voxel  of `solved`, the first of the box; the box is not empty
  /// @param channels, channel  of the problem
  PhotonChannelMap(
    const PhotonsToCome& photons, const UncollidedImage& solved, std::size_t voxel, int channels, int channel);

  int from = 0;         ///< channel of the photons' light
  double fluence = 1.0; ///< of the lattice's units, in one of the photons'
  double power = 1.0;   ///< the same of power
};

/// Part of a channel's light that a step's way through a voxel scatters, in units of that light.
/// @param begins  as LatticeVoxels has it
std::vector<float> ScattersOf(const Medium& medium, int channel, double unit, const std::vector<double>& begins);
}
