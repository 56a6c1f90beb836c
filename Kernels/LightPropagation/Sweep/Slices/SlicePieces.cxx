#include "LightPropagation/Sweep/Slices/SlicePieces.h"

#include "Device/Sizes.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// The piece that a unit crosses next, from the remaining range `left`.
SlicePiece NextPiece(const SweepPlan& plan, bool backward, const cl_int2& left, int thickness, int aligned)
{
  const int planes = plan.Planes();
  const int lap = left.s[0] / planes * planes; // first plane of the current lap
  const int from = left.s[0] - lap;
  const int to = std::min(left.s[1] - lap, planes);
  SlicePiece piece;
  if (backward)
  {
    piece.end = planes - from;
    const int lowest = std::max(piece.end - thickness, 0);
    piece.begin = std::max(planes - to, RoundUp(lowest, aligned));
  }
  else
  {
    piece.begin = from;
    piece.end = std::min(to, from / aligned * aligned + thickness);
  }
  piece.range = { { left.s[0], left.s[0] + piece.end - piece.begin } };
  return piece;
}
}

std::vector<std::vector<SlicePiece>> CutIntoPieces(
  const SweepPlan& plan, const std::vector<cl_int2>& schedule, int thickness, int aligned)
{
  const std::size_t units = plan.units.size();
  std::vector<std::vector<SlicePiece>> launches;
  for (std::size_t first = 0; first < schedule.size(); first += units)
  {
    std::vector<cl_int2> left(schedule.begin() + first, schedule.begin() + first + units);
    const auto isLeft = [](const cl_int2& range) { return range.s[0] < range.s[1]; };
    while (std::any_of(left.begin(), left.end(), isLeft))
    {
      std::vector<SlicePiece> launch(units);
      for (std::size_t u = 0; u < units; ++u)
      {
        if (isLeft(left[u]))
        {
          launch[u] = NextPiece(plan, plan.units[u].backward != 0, left[u], thickness, aligned);
          left[u].s[0] = launch[u].range.s[1];
        }
      }
      launches.push_back(std::move(launch));
    }
  }
  return launches;
}

bool Meet(const SlicePiece& first, const SlicePiece& second, int aligned)
{
  const auto begin = [aligned](const SlicePiece& piece) { return piece.begin / aligned; };
  const auto end = [aligned](const SlicePiece& piece) { return PartsOf(piece.end, aligned); };
  return first.begin < first.end && second.begin < second.end && begin(first) < end(second) &&
    begin(second) < end(first);
}
}
