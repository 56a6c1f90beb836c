#include "LightPropagation/Uncollided/EnvironmentPeaks.h"

#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
/// Peaks are sought in the brightest pixels of each cell (the pixels nearest to one quadrature direction). These pixels
/// cover this fraction of the cell's solid angle
constexpr double BrightPart = 0.05;
/// A peak's radiance exceeds this multiple of the mean radiance in the rest of its cell (the pixels nearest to one
/// quadrature direction)
constexpr double Outshines = 4.0;
constexpr double LeastPower = 1.0 / 500.0;
constexpr std::size_t MostPeaks = 64;

/// A pixel of the environment, to be sorted by brightness among the pixels nearest to the same quadrature direction.
struct Pixel
{
  std::size_t index;
  double brightness; ///< mean of the channels, W / (length^2 sr)
  double solidAngle;
};

struct Peak
{
  /// For each pixel of the peak: index of the pixel, and the fraction of its radiance that stays in the environment.
  std::vector<std::pair<std::size_t, double>> kept;
  std::array<double, 3> towards = {}; ///< sum of the directions towards the pixels, weighted by power
  Rgb irradiance = {};
  double brightness = 0.0;
};

std::array<double, 3> DirectionOf(const Environment& environment, std::size_t pixel)
{
  const std::size_t column = pixel % environment.width;
  const std::size_t row = pixel / environment.width;
  const double azimuth = 2.0 * Pi * (column + 0.5) / environment.width;
  const double polar = Pi * (1.0 - (row + 0.5) / environment.height);
  return environment.ToScene(
    { std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar) });
}

double SolidAngle(const Environment& environment, std::size_t pixel)
{
  const std::size_t row = pixel / environment.width;
  const double top = Pi * row / environment.height;
  const double bottom = Pi * (row + 1) / environment.height;
  return (std::cos(top) - std::cos(bottom)) * 2.0 * Pi / environment.width;
}

/// Finds the peak of the environment in a cell (the pixels nearest to one quadrature direction). In the cell's
/// brightest pixels, which cover the fraction BrightPart of its solid angle, the peak is the radiance above Outshines
/// times the mean radiance of the other pixels.
Peak FindPeak(const Environment& environment, std::vector<Pixel>& cell)
{
  std::sort(cell.begin(), cell.end(), [](const Pixel& a, const Pixel& b) {
    return a.brightness != b.brightness ? a.brightness > b.brightness : a.index < b.index;
  });
  double all = 0.0;
  for (const Pixel& pixel : cell)
  {
    all += pixel.solidAngle;
  }
  std::size_t bright = 0;
  double solidAngle = 0.0;
  while (bright + 1 < cell.size() && solidAngle + cell[bright].solidAngle <= BrightPart * all)
  {
    solidAngle += cell[bright++].solidAngle;
  }
  double rest = 0.0;
  for (std::size_t i = bright; i < cell.size(); ++i)
  {
    rest += cell[i].brightness * cell[i].solidAngle;
  }
  const double limit = Outshines * rest / std::max(all - solidAngle, 1e-30);
  Peak peak;
  for (std::size_t i = 0; i < bright && cell[i].brightness > limit; ++i)
  {
    const double kept = limit / cell[i].brightness;
    const std::array<double, 3> direction = DirectionOf(environment, cell[i].index);
    const double taken = (1.0 - kept) * cell[i].solidAngle;
    peak.kept.emplace_back(cell[i].index, kept);
    peak.brightness += taken * cell[i].brightness;
    for (int c = 0; c < 3; ++c)
    {
      peak.irradiance[c] += taken * environment.radiance[3 * cell[i].index + c];
      peak.towards[c] += taken * cell[i].brightness * direction[c];
    }
  }
  return peak;
}
}

SplitEnvironment Split(const Environment& environment, const DirectionSet& set)
{
  SplitEnvironment split;
  split.smooth = environment;
  if (environment.Empty())
  {
    return split;
  }
  std::vector<std::vector<Pixel>> cells(set.directions.size());
  double all = 0.0;
  for (std::size_t i = 0; i < environment.radiance.size() / 3; ++i)
  {
    const float* rgb = environment.radiance.data() + 3 * i;
    const Pixel pixel = { i, (static_cast<double>(rgb[0]) + rgb[1] + rgb[2]) / 3.0, SolidAngle(environment, i) };
    all += pixel.brightness * pixel.solidAngle;
    cells[Nearest(set, DirectionOf(environment, i))].push_back(pixel);
  }
  std::vector<Peak> peaks;
  for (std::vector<Pixel>& cell : cells)
  {
    Peak peak = FindPeak(environment, cell);
    if (peak.brightness >= LeastPower * all && peak.brightness > 0.0)
    {
      peaks.push_back(std::move(peak));
    }
  }
  std::stable_sort(
    peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) { return a.brightness > b.brightness; });
  peaks.resize(std::min(peaks.size(), MostPeaks));
  for (const Peak& peak : peaks)
  {
    for (const auto& [pixel, kept] : peak.kept)
    {
      for (int c = 0; c < 3; ++c)
      {
        split.smooth.radiance[3 * pixel + c] = static_cast<float>(environment.radiance[3 * pixel + c] * kept);
      }
    }
    Light light;
    light.direction = { -peak.towards[0], -peak.towards[1], -peak.towards[2] };
    light.power = peak.irradiance;
    split.peaks.push_back(light);
  }
  return split;
}
}
