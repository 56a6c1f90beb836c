#pragma once

#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// The voxels of a lattice, among those of which it is known what they do to light: all of them, or those of a rank's
/// block, of which the ones around it are known too.
struct LatticeBox
{
  explicit LatticeBox(const Grid& all)
    : known(all)
    , own({ { 0, 0, 0 }, all.size })
  {
  }
  /// @param inner  bits of the faces -x, +x, ... +z of `voxels` behind which others lie
  LatticeBox(const Grid& all, const VoxelBox& voxels, int inner)
    : known(all)
    , own(voxels)
    , innerFaces(inner)
  {
  }

  std::size_t Count() const { return this->own.VoxelCount(); }
  bool IsAll() const { return this->Count() == this->known.VoxelCount(); }
  /// Place among the known voxels of one of the lattice.
  std::size_t Known(std::size_t voxel) const
  {
    if (this->IsAll())
    {
      return voxel;
    }
    Grid grid;
    grid.size = this->own.size;
    return this->Known(grid.VoxelAt(voxel));
  }
  /// @param at  from -1 on, as far as voxels are known
  std::size_t Known(std::array<int, 3> at) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      at[axis] += this->own.first[axis];
    }
    return this->known.IndexOf(at);
  }

  Grid known;
  VoxelBox own;
  int innerFaces = 0;
};
}
