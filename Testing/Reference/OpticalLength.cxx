#include "Reference/OpticalLength.h"

#include <algorithm>
#include <cmath>
#include <limits>

double OpticalLength(const std::array<int, 3>& size, const std::array<double, 3>& spacing, const float* extinction,
  const std::array<double, 3>& from, const std::array<double, 3>& to)
{
  std::array<double, 3> way, next;
  std::array<int, 3> at;
  double squared = 0.0;
  for (int a = 0; a < 3; ++a)
  {
    way[a] = to[a] - from[a];
    squared += std::pow(way[a] * spacing[a], 2);
    at[a] = static_cast<int>(from[a]);
    next[a] = way[a] == 0.0 ? std::numeric_limits<double>::infinity() : (at[a] + (way[a] > 0.0) - from[a]) / way[a];
  }
  double tau = 0.0;
  for (double now = 0.0; now < 1.0;)
  {
    const int axis = static_cast<int>(std::min_element(next.begin(), next.end()) - next.begin());
    const double end = std::min(next[axis], 1.0);
    tau += extinction[(static_cast<std::size_t>(at[2]) * size[1] + at[1]) * size[0] + at[0]] * (end - now);
    now = end;
    at[axis] = std::clamp(at[axis] + (way[axis] > 0.0 ? 1 : -1), 0, size[axis] - 1);
    next[axis] += 1.0 / std::abs(way[axis]);
  }
  return tau * std::sqrt(squared);
}
