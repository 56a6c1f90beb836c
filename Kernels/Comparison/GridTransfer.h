#pragma once

#include "Medium/Grid.h"

#include <array>
#include <optional>
#include <vector>

/// Fields from a grid to one whose voxels are a whole number of times larger or smaller.
namespace tyndall
{
/// Fine voxels per coarse voxel along each axis, at least 1.
using Factors = std::array<int, 3>;

/// The same box with voxels `factor` times as large; axes of one voxel stay as they are.
/// @return nothing where an axis has not a whole number of them
std::optional<Factors> CoarseningBy(int factor, const Grid& grid);

Grid Coarsened(const Grid& fine, const Factors& factors);
Grid Refined(const Grid& coarse, const Factors& factors);

/// How many voxels of `fine` make one of `coarse`, the same box to a thousandth of a voxel; nothing where there is no
/// whole number.
std::optional<Factors> FactorsBetween(const Grid& fine, const Grid& coarse);

/// Means over the voxels of the coarse grid. NaN where one of them is.
/// @param values  `components` per voxel of `fine`, x fastest
std::vector<float> Averaged(const float* values, int components, const Grid& fine, const Factors& factors);

/// Each coarse voxel's value in all of its fine ones.
/// @param values  `components` per voxel of `coarse`, x fastest
std::vector<float> Repeated(const float* values, int components, const Grid& coarse, const Factors& factors);
}
