#include "Viewing/Scene/SeenBricks.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Bricks that are, or have along one axis a neighbour that is, among `bricks`.
std::vector<unsigned char> Widened(const std::vector<unsigned char>& bricks, const std::array<int, 3>& count, int axis)
{
  const std::size_t stride = axis == 0 ? 1
    : axis == 1                        ? static_cast<std::size_t>(count[0])
                                       : static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]);
  std::vector<unsigned char> wide = bricks;
  for (std::size_t brick = 0; brick < bricks.size(); ++brick)
  {
    const auto place = static_cast<int>(brick / stride % static_cast<std::size_t>(count[axis]));
    wide[brick] |= place > 0 ? bricks[brick - stride] : 0;
    wide[brick] |= place + 1 < count[axis] ? bricks[brick + stride] : 0;
  }
  return wide;
}
}

SeenBricks SeenBricksOf(const FilledBricks& filled, bool everywhere)
{
  SeenBricks bricks;
  bricks.count = filled.count;
  if (everywhere)
  {
    bricks.seen.assign(filled.filled.size(), 1);
    return bricks;
  }
  bricks.seen = filled.filled;
  for (int axis = 0; axis < 3; ++axis) // neighbours by corners too
  {
    bricks.seen = Widened(bricks.seen, filled.count, axis);
  }
  bricks.all = std::count(bricks.seen.begin(), bricks.seen.end(), 0) == 0;
  return bricks;
}
}
