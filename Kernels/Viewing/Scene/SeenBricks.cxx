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

/// With all neighbours, by corners too.
std::vector<unsigned char> WithNeighbours(std::vector<unsigned char> bricks, const std::array<int, 3>& count)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    bricks = Widened(bricks, count, axis);
  }
  return bricks;
}
}

SeenBricks SeenBricksOf(const Medium& medium, bool everywhere)
{
  const FilledBricks filled = FindFilledBricks(medium);
  SeenBricks bricks;
  bricks.count = filled.count;
  if (everywhere)
  {
    bricks.sight.assign(filled.filled.size(), SeenBricks::Seen);
    return bricks;
  }
  bricks.sight = WithNeighbours(filled.filled, filled.count);
  const std::vector<unsigned char> beside = WithNeighbours(bricks.sight, filled.count);
  std::transform(bricks.sight.begin(), bricks.sight.end(), beside.begin(), bricks.sight.begin(),
    [](unsigned char seen, unsigned char near) { return static_cast<unsigned char>(seen + near); });
  bricks.all = std::count(bricks.sight.begin(), bricks.sight.end(), SeenBricks::Unseen) == 0;
  return bricks;
}
}
