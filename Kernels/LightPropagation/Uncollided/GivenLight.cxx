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

/// Scalar times the mean direction of light in each voxel, [channel][x, y, z][voxel].
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

/// Mean position of the first collisions in a voxel of optical thickness tau, for light that enters through one face
/// and decays exponentially: 1 at that face, 0 in the middle of the voxel.
double NearnessToFace(double tau)
{
  return tau < 0.05 ? tau / 6.0 : 1.0 - 2.0 * (1.0 / tau - 1.0 / std::expm1(tau));
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
  if (volume.deposit.firstMoments)
  {
    AddFirst(volume.device, this->FirstMoments(layout, path), *volume.deposit.firstMoments);
  }
  if (!volume.basis && volume.deposit.flux)
  {
    AddFirst(volume.device, flux, *volume.deposit.flux);
  }
  return TallyOf(this->Image, this->TheMedium, 0, layout.channels);
}

std::vector<float> GivenLight::FirstMoments(const VolumeLayout& layout, const std::vector<float>& path) const
{
  const std::array<double, 3>& h = layout.grid.spacing;
  const double faces = 1.0 / h[0] + 1.0 / h[1] + 1.0 / h[2];
  std::vector<float> moments(layout.Floats(6), 0.0f);
  for (std::size_t at = 0; at < layout.channels * layout.grid.VoxelCount(); ++at)
  {
    const std::size_t i = at % layout.grid.VoxelCount(), c = at / layout.grid.VoxelCount();
    const Field& mean = this->Image.meanDirection;
    const std::array<double, 3> way = { mean.At(i, 0), mean.At(i, 1), mean.At(i, 2) };
    const double narrow = std::min(std::hypot(way[0], way[1], way[2]), 1.0);
    const double ahead = std::abs(way[0]) / h[0] + std::abs(way[1]) / h[1] + std::abs(way[2]) / h[2];
    const double half = 0.5 * path[c * layout.Stride() + i];
    for (std::size_t a = 0; a < 3; ++a)
    {
      const double tau = this->Scattering.SigmaT(i, static_cast<int>(c)) * h[a], along = std::abs(way[a]);
      const double even = half * (1.0 - narrow) / (2.0 * h[a] * faces) * NearnessToFace(2.0 * tau);
      const double beam =
        along > 0.0 ? half * narrow * along / (h[a] * ahead) * NearnessToFace(tau * narrow / along) : 0.0;
      float* const low = &moments[(6 * c + 2 * a) * layout.Stride() + i];
      low[0] = static_cast<float>(even + (way[a] > 0.0 ? beam : 0.0));
      low[layout.Stride()] = static_cast<float>(even + (way[a] < 0.0 ? beam : 0.0));
    }
  }
  return moments;
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
