#include "Viewing/Backdrop/EnvironmentPixels.h"

#include "LightPropagation/Uncollided/EnvironmentPeaks.h"

namespace tyndall
{
namespace
{
constexpr int DirectionsOfPeaks = 25; ///< a face, by which the environment's peaks are told from the rest

/// A column more on both sides.
std::vector<cl_float4> ClosedEnvironment(const Environment& environment)
{
  const int width = environment.width;
  std::vector<cl_float4> pixels(static_cast<std::size_t>(width + 2) * environment.height);
  for (int j = 0; j < environment.height; ++j)
  {
    for (int i = 0; i < width + 2; ++i)
    {
      const std::size_t from = 3 * (static_cast<std::size_t>(j) * width + (i + width - 1) % width);
      pixels[static_cast<std::size_t>(j) * (width + 2) + i] = { { environment.radiance[from],
        environment.radiance[from + 1], environment.radiance[from + 2], 0.0f } };
    }
  }
  return pixels;
}
}

EnvironmentPixels PixelsOf(const Environment& environment, bool peaksApart)
{
  EnvironmentPixels pixels;
  pixels.shown = ClosedEnvironment(environment);
  if (peaksApart)
  {
    // What is small and bright is one of the lamps: what of it comes straight on without being scattered is seen apart.
    pixels.sharp = pixels.shown;
    pixels.shown = ClosedEnvironment(Split(environment, EquiangularDirections(DirectionsOfPeaks)).smooth);
    for (std::size_t i = 0; i < pixels.sharp.size(); ++i)
    {
      for (int c = 0; c < 3; ++c)
      {
        pixels.sharp[i].s[c] -= pixels.shown[i].s[c];
      }
    }
  }
  return pixels;
}
}
