#include "LightPropagation/Problem/ThickLines.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double Uneven = 1.5; ///< ratio of the thickest line to the mean of all lines, weighted by thickness
}

ThickLines::ThickLines(const Grid& grid, const LineSums& sigma_t)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    double all = 0.0, squares = 0.0;
    for (const double line : sigma_t[axis])
    {
      all += line;
      squares += line * line;
    }
    const double thickest = *std::max_element(sigma_t[axis].begin(), sigma_t[axis].end());
    const double mean = all > 0.0 ? squares / all : 0.0;
    this->along[axis] = grid.spacing[axis] * std::cbrt(mean * mean * thickest);
    this->uneven = this->uneven || thickest > Uneven * mean;
  }
}
}
