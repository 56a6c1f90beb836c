#pragma once

#include "Distribution/Halo.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <cstddef>

namespace tyndall
{
constexpr auto Outside = static_cast<std::size_t>(-1); ///< index that stands for no voxel

/// Box of the voxels that this rank solves (own voxels) within those whose coefficients it has (known voxels). On one
/// rank all voxels are own voxels. On several ranks the known voxels are the rank's block and its ghost voxels, which
/// wrap around periodic axes.
struct LatticeBox
{
  /// Box of a serial lattice: own and known voxels are the whole grid.
  LatticeBox(const Grid& whole, const std::array<bool, 3>& periodicAxes)
    : known(whole)
    , own({ { 0, 0, 0 }, whole.size })
    , periodic(periodicAxes)
  {
  }
  /// Box of a rank's block with its ghost voxels.
  explicit LatticeBox(const Halo& halo)
    : known(halo.KnownGrid())
    , own(halo.Own())
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool wraps = halo.Periodic()[axis];
      const bool below = wraps || this->own.first[axis] > 0;
      const bool above = wraps || EndOf(this->own, axis) < halo.Whole().size[axis];
      this->innerFaces |= (below ? 1 : 0) << 2 * axis | (above ? 2 : 0) << 2 * axis;
      this->own.first[axis] -= halo.Known().first[axis];
    }
  }

  std::size_t Count() const { return this->own.VoxelCount(); }
  bool IsAll() const { return this->Count() == this->known.VoxelCount(); }

  /// Index, among the known voxels (own and ghost voxels), of the voxel with index `voxel` in this rank's block.
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
  /// Index, among the known voxels (own and ghost voxels), of the voxel at given indices along the axes.
  /// @param at  indices relative to the first own voxel; may be those of a ghost voxel
  std::size_t Known(std::array<int, 3> at) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      at[axis] += this->own.first[axis];
    }
    return this->known.IndexOf(at);
  }

  /// Index of the neighbour of a known voxel (own or ghost voxel) across its face -x, +x, ... +z, among the known
  /// voxels; Outside if there is none.
  std::size_t Beyond(std::size_t voxel, std::size_t face) const
  {
    return this->Beyond(this->known.VoxelAt(voxel), face);
  }
  std::size_t Beyond(std::array<int, 3> at, std::size_t face) const
  {
    const std::size_t axis = face / 2;
    at[axis] += face % 2 == 0 ? -1 : 1;
    const int size = this->known.size[axis];
    if ((at[axis] < 0 || at[axis] >= size) && !this->periodic[axis])
    {
      return Outside;
    }
    at[axis] = at[axis] < 0 ? size - 1 : at[axis] < size ? at[axis] : 0;
    return this->known.IndexOf(at);
  }

  Grid known;
  VoxelBox own;       ///< box of the own voxels, in voxels of `known`
  int innerFaces = 0; ///< bits of the faces -x, +x, ... +z of `own` beyond which ghost voxels lie
  /// Periodic axes whose two ends both lie within `known`; a block with ghost voxels has none.
  std::array<bool, 3> periodic = {};
};
}
