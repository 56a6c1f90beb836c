#include "LightPropagation/Uncollided/GivenLight.h"

#include "Distribution/Halo.h"
#include "LightPropagation/Uncollided/NarrowLight.h"
#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

/// Estimate of the uncollided fluence at the faces of a block's voxels, from the means over voxels.
class LightAtFaces
{
public:
  /// @param around  halo of one voxel around the block
  /// @param known  fluence and extinction of the voxels of the block with its halo, [voxel][channel][2]
  LightAtFaces(const Halo& around, std::vector<float>&& known, int channels)
    : Around(around)
    , Grown(around.KnownGrid())
    , Known(std::move(known))
    , Channels(channels)
  {
  }

  /// Fluence that comes to the six faces of voxel i of the block from beyond them: that of the neighbour, attenuated
  /// over its edge `h`; at the box's faces, that which falls to the voxel's mean. All 1 where nothing comes.
  std::array<double, 6> Of(std::size_t i, int channel, const std::array<double, 3>& h) const
  {
    const std::array<int, 3> at = this->Around.Known().Within(this->Around.Own().VoxelAt(i));
    const std::array<std::size_t, 3> step = this->Grown.Strides();
    const std::size_t here = this->Grown.IndexOf(at);
    std::array<double, 6> light;
    for (std::size_t d = 0; d < 6; ++d)
    {
      const std::size_t a = d / 2;
      const bool outside = d % 2 == 0 ? at[a] == 0 : at[a] + 1 == this->Grown.size[a];
      const std::size_t from = outside ? here : d % 2 == 0 ? here - step[a] : here + step[a];
      const float* const values = &this->Known[2 * (from * static_cast<std::size_t>(this->Channels) + channel)];
      const double x = 2.0 * h[a] * values[1];
      light[d] = values[0] * (x < 1e-3 ? 1.0 : outside ? x / -std::expm1(-x) : x / std::expm1(x));
    }
    if (*std::max_element(light.begin(), light.end()) == 0.0)
    {
      light.fill(1.0);
    }
    return light;
  }

private:
  const Halo& Around;
  Grid Grown; ///< the block with its halo
  std::vector<float> Known;
  int Channels;
};

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
  const double size = layout.grid.VoxelVolume();
  std::vector<float> path;
  volume.domain.Collective([&] {
    path = Planar(layout, layout.channels,
      [&](std::size_t i, int c) { return static_cast<float>(size * this->Image.fluence.At(i, c)); });
  });
  const std::vector<float> moments =
    volume.deposit.firstMoments ? this->FirstMoments(volume, path) : std::vector<float>();
  if (layout.grid.VoxelCount() == 0)
  {
    return {};
  }
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
    AddFirst(volume.device, moments, *volume.deposit.firstMoments);
  }
  if (!volume.basis && volume.deposit.flux)
  {
    AddFirst(volume.device, flux, *volume.deposit.flux);
  }
  return TallyOf(this->Image, this->TheMedium, 0, layout.channels);
}

std::vector<float> GivenLight::FirstMoments(const UncollidedVolume& volume, const std::vector<float>& path) const
{
  const VolumeLayout& layout = volume.layout;
  const int channels = layout.channels;
  std::vector<float> own;
  volume.domain.Collective([&] {
    own.reserve(2 * channels * layout.grid.VoxelCount());
    for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
    {
      for (int c = 0; c < channels; ++c)
      {
        own.push_back(this->Image.fluence.At(i, c));
        own.push_back(static_cast<float>(this->Scattering.SigmaT(i, c)));
      }
    }
  });
  const Halo around(volume.domain.Comm(), volume.domain.Partition(), volume.periodic, 1);
  const LightAtFaces light(around, around.Spread(own, 2 * channels), channels);
  const std::array<double, 3>& h = layout.grid.spacing;
  std::vector<float> moments(layout.Floats(6), 0.0f);
  for (std::size_t at = 0; at < channels * layout.grid.VoxelCount(); ++at)
  {
    const std::size_t i = at % layout.grid.VoxelCount(), c = at / layout.grid.VoxelCount();
    const Field& mean = this->Image.meanDirection;
    const std::array<double, 3> way = { mean.At(i, 0), mean.At(i, 1), mean.At(i, 2) };
    const double narrow = std::min(std::hypot(way[0], way[1], way[2]), 1.0);
    const std::array<double, 6> enters = light.Of(i, static_cast<int>(c), h);
    double evenly = 0.0, ahead = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
    {
      evenly += (enters[2 * a] + enters[2 * a + 1]) / h[a];
      ahead += enters[2 * a + (way[a] > 0.0 ? 0 : 1)] * std::abs(way[a]) / h[a];
    }
    const double half = 0.5 * path[c * layout.Stride() + i];
    for (std::size_t d = 0; d < 6; ++d)
    {
      const double edge = h[d / 2], along = d % 2 == 0 ? way[d / 2] : -way[d / 2];
      const double tau = this->Scattering.SigmaT(i, static_cast<int>(c)) * edge;
      const double even = evenly > 0.0 ? (1.0 - narrow) * enters[d] / (edge * evenly) * NearnessToFace(2.0 * tau) : 0.0;
      const double beam = along > 0.0 && ahead > 0.0
        ? narrow * enters[d] * along / (edge * ahead) * NearnessToFace(tau * narrow / along)
        : 0.0;
      moments[(6 * c + d) * layout.Stride() + i] = static_cast<float>(half * (even + beam));
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
