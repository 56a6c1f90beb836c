#include "Refraction/Index/IndexRange.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"
#include "Numerics/PyramidLayout.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
constexpr float Rounding = 1e-6f; ///< relative
constexpr float Least = static_cast<float>(LeastIndex);
constexpr float Largest = static_cast<float>(LargestIndex);
}

void CheckIndex(const Field& ior, const Grid& grid)
{
  const std::size_t count = ior.values ? grid.VoxelCount() : 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    if (!(ior.values[i] >= Least && ior.values[i] <= Largest))
    {
      throw InvalidInput("ior is " + Text("%g", ior.values[i]) + " in voxel " + VoxelName(grid, i) +
        " (the first such voxel); a refractive index must be finite and positive, from " + Text("%g", Least) + " to " +
        Text("%g", Largest) + ".");
    }
  }
}

bool IndexRange::Varies() const
{
  return this->largest - this->least > Rounding * this->largest;
}

IndexRange IndexRangeOf(const Field& ior, const Grid& grid)
{
  if (!ior.values)
  {
    return {};
  }
  const auto range = std::minmax_element(ior.values, ior.values + grid.VoxelCount());
  return { *range.first, *range.second };
}

bool IndexVaries(const Field& ior, const Grid& grid)
{
  return IndexRangeOf(ior, grid).Varies();
}

void CheckLevels(const std::uint8_t* levels, const Grid& grid)
{
  CheckLevels(levels, grid, grid);
}

void CheckLevels(const std::uint8_t* levels, const Grid& grid, const Grid& whole)
{
  const int top = PyramidLayout(whole.size).Top();
  const std::size_t count = levels ? grid.VoxelCount() : 0;
  int highest = 0; // separate from the search for the voxel: compilers vectorise this loop
  for (std::size_t i = 0; i < count; ++i)
  {
    highest = std::max<int>(highest, levels[i]);
  }
  if (highest > top)
  {
    const std::size_t i =
      static_cast<std::size_t>(std::find_if(levels, levels + count, [&](int level) { return level > top; }) - levels);
    throw InvalidInput("octree_level is " + std::to_string(levels[i]) + " in voxel " + VoxelName(grid, i) +
      " (the first such voxel); a grid of this size has levels 0 to " + std::to_string(top) +
      ". Make them with RefractionOctree.");
  }
}
}
