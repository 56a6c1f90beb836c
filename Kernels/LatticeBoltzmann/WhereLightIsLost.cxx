#include "LatticeBoltzmann/WhereLightIsLost.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Smaller components of the mean direction along an axis are ignored, since light also decreases at shadow edges. The
/// weight grows linearly from the first to the second value, so that rounding does not decide.
constexpr double SaysNothing = 0.15, SaysAll = 0.25;

/// Mean of exp(-k x) over x from 0 to 1.
double MeanOf(double k)
{
  return k > 1e-6 ? -std::expm1(-k) / k : 1.0 - 0.5 * k;
}

/// sigma_t times the voxel's edge along an axis.
double ThicknessOf(const Medium& medium, std::size_t voxel, std::size_t axis, int channel)
{
  return medium.grid.spacing[axis] * (medium.sigma_a.At(voxel, channel) + medium.sigma_s.At(voxel, channel));
}

/// Distance from the voxel's centre, upstream, of the mean place at which light exp(-k x) is lost.
double NearerBy(double k)
{
  return k > 1e-2 ? std::min(0.5 - 1.0 / k + 1.0 / std::expm1(k), 0.5) : k / 12.0;
}

/// Solves exp(-k) MeanOf(ratio k) / MeanOf(k) = passes for k, at most `most`: the next voxel downstream is `ratio`
/// times as thick and has the fraction `passes` of this voxel's fluence. The left side decreases with k.
double FallOff(double passes, double ratio, double most)
{
  double low = 0.0, high = most;
  for (int i = 0; i < 40 && passes < 1.0; ++i)
  {
    const double k = 0.5 * (low + high);
    (std::exp(-k) * MeanOf(ratio * k) > passes * MeanOf(k) ? low : high) = k;
  }
  return low;
}

/// One channel of an uncollided image in its medium.
class LostLight
{
public:
  LostLight(const UncollidedImage& image, const Medium& medium, const LatticeBox& box, int channel)
    : Image(image)
    , TheMedium(medium)
    , Box(box)
    , Channel(channel)
  {
  }

  /// Distance of the mean collision place from the voxel's centre along the axis, upstream.
  double Nearer(std::size_t voxel, std::size_t axis) const
  {
    const double along = this->Image.meanDirection.At(voxel, static_cast<int>(axis));
    const double says = std::clamp((std::abs(along) - SaysNothing) / (SaysAll - SaysNothing), 0.0, 1.0);
    return says > 0.0 && this->Thickness(voxel, axis) > 0.0 ? says * this->NearerBySlope(voxel, axis, along) : 0.0;
  }

  double Fluence(std::size_t voxel) const { return this->Image.fluence.At(voxel, this->Channel); }

private:
  /// The same, from the decay of the light.
  /// @param along  component of the mean direction along the axis
  double NearerBySlope(std::size_t voxel, std::size_t axis, double along) const
  {
    const double thickness = this->Thickness(voxel, axis);
    const double most = thickness / std::abs(along);
    const std::size_t ahead = along > 0.0 ? 1 : 0; // the downstream one of the two faces across the axis
    const std::size_t next = this->Box.Beyond(voxel, 2 * axis + ahead);
    if (next != Outside)
    {
      const double here = this->Fluence(voxel);
      return NearerBy(FallOff(this->Fluence(next) / here, this->Thickness(next, axis) / thickness, most));
    }
    const std::size_t last = this->Box.Beyond(voxel, 2 * axis + 1 - ahead);
    if (last != Outside)
    {
      // From the preceding voxel, in units of whose thickness k is measured.
      const double before = this->Thickness(last, axis), there = this->Fluence(last);
      const double ratio = before > 0.0 ? thickness / before : 0.0;
      const double passes = there > 0.0 ? this->Fluence(voxel) / there : 1.0; // no light came from there
      return before > 0.0 ? NearerBy(std::min(ratio * FallOff(passes, ratio, before / std::abs(along)), most))
                          : NearerBy(most);
    }
    return NearerBy(most);
  }

  double Thickness(std::size_t voxel, std::size_t axis) const
  {
    return ThicknessOf(this->TheMedium, voxel, axis, this->Channel);
  }

  const UncollidedImage& Image;
  const Medium& TheMedium;
  const LatticeBox& Box;
  int Channel;
};
}

double NearerOfNormalBeam(const Medium& medium, std::size_t voxel, int channel)
{
  return NearerBy(ThicknessOf(medium, voxel, 0, channel));
}

std::vector<float> EstimatedFirstMoments(const UncollidedImage& image, const Medium& medium, const LatticeBox& box)
{
  if (!image.meanDirection.values)
  {
    return {};
  }
  const auto channels = static_cast<std::size_t>(image.fluence.components);
  std::vector<float> moments(6 * channels * medium.grid.VoxelCount(), 0.0f);
  for (std::size_t c = 0; c < channels; ++c)
  {
    const LostLight light(image, medium, box, static_cast<int>(c));
    for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
    {
      const double fluence = light.Fluence(i);
      for (std::size_t axis = 0; axis < 3 && fluence > 0.0; ++axis)
      {
        const bool forwards = image.meanDirection.At(i, static_cast<int>(axis)) > 0.0f;
        const std::size_t face = 2 * axis + (forwards ? 0 : 1);
        moments[6 * (i * channels + c) + face] = static_cast<float>(fluence * light.Nearer(i, axis));
      }
    }
  }
  return moments;
}
}
