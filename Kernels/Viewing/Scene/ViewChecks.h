#pragma once

#include "Refraction/Index/IndexField.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewSettings.h"

#include <string>
#include <vector>

namespace tyndall
{
/// @throws InvalidInput for a setting that is invalid in every scene
void Check(const ViewSettings& settings);

/// @throws InvalidInput for a light array that is not finite or has a wrong number of components, or if the settings
///   need an array that is missing
void Check(const SolvedLight& light, const Grid& grid, const ViewSettings& settings);

/// Degree of angular moments with (degree + 1)^2 or 3 (degree + 1)^2 components.
/// @throws InvalidInput for any other number of components
int DegreeOf(const Field& moments);

/// Warnings about what may not look as intended, a sentence each: an unlit table, a surface index that the medium never
/// has, an index that varies over the box's faces.
/// @param ior    refractive index; null: constant
/// @param index  the range of `ior`
std::vector<std::string> DoubtsAbout(
  const ViewSettings& settings, const SolvedLight& light, const Field& ior, const IndexRange& index, const Grid& grid);

/// @throws InvalidInput if the camera is so far from the grid, or the picture so wide, that ray coordinates overflow
void CheckDistance(const Camera& camera, const Grid& grid);

/// @throws InvalidInput for a refractive index that is not finite, lies outside [1e-3, 1e3] or does not have exactly
///   one component
void CheckViewedIndex(const Field& ior, const Grid& grid);
}
