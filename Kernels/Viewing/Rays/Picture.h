#pragma once

#include <vector>

namespace tyndall
{
/// A rendered picture: rows from bottom to top, pixels from left to right.
struct Picture
{
  int width = 0;
  int height = 0;
  std::vector<float> radiance; ///< radiance, 3 per pixel, W / (length^2 sr)
  /// Opacity, one per pixel, for what is behind the medium: 1 - transmittance, averaged over the channels, of the
  /// medium and of the reflecting surface. 1 where the table is seen.
  std::vector<float> alpha;
  /// Distance from the camera along the view axis at which the mean transmittance falls to 1/2, one per pixel, also for
  /// bent rays; `farDepth` if it does not.
  std::vector<float> depth;
  float farDepth = 0.0f; ///< depth beyond every point of the box, for rays whose transmittance stays above 1/2
  /// Estimated standard error of the radiance, 3 per pixel, W / (length^2 sr); empty: not requested (PictureError.h).
  std::vector<float> error;
  double relativeError = 0.0; ///< root mean square of `error`, relative to that of the radiance
  /// Only for a block of a larger grid, 3 per pixel: transmittance of the block for radiance from behind it.
  std::vector<float> transmittance;
  /// Only for a block, 3 per pixel: transmittance for light from behind that is not scattered at all. It differs from
  /// `transmittance` only if the light is given by angular moments. Its mean over the channels is 1 - alpha, except
  /// where the block shows the background, which has alpha 1.
  std::vector<float> sceneTransmittance;
  /// Only for a block, 3 per pixel, may be empty: radiance that passes the blocks in front unscattered. These blocks
  /// attenuate it by their sceneTransmittance, so it is not included in `radiance`.
  std::vector<float> sharp;
  /// Only for a block, 3 per pixel: correction for light at the surface of thick voxels (SurfaceLight in Backdrop.cxx)
  /// where the ray enters the domain. It is added to the radiance, multiplied by 1 - transmittance of all blocks along
  /// the ray.
  std::vector<float> missing;
};

/// Transmittance of the blocks in front of a block that is rendered again, 3 per pixel of the picture. 0 marks pixels
/// that are not rendered again. Empty: no blocks are in front.
struct Starts
{
  /// Transmittances of the blocks in front: `transmittance` for radiance (Picture::transmittance), `seen` for
  /// unscattered light (Picture::sceneTransmittance).
  std::vector<float> transmittance, seen;

  bool IsEmpty() const { return this->seen.empty(); }
};
}
