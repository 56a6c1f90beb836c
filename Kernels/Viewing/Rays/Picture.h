#pragma once

#include <vector>

namespace tyndall
{
/// A rendered picture: rows from bottom to top, pixels from left to right.
struct Picture
{
  int width = 0;
  int height = 0;
  std::vector<float> radiance; ///< 3 per pixel, W / (length^2 sr)
  /// 1 - transmittance (mean over the channels) of the medium and of a surface's reflection, for what is behind. 1
  /// where the table is seen.
  std::vector<float> alpha;
  /// Distance from the camera along the view axis at which the mean transmittance falls to 1/2, also for bent rays;
  /// `farDepth` if it does not.
  std::vector<float> depth;
  float farDepth = 0.0f; ///< a depth beyond every point of the box
  /// For a block of a larger grid only, 3 per pixel: transmittance for radiance from behind the block.
  std::vector<float> transmittance;
  /// For a block only, 3 per pixel: transmittance for the unscattered light of the scene behind. Differs from
  /// `transmittance` only if the light has angular moments. Its mean is 1 - alpha, except where the block shows the
  /// background and alpha is therefore 1.
  std::vector<float> sceneTransmittance;
  /// For a block only, 3 per pixel, may be empty: radiance that blocks in front attenuate by sceneTransmittance,
  /// because it passes them unscattered; not included in `radiance`.
  std::vector<float> sharp;
  /// For a block only, 3 per pixel: surface light at the ray's entry into the domain. It is added multiplied by 1 -
  /// transmittance of all blocks along the ray.
  std::vector<float> missing;
};

/// Transmittance of the blocks in front of a block that is rendered again, 3 per pixel of the picture; 0 for pixels
/// that are skipped. Empty: no blocks are in front.
struct Starts
{
  std::vector<float> transmittance, seen; ///< as Picture's transmittance and sceneTransmittance

  bool IsEmpty() const { return this->seen.empty(); }
};
}
