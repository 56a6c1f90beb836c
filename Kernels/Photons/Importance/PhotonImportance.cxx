#include "Photons/Importance/PhotonImportance.h"

#include "Device/Errors.h"
#include "Light/LeftOut.h"
#include "Numerics/NumberText.h"
#include "Photons/Emission/PhotonEmitter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tyndall
{
namespace
{
// Constants of the automatic thresholds, which are proportional to the light of the pilot photons (numerics.md, Eq.
// (96)).
constexpr double SteepPart = 0.2; ///< fraction of the lit cells whose gradient of luminance counts as steep
/// Smallest difference of luminance between neighbouring cells that counts as steep, relative to the median luminance.
/// Smaller differences are statistical noise, or extinction in fog.
constexpr double SteepAtLeast = 0.25;
constexpr double DimBelow = 0.5; ///< luminance, relative to the median, below which a lit cell counts as dark
/// An importance map is used only if at least this fraction of the lit cells is chosen for dense sampling
constexpr double FewCells = 0.01;
/// A light needs no map if a product is below this value. Its factors are the standard deviation of the map of the
/// chosen cells (mean 1), and the fourth root of the fraction of lit cells that are chosen. Measured products: 0.2 to
/// 0.46 for thin or thick fog under a sun from any direction, or a lamp above or in it; 0.53 to 1 for glass in fog.
constexpr double EvenMap = 0.5;

constexpr int LargestEdge = 1024; ///< maximum number of map cells along an edge
constexpr int FilterReach = 2;    ///< half width of the Gaussian filter, in cells: 5x5
constexpr double FilterVariance = 2.0;

void Check(const ImportanceSettings& settings)
{
  Require(settings.pilotCount > 0,
    "The number of pilot photons is 0; ask for at least one, some tenth of the photons to follow.");
  for (int a = 0; a < 3; ++a)
  {
    Require(settings.cells[a] >= 1,
      "The pilot grid has " + std::to_string(settings.cells[a]) + " cells along axis " + std::to_string(a) +
        "; it must have at least 1.");
  }
  Require(settings.background > 0.0 && settings.background <= 1.0,
    "The background is " + Text("%g", settings.background) +
      " of the photons; it must be above 0, so that every place sends some, and at most 1.");
  Require(settings.automatic || (settings.gradientThreshold >= 0.0 && settings.luminanceThreshold >= 0.0),
    "The thresholds are " + Text("%g", settings.gradientThreshold) + " (gradient) and " +
      Text("%g", settings.luminanceThreshold) + " (luminance); they must not be negative.");
}

/// Luminance of each cell: mean fluence of the channels, W / length^2.
std::vector<double> LuminanceOf(const PilotLight& light)
{
  const std::size_t channels = static_cast<std::size_t>(light.channels);
  std::vector<double> luminance(light.count.size(), 0.0);
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    luminance[i / channels] += light.fluence[i] / static_cast<double>(channels);
  }
  return luminance;
}

/// Adds the pilot light of one lamp to that of earlier lamps. If several lamps reach a cell, the cell keeps the origins
/// (positions on the photon plane) of the first lamp's photons.
void Add(const PilotLight& more, PilotLight& light)
{
  if (light.count.empty())
  {
    light = more;
    return;
  }
  const int channels = std::max(light.channels, more.channels);
  const std::size_t cells = light.count.size();
  std::vector<float> sum(cells * static_cast<std::size_t>(channels));
  const auto channel = [](const PilotLight& of, std::size_t cell, int c) {
    return of.fluence[cell * static_cast<std::size_t>(of.channels) + (of.channels == 3 ? c : 0)];
  };
  for (std::size_t i = 0; i < cells; ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      sum[i * static_cast<std::size_t>(channels) + c] = channel(light, i, c) + channel(more, i, c);
    }
    for (std::size_t k = 2 * i; k < 2 * i + 2 && light.count[i] == 0.0f; ++k)
    {
      light.originMean[k] = more.originMean[k];
      light.originDeviation[k] = more.originDeviation[k];
    }
    light.count[i] += more.count[i];
  }
  light.fluence = std::move(sum);
  light.channels = channels;
  light.seconds += more.seconds;
}

/// Norm of the vector of luminance differences between neighbouring cells: central differences, one-sided at the
/// faces.
std::vector<float> GradientOf(const std::vector<double>& luminance, const Grid& grid)
{
  const std::array<std::size_t, 3> stride = grid.Strides();
  std::vector<float> gradient(luminance.size());
  for (std::size_t i = 0; i < luminance.size(); ++i)
  {
    const std::array<int, 3> cell = grid.VoxelAt(i);
    double squares = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      const std::size_t before = cell[a] > 0 ? i - stride[a] : i,
                        after = cell[a] < grid.size[a] - 1 ? i + stride[a] : i;
      const double steps = std::max<double>((after - before) / stride[a], 1.0);
      squares += std::pow((luminance[after] - luminance[before]) / steps, 2);
    }
    gradient[i] = static_cast<float>(std::sqrt(squares));
  }
  return gradient;
}

