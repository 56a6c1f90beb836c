#include "Comparison/ConvergedLight.h"

// The reference that a comparison makes itself: see SolverComparison.h.

#include "Comparison/TimeLimit.h"
#include "Device/Errors.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tyndall
{
namespace
{
/// Settings to converge with, best first.
struct Rung
{
  int refinement, directions, map;
};
constexpr Rung Ladder[] = { { 2, 256, 2 }, { 2, 256, 1 }, { 2, 144, 1 }, { 1, 256, 2 }, { 1, 144, 2 }, { 1, 144, 1 } };
constexpr double ConvergedTolerance = 1e-6;

Factors RefinementBy(int factor, const Grid& grid)
{
  Factors factors;
  std::transform(grid.size.begin(), grid.size.end(), factors.begin(), [=](int size) { return size == 1 ? 1 : factor; });
  return factors;
}

PropagationSettings SettingsOf(const Rung& rung)
{
  PropagationSettings settings;
  settings.directionsPerFace = rung.directions;
  settings.mapResolution = rung.map;
  settings.tolerance = ConvergedTolerance;
  return settings;
}

std::string InWords(const Rung& rung, const Grid& grid, double seconds)
{
  char text[256];
  std::snprintf(text, sizeof(text),
    "light propagation maps, %d directions a face, map resolution %d, tolerance %g, %dx%dx%d voxels (%s), %.3g s",
    rung.directions, rung.map, ConvergedTolerance, grid.size[0], grid.size[1], grid.size[2],
    rung.refinement > 1 ? "twice as fine" : "the medium's: what they are too large for is in no figure", seconds);
  return text;
}

ReferenceLight AsReference(LightField&& light, const Grid& grid)
{
  ReferenceLight reference;
  reference.grid = grid;
  reference.channels = light.channels;
  reference.fluence = std::move(light.fluence);
  reference.fluenceDirect = std::move(light.fluenceDirect);
  return reference;
}

ReferenceLight Climb(Device& device, const ComparedScene& scene, const Rung& rung, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const RescaledScene fine(scene, RescaledScene::To::Finer, RefinementBy(rung.refinement, scene.medium.grid));
  ReferenceLight reference =
    AsReference(Propagate(device, fine.Scene(), SettingsOf(rung), monitor), fine.Scene().medium.grid);
  reference.text = InWords(rung, reference.grid, ClockSeconds() - start);
  return reference;
}

/// Seconds that settings take, from two poorer ones: a part for what does not depend on the rays, and one for each ray.
class Forecast
{
public:
  Forecast(Device& device, const ComparedScene& scene, const Monitor& monitor)
    : VoxelGrid(scene.medium.grid)
  {
    constexpr Rung few = { 1, 25, 1 }, more = { 1, 100, 1 };
    const auto run = [&](const Rung& rung, double from, double to) {
      const double start = ClockSeconds();
      Propagate(device, scene, SettingsOf(rung), PartWithin(HUGE_VAL, monitor, from, to));
      return ClockSeconds() - start;
    };
    run(few, 0.0, 0.2); // compiles
    const double ofFew = run(few, 0.2, 0.4), ofMore = run(more, 0.4, 1.0);
    this->OfRay = std::max(ofMore - ofFew, 0.1 * ofMore) / (Rays(more) - Rays(few));
    this->Fixed = std::max(0.0, ofMore - this->OfRay * Rays(more));
  }

  double Seconds(const Rung& rung) const
  {
    const Factors factors = RefinementBy(rung.refinement, this->VoxelGrid);
    return (this->Fixed + this->OfRay * Rays(rung)) * factors[0] * factors[1] * factors[2];
  }

private:
  static double Rays(const Rung& rung) { return 1.0 * rung.directions * rung.map * rung.map; }

  Grid VoxelGrid;
  double OfRay = 0.0, Fixed = 0.0;
};

ReferenceLight ByPropagation(Device& device, const ComparedScene& scene, double seconds, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const Forecast forecast(device, scene, PartWithin(HUGE_VAL, monitor, 0.0, 0.2));
  for (const Rung& rung : Ladder)
  {
    const bool last = &rung == std::end(Ladder) - 1;
    const double left = seconds - (ClockSeconds() - start);
    if (!last && forecast.Seconds(rung) > left)
    {
      continue;
    }
    try
    {
      return Climb(device, scene, rung, PartWithin(last ? HUGE_VAL : left, monitor, 0.2, 1.0));
    }
    catch (const TimeIsUp&)
    {
    }
    catch (const DeviceError&) // too large; a lower rung may do
    {
      if (last)
      {
        throw;
      }
    }
  }
  return {}; // not reached: the last rung has all the time it needs
}

/// Means of independent sets of photons, and how far they are off.
class Means
{
public:
  void Add(const std::vector<float>& values)
  {
    this->Sums.resize(values.size());
    this->Squares.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      this->Sums[i] += values[i];
      this->Squares[i] += static_cast<double>(values[i]) * values[i];
    }
    ++this->Count;
  }

  std::vector<float> Values() const
  {
    std::vector<float> means(this->Sums.size());
    std::transform(this->Sums.begin(), this->Sums.end(), means.begin(),
      [this](double sum) { return static_cast<float>(sum / this->Count); });
    return means;
  }

  /// Root of the mean square of the standard errors, over that of the values; needs two sets.
  double RelativeError() const
  {
    double variance = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < this->Sums.size(); ++i)
    {
      const double mean = this->Sums[i] / this->Count;
      variance += std::max(0.0, this->Squares[i] / this->Count - mean * mean) / (this->Count - 1);
      squares += mean * mean;
    }
    return squares > 0.0 ? std::sqrt(variance / squares) : 0.0;
  }

  int Count = 0;

private:
  std::vector<double> Sums, Squares;
};

