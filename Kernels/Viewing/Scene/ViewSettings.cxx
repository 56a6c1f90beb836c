#include "Viewing/Scene/ViewSettings.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double LeastStep = 0.01, LargestStep = 20.0; ///< smallest and largest step size, voxels
/// Largest radiance that a setting may have, W / (length^2 sr); a sum of radiances does not overflow a float.
constexpr double LargestRadiance = 1e37;
constexpr double MostPixels = 7e8; ///< largest number of pixels; with three values per pixel, indices stay below 2^31

void CheckPart(double part, const char* what)
{
  Require(part >= 0.0 && part <= 1.0,
    std::string(what) + " is " + Text("%g", part) + "; it is a part of the light, from 0 to 1.");
}

void CheckSurface(const ViewSettings& settings)
{
  const int reflection = static_cast<int>(settings.surfaceReflection);
  Require(reflection >= 0 && reflection <= 2,
    "Surface reflection " + std::to_string(reflection) + " does not exist; use 0 (none), 1 (Fresnel) or 2 (fixed).");
  Require(settings.surfaceIndex >= 0.0 && std::isfinite(settings.surfaceIndex),
    "The refractive index of the surface is " + Text("%g", settings.surfaceIndex) +
      "; it must be above 0, or 0 for the middle of the grid's range.");
  CheckPart(settings.surfaceReflectance, "The surface's reflectance");
}

void CheckTable(const ViewSettings& settings)
{
  Require(settings.tableFace >= -1 && settings.tableFace <= 5,
    "The table is face " + std::to_string(settings.tableFace) +
      " of the box; use 0 to 5 for -x, +x, -y, +y, -z, +z, or -1 for none.");
  CheckPart(settings.tableReflectance, "The part that the table mirrors");
  for (const double colour : settings.tableColor)
  {
    CheckPart(colour, "A channel of the table's colour");
    Require(colour + settings.tableReflectance <= 1.0 + 1e-9,
      "The table scatters " + Text("%g", colour) + " and mirrors " + Text("%g", settings.tableReflectance) +
        " of the light, together more than all of it; lower its colour or its reflectance.");
  }
}

void SetLevel(ViewSettings& settings, double stepSize, int rectangleSamples, double minimumTransmittance)
{
  const ViewSettings byDefault;
  SetUnlessChosen(settings.stepSize, byDefault.stepSize, stepSize);
  SetUnlessChosen(settings.rectangleSamples, byDefault.rectangleSamples, rectangleSamples);
  SetUnlessChosen(settings.minimumTransmittance, byDefault.minimumTransmittance, minimumTransmittance);
}
}

void Check(const ViewSettings& settings)
{
  Require(settings.imageSize[0] >= 1 && settings.imageSize[1] >= 1,
    "The image is " + std::to_string(settings.imageSize[0]) + " by " + std::to_string(settings.imageSize[1]) +
      " pixels; it needs at least one each way.");
  Require(static_cast<double>(settings.imageSize[0]) * settings.imageSize[1] <= MostPixels,
    "The image is " + std::to_string(settings.imageSize[0]) + " by " + std::to_string(settings.imageSize[1]) +
      " pixels; all together they may be at most " + Text("%g", MostPixels) + ".");
  Require(settings.stepSize >= LeastStep && settings.stepSize <= LargestStep,
    "The step size (StepSize) is " + Text("%g", settings.stepSize) + " voxels; it must be from " +
      Text("%g", LeastStep) + " to " + Text("%g", LargestStep) +
      ". Smaller steps than that show nothing more, larger ones miss voxels.");
  for (const double channel : settings.backgroundColor)
  {
    Require(channel >= 0.0 && channel <= LargestRadiance,
      "A channel of the background (BackgroundRadiance) is " + Text("%g", channel) +
        " W/(length^2 sr); it must be from 0 to " + Text("%g", LargestRadiance) + ".");
  }
  const std::array<int, 5> widths = { 0, 1, 4, 8, 16 };
  Require(std::find(widths.begin(), widths.end(), settings.packetWidth) != widths.end(),
    "Packets of " + std::to_string(settings.packetWidth) + " rays do not exist; use 0, 1, 4, 8 or 16.");
  Require(settings.minimumTransmittance >= 0.0 && settings.minimumTransmittance < 1.0,
    "The transmittance at which rays stop is " + Text("%g", settings.minimumTransmittance) +
      "; it must be at least 0 and below 1.");
  Require(
    !settings.shadowRays || settings.rectangleSamples >= 1, "A rectangular light needs at least one sample per edge.");
  CheckSurface(settings);
  CheckTable(settings);
}

ViewSettings AtQuality(Quality quality, ViewSettings settings)
{
  switch (quality)
  {
    case Quality::Draft: SetLevel(settings, 1.0, 2, settings.minimumTransmittance); break;
    case Quality::Default: break;
    case Quality::Fine: SetLevel(settings, 0.25, 5, 1e-4); break;
    case Quality::Reference: SetLevel(settings, 0.1, 9, 1e-5); break;
  }
  return settings;
}

std::vector<std::string> Words(const ViewSettings& settings)
{
  return { "StepSize = " + Text("%g", settings.stepSize),
    "RectangleSamples = " + std::to_string(settings.rectangleSamples) };
}
}
