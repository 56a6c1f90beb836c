#include "Lights/UncollidedImage.h"

#include "Device/Errors.h"
#include "Medium/Medium.h"
#include "Numerics/NumberText.h"

#include <cmath>

namespace tyndall
{
namespace
{
/// Largest accepted length of a mean of unit vectors: 1 with rounding in floats.
constexpr double LongestMean = 1.0 + 1e-3;

void CheckFluence(const UncollidedImage& image, const Grid& grid)
{
  CheckComponents(image.fluence, "fluence_direct");
  const std::size_t components = static_cast<std::size_t>(image.fluence.components);
  for (std::size_t i = 0; i < grid.VoxelCount() * components; ++i)
  {
    if (!IsUsable(image.fluence.values[i]))
    {
      throw InvalidInput("fluence_direct of UncollidedLight is " + Text("%.6g", image.fluence.values[i]) +
        " in voxel " + VoxelName(grid, i / components) +
        " (the first such voxel); it must be finite and not negative.");
    }
  }
}

void CheckMeanDirection(const UncollidedImage& image, const Grid& grid)
{
  for (std::size_t i = 0; i < grid.VoxelCount() && image.meanDirection.values; ++i)
  {
    const double length =
      std::hypot(image.meanDirection.At(i, 0), image.meanDirection.At(i, 1), image.meanDirection.At(i, 2));
    if (!(length <= LongestMean))
    {
      throw InvalidInput("mean_direction of UncollidedLight has length " + Text("%.6g", length) + " in voxel " +
        VoxelName(grid, i) + " (the first such voxel); a mean of unit vectors has at most 1.");
    }
  }
}
}

double PowerLost(const UncollidedImage& image, const Medium& medium, int channel)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    const double sigma_t =
      static_cast<double>(medium.sigma_a.At(i, channel)) + static_cast<double>(medium.sigma_s.At(i, channel));
    sum += sigma_t * image.fluence.At(i, channel);
  }
  return sum * medium.grid.VoxelVolume();
}

void Check(const UncollidedImage& image, const Medium& medium)
{
  if (!image.IsThere())
  {
    return;
  }
  CheckFluence(image, medium.grid);
  CheckMeanDirection(image, medium.grid);
  for (const Rgb& face : image.escaped)
  {
    for (double watts : face)
    {
      if (!IsUsable(watts))
      {
        throw InvalidInput(
          "face_power_out of UncollidedLight is " + Text("%.6g", watts) + " W; it must be finite and not negative.");
      }
    }
  }
}
}
