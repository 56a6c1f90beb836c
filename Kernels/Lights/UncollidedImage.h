#pragma once

#include "Lights/Rgb.h"
#include "Medium/Field.h"

#include <array>

namespace tyndall
{
struct Medium;

/// Uncollided light by voxel that another solver has computed, for example from photons along bent rays. A solver that
/// receives it uses it in place of the uncollided light of the lamps, and transports the light that is scattered from
/// it (numerics.md, section 5.7).
struct UncollidedImage
{
  Field fluence; ///< uncollided fluence, W / length^2, on the medium's grid; null values: there is no such light
  /// Power-weighted mean direction of the uncollided light, 3 components per voxel; its length is 0 for isotropic light
  /// and 1 for a beam. Null values: isotropic light.
  Field meanDirection;
  std::array<Rgb, 6> escaped = {}; ///< uncollided power that leaves through faces -x, +x, -y, +y, -z, +z, W

  bool IsThere() const { return this->fluence.values != nullptr; }
};

/// Power that the medium absorbs and scatters from the image's light in one channel, W.
double PowerLost(const UncollidedImage& image, const Medium& medium, int channel);

/// Checks an UncollidedImage.
/// @throws InvalidInput if a fluence is negative or beyond float, a mean direction is not finite or longer than 1
///   (names the first such voxel), or an escaped power is not representable as float
void Check(const UncollidedImage& image, const Medium& medium);
}
