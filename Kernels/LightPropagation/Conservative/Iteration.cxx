#include "LightPropagation/Conservative/Iteration.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
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
