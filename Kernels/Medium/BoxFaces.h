#pragma once

#include "Medium/Grid.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// Index of the face (0 to 5: -x, +x, -y, +y, -z, +z) through which light enters. The light travels along `axis`, in
/// the positive direction if `up`.
inline int EntryFace(int axis, bool up)
{
  return 2 * axis + (up ? 0 : 1);
}

/// A face cell: the face of a boundary voxel that lies on a face of the box.
struct BoxFaceCell
{
  /// Index among the cells of all faces. Faces are in the order -x, +x, -y, +y, -z, +z; within a face the lower of its
  /// two axes varies fastest.
  std::size_t number;
  /// `face`: index of the box's face. `u`, `v`: position of the cell in that face, u along the lower of its two axes.
  int face, u, v;
  std::size_t voxel;
  std::size_t inward; ///< index of the next voxel inwards from `voxel`; `voxel` if there is none
};

/// Numbering of the cells of one face of the box. Cells of all faces are numbered together; `first` is the index of the
/// first cell of this face.
struct BoxFaceLayout
{
  std::size_t first;
  /// Difference of the indices of neighbouring cells along each axis; 0 along the face's normal.
  std::array<std::size_t, 3> step;

  /// Index of the cell at a boundary voxel.
  std::size_t CellAt(const std::array<int, 3>& voxel) const
  {
    return this->first + voxel[0] * this->step[0] + voxel[1] * this->step[1] + voxel[2] * this->step[2];
  }
};

inline BoxFaceLayout LayoutOfFace(const Grid& grid, int face)
{
  BoxFaceLayout layout = { 0, {} };
  for (int before = 0; before < face; ++before)
  {
    const PlaneAxes across = AcrossAxis(before / 2);
    layout.first += static_cast<std::size_t>(grid.size[across.u]) * grid.size[across.v];
  }
  const PlaneAxes axes = AcrossAxis(face / 2);
  layout.step[axes.u] = 1;
  layout.step[axes.v] = grid.size[axes.u];
  return layout;
}

/// Calls act(BoxFaceCell) for every cell of the box's faces, in ascending order of their index.
template <class Act>
void ForBoxFaceCells(const Grid& grid, const Act& act)
{
  const std::array<std::size_t, 3> step = grid.Strides();
  std::size_t number = 0;
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2;
    const int u = AcrossAxis(axis).u;
    const int v = AcrossAxis(axis).v;
    const std::size_t first = face % 2 ? (grid.size[axis] - 1) * step[axis] : 0;
    for (int j = 0; j < grid.size[v]; ++j)
    {
      for (int i = 0; i < grid.size[u]; ++i)
      {
        const std::size_t voxel = first + i * step[u] + j * step[v];
        const std::size_t inward = grid.size[axis] == 1 ? voxel : face % 2 ? voxel - step[axis] : voxel + step[axis];
        act(BoxFaceCell{ number++, face, i, j, voxel, inward });
      }
    }
  }
}

inline std::size_t BoxFaceCellCount(const Grid& grid)
{
  const std::array<int, 3>& n = grid.size;
  return 2 *
    (static_cast<std::size_t>(n[0]) * n[1] + static_cast<std::size_t>(n[1]) * n[2] +
      static_cast<std::size_t>(n[2]) * n[0]);
}

/// Cosines to the outward normal at which the outgoing radiance of a face cell is tabulated. Cubic interpolation
/// between these cosines reproduces Chandrasekhar's H function within 0.5% for cosines of at least 0.03.
constexpr std::array<double, 4> SurfaceCosines = { 0.05, 0.25, 0.6, 1.0 };

/// If the optical thickness of a boundary voxel along the face's normal is above this, the light at its surface is
/// distinguished from the light at its centre.
constexpr double ThickAtSurface = 0.5;
}
