#pragma once

#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Light field that a solver computed: `fluence`, `fluence_direct` and further arrays that the filters store with a
/// medium. Does not own its arrays.
struct SolvedLight
{
  Field fluence;       ///< total fluence, W / length^2; null: dark
  Field fluenceDirect; ///< fluence of uncollided light, W / length^2; null: not known
  /// Mean direction of the light in each voxel, weighted by power, 3 components; its length is the anisotropy, in [0,
  /// 1]. Null: not known.
  Field meanDirection;
  /// Outgoing radiance, W / (length^2 sr), in each cell of the box's faces (BoxFaces.h): 4 components, at the cosines
  /// SurfaceCosines, or 12 (for each cosine red, green, blue). Null: not known. NaN: not known in a cell and channel.
  Field surface = {};
  /// scatteredMoments: angular moments of scattered light, LightField::scatteredMoments, with (degree + 1)^2 components
  /// or 3 times as many. straightOn: the fraction of scattering that the solver of the moments treated as unscattered,
  /// LightField::straightOn. Null: not known. lampsApart: the lamps whose first scattering is not in the moments,
  /// LightField::lampsApart.
  Field scatteredMoments = {}, straightOn = {};
  std::vector<Light> lampsApart = {};
  /// Outgoing partial current in the cells of the box's faces, W / length^2, LightField::facePower, with 1 or 3
  /// components (null: not known), and albedo of the faces, LightField::faceAlbedo.
  Field facePower = {};
  std::array<Rgb, 6> faceAlbedo = {};
  /// Radiance that enters through the faces, W / (length^2 sr) (Illumination::faces). Pictures made of scatteredMoments
  /// show the part of it that was scattered through small angles.
  std::array<Rgb, 6> faceRadiance = {};
  /// Standard error of `fluence`, W / length^2, with 1 or 3 components, for PictureError.h; null: not known.
  Field fluenceError = {};
  /// Standard error of `surface`, LightField::surfaceError, and length over which errors of `fluence` have the same
  /// sign, LightField::errorLength; null and 0: not known.
  Field surfaceError = {};
  double errorLength = 0.0;
};

struct ViewSettings;

/// Checks the arrays of a light field.
/// @throws InvalidInput for an array that is not finite or has a wrong number of components, or if the settings need an
///   array that is missing
void Check(const SolvedLight& light, const Grid& grid, const ViewSettings& settings);

/// Degree of angular moments with (degree + 1)^2 or 3 (degree + 1)^2 components.
/// @throws InvalidInput for any other number of components
int DegreeOf(const Field& moments);
}
