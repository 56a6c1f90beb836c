#include "LightPropagation/Scattering/BeamScattering.h"

#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Part of the light that a phase function scatters forwards above a level.
double PartAbove(const PhaseFunction& function, double level)
{
  static const GaussLegendre rule(24);
  double sum = 0.0, far = 1.0;
  for (int stretch = 0; stretch < 40; ++stretch, far *= 0.5) // towards the peak in stretches that halve
  {
    const double near = stretch == 39 ? 0.0 : 0.5 * far;
    for (std::size_t i = 0; i < rule.points.size(); ++i)
    {
      const double away = near + 0.5 * (rule.points[i] + 1.0) * (far - near);
      sum += Pi * (far - near) * rule.weights[i] * std::max(function.Value(1.0 - away) - level, 0.0);
    }
  }
  return sum;
}

/// Level above which a phase function's forward part holds `part` of the light.
double LevelOf(const PhaseFunction& function, double part)
{
  double low = 0.0, high = std::max(function.Value(1.0), 1e-30);
  for (int i = 0; i < 100 && part > 0.0; ++i)
  {
    const double level = low > 0.0 ? std::sqrt(low * high) : 1e-6 * high;
    (PartAbove(function, level) > part ? low : high) = level;
  }
  return high;
}

double Dot(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
}

std::vector<double> BeyondMoments(const PhaseFunction& function, const DeltaM& truncated, const DirectionSet& set,
  const AngularBasis& basis, const std::array<double, 3>& beam)
{
  const double level = LevelOf(function, truncated.forward);
  std::vector<double> scattered;
  std::vector<std::vector<double>> functions;
  double sum = 0.0;
  for (const Direction& direction : set.directions)
  {
    const double cosine = std::clamp(Dot(direction.omega, beam), -1.0, 1.0);
    const double value = function.Value(cosine);
    scattered.push_back(cosine > 0.0 ? std::min(value, level) : value);
    functions.push_back(basis.At(direction.omega));
    sum += direction.weight * scattered.back() / (4.0 * Pi);
  }
  std::vector<double> moments(basis.Count(), 0.0);
  for (std::size_t d = 0; d < scattered.size(); ++d)
  {
    scattered[d] /= sum;
    for (int i = 0; i < basis.Count(); ++i)
    {
      moments[i] += set.directions[d].weight * scattered[d] * functions[d][i] / (4.0 * Pi);
    }
  }
  for (std::size_t d = 0; d < scattered.size(); ++d)
  {
    for (int i = 0; i < basis.Count(); ++i)
    {
      scattered[d] -= moments[i] * functions[d][i];
    }
  }
  return scattered;
}
}
