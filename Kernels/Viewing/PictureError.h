#pragma once

#include "Viewing/MediumRayCaster.h"

#include <array>
#include <functional>
#include <memory>
#include <string>

namespace tyndall
{
/// Settings of the two coarser pictures (PictureErrorCasters) from which the error of a picture is estimated.
ViewSettings CoarserSettings(ViewSettings settings);

/// Further pictures, all of every second pixel along each axis, from which the error of a picture is estimated without
/// a reference (numerics.md, section 14.10):
///  - `coarse`: half as many samples along rays and along the edges of rectangle lights, rays that end at four times
/// the transmittance, and angular moments of the last degree that are changed to represent higher degrees;
///  - `ofLight`: the error of the light, fluenceError and surfaceError, in place of the light;
///  - `even` and `variance`: the isotropic error and its variance, whose ratio is the part of the error that is left if
/// errors along a ray have the same sign over errorLength only.
/// The error due to interpolation of light and medium between voxel centres is not estimated.
struct PictureErrorCasters
{
  /// Prepares the pictures; parameters and exceptions as of MediumRayCaster.
  PictureErrorCasters(Device& device, const Medium& medium, const SolvedLight& light, const Illumination& illumination,
    const ViewSettings& settings, const Field& ior = {}, const BlockOfScene* block = nullptr);

  /// Adopts the settings of the picture, as MediumRayCaster::Adopt.
  bool Adopt(const ViewSettings& settings);

  /// Sets error and relativeError of a picture that one rank renders.
  void Estimate(Picture& picture, const Camera& camera, const Monitor& monitor = {}) const;

  std::unique_ptr<MediumRayCaster> coarse;
  std::unique_ptr<MediumRayCaster> ofLight; ///< null: the picture shows no solved light, or its error is not known
  std::unique_ptr<MediumRayCaster> even, variance; ///< null: as ofLight, or errorLength is not known
  std::string lightLeftOut; ///< why the error of the light is not part of the estimate; empty: it is, or is none
};

/// Renders a picture of PictureErrorCasters by a camera and in a size in pixels; an empty picture if it is null.
using RenderForError = std::function<Picture(
  std::unique_ptr<MediumRayCaster> PictureErrorCasters::*which, const Camera&, const std::array<int, 2>& size)>;

/// Sets error and relativeError of a picture.
/// @param picture  the whole picture
void EstimatePictureError(Picture& picture, const Camera& camera, const RenderForError& render);
}
