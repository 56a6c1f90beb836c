#include "Viewing/Samples/SampleBricks.h"

#include "Viewing/Samples/SampleBricksShared.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Whether a brick's record holds the sample of any filled voxel: voxels of its own brick, and the last ones of the
/// preceding bricks, because the border shifts samples by one voxel.
bool IsFilled(const FilledBricks& filled, const std::array<int, 3>& cells)
{
  std::array<int, 3> low, high;
  for (int a = 0; a < 3; ++a)
  {
    low[a] = std::max(cells[a] - 1, 0);
    high[a] = std::min(cells[a], filled.count[a] - 1);
  }
  bool any = false;
  for (int k = low[2]; k <= high[2]; ++k)
  {
    for (int j = low[1]; j <= high[1]; ++j)
    {
      const unsigned char* const row = filled.RowOf(j * BrickEdge, k * BrickEdge);
      any = any || std::count(row + low[0], row + high[0] + 1, 1) > 0;
    }
  }
  return any;
}
}

SampleBricks SampleBricksOf(const FilledBricks& filled, const Grid& grid, bool paired)
{
  SampleBricks bricks;
  bricks.edges = { SampleEdge, paired ? static_cast<int>(BrickEdge) : static_cast<int>(SampleEdge), SampleEdge };
  for (int a = 0; a < 3; ++a)
  {
    bricks.count[a] = grid.size[a] / BrickEdge + 1;
  }
  const auto each = static_cast<cl_int>(bricks.SamplesEach());
  bricks.bricks.push_back(-1);
  for (int k = 0; k < bricks.count[2]; ++k)
  {
    for (int j = 0; j < bricks.count[1]; ++j)
    {
      for (int i = 0; i < bricks.count[0]; ++i)
      {
        const bool isFilled = IsFilled(filled, { i, j, k });
        bricks.first.push_back(isFilled ? static_cast<cl_int>(bricks.bricks.size()) * each : 0);
        if (isFilled)
        {
          bricks.bricks.push_back(static_cast<cl_int>(bricks.first.size() - 1));
        }
      }
    }
  }
  return bricks;
}
}
