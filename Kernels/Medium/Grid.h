#pragma once

#include <array>
#include <cstddef>

namespace tyndall
{
/// A box of voxels. Voxel (i, j, k) covers [origin + (i, j, k) spacing, origin + (i+1, j+1, k+1) spacing]; arrays over
/// it have x fastest. Lengths in the dataset's own unit.
struct Grid
{
  std::array<int, 3> size = { 1, 1, 1 };             ///< voxels per axis, at least 1
  std::array<double, 3> spacing = { 1.0, 1.0, 1.0 }; ///< edges of a voxel, > 0
  std::array<double, 3> origin = { 0.0, 0.0, 0.0 };  ///< the box's lower corner

  std::size_t VoxelCount() const
  {
    return static_cast<std::size_t>(this->size[0]) * static_cast<std::size_t>(this->size[1]) *
      static_cast<std::size_t>(this->size[2]);
  }
  double VoxelVolume() const { return this->spacing[0] * this->spacing[1] * this->spacing[2]; }
  double Length(int axis) const { return this->size[axis] * this->spacing[axis]; }
};

/// The axes of a plane across `axis`: u is the lower of both, and runs along rows in memory.
struct PlaneAxes
{
  int axis, u, v;
};
constexpr PlaneAxes AcrossAxis(int axis)
{
  return { axis, axis == 0 ? 1 : 0, axis == 2 ? 1 : 2 };
}
}
