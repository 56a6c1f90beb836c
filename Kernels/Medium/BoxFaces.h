#pragma once

#include "Medium/Grid.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// The face, of -x, +x, -y, +y, -z, +z, that light comes in through which goes up or down an axis.
inline int EntryFace(int axis, bool up)
{
  return 2 * axis + (up ? 0 : 1);
}

/// A voxel's face on a face of the box.
struct BoxFaceCell
{
  std::size_t number; ///< among all: faces -x, +x, -y, +y, -z, +z, of each row by row, the lower axis first
  int face, u, v;     ///< u along the lower of the two axes across
  std::size_t voxel;
  std::size_t inward; ///< the voxel behind it; itself where there is none
};

/// How the cells of a face of the box are numbered among those of all.
struct BoxFaceLayout
{
  std::size_t first;
  std::array<std::size_t, 3> step; ///< from a cell to the next along each axis; 0 across the face
};

inline BoxFaceLayout LayoutOfFace(const Grid& grid, int face)
{
  BoxFaceLayout layout = { 0, {} };
  for (int before = 0; before < face; ++before)
  {
    layout.first += grid.VoxelCount() / grid.size[before / 2];
  }
  const PlaneAxes axes = AcrossAxis(face / 2);
  layout.step[axes.u] = 1;
  layout.step[axes.v] = grid.size[axes.u];
  return layout;
}

/// Calls act(cell) for every cell of the box's faces, in order.
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

/// Cosines to the outward normal at which the radiance that leaves a cell is given; a cubic through them is within 0.5%
/// of Chandrasekhar's H from 0.03 on.
constexpr std::array<double, 4> SurfaceCosines = { 0.05, 0.25, 0.6, 1.0 };

/// Mean free paths of a voxel across a face of the box from which on the light at its surface is not that at its
/// centre.
constexpr double ThickAtSurface = 0.5;
}