/// Quantile: the value below which the fraction `part` of the values lies.
double Quantile(std::vector<double> values, double part)
{
  if (values.empty())
  {
    return 0.0;
  }
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void ChooseThresholds(const std::vector<double>& luminance, Importance& importance)
{
  std::vector<double> lit, steepness, counts;
  for (std::size_t i = 0; i < luminance.size(); ++i)
  {
    if (importance.pilot.count[i] > 0.0f)
    {
      lit.push_back(luminance[i]);
      steepness.push_back(importance.gradient[i]);
      counts.push_back(importance.pilot.count[i]);
    }
  }
  const double median = Quantile(lit, 0.5);
  // Noise of the luminance of a cell. Photons cross a cell in rows, and each row's count fluctuates by about one. The
  // total N then fluctuates by sqrt(N), and the luminance by the fraction 1 / sqrt(N).
  const double chance = 1.0 / std::sqrt(std::max(Quantile(counts, 0.5), 1.0));
  importance.gradientThreshold =
    std::max(Quantile(steepness, 1.0 - SteepPart), std::max(SteepAtLeast, chance) * median);
  importance.luminanceThreshold = DimBelow * median;
}

/// Chooses the cells that are to be sampled densely, as in Listing B.1 of Pfeuti 2009. Returns the fraction of the lit
/// cells that are chosen.
double ChooseCells(const std::vector<double>& luminance, Importance& importance)
{
  std::size_t lit = 0, chosen = 0;
  importance.chosen.assign(luminance.size(), 0.0f);
  for (std::size_t i = 0; i < luminance.size(); ++i)
  {
    const bool there = importance.pilot.count[i] > 0.0f && luminance[i] > 0.0;
    const bool steep = importance.gradient[i] >= importance.gradientThreshold;
    const bool dim = luminance[i] <= importance.luminanceThreshold;
    lit += there ? 1 : 0;
    if (there && (steep || dim))
    {
      importance.chosen[i] = 1.0f;
      ++chosen;
    }
  }
  return lit > 0 ? static_cast<double>(chosen) / static_cast<double>(lit) : 0.0;
}

/// Adds 1 to the map cells whose centres lie in a circle, and always to the cell that contains the circle's centre.
void Splat(double x, double y, double diameter, int size, std::vector<double>& map)
{
  const double radius = 0.5 * diameter;
  const auto cell = [&](double at) { return std::min(std::max(static_cast<int>(std::floor(at)), 0), size - 1); };
  bool any = false;
  for (int j = cell(y - radius); j <= cell(y + radius); ++j)
  {
    for (int i = cell(x - radius); i <= cell(x + radius); ++i)
    {
      if (std::hypot(i + 0.5 - x, j + 0.5 - y) <= radius)
      {
        map[static_cast<std::size_t>(j) * size + i] += 1.0;
        any = true;
      }
    }
  }
  if (!any)
  {
    map[static_cast<std::size_t>(cell(y)) * size + cell(x)] += 1.0;
  }
}

/// Diameter, in map cells, of the circle drawn for a coarse cell. As published (Listing B.1), it is the sum of the
/// standard deviations of the origins of the cell's photons along the two axes of the photon plane. This leaves gaps
/// between the circles of neighbouring cells. If `asPublished` is false, it is twice the sum, and includes the spread
/// of origins within their map cells.
double DiameterOf(const float* deviation, bool asPublished)
{
  if (asPublished)
  {
    return std::max<double>(deviation[0] + deviation[1], 1.0);
  }
  const auto whole = [](double d) { return std::sqrt(d * d + 1.0 / 12.0); };
  return 2.0 * (whole(deviation[0]) + whole(deviation[1]));
}

/// Map of the photon plane of one light, scaled to mean 1, in which each chosen cell is drawn as a circle around the
/// mean origin of its photons. Empty if no chosen cell has photons of this light.
std::vector<double> CirclesOf(const std::vector<float>& chosen, const PilotLight& light, int size, bool asPublished)
{
  std::vector<double> map(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0.0);
  for (std::size_t i = 0; i < chosen.size(); ++i)
  {
    if (chosen[i] > 0.0f && light.count[i] > 0.0f)
    {
      const double diameter = DiameterOf(light.originDeviation.data() + 2 * i, asPublished);
      Splat(light.originMean[2 * i] + 0.5, light.originMean[2 * i + 1] + 0.5, diameter, size, map);
    }
  }
  const double sum = std::accumulate(map.begin(), map.end(), 0.0);
  if (sum == 0.0)
  {
    return {};
  }
  std::for_each(map.begin(), map.end(), [&](double& d) { d *= static_cast<double>(map.size()) / sum; });
  return map;
}

/// Applies a 5x5 Gaussian filter of variance 2; beyond the edges the map's border values are repeated.
std::vector<double> Smooth(const std::vector<double>& map, int size)
{
  double weights[2 * FilterReach + 1], sum = 0.0;
  for (int k = -FilterReach; k <= FilterReach; ++k)
  {
    sum += weights[k + FilterReach] = std::exp(-0.5 * k * k / FilterVariance);
  }
  const auto pass = [&](const std::vector<double>& from, std::size_t stride, std::size_t across) {
    std::vector<double> to(from.size(), 0.0);
    for (int line = 0; line < size; ++line)
    {
      for (int at = 0; at < size; ++at)
      {
        for (int k = -FilterReach; k <= FilterReach; ++k)
        {
          const int there = std::min(std::max(at + k, 0), size - 1);
          to[line * across + at * stride] += weights[k + FilterReach] / sum * from[line * across + there * stride];
        }
      }
    }
    return to;
  };
  const std::size_t row = static_cast<std::size_t>(size);
  return pass(pass(map, 1, row), row, 1);
}

/// Root mean square deviation from 1 of the map's means over blocks, eight along an edge. Smaller blocks would show
/// mainly the gaps between the circles of neighbouring cells.
double DeviationOf(const std::vector<double>& map, int size)
{
  const int blocks = std::min(size, 8);
  std::vector<double> sums(static_cast<std::size_t>(blocks) * blocks, 0.0), cells(sums.size(), 0.0);
  for (std::size_t i = 0; i < map.size(); ++i)
  {
    const std::size_t column = i % size * blocks / size, row = i / size * blocks / size;
    sums[row * blocks + column] += map[i];
    cells[row * blocks + column] += 1.0;
  }
  double squares = 0.0;
  for (std::size_t b = 0; b < sums.size(); ++b)
  {
    squares += std::pow(sums[b] / cells[b] - 1.0, 2);
  }
  return std::sqrt(squares / static_cast<double>(sums.size()));
}

/// The importance map of one light, mean 1; empty if a map gains nothing.
/// @param part  fraction of lit cells that are chosen
std::vector<double> MapOf(
  const Importance& importance, const PilotLight& light, double part, const ImportanceSettings& settings)
{
  std::vector<double> map = CirclesOf(importance.chosen, light, importance.map.size, !settings.automatic);
  if (map.empty())
  {
    return {};
  }
  map = Smooth(map, importance.map.size);
  if (settings.automatic && DeviationOf(map, importance.map.size) * std::sqrt(std::sqrt(part)) < EvenMap)
  {
    return {};
  }
  const double mean = std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
  std::for_each(
    map.begin(), map.end(), [&](double& d) { d = (1.0 - settings.background) * d / mean + settings.background; });
  return map;
}

void MakeMaps(const std::vector<PilotPhotons>& pilots, const std::vector<PilotLight>& lights, double part,
  const ImportanceSettings& settings, Importance& importance)
{
  const bool worthIt = !settings.automatic || part >= FewCells;
  const bool lit =
    std::any_of(importance.pilot.count.begin(), importance.pilot.count.end(), [](float n) { return n > 0.0f; });
  importance.even = true;
  for (std::size_t l = 0; l < pilots.size(); ++l)
  {
    std::vector<double> map = worthIt ? MapOf(importance, lights[l], part, settings) : std::vector<double>();
    importance.even = importance.even && map.empty();
    map.resize(importance.map.Cells(), 1.0); // an empty map stands for uniform density
    importance.map.lights.push_back(pilots[l].light);
    importance.map.density.insert(importance.map.density.end(), map.begin(), map.end());
  }
  if (importance.even)
  {
    importance.leftOut.push_back(!lit ? "importance: no pilot photon meets the medium"
        : settings.automatic
        ? "importance: light is even as far as the pilot photons tell, so photons are best spread evenly"
        : "importance: the thresholds given choose no cell, so photons are spread evenly");
  }
}
}

