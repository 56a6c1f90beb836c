#pragma once

#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// The light field that a solver computed, `fluence` and `fluence_direct` of the data contract. Does not own its
/// arrays.
struct SolvedLight
{
  Field fluence;       ///< W / length^2, total; null: dark
  Field fluenceDirect; ///< its uncollided part; null: not known
  /// Mean direction of the light, weighted by power, 3 components; its length is the anisotropy, in [0, 1]. Null: not
  /// known.
  Field meanDirection;
  /// Outgoing radiance at the box's faces, W / (length^2 sr), for each face cell (BoxFaces.h): 4 components
  /// (SurfaceCosines), or 12 (cosine by cosine, red, green, blue). Null: not known.
  Field surface = {};
  /// LightField::scatteredMoments with (degree + 1)^2 components, or 3 times as many, and the matching straightOn and
  /// lampsApart. Null: not known.
  Field scatteredMoments = {}, straightOn = {};
  std::vector<Light> lampsApart = {};
  /// LightField::facePower, 1 or 3 components, and faceAlbedo, both for reflecting faces. Null: not known.
  Field facePower = {};
  std::array<Rgb, 6> faceAlbedo = {};
};

struct ViewSettings;

/// @throws InvalidInput for a light array that is not finite or has a wrong number of components, or if the settings
///   need an array that is missing
void Check(const SolvedLight& light, const Grid& grid, const ViewSettings& settings);

/// Degree of angular moments with (degree + 1)^2 or 3 (degree + 1)^2 components.
/// @throws InvalidInput for any other number of components
int DegreeOf(const Field& moments);
}
