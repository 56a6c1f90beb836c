#pragma once

#include "Lights/Rgb.h"
#include "Medium/Field.h"

#include <array>

namespace tyndall
{
struct Medium;

/// Light that no medium has scattered yet, as another solver found it by voxel: that of photons along bent rays, say. A
/// solver takes it as the uncollided light of lamps of its own, and carries what is scattered of it (numerics.md,
/// section 5.7).
struct UncollidedImage
{
  Field fluence; ///< W / length^2, of the medium's grid; null: there is none
  /// Mean direction, power-weighted, 3 components a voxel: its length, 0 to 1, is the anisotropy. Null: light goes
  /// every way alike.
  Field meanDirection;
  std::array<Rgb, 6> escaped = {}; ///< W, that left through -x, +x, -y, +y, -z, +z without having been scattered

  bool IsThere() const { return this->fluence.values != nullptr; }
};

/// W that a medium takes out of the image's light in the channel, absorbed and scattered.
double PowerLost(const UncollidedImage& image, const Medium& medium, int channel);

/// @throws InvalidInput where a fluence is negative or beyond float, a mean direction not finite or longer than 1
///   (names the first such voxel), or the power through a face is not a number that floats hold
void Check(const UncollidedImage& image, const Medium& medium);
}
