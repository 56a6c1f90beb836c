#include "LightPropagation/Accuracy/ErrorEstimate.h"

#include "LightPropagation/Problem/CoarseScene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
constexpr double OrderInDirections = 0.9; ///< error as number of directions to the power of minus this
constexpr double OrderInSpace = 2.0;
constexpr double FinePart = 0.8; ///< of the whole time, for the monitor

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

/// What a variance of coarse voxels' fluence is in each voxel of theirs: the brighter are off by more, as beside lamps.
std::vector<double> InVoxels(const LightField& light, const std::vector<float>& averages,
  const std::vector<double>& variance, const Coarsening& coarsening)
{
  const auto channels = static_cast<std::size_t>(light.channels);
  std::vector<double> squares(light.fluence.size());
  for (std::size_t i = 0; i < squares.size(); ++i)
  {
    const std::size_t parent = coarsening.Parent(i / channels) * channels + i % channels;
    const double part = averages[parent] > 0.0f ? static_cast<double>(light.fluence[i]) / averages[parent] : 1.0;
    squares[i] = variance[parent] * part * part;
  }
  return squares;
}

double SumOfSquares(const std::vector<float>& values)
{
  return std::accumulate(
    values.begin(), values.end(), 0.0, [](double sum, double value) { return sum + value * value; });
}

/// Fills in fluenceError and relativeError: errors of voxels smoothly, all together as large as they were, and not
/// smaller, relative to all light, than in the averages, which beside lamps do not see how it falls off within voxels.
/// @param averages, variance  of the coarse voxels' fluence
void WriteError(
  LightField& light, const std::vector<float>& averages, std::vector<double> variance, const Coarsening& coarsening)
{
  const auto sum = [](const std::vector<double>& all) { return std::accumulate(all.begin(), all.end(), 0.0); };
  const double fluences = SumOfSquares(light.fluence), ofAverages = SumOfSquares(averages);
  const double asAverages = ofAverages > 0.0 ? fluences * sum(variance) / ofAverages : 0.0;
  const double all = std::max(asAverages, sum(InVoxels(light, averages, variance, coarsening)));
  Smooth(variance, coarsening.Coarse(), light.channels);
  const std::vector<double> squares = InVoxels(light, averages, variance, coarsening);
  const double smoothed = sum(squares), scale = smoothed > 0.0 ? all / smoothed : 1.0;
  const double residual = light.convergence.empty() ? 0.0 : light.convergence.back().residual;
  light.fluenceError.resize(light.fluence.size());
  double errors = 0.0;
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    const double fluence = light.fluence[i];
    const double square = scale * squares[i] + residual * residual * fluence * fluence;
    light.fluenceError[i] = static_cast<float>(std::sqrt(square));
    errors += square;
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

ErrorParts WriteErrorEstimate(LightField& light, const Coarsening& coarsening, const std::vector<float>& same,
  const std::vector<float>& other, double partOfDifference, double orderInSpace)
{
  const double ratio = coarsening.Ratio();
  const double inSpace = ratio > 1.0 ? 1.0 / (std::pow(ratio, orderInSpace) - 1.0) : 0.0;
  const std::vector<float> fine = coarsening.Average(light.fluence.data(), light.channels);
  std::vector<double> variance(fine.size());
  double ofSpace = 0.0, ofDirections = 0.0, all = 0.0;
  for (std::size_t i = 0; i < fine.size(); ++i)
  {
    const double space = inSpace * (static_cast<double>(fine[i]) - same[i]);
    const double directions = partOfDifference * (static_cast<double>(same[i]) - other[i]);
    variance[i] = space * space + directions * directions;
    ofSpace += space * space;
    ofDirections += directions * directions;
    all += static_cast<double>(fine[i]) * fine[i];
  }
  WriteError(light, fine, std::move(variance), coarsening);
  const double scale = all > 0.0 ? 1.0 / all : 0.0;
  return { std::sqrt(scale * ofSpace), std::sqrt(scale * ofDirections),
    light.convergence.empty() ? 0.0 : light.convergence.back().residual };
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
  const CoarseScene coarse(medium, illumination, coarsening);
  PropagationSettings plain = settings;
  plain.netFlux = false;
  plain.storedDirections = 1;
  const int directions = light.directionsPerFace > 0 ? light.directionsPerFace : settings.directionsPerFace;
  plain.directionsPerFace = directions;
  plain.adaptDirections = false;
  plain.uncollidedDirections = light.uncollidedDirections; // as they were chosen for the grid itself
  const std::vector<float> many =
    solve(coarse.TheMedium(), coarse.Shining(), plain, OfPart(monitor, FinePart, 0.95)).fluence;
  plain.directionsPerFace = OtherDirections(directions);
  if (light.uncollidedDirections > 0)
  {
    plain.uncollidedDirections = OtherDirections(light.uncollidedDirections);
  }
  const std::vector<float> few = solve(coarse.TheMedium(), coarse.Shining(), plain, OfPart(monitor, 0.95, 1.0)).fluence;

  WriteErrorEstimate(light, coarsening, many, few, PartOfDifference(directions, plain.directionsPerFace), OrderInSpace);
  return light;
}
}