/// Photons that are not filtered, scattered where that is asked for: sixteen to sixty-four times the largest number
/// that is tried.
ReferenceLight ByPhotons(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor)
{
  constexpr int fewest = 16, most = 64;
  const double start = ClockSeconds();
  const auto set =
    static_cast<std::size_t>(*std::max_element(settings.photonCounts.begin(), settings.photonCounts.end()));
  const bool all = settings.scattersReference;
  Means means, direct;
  ReferenceLight reference;
  while (means.Count < most && (means.Count < fewest || ClockSeconds() - start < seconds))
  {
    const Monitor part = PartWithin(HUGE_VAL, monitor, 1.0 * means.Count / most, (means.Count + 1.0) / most);
    LightField light = MarchEvenly(device, scene, set, all ? 0 : 1, static_cast<std::uint64_t>(means.Count) + 1, part);
    means.Add(light.fluence);
    direct.Add(all ? light.fluenceDirect : light.fluence);
    reference.channels = light.channels;
  }
  reference.grid = scene.medium.grid;
  reference.fluence = all ? means.Values() : std::vector<float>();
  reference.fluenceDirect = direct.Values();
  char text[160];
  std::snprintf(text, sizeof(text), "%d times %zu photons%s, not filtered, standard error %.2g, %.3g s", means.Count,
    set, all ? " that are scattered until they end" : "", means.RelativeError(), ClockSeconds() - start);
  reference.text = text;
  return reference;
}
}

ReferenceLight ConvergedLight(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor)
{
  const std::string whyNot = settings.monteCarloReference ? scene.WhyNotByPhotons(true) : "";
  if (!whyNot.empty())
  {
    throw InvalidInput("MonteCarloReference cannot be made: " + whyNot + ". Switch it off, or connect a reference.");
  }
  return scene.BendsLight() || settings.monteCarloReference ? ByPhotons(device, scene, settings, seconds, monitor)
                                                            : ByPropagation(device, scene, seconds, monitor);
}
}
