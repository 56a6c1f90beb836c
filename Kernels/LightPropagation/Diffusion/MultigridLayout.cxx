#include "LightPropagation/Diffusion/MultigridLayout.h"

#include "Device/Sizes.h"

#include <algorithm>
#include <cstddef>

namespace tyndall
{
namespace
{
/// Number of voxels below which a multigrid level is not coarsened further
constexpr std::size_t FewVoxels = 64;
constexpr int VoxelsOfItem = 4096;           ///< approximate number of voxels per work-item
constexpr int BetweenPlanes = 2 * RowVector; ///< padding after each plane of voxels, floats

/// Sets the memory layout of a level from its size.
void LayOut(MultigridLevel& level)
{
  level.pitch = RoundUp(level.size[0], int(RowVector)) + RowVector;
  level.plane = level.size[1] * level.pitch + BetweenPlanes;
  level.floats = RowsLead + level.size[2] * level.plane + 2 * RowVector;
  level.together = std::max(1, VoxelsOfItem / level.pitch);
}

std::size_t VoxelsOf(const MultigridLevel& level)
{
  return static_cast<std::size_t>(level.size[0]) * level.size[1] * level.size[2];
}
}

std::vector<MultigridLevel> MultigridLevels(const std::array<int, 3>& size, const std::array<double, 3>& ofSpacing)
{
  std::array<double, 3> spacing = ofSpacing;
  MultigridLevel level = {};
  std::copy(size.begin(), size.end(), level.size);
  level = WithGhostsOwned(level);
  std::vector<MultigridLevel> levels;
  for (;;)
  {
    double shortest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool shorter = shortest == 0.0 || spacing[axis] < shortest;
      shortest = level.size[axis] > 1 && shorter ? spacing[axis] : shortest;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      level.halved[axis] = level.size[axis] > 1 && spacing[axis] < 1.9 * shortest ? 1 : 0;
      level.single[axis] = level.size[axis] == 1;
    }
    LayOut(level);
    levels.push_back(level);
    if (VoxelsOf(level) <= FewVoxels)
    {
      return levels;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      spacing[axis] *= 1 + level.halved[axis];
      level.size[axis] = (level.size[axis] + level.halved[axis]) >> level.halved[axis];
    }
    level = WithGhostsOwned(level);
  }
}

MultigridLevel PartOfLevel(
  const MultigridLevel& whole, const VoxelBox& box, const VoxelBox& own, const VoxelBox& joined)
{
  MultigridLevel level = whole;
  const bool any = own.VoxelCount() > 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    level.size[axis] = any ? box.size[axis] : 0;
    level.first[axis] = any ? own.first[axis] - box.first[axis] : 0;
    level.end[axis] = any ? level.first[axis] + own.size[axis] : 0;
    level.shift[axis] = (joined.first[axis] << whole.halved[axis]) - box.first[axis];
  }
  LayOut(level);
  return level;
}

MultigridLevel WithGhostsOwned(MultigridLevel level)
{
  std::fill_n(level.first, 3, 0);
  std::copy_n(level.size, 3, level.end);
  return level;
}

VoxelBox Joined(const MultigridLevel& level, const VoxelBox& box)
{
  VoxelBox joined = box;
  for (int axis = 0; axis < 3 && box.VoxelCount() > 0; ++axis)
  {
    joined.first[axis] = box.first[axis] >> level.halved[axis];
    joined.size[axis] = ((box.first[axis] + box.size[axis] - 1) >> level.halved[axis]) + 1 - joined.first[axis];
  }
  return joined;
}
}
