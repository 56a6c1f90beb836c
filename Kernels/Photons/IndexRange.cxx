#include "IndexRange.h"

#include "../Device/Errors.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
constexpr float Rounding = 1e-6f; ///< relative
}

void CheckIndex(const Field& ior, const Grid& grid)
{
  const std::size_t count = ior.values ? grid.VoxelCount() : 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    if (!(ior.values[i] > 0.0f) || std::isinf(ior.values[i]))
    {
      throw InvalidInput("ior is " + std::to_string(ior.values[i]) + " in voxel " + VoxelName(grid, i) +
        " (the first such voxel); a refractive index must be finite and positive.");
    }
  }
}

bool IndexVaries(const Field& ior, const Grid& grid)
{
  if (!ior.values)
  {
    return false;
  }
  const auto range = std::minmax_element(ior.values, ior.values + grid.VoxelCount());
  return *range.second - *range.first > Rounding * *range.second;
}
}
