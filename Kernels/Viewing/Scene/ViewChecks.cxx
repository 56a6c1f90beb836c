#include "Viewing/Scene/ViewChecks.h"

#include "Device/Errors.h"
#include "Device/HostThreads.h"
#include "Medium/BoxFaces.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tyndall
{
namespace
{
constexpr float LeastViewedIndex = 1e-3f;
constexpr float LargestViewedIndex = 1e3f;
constexpr double LeastStep = 0.01, LargestStep = 10.0; ///< voxels
constexpr double LargestRadiance = 1e37;               ///< W / (length^2 sr); sums of it do not overflow a float
constexpr double FarthestCamera = 1e15;                ///< lengths or voxels; their squares do not overflow a float
constexpr double MostPixels = 7e8;                     ///< with three values per pixel, indices stay below 2^31
constexpr int MostMomentDegree = 15;
constexpr float LargestFloat = std::numeric_limits<float>::max();
constexpr float FacesAlike = 1e-3f; ///< relative tolerance, for smoothing of structures near the border

IndexRange RangeOnFaces(const Field& ior, const Grid& grid)
{
  IndexRange range = { ior.values[0], ior.values[0] };
  const std::array<int, 3>& size = grid.size;
  for (int k = 0; k < size[2]; ++k)
  {
    for (int j = 0; j < size[1]; ++j)
    {
      const bool wholeRow = k == 0 || k == size[2] - 1 || j == 0 || j == size[1] - 1;
      const float* row = ior.values + grid.IndexOf({ 0, j, k });
      const int step = wholeRow ? 1 : std::max(size[0] - 1, 1); // otherwise only the row's two ends
      for (int i = 0; i < size[0]; i += step)
      {
        range.least = std::min(range.least, row[i]);
        range.largest = std::max(range.largest, row[i]);
      }
    }
  }
  return range;
}

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

void CheckPart(double part, const char* what)
{
  if (!(part >= 0.0 && part <= 1.0))
  {
    throw InvalidInput(std::string(what) + " is " + Text("%g", part) + "; it is a part of the light, from 0 to 1.");
  }
}

void CheckSurface(const ViewSettings& settings)
{
  const int reflection = static_cast<int>(settings.surfaceReflection);
  if (reflection < 0 || reflection > 2)
  {
    throw InvalidInput(
      "Surface reflection " + std::to_string(reflection) + " does not exist; use 0 (none), 1 (Fresnel) or 2 (fixed).");
  }
  if (settings.surfaceIndex != 0.0 && !(settings.surfaceIndex > 0.0 && std::isfinite(settings.surfaceIndex)))
  {
    throw InvalidInput("The refractive index of the surface is " + Text("%g", settings.surfaceIndex) +
      "; it must be above 0, or 0 for the middle of the grid's range.");
  }
  CheckPart(settings.surfaceReflectance, "The surface's reflectance");
}

void CheckTable(const ViewSettings& settings)
{
  if (settings.tableFace < -1 || settings.tableFace > 5)
  {
    throw InvalidInput("The table is face " + std::to_string(settings.tableFace) +
      " of the box; use 0 to 5 for -x, +x, -y, +y, -z, +z, or -1 for none.");
  }
  CheckPart(settings.tableReflectance, "The part that the table mirrors");
  for (const double colour : settings.tableColor)
  {
    CheckPart(colour, "A channel of the table's colour");
    if (colour + settings.tableReflectance > 1.0 + 1e-9)
    {
      throw InvalidInput("The table scatters " + Text("%g", colour) + " and mirrors " +
        Text("%g", settings.tableReflectance) +
        " of the light, together more than all of it; lower its colour or its reflectance.");
    }
  }
}
}

void Check(const ViewSettings& settings)
{
  if (settings.imageSize[0] < 1 || settings.imageSize[1] < 1)
  {
    throw InvalidInput("The image is " + std::to_string(settings.imageSize[0]) + " by " +
      std::to_string(settings.imageSize[1]) + " pixels; it needs at least one each way.");
  }
  if (static_cast<double>(settings.imageSize[0]) * settings.imageSize[1] > MostPixels)
  {
    throw InvalidInput("The image is " + std::to_string(settings.imageSize[0]) + " by " +
      std::to_string(settings.imageSize[1]) + " pixels; all together they may be at most " + Text("%g", MostPixels) +
      ".");
  }
  if (!(settings.stepSize >= LeastStep && settings.stepSize <= LargestStep))
  {
    throw InvalidInput("The step size (StepSize) is " + Text("%g", settings.stepSize) + " voxels; it must be from " +
      Text("%g", LeastStep) + " to " + Text("%g", LargestStep) +
      ". Smaller steps than that show nothing more, larger ones miss voxels.");
  }
  for (const double channel : settings.backgroundColor)
  {
    if (!(channel >= 0.0 && channel <= LargestRadiance))
    {
      throw InvalidInput("A channel of the background (BackgroundRadiance) is " + Text("%g", channel) +
        " W/(length^2 sr); it must be from 0 to " + Text("%g", LargestRadiance) + ".");
    }
  }
  const std::array<int, 5> widths = { 0, 1, 4, 8, 16 };
  if (std::find(widths.begin(), widths.end(), settings.packetWidth) == widths.end())
  {
    throw InvalidInput(
      "Packets of " + std::to_string(settings.packetWidth) + " rays do not exist; use 0, 1, 4, 8 or 16.");
  }
  if (!(settings.minimumTransmittance >= 0.0 && settings.minimumTransmittance < 1.0))
  {
    throw InvalidInput("The transmittance at which rays stop is " + Text("%g", settings.minimumTransmittance) +
      "; it must be at least 0 and below 1.");
  }
  if (settings.shadowRays && settings.rectangleSamples < 1)
  {
    throw InvalidInput("A rectangular light needs at least one sample per edge.");
  }
  CheckSurface(settings);
  CheckTable(settings);
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
    if (light.meanDirection.components != 3)
    {
      throw InvalidInput("mean_direction has " + std::to_string(light.meanDirection.components) +
        " components a voxel; a direction has 3.");
    }
    CheckFinite(light.meanDirection, "mean_direction", grid);
  }
  for (std::size_t i = 0; light.surface.values && i < BoxFaceCellCount(grid) * light.surface.components; ++i)
  {
    if (!std::isfinite(light.surface.values[i]))
    {
      throw InvalidInput(
        "surface_radiance is not finite in tuple " + std::to_string(i / light.surface.components) + ".");
    }
  }
  for (std::size_t i = 0; light.facePower.values && i < BoxFaceCellCount(grid) * light.facePower.components; ++i)
  {
    if (!std::isfinite(light.facePower.values[i]))
    {
      throw InvalidInput("face_power is not finite in tuple " + std::to_string(i / light.facePower.components) + ".");
    }
  }
  const bool separates = settings.shadowRays != settings.singleScatteringOnly; // separates direct light from the rest
  const bool byMoments = light.scatteredMoments.values && !settings.singleScatteringOnly;
  if (byMoments)
  {
    CheckFinite(light.scatteredMoments, "scattered_moments", grid);
    CheckLightField(light.straightOn, "straight_on", grid);
    if (!light.straightOn.values)
    {
      throw InvalidInput("straight_on is missing: it belongs to scattered_moments.");
    }
  }
  if (separates && !byMoments && light.fluence.values && !light.fluenceDirect.values)
  {
    throw InvalidInput(
      "fluence_direct is missing: without it, light that scattered once cannot be told from the rest of "
      "fluence. Let the solver write it, or use neither or both of shadow rays and single scattering only.");
  }
}

