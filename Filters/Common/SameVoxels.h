#pragma once

#include "Medium/Grid.h"

#include <string>

namespace tyndall
{
/// Whether a grid's voxels have the same corners as those of the medium, but for rounding.
bool AreSameVoxels(const Grid& grid, const Grid& medium);

/// @param whose, remedy  for the message: "The octree", "Make the octree of the same medium."
/// @throws InvalidInput where a grid's voxels do not have the same corners as those of the medium, but for rounding
void CheckSameVoxels(const Grid& grid, const Grid& medium, const std::string& whose, const std::string& remedy);
}
