#pragma once

#include <vector>

namespace tyndall
{
/// What a camera sees, row by row from the lowest, pixels from left to right.
struct Picture
{
  int width = 0;
  int height = 0;
  std::vector<float> radiance; ///< 3 per pixel, W / (length^2 sr)
  /// 1 - transmittance, its mean over the channels: what the medium, and a surface's reflection, let through of what is
  /// behind. 1 where the table is seen.
  std::vector<float> alpha;
  /// Distance from the camera along the view axis to where transmittance (its mean over the channels) falls to 1/2, on
  /// rays that bend as well. `farDepth` where it never does.
  std::vector<float> depth;
  float farDepth = 0.0f; ///< beyond every point of the box
  /// Of a block of a larger grid only, 3 per pixel: the part of the radiance behind the block that comes through.
  std::vector<float> transmittance;
  /// Likewise, the part of the scene behind that is seen through it, which is not scattered light: the same but where
  /// the light has angular moments. Its mean is 1 - alpha, but where the background is seen: there a block's alpha is
  /// 1.
  std::vector<float> sceneTransmittance;
  /// Likewise of a block, or empty, 3 per pixel: radiance that comes through what is before the block without being
  /// scattered, as sceneTransmittance says; it is not in `radiance` then.
  std::vector<float> sharp;
  /// Likewise: light at the surface where the ray enters the whole, of which so much is seen as the ray meets of the
  /// medium.
  std::vector<float> missing;
};

/// What comes through the blocks before one that is to be looked at again, 3 per pixel of the picture; 0 where nothing
/// is looked for. Empty: nowhere.
struct Starts
{
  std::vector<float> transmittance, seen; ///< as Picture's transmittance and sceneTransmittance

  bool IsEmpty() const { return this->seen.empty(); }
};
}