Importance FindImportance(PhotonMarcher& marcher, const Grid& grid, const Illumination& illumination,
  const ImportanceSettings& settings, const Monitor& monitor)
{
  Check(settings);
  Importance importance;
  importance.map.size =
    std::min(static_cast<int>(std::sqrt(static_cast<double>(settings.pilotCount) + 0.5)), LargestEdge);
  const std::vector<PilotPhotons> pilots = EmitPilots(grid, illumination, importance.map.size, settings.seed);
  Require(!pilots.empty(),
    "No light shines, so there is no importance to find. Connect Lights or an Environment, or set SkyColor.");
  std::vector<PilotLight> lights;
  for (const PilotPhotons& pilot : pilots)
  {
    lights.push_back(marcher.Gather(pilot.photons, pilot.origins, settings.cells, monitor));
    Add(lights.back(), importance.pilot);
    AddMissing(importance.leftOut, lights.back().leftOut);
  }
  const std::vector<double> luminance = LuminanceOf(importance.pilot);
  importance.gradient = GradientOf(luminance, importance.pilot.grid);
  importance.gradientThreshold = settings.gradientThreshold;
  importance.luminanceThreshold = settings.luminanceThreshold;
  if (settings.automatic)
  {
    ChooseThresholds(luminance, importance);
  }
  const double part = ChooseCells(luminance, importance);
  MakeMaps(pilots, lights, part, settings, importance);
  return importance;
}
}
