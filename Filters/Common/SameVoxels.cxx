#include "Common/SameVoxels.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tyndall
{
namespace
{
std::string Triple(const std::array<double, 3>& values)
{
  return "(" + Text("%.9g", values[0]) + ", " + Text("%.9g", values[1]) + ", " + Text("%.9g", values[2]) + ")";
}

std::string Described(const Grid& grid)
{
  const std::array<int, 3>& size = grid.size;
  return std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]) +
    " voxels of spacing " + Triple(grid.spacing) + " from origin " + Triple(grid.origin);
}
}

bool AreSameVoxels(const Grid& a, const Grid& b)
{
  constexpr double part = 1e-3; // of a voxel
  bool agree = a.size == b.size;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = std::abs(a.origin[axis] - b.origin[axis]);
    const double high = std::abs(a.origin[axis] + a.Length(axis) - b.origin[axis] - b.Length(axis));
    agree = agree && std::max(low, high) <= part * b.spacing[axis];
  }
  return agree;
}

void CheckSameVoxels(const Grid& grid, const Grid& medium, const std::string& whose, const std::string& remedy)
{
  if (!AreSameVoxels(grid, medium))
  {
    throw InvalidInput(whose + " has " + Described(grid) + ", the medium " + Described(medium) + ". " + remedy);
  }
}
}
