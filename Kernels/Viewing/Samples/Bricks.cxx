#include "Viewing/Samples/Bricks.h"

#include <algorithm>
#include <cstddef>

namespace tyndall
{
namespace
{
/// Moves from each brick to the nearest one of another kind, by sweeps that go on from moves that were found before.
class Moves
{
public:
  Moves(const std::vector<cl_char>& bricks, const std::array<int, 3>& count)
    : Bricks(bricks)
    , Count(count)
    , Found(bricks.size(), 127)
  {
    const std::ptrdiff_t row = count[0], slice = row * count[1];
    for (int neighbour = 0; neighbour < Neighbours; ++neighbour)
    {
      this->Offsets[neighbour] = (neighbour % 3 - 1) + (neighbour / 3 % 3 - 1) * row + (neighbour / 9 - 1) * slice;
    }
  }

  /// @param side  1: of the neighbours before it in memory; -1: of those behind it
  void Relax(int i, int j, int k, int side)
  {
    const std::ptrdiff_t here = (static_cast<std::ptrdiff_t>(k) * this->Count[1] + j) * this->Count[0] + i;
    const bool inside =
      i > 0 && j > 0 && k > 0 && i + 1 < this->Count[0] && j + 1 < this->Count[1] && k + 1 < this->Count[2];
    int moves = this->Found[here];
    for (int neighbour = 0; neighbour < Neighbours; ++neighbour)
    {
      if (inside ||
        this->IsThere(
          i + side * (neighbour % 3 - 1), j + side * (neighbour / 3 % 3 - 1), k + side * (neighbour / 9 - 1)))
      {
        const std::ptrdiff_t there = here + side * this->Offsets[neighbour];
        moves = std::min(moves, this->Bricks[there] != this->Bricks[here] ? 1 : this->Found[there] + 1);
      }
    }
    this->Found[here] = moves;
  }

  int operator[](std::size_t brick) const { return this->Found[brick]; }

private:
  static constexpr int Neighbours = 13; ///< on either side

  bool IsThere(int i, int j, int k) const
  {
    return i >= 0 && j >= 0 && k >= 0 && i < this->Count[0] && j < this->Count[1] && k < this->Count[2];
  }

  const std::vector<cl_char>& Bricks;
  const std::array<int, 3> Count;
  std::array<std::ptrdiff_t, Neighbours> Offsets;
  std::vector<int> Found;
};
}

void FindDistances(std::vector<cl_char>& bricks, const std::array<int, 3>& count)
{
  Moves moves(bricks, count);
  for (int k = 0; k < count[2]; ++k)
  {
    for (int j = 0; j < count[1]; ++j)
    {
      for (int i = 0; i < count[0]; ++i)
      {
        moves.Relax(i, j, k, 1);
      }
    }
  }
  for (int k = count[2] - 1; k >= 0; --k)
  {
    for (int j = count[1] - 1; j >= 0; --j)
    {
      for (int i = count[0] - 1; i >= 0; --i)
      {
        moves.Relax(i, j, k, -1);
      }
    }
  }
  for (std::size_t brick = 0; brick < bricks.size(); ++brick)
  {
    bricks[brick] = static_cast<cl_char>(bricks[brick] * moves[brick]);
  }
}
}
