// Shared by C++ and the kernels of the lattice.
#pragma once

#include "Device/SharedTypes.h"

/// Steps along the links, x, y, z; direction 2 k + 1 is opposite to 2 k.
#define LATTICE_WAYS                                                                                                  \
  {                                                                                                                   \
    { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 }, { 1, 1, 0 }, { -1, -1, 0 },      \
      { 1, -1, 0 }, { -1, 1, 0 }, { 1, 0, 1 }, { -1, 0, -1 }, { 1, 0, -1 }, { -1, 0, 1 }, { 0, 1, 1 }, { 0, -1, -1 }, \
      { 0, 1, -1 },                                                                                                   \
    {                                                                                                                 \
      0, -1, 1                                                                                                        \
    }                                                                                                                 \
  }

SHARED_BEGIN
enum
{
  LatticeFirst = 16, ///< place of a row's first voxel, so that rows are aligned as vectors are
  OtherBlock = 6     ///< in place of a face of the grid: beyond it lies another block
};

/// A lattice in memory: voxels with one layer around them, rows of `row` values, the first voxel at LatticeFirst.
typedef struct
{
  int size[3]; ///< voxels
  int row, layer;
  int periodic;      ///< bits of the axes
  int inner;         ///< bits of the faces -x, +x, ... +z that are no faces of the grid: beyond them lies another block
  int offset[18];    ///< from a voxel to its neighbour along each direction
  float albedo[6];   ///< of the faces -x, +x, ... +z
  float incoming[6]; ///< W / length^2: fluence, over n^2, of the diffuse light outside each face
  ulong stride;      ///< of densities, from direction to direction
} LatticeInfo;
SHARED_END

#ifndef __OPENCL_C_VERSION__
namespace tyndall
{
inline constexpr int LatticeWays[18][3] = LATTICE_WAYS;
}
#endif
