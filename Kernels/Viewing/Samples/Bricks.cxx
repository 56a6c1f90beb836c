#include "Viewing/Samples/Bricks.h"

#include <algorithm>

namespace tyndall
{
void FindDistances(std::vector<cl_char>& bricks, const std::array<int, 3>& count)
{
  std::vector<int> moves(bricks.size(), 127);
  const auto relax = [&](int i, int j, int k, int side) {
    const std::size_t here = (static_cast<std::size_t>(k) * count[1] + j) * count[0] + i;
    for (int neighbour = 0; neighbour < 13; ++neighbour)
    {
      const int x = i + side * (neighbour % 3 - 1);
      const int y = j + side * (neighbour / 3 % 3 - 1);
      const int z = k + side * (neighbour / 9 - 1);
      if (x >= 0 && y >= 0 && z >= 0 && x < count[0] && y < count[1] && z < count[2])
      {
        const std::size_t there = (static_cast<std::size_t>(z) * count[1] + y) * count[0] + x;
        const bool other = bricks[there] != bricks[here];
        moves[here] = std::min(moves[here], other ? 1 : moves[there] + 1);
      }
    }
  };
  const int last = count[0] * count[1] * count[2] - 1;
  for (int n = 0; n <= last; ++n)
  {
    relax(n % count[0], n / count[0] % count[1], n / (count[0] * count[1]), 1);
  }
  for (int n = last; n >= 0; --n)
  {
    relax(n % count[0], n / count[0] % count[1], n / (count[0] * count[1]), -1);
  }
  for (std::size_t brick = 0; brick < bricks.size(); ++brick)
  {
    bricks[brick] = static_cast<cl_char>(bricks[brick] * moves[brick]);
  }
}
}
