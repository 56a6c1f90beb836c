#include "Viewing/Samples/Marching.h"

#include "Device/Defines.h"

#include <cmath>

namespace tyndall
{
namespace
{
/// largest number of samples between two progress reports: under a second on one old core
constexpr double SamplesAtOnce = 3.2e7;
constexpr double ManySteps = 4096.0; ///< steps per ray from which accumulated rounding errors reach 1e-4
}

double LongestSteps(const Grid& grid, double stepSize)
{
  return std::hypot(grid.size[0], grid.size[1], grid.size[2]) / stepSize + 1.0;
}

std::string StepOption(double longestSteps)
{
  return Define("MANY_STEPS", longestSteps > ManySteps);
}

Batches BatchesOfRows(std::size_t rows, std::size_t cells, double samples, double from, double to)
{
  const double atOnce = std::max(SamplesAtOnce / std::max(samples, 1.0), 1.0);
  Batches batches;
  batches.count = rows * cells;
  batches.whole = atOnce >= static_cast<double>(cells) ? cells : 1;
  batches.most = static_cast<std::size_t>(std::min(atOnce, static_cast<double>(batches.count)));
  batches.first = std::max<std::size_t>(1, rows / 8) * cells;
  batches.from = from;
  batches.to = to;
  return batches;
}
}
