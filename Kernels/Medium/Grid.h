#pragma once

#include <array>
#include <cstddef>

namespace tyndall
{
/// A uniform grid of voxels. Voxel (i, j, k) covers [origin + (i, j, k) spacing, origin + (i+1, j+1, k+1) spacing];
/// arrays over it have x fastest. Lengths are in the dataset's own unit.
struct Grid
{
  std::array<int, 3> size = { 1, 1, 1 };             ///< number of voxels per axis, at least 1
  std::array<double, 3> spacing = { 1.0, 1.0, 1.0 }; ///< edge lengths of a voxel, > 0
  std::array<double, 3> origin = { 0.0, 0.0, 0.0 };  ///< position of the lower corner of the grid's box

  std::size_t VoxelCount() const
  {
    return static_cast<std::size_t>(this->size[0]) * static_cast<std::size_t>(this->size[1]) *
      static_cast<std::size_t>(this->size[2]);
  }
  /// Array strides: difference of array indices between neighbouring voxels along each axis.
  std::array<std::size_t, 3> Strides() const
  {
    const std::size_t x = static_cast<std::size_t>(this->size[0]);
    return { 1, x, x * static_cast<std::size_t>(this->size[1]) };
  }
  /// Array index of voxel (i, j, k).
  std::size_t IndexOf(const std::array<int, 3>& voxel) const
  {
    const std::array<std::size_t, 3> stride = this->Strides();
    return voxel[0] + voxel[1] * stride[1] + voxel[2] * stride[2];
  }
  /// Voxel (i, j, k) at an array index.
  std::array<int, 3> VoxelAt(std::size_t index) const
  {
    const std::array<std::size_t, 3> stride = this->Strides();
    return { static_cast<int>(index % stride[1]), static_cast<int>(index % stride[2] / stride[1]),
      static_cast<int>(index / stride[2]) };
  }
  double VoxelVolume() const { return this->spacing[0] * this->spacing[1] * this->spacing[2]; }
  double Length(int axis) const { return this->size[axis] * this->spacing[axis]; }
};

/// Calls act(array index, x, y, z) for each voxel of a grid of `size` voxels, x fastest.
template <class Act>
void ForGridVoxels(const std::array<int, 3>& size, const Act& act)
{
  std::size_t i = 0;
  for (int z = 0; z < size[2]; ++z)
  {
    for (int y = 0; y < size[1]; ++y)
    {
      for (int x = 0; x < size[0]; ++x, ++i)
      {
        act(i, x, y, z);
      }
    }
  }
}

/// The two axes of a plane normal to `axis`: u is the lower one, and varies faster in memory.
struct PlaneAxes
{
  int axis, u, v;
};
constexpr PlaneAxes AcrossAxis(int axis)
{
  return { axis, axis == 0 ? 1 : 0, axis == 2 ? 1 : 2 };
}
}
