#include "LightPropagation/Conservative/ErrorEstimate.h"

#include "Medium/Coarsening.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace tyndall
{
namespace
{
constexpr double OrderInDirections = 0.9; ///< error as number of directions to the power of minus this
constexpr double FinePart = 0.8;          ///< of the whole time, for the monitor

/// A medium on the coarse grid, with its arrays.
class CoarseMedium
{
public:
  CoarseMedium(const Medium& medium, const Coarsening& coarsening)
    : TheMedium(medium)
  {
    this->TheMedium.grid = coarsening.Coarse();
    if (const Field g = this->TheMedium.phase.G(); g.values)
    {
      this->G = coarsening.Average(g, this->TheMedium.sigma_s);
      const auto components = static_cast<int>(this->G.size() / coarsening.Coarse().VoxelCount());
      this->TheMedium.phase = this->TheMedium.phase.WithG({ this->G.data(), components });
    }
    int next = 0;
    for (Field* field : { &this->TheMedium.sigma_a, &this->TheMedium.sigma_s, &this->TheMedium.emission })
    {
      if (field->values)
      {
        this->Arrays[next] = coarsening.Average(field->values, field->components);
        field->values = this->Arrays[next].data();
        ++next;
      }
    }
  }
  CoarseMedium(const CoarseMedium&) = delete;
  CoarseMedium& operator=(const CoarseMedium&) = delete;

  const Medium& Get() const { return this->TheMedium; }

private:
  Medium TheMedium;
  std::array<std::vector<float>, 3> Arrays;
  std::vector<float> G;
};

/// sigma_t of a voxel and channel, [voxel][channel].
std::vector<float> Extinctions(const Medium& medium, int channels)
{
  std::vector<float> values;
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      values.push_back(medium.sigma_a.At(i, c) + medium.sigma_s.At(i, c));
    }
  }
  return values;
}

/// What shines, on the coarse grid: of light by voxel the power that the medium takes is kept.
class CoarseIllumination
{
public:
  CoarseIllumination(const Illumination& illumination, const Medium& medium, const Coarsening& coarsening)
    : Shining(illumination)
  {
    UncollidedImage& image = this->Shining.uncollided;
    if (!image.IsThere())
    {
      return;
    }
    const Field fluence = image.fluence, mean = image.meanDirection;
    if (mean.values)
    {
      this->AverageDirections(mean, fluence, coarsening);
      image.meanDirection = { this->Directions.data(), 3 };
    }
    const int channels = fluence.HasColour() || medium.Channels() == 3 ? 3 : 1;
    this->AverageFluence(fluence, Extinctions(medium, channels), channels, coarsening);
    image.fluence = { this->Fluence.data(), channels };
  }
  CoarseIllumination(const CoarseIllumination&) = delete;
  CoarseIllumination& operator=(const CoarseIllumination&) = delete;

  const Illumination& Get() const { return this->Shining; }

private:
  void AverageFluence(
    const Field& fluence, const std::vector<float>& extinctions, int channels, const Coarsening& coarsening)
  {
    std::vector<float> lost(extinctions.size()), all(extinctions.size());
    for (std::size_t i = 0; i < lost.size(); ++i)
    {
      all[i] = fluence.At(i / channels, static_cast<int>(i % channels));
      lost[i] = extinctions[i] * all[i];
    }
    this->Fluence = coarsening.Average(all.data(), channels);
    const std::vector<float> meanLost = coarsening.Average(lost.data(), channels);
    const std::vector<float> meanExtinction = coarsening.Average(extinctions.data(), channels);
    for (std::size_t i = 0; i < this->Fluence.size(); ++i)
    {
      this->Fluence[i] = meanExtinction[i] > 0.0f ? meanLost[i] / meanExtinction[i] : this->Fluence[i];
    }
  }

  void AverageDirections(const Field& mean, const Field& fluence, const Coarsening& coarsening)
  {
    const std::size_t voxels = coarsening.Fine().VoxelCount();
    std::vector<float> flux(3 * voxels), light(voxels);
    for (std::size_t i = 0; i < voxels; ++i)
    {
      light[i] = (fluence.At(i, 0) + fluence.At(i, 1) + fluence.At(i, 2)) / 3.0f;
      for (int a = 0; a < 3; ++a)
      {
        flux[3 * i + a] = light[i] * mean.At(i, a);
      }
    }
    this->Directions = coarsening.Average(flux.data(), 3);
    const std::vector<float> of = coarsening.Average(light.data(), 1);
    for (std::size_t i = 0; i < this->Directions.size(); ++i)
    {
      this->Directions[i] = of[i / 3] > 0.0f ? this->Directions[i] / of[i / 3] : 0.0f;
    }
  }

  Illumination Shining;
  std::vector<float> Fluence, Directions;
};

/// Another number of directions a face: fewer, but for a single one; rows are even in number where `directionsPerFace`
/// has such.
int OtherDirections(int directionsPerFace)
{
  const int edge = static_cast<int>(std::lround(std::sqrt(static_cast<double>(directionsPerFace))));
  const int step = edge % 2 == 0 && edge > 2 ? 2 : 1;
  const int other = edge == 1 ? 2 : step * std::max(1, static_cast<int>(std::lround(0.6 * edge / step)));
  return other * other;
}

