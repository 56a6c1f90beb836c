#include "LightPropagation/Uncollided/GivenLight.h"

#include "LightPropagation/Uncollided/NarrowLight.h"
#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Adds `values` to the first elements of the array `to`.
void AddFirst(Device& device, const std::vector<float>& values, const Buffer<float>& to)
{
  std::vector<float> sum(values.size());
  to.Read(sum.data(), sum.size());
  std::transform(sum.begin(), sum.end(), values.begin(), sum.begin(), [](float a, float b) { return a + b; });
  device.Queue().enqueueWriteBuffer(to.Handle(), CL_TRUE, 0, sum.size() * sizeof(float), sum.data());
}

/// Scalar in each voxel times the mean direction there, [channel][x, y, z][voxel].
std::vector<float> Along(const VolumeLayout& layout, const std::vector<float>& scalar, const Field& direction)
{
  std::vector<float> flux(layout.Floats(3), 0.0f);
  for (int c = 0; c < layout.channels && direction.values; ++c)
  {
    for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
    {
      for (int a = 0; a < 3; ++a)
      {
        flux[(3 * c + a) * layout.Stride() + i] = scalar[c * layout.Stride() + i] * direction.At(i, a);
      }
    }
  }
  return flux;
}

double LeastOfPeak(int degree, double fall)
{
  double least = 1.0;
  for (int i = 0; i <= 400; ++i)
  {
    const std::vector<double> p = LegendrePolynomials(degree, std::cos(Pi * i / 400.0));
    double sum = 0.0;
    for (int l = 0; l <= degree; ++l)
    {
      sum += (2.0 * l + 1.0) * std::exp(-fall * l * (l + 1.0)) * p[l];
    }
    least = std::min(least, sum);
  }
  return least;
}
}

SweepTally TallyOf(const UncollidedImage& image, const Medium& medium, int first, int channels)
{
  SweepTally tally;
  for (int c = 0; c < channels; ++c)
  {
    tally.in[0][c] = PowerLost(image, medium, first + c);
    for (int face = 0; face < 6; ++face)
    {
      tally.out[face][c] = image.escaped[face][first + c];
      tally.in[0][c] += image.escaped[face][first + c];
    }
  }
  return tally;
}

double SmoothPeak(int degree)
{
  double low = 0.0, high = 2.0;
  for (int i = 0; i < 40; ++i)
  {
    const double fall = 0.5 * (low + high);
    (LeastOfPeak(degree, fall) < 0.0 ? low : high) = fall;
  }
  return std::exp(-2.0 * high);
}

GivenLight::GivenLight(const UncollidedImage& image, const Medium& medium, const TruncatedScattering& scattering)
  : Image(image)
  , TheMedium(medium)
  , Scattering(scattering)
{
}

SweepTally GivenLight::AddTo(const UncollidedVolume& volume, const Monitor&) const
{
  const VolumeLayout& layout = volume.layout;
  if (layout.grid.VoxelCount() == 0)
  {
    return {};
  }
  const double size = layout.grid.VoxelVolume();
  const std::vector<float> path = Planar(layout, layout.channels,
    [&](std::size_t i, int c) { return static_cast<float>(size * this->Image.fluence.At(i, c)); });
  const std::vector<float> flux = Along(layout, path, this->Image.meanDirection);
  if (volume.basis)
  {
    AddNarrowMoments(volume.device, layout, *volume.basis, Buffer<float>(volume.device, path, "the light given"),
      Buffer<float>(volume.device, flux, "the light given"), *volume.deposit.path);
  }
  else
  {
    AddFirst(volume.device, path, *volume.deposit.path);
  }
  if (!volume.basis && volume.deposit.flux)
  {
    AddFirst(volume.device, flux, *volume.deposit.flux);
  }
  return TallyOf(this->Image, this->TheMedium, 0, layout.channels);
}

bool GivenLight::AddStraightOn(
  Device& device, const VolumeLayout& layout, const AngularBasis* basis, const Buffer<float>& source) const
{
  const std::vector<float> power = Planar(layout, layout.channels, [&](std::size_t i, int c) {
    const double straight = static_cast<double>(this->TheMedium.sigma_s.At(i, c)) - this->Scattering.SigmaS(i, c);
    return static_cast<float>(straight / (4.0 * Pi) * this->Image.fluence.At(i, c));
  });
  if (std::all_of(power.begin(), power.end(), [](float value) { return value == 0.0f; }))
  {
    return false;
  }
  if (!basis)
  {
    AddFirst(device, power, source);
    return true;
  }
  AddNarrowMoments(device, layout, *basis, Buffer<float>(device, power, "the light given"),
    Buffer<float>(device, Along(layout, power, this->Image.meanDirection), "the light given"), source,
    static_cast<float>(SmoothPeak(basis->Degree())));
  return true;
}
}
