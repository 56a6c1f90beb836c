#include "Medium/FilledBricks.h"

#include "Device/HostThreads.h"
#include "Device/Sizes.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Whether any of `count` values is not zero; they are not negative, and all of them are read: no branch a value.
bool AnyOf(const float* values, int count)
{
  float most = 0.0f;
  for (int i = 0; i < count; ++i)
  {
    most = std::max(most, values[i]);
  }
  return most > 0.0f;
}

/// Marks the bricks of one row of voxels.
void MarkRow(const Field& field, std::size_t first, int size, unsigned char* bricks)
{
  if (!field.values)
  {
    return;
  }
  const float* row = field.values + first * static_cast<std::size_t>(field.components);
  for (int x = 0, brick = 0; x < size; x += BrickEdge, ++brick)
  {
    const int voxels = std::min<int>(BrickEdge, size - x);
    bricks[brick] |= AnyOf(row + x * field.components, voxels * field.components) ? 1 : 0;
  }
}
}

FilledBricks FindFilledBricks(const Medium& medium)
{
  const std::array<int, 3>& size = medium.grid.size;
  FilledBricks bricks;
  for (int axis = 0; axis < 3; ++axis)
  {
    bricks.count[axis] = PartsOf<int>(size[axis], BrickEdge);
  }
  const std::array<int, 3>& count = bricks.count;
  const std::size_t layer = static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]);
  bricks.filled.assign(layer * static_cast<std::size_t>(count[2]), 0);
  InThreads(static_cast<std::size_t>(count[2]), 1, [&](std::size_t begin, std::size_t end) {
    const int last = std::min(static_cast<int>(end) * BrickEdge, size[2]);
    for (int z = static_cast<int>(begin) * BrickEdge; z < last; ++z)
    {
      for (int y = 0; y < size[1]; ++y)
      {
        unsigned char* row = &bricks.filled[static_cast<std::size_t>(z / BrickEdge) * layer +
          static_cast<std::size_t>(y / BrickEdge) * static_cast<std::size_t>(count[0])];
        for (const Field* field : { &medium.sigma_a, &medium.sigma_s, &medium.emission })
        {
          MarkRow(*field, medium.grid.IndexOf({ 0, y, z }), size[0], row);
        }
      }
    }
  });
  bricks.filledCount = static_cast<std::size_t>(std::count(bricks.filled.begin(), bricks.filled.end(), 1));
  return bricks;
}
}