/// The error of `directions` over the difference to the light of `others`.
double PartOfDifference(int directions, int others)
{
  const double ratio = std::pow(static_cast<double>(others) / directions, OrderInDirections);
  return ratio < 1.0 ? ratio / (1.0 - ratio) : ratio / (ratio - 1.0);
}

/// Means of three neighbours along one axis of [outer][count][inner] values, two at its ends.
void SmoothAlong(std::vector<double>& values, std::size_t count, std::size_t inner)
{
  const std::vector<double> rough = values;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const std::size_t place = i / inner % count;
    double sum = rough[i];
    int terms = 1;
    if (place > 0)
    {
      sum += rough[i - inner];
      ++terms;
    }
    if (place + 1 < count)
    {
      sum += rough[i + inner];
      ++terms;
    }
    values[i] = sum / terms;
  }
}

void Smooth(std::vector<double>& values, const Grid& grid, int channels)
{
  auto inner = static_cast<std::size_t>(channels);
  for (int size : grid.size)
  {
    SmoothAlong(values, static_cast<std::size_t>(size), inner);
    inner *= static_cast<std::size_t>(size);
  }
}

/// Whether the solve was stopped after its first order, which does not tell how much light is still to come.
bool IsStoppedTooSoonToTell(const LightField& light)
{
  return light.convergence.size() == 1 && light.convergence.front().residual > 0.0;
}

/// Fills in fluenceError and relativeError.
/// @param variance  of the coarse voxels' fluence
void WriteError(LightField& light, const std::vector<double>& variance, const Coarsening& coarsening)
{
  const double residual = light.convergence.empty() ? 0.0 : light.convergence.back().residual;
  const auto channels = static_cast<std::size_t>(light.channels);
  light.fluenceError.resize(light.fluence.size());
  double errors = 0.0, fluences = 0.0;
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    const double fluence = light.fluence[i];
    const std::size_t parent = coarsening.Parent(i / channels) * channels + i % channels;
    const double square = variance[parent] + residual * residual * fluence * fluence;
    light.fluenceError[i] = static_cast<float>(std::sqrt(square));
    errors += square;
    fluences += fluence * fluence;
  }
  light.relativeError = fluences > 0.0 ? std::sqrt(errors / fluences) : 0.0;
}
}

namespace
{
/// Of a plane-parallel solve: what fewer cosines change. It has no other error.
void WriteErrorOfCosines(LightField& light, const LightField& few)
{
  double errors = 0.0, fluences = 0.0;
  light.fluenceError.resize(light.fluence.size());
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    light.fluenceError[i] = std::abs(light.fluence[i] - few.fluence[i]);
    errors += static_cast<double>(light.fluenceError[i]) * light.fluenceError[i];
    fluences += static_cast<double>(light.fluence[i]) * light.fluence[i];
  }
  light.relativeError = fluences > 0.0 ? std::sqrt(errors / fluences) : 0.0;
}
}

LightField SolveWithErrorEstimate(const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor, const PropagationSolver& solve)
{
  LightField light = solve(medium, illumination, settings, OfPart(monitor, 0.0, FinePart));
  if (light.polarNodes > 0)
  {
    PropagationSettings fewer = settings;
    fewer.polarNodes = 3 * light.polarNodes / 4;
    WriteErrorOfCosines(light, solve(medium, illumination, fewer, OfPart(monitor, FinePart, 1.0)));
    return light;
  }
  if (IsStoppedTooSoonToTell(light))
  {
    light.relativeError = std::numeric_limits<double>::quiet_NaN();
    return light;
  }

  const Coarsening coarsening(medium.grid);
  const CoarseMedium coarse(medium, coarsening);
  const CoarseIllumination shining(illumination, medium, coarsening);
  PropagationSettings plain = settings;
  plain.netFlux = false;
  plain.storedDirections = 1;
  const int directions = light.directionsPerFace > 0 ? light.directionsPerFace : settings.directionsPerFace;
  plain.directionsPerFace = directions;
  plain.adaptDirections = false;
  const std::vector<float> many = solve(coarse.Get(), shining.Get(), plain, OfPart(monitor, FinePart, 0.95)).fluence;
  plain.directionsPerFace = OtherDirections(directions);
  if (settings.uncollidedDirections > 0)
  {
    plain.uncollidedDirections = OtherDirections(settings.uncollidedDirections);
  }
  const std::vector<float> few = solve(coarse.Get(), shining.Get(), plain, OfPart(monitor, 0.95, 1.0)).fluence;

  const double ratio = coarsening.Ratio();
  const double inSpace = ratio > 1.0 ? 1.0 / (ratio * ratio - 1.0) : 0.0;
  const double inDirections = PartOfDifference(directions, plain.directionsPerFace);
  const std::vector<float> fine = coarsening.Average(light.fluence.data(), light.channels);
  std::vector<double> variance(fine.size());
  for (std::size_t i = 0; i < fine.size(); ++i)
  {
    const double space = inSpace * (static_cast<double>(fine[i]) - many[i]);
    const double directions = inDirections * (static_cast<double>(many[i]) - few[i]);
    variance[i] = space * space + directions * directions;
  }
  Smooth(variance, coarsening.Coarse(), light.channels);
  WriteError(light, variance, coarsening);
  return light;
}
}
