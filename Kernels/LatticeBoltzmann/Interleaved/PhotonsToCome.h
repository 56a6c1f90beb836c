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
/// Synthetic uncollided light for photons that have not yet been marched, from which LatticeProblem chooses units and
/// channels. Its fluence has the order of magnitude of theirs, and varies from voxel to voxel, in three channels
/// independently if photons differ in colour, so that the problem keeps all channels that they need.
struct PhotonsToCome
{
  /// @param given  channels that the photons' light will have
  PhotonsToCome(const PackedPhotons& packed, int given, const Grid& grid);

  UncollidedImage Image() const; ///< refers to the arrays of this object

  int channels;
  std::vector<float> fluence; ///< [voxel][channel]
  std::array<Rgb, 6> escaped = {};
};

/// Which channel of the photons' light a channel of the problem uses, and the unit conversion.
struct PhotonChannelMap
{
  PhotonChannelMap() = default;
  /// @param photons  the uncollided light that the problem was given
  /// @param solved  the same light in the problem's units
  /// @param channels, channel  number of channels of the problem, and the index of one
  PhotonChannelMap(const PhotonsToCome& photons, const UncollidedImage& solved, int channels, int channel);

  int from = 0;         ///< channel of the photons' light
  double fluence = 1.0; ///< lattice units of fluence per unit of the photons' fluence
  double power = 1.0;   ///< the same for power
};

/// Fraction of a channel's fluence that is scattered in each voxel in a step, times the unit of that light.
/// @param begins  LatticeVoxels::begins
std::vector<float> ScattersOf(const Medium& medium, int channel, double unit, const std::vector<double>& begins);
}
