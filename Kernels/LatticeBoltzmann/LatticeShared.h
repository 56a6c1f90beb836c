// Shared by C++ and the kernels of the lattice.
#pragma once

#include "Device/SharedTypes.h"

/// Lattice directions: link vectors in voxels (x, y, z); direction 2 k + 1 is opposite to 2 k.
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
  LatticeFirst = 16, ///< index of a row's first voxel, chosen so that rows are aligned for vector loads
  OtherBlock = 6     ///< stands for a face number of the grid: another block lies beyond
};

/// Memory layout of a lattice: voxels with a halo of one layer, in rows of `row` values, the first voxel at
/// LatticeFirst.
typedef struct
{
  int size[3]; ///< voxels
  int row, layer;
  int periodic;      ///< bit mask of the periodic axes
  int inner;         ///< bit mask of the faces -x, +x, ... +z beyond which another block lies
  int offset[18];    ///< index offset from a voxel to its neighbour along each direction
  float albedo[6];   ///< albedo of the faces -x, +x, ... +z
  float incoming[6]; ///< fluence / n^2 of the diffuse light outside each face, W / length^2
  ulong stride;      ///< stride of the densities between directions
  int steps;         ///< with blocks: steps until they exchange light
} LatticeInfo;

/// A sweep along the lines of links of a pair of directions.
typedef struct
{
  LatticeInfo lattice; ///< with no incoming light if the sweep is without sources
  int pair;            ///< directions 2 pair and 2 pair + 1
  int writes;          ///< 1: also write densities, in the layout of step_lattice
} LinePass;
SHARED_END

#ifndef __OPENCL_C_VERSION__
namespace tyndall
{
inline constexpr int LatticeWays[18][3] = LATTICE_WAYS;
}
#endif
