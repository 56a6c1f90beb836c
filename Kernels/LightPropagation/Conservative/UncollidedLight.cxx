#include "LightPropagation/Conservative/UncollidedLight.h"

#include "LightPropagation/Uncollided/UncollidedEmission.h"
#include "LightPropagation/Uncollided/UncollidedLamp.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
}

UncollidedSources LampsOf(const TransportParts& parts)
{
  UncollidedSources sources;
  for (const Light& lamp : parts.Lamps)
  {
    sources.push_back(std::make_unique<UncollidedLamp>(lamp, parts.Problem.Settings().periodic));
  }
  return sources;
}

UncollidedSources BrightEmissionOf(const TransportParts& parts)
{
  UncollidedSources sources;
  for (const EmissionPeak& peak : parts.Emission.peaks)
  {
    sources.push_back(std::make_unique<UncollidedEmission>(peak, parts.Problem.Settings().emissionError));
  }
  return sources;
}

void CountEmission(const TransportParts& parts, EnergyLedger& ledger)
{
  const Medium& medium = parts.Problem.TheMedium();
  const double volume = parts.Layout.grid.VoxelVolume();
  for (int c = 0; c < parts.Layout.channels && parts.Problem.Traits().emits; ++c)
  {
    for (std::size_t i = 0; i < parts.Layout.grid.VoxelCount(); ++i)
    {
      ledger.Emit(c, 4.0 * Pi * medium.emission.At(i, c) * volume);
    }
  }
}

double ProgressOf(const PropagationSettings& settings, double residual, double iterations)
{
  if (settings.maximumOrders > 0)
  {
    return iterations / settings.maximumOrders;
  }
  const double way = std::log(std::clamp(residual, 1e-12, 1.0)) / std::log(settings.tolerance);
  return std::clamp(std::max(way, 1.0 - 1.0 / (1.0 + 0.05 * iterations)), 0.0, 0.99);
}
}
