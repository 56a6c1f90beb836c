#pragma once

#include "Medium/Grid.h"

#include <array>
#include <optional>
#include <vector>

/// Transfer of fields between grids whose voxel sizes differ by integer factors.
namespace tyndall
{
/// Fine voxels per coarse voxel along each axis, at least 1.
using Factors = std::array<int, 3>;

/// Factors for voxels `factor` times as large; axes with a single voxel are not coarsened.
/// @return nothing if `factor` does not divide the size of an axis
std::optional<Factors> CoarseningBy(int factor, const Grid& grid);

Grid Coarsened(const Grid& fine, const Factors& factors);
Grid Refined(const Grid& coarse, const Factors& factors);

/// Voxels of `fine` per voxel of `coarse` along each axis; nothing if they are not integers, or the boxes differ by
/// more than a thousandth of a voxel.
std::optional<Factors> FactorsBetween(const Grid& fine, const Grid& coarse);

/// Means over coarse voxels; NaN if a fine value is.
/// @param values  `components` per voxel of `fine`, x fastest
std::vector<float> Averaged(const float* values, int components, const Grid& fine, const Factors& factors);

/// Copies each coarse value to all of its fine voxels.
/// @param values  `components` per voxel of `coarse`, x fastest
std::vector<float> Repeated(const float* values, int components, const Grid& coarse, const Factors& factors);
}
