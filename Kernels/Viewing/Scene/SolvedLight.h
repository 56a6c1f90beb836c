#pragma once

#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// The light in a medium as a solver gives it, `fluence` and `fluence_direct` of the data contract; seen, not owned.
struct SolvedLight
{
  Field fluence;       ///< W / length^2, all of it; null: dark
  Field fluenceDirect; ///< its unscattered part; null: not known
  /// Mean direction of the light weighted by power, 3 components; its length is the anisotropy, in [0, 1]. Null: not
  /// known.
  Field meanDirection;
  /// W / (length^2 sr) that leaves through the box's faces, a value for each cell of BoxFaces.h, 4 components
  /// (SurfaceCosines) or 3 times as many (cosine by cosine, red, green, blue). Null: not known.
  Field surface = {};
  /// LightField::scatteredMoments, (degree + 1)^2 or 3 times as many components, and straightOn and lampsApart that
  /// belong to them. Null: not known.
  Field scatteredMoments = {}, straightOn = {};
  std::vector<Light> lampsApart = {};
  /// LightField::facePower, 1 or 3 components, and faceAlbedo, of faces that give back light. Null: not known.
  Field facePower = {};
  std::array<Rgb, 6> faceAlbedo = {};
};
}