std::vector<std::string> DoubtsAbout(
  const ViewSettings& settings, const SolvedLight& light, const Field& ior, const IndexRange& index, const Grid& grid)
{
  std::vector<std::string> doubts;
  if (settings.tableFace >= 0 && !light.fluence.values)
  {
    doubts.push_back(
      "The table is dark: it is lit by fluence, which is missing. PhotonMarcher and other solvers make it.");
  }
  if (!ior.values)
  {
    return doubts;
  }
  if (settings.surfaceReflection != SurfaceReflection::None && settings.surfaceIndex > 0.0 &&
    !(settings.surfaceIndex > index.least && settings.surfaceIndex <= index.largest))
  {
    doubts.push_back("No surface reflects: its index is " + Text("%g", settings.surfaceIndex) +
      ", those of the grid are from " + Text("%g", index.least) + " to " + Text("%g", index.largest) + ".");
  }
  const IndexRange faces = RangeOnFaces(ior, grid);
  if (faces.largest - faces.least > FacesAlike * faces.largest)
  {
    doubts.push_back("The refractive index varies over the faces of the box, from " + Text("%g", faces.least) + " to " +
      Text("%g", faces.largest) +
      ": light is not bent there, and looks brighter or darker by n^2. Give the box a margin.");
  }
  return doubts;
}

void CheckDistance(const Camera& camera, const Grid& grid)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double away = std::abs(camera.position[axis] - grid.origin[axis]);
    if (!(away <= FarthestCamera && away / grid.spacing[axis] <= FarthestCamera))
    {
      throw InvalidInput("The camera is too far away: " + Text("%g", away) + " from the medium's corner along " +
        "xyz"[axis] + ", " + Text("%g", away / grid.spacing[axis]) + " voxels; come closer than " +
        Text("%g", FarthestCamera) + " of both.");
    }
    if (camera.parallelProjection && !(camera.parallelScale / grid.spacing[axis] <= FarthestCamera))
    {
      throw InvalidInput("The camera's parallel scale is " + Text("%g", camera.parallelScale) + ", " +
        Text("%g", camera.parallelScale / grid.spacing[axis]) + " voxels along " + "xyz"[axis] +
        "; it may be at most " + Text("%g", FarthestCamera) + " voxels.");
    }
  }
}

void CheckViewedIndex(const Field& ior, const Grid& grid)
{
  if (ior.values && ior.components != 1)
  {
    throw InvalidInput("ior has " + std::to_string(ior.components) + " components a voxel; a refractive index has 1.");
  }
  CheckIndex(ior, grid);
  for (std::size_t i = 0; ior.values && i < grid.VoxelCount(); ++i)
  {
    if (ior.values[i] < LeastViewedIndex || ior.values[i] > LargestViewedIndex)
    {
      throw InvalidInput("ior is " + Text("%g", ior.values[i]) + " in voxel " + VoxelName(grid, i) +
        " (the first such voxel); rays are followed where it is from 0.001 to 1000.");
    }
  }
}
}
