#pragma once

#include "Lights/UncollidedImage.h"
#include "Medium/Grid.h"
#include "Medium/Medium.h"
#include "Photons/Marching/PhotonPacking.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// A stand-in for the light of photons that are yet to march, from which a problem chooses its units and channels. It
/// varies from voxel to voxel, and in colour if photons have several.
struct PhotonsToCome
{
  /// @param given  channels that their light will have
  PhotonsToCome(const PackedPhotons& packed, int given, const Grid& grid);

  UncollidedImage Image() const; ///< refers to these arrays

  int channels;
  std::vector<float> fluence; ///< [voxel][channel]
  std::array<Rgb, 6> escaped = {};
};

/// The channel of photons' light that a channel of a problem uses, and its units.
struct PhotonChannelMap
{
  PhotonChannelMap() = default;
  /// @param photons  the stand-in that the problem was given
  /// @param solved  the same in the problem's units
  /// @param channels, channel  of the problem
  PhotonChannelMap(const PhotonsToCome& photons, const UncollidedImage& solved, int channels, int channel);

  int from = 0;         ///< channel of the photons' light
  double fluence = 1.0; ///< of the lattice's units, in one of the photons'
  double power = 1.0;   ///< the same of power
};

/// Part of a channel's fluence that is scattered in a voxel in a step, in units of that light.
/// @param begins  as LatticeVoxels has it
std::vector<float> ScattersOf(const Medium& medium, int channel, double unit, const std::vector<double>& begins);
}
