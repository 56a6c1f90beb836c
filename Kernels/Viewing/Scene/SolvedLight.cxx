#include "Viewing/Scene/SolvedLight.h"

#include "Device/Errors.h"
#include "Device/HostThreads.h"
#include "Medium/BoxFaces.h"
#include "Viewing/Scene/ViewSettings.h"

#include <cmath>
#include <limits>
#include <string>

namespace tyndall
{
namespace
{
constexpr int MostMomentDegree = 15;
constexpr float LargestFloat = std::numeric_limits<float>::max();

void CheckFinite(const Field& field, const char* name, const Grid& grid)
{
  const std::size_t count = grid.VoxelCount() * static_cast<std::size_t>(field.components);
  if (!AnyInThreads(count, [&](std::size_t i) { return !(std::abs(field.values[i]) <= LargestFloat); }))
  {
    return;
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    if (!std::isfinite(field.values[i]))
    {
      throw InvalidInput(std::string(name) + " is not finite in voxel " + VoxelName(grid, i / field.components) +
        " (the first such voxel).");
    }
  }
}

void CheckLightField(const Field& field, const char* name, const Grid& grid)
{
  if (!field.values)
  {
    return;
  }
  CheckComponents(field, name);
  CheckFinite(field, name, grid);
}

/// Checks an array on the cells of the box's faces.
/// @param mayBeUnknown  whether values may be NaN
/// @throws InvalidInput unless all values are finite
void CheckFaces(const Field& faces, const char* name, const Grid& grid, bool mayBeUnknown)
{
  for (std::size_t i = 0; faces.values && i < BoxFaceCellCount(grid) * faces.components; ++i)
  {
    if (!std::isfinite(faces.values[i]) && !(mayBeUnknown && std::isnan(faces.values[i])))
    {
      throw InvalidInput(std::string(name) + " is not finite in tuple " + std::to_string(i / faces.components) + ".");
    }
  }
}
}

int DegreeOf(const Field& moments)
{
  for (int degree = 0; degree <= MostMomentDegree; ++degree)
  {
    const int harmonics = (degree + 1) * (degree + 1);
    if (moments.components == harmonics || moments.components == 3 * harmonics)
    {
      return degree;
    }
  }
  throw InvalidInput("scattered_moments has " + std::to_string(moments.components) +
    " components a voxel; moments up to degree L have (L + 1)^2, or 3 times as many, L at most " +
    std::to_string(MostMomentDegree) + ".");
}

void Check(const SolvedLight& light, const Grid& grid, const ViewSettings& settings)
{
  CheckLightField(light.fluence, "fluence", grid);
  CheckLightField(light.fluenceDirect, "fluence_direct", grid);
  if (light.meanDirection.values)
  {
    Require(light.meanDirection.components == 3,
      "mean_direction has " + std::to_string(light.meanDirection.components) +
        " components a voxel; a direction has 3.");
    CheckFinite(light.meanDirection, "mean_direction", grid);
  }
  CheckFaces(light.surface, "surface_radiance", grid, true);
  CheckFaces(light.facePower, "face_power", grid, false);
  // Whether uncollided light must be separated from the total fluence.
  const bool separates = settings.shadowRays != settings.singleScatteringOnly;
  const bool byMoments = light.scatteredMoments.values && !settings.singleScatteringOnly;
  if (byMoments)
  {
    CheckFinite(light.scatteredMoments, "scattered_moments", grid);
    CheckLightField(light.straightOn, "straight_on", grid);
    Require(light.straightOn.values, "straight_on is missing: it belongs to scattered_moments.");
  }
  Require(!separates || byMoments || !light.fluence.values || light.fluenceDirect.values,
    "fluence_direct is missing: without it, light that scattered once cannot be told from the rest of "
    "fluence. Let the solver write it, or use neither or both of shadow rays and single scattering only.");
}
}
