#include "Comparison/GridTransfer.h"

#include "Medium/Coarsening.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Calls visit(fine voxel, coarse voxel) for all fine voxels in their order.
template <class Visit>
void ForAllPairs(const Grid& fine, const Factors& factors, const Visit& visit)
{
  const Grid coarse = Coarsened(fine, factors);
  std::size_t voxel = 0;
  for (int k = 0; k < fine.size[2]; ++k)
  {
    for (int j = 0; j < fine.size[1]; ++j)
    {
      const std::size_t row = coarse.IndexOf({ 0, j / factors[1], k / factors[2] });
      for (int i = 0; i < fine.size[0]; ++i, ++voxel)
      {
        visit(voxel, row + static_cast<std::size_t>(i / factors[0]));
      }
    }
  }
}
}

std::optional<Factors> CoarseningBy(int factor, const Grid& grid)
{
  Factors factors;
  for (int axis = 0; axis < 3; ++axis)
  {
    factors[axis] = grid.size[axis] == 1 ? 1 : factor;
    if (grid.size[axis] % factors[axis] != 0)
    {
      return std::nullopt;
    }
  }
  return factors;
}

Grid Coarsened(const Grid& fine, const Factors& factors)
{
  Grid coarse = fine;
  for (int axis = 0; axis < 3; ++axis)
  {
    coarse.size[axis] = fine.size[axis] / factors[axis];
    coarse.spacing[axis] = fine.spacing[axis] * factors[axis];
  }
  return coarse;
}

Grid Refined(const Grid& coarse, const Factors& factors)
{
  Grid fine = coarse;
  for (int axis = 0; axis < 3; ++axis)
  {
    fine.size[axis] = coarse.size[axis] * factors[axis];
    fine.spacing[axis] = coarse.spacing[axis] / factors[axis];
  }
  return fine;
}

std::optional<Factors> FactorsBetween(const Grid& fine, const Grid& coarse)
{
  constexpr double part = 1e-3;
  Factors factors;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = std::abs(fine.origin[axis] - coarse.origin[axis]);
    const double high = std::abs(fine.origin[axis] + fine.Length(axis) - coarse.origin[axis] - coarse.Length(axis));
    if (fine.size[axis] % coarse.size[axis] != 0 || std::max(low, high) > part * fine.spacing[axis])
    {
      return std::nullopt;
    }
    factors[axis] = fine.size[axis] / coarse.size[axis];
  }
  return factors;
}

std::vector<float> Averaged(const float* values, int components, const Grid& fine, const Factors& factors)
{
  return Coarsening(fine, Coarsened(fine, factors)).Average(values, components);
}

std::vector<float> Repeated(const float* values, int components, const Grid& coarse, const Factors& factors)
{
  const Grid fine = Refined(coarse, factors);
  const std::size_t channels = static_cast<std::size_t>(components);
  std::vector<float> repeated(fine.VoxelCount() * channels);
  ForAllPairs(fine, factors, [&](std::size_t to, std::size_t from) {
    std::copy_n(values + from * channels, channels, repeated.begin() + static_cast<std::ptrdiff_t>(to * channels));
  });
  return repeated;
}
}
