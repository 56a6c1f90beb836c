#pragma once

#include "Refraction/Index/IndexRange.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewSettings.h"

#include <string>
#include <vector>

namespace tyndall
{
/// @throws InvalidInput for a setting that has no meaning, whatever the scene
void Check(const ViewSettings& settings);

/// @throws InvalidInput for an array of light that is not finite or has components of another number, and where the
///   settings ask for one that is not there
void Check(const SolvedLight& light, const Grid& grid, const ViewSettings& settings);

/// Degree of moments by their number of components, (degree + 1)^2 or 3 times as many.
/// @throws InvalidInput for another number
int DegreeOf(const Field& moments);

/// Warnings of what may not look as it was meant to, a sentence each: a table without light, a surface where the index
/// is never, an index that varies over the box's faces.
/// @param ior    null: constant
/// @param index  its range
std::vector<std::string> DoubtsAbout(
  const ViewSettings& settings, const SolvedLight& light, const Field& ior, const IndexRange& index, const Grid& grid);

/// @throws InvalidInput for a camera so far from the grid, or a picture so wide, that the numbers of its rays end
void CheckDistance(const Camera& camera, const Grid& grid);

/// @throws InvalidInput for an index that has not one component, is not finite, below 1e-3 or above 1e3
void CheckViewedIndex(const Field& ior, const Grid& grid);
}
