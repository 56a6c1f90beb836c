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
  /// used in place of the number (0 to 5) of a face of the grid if the voxel's neighbour is in another block
  OtherBlock = 6
};

/// Memory layout of a lattice: voxels with a halo of one layer, in rows of `row` values; the first voxel of a row is at
/// index LatticeFirst.
typedef struct
{
  int size[3]; ///< number of voxels along each axis
  int row, layer;
  int periodic;      ///< bit mask of the periodic axes
  int inner;         ///< bit mask of the faces -x, +x, ... +z beyond which another block lies
  int offset[18];    ///< index offset from a voxel to its neighbour along each direction
  float albedo[6];   ///< albedo of the faces -x, +x, ... +z
  float incoming[6]; ///< fluence / n^2 of the diffuse light outside each face, W / length^2
  ulong stride;      ///< number of values from the densities of one direction to those of the next
  int steps;         ///< number of steps in a block between exchanges of light
} LatticeInfo;

/// Parameters of a sweep along the lines of links (rows of voxels along a link vector) for two opposite directions
/// (LatticeLines.cl).
typedef struct
{
  /// layout of the lattice, and the light incident at its faces, which is 0 in sweeps that carry only collided light
  LatticeInfo lattice;
  int pair;   ///< directions 2 pair and 2 pair + 1
  int writes; ///< 1: the sweep also writes densities, in the layout of `lattice`
} LinePass;
SHARED_END

#ifndef __OPENCL_C_VERSION__
namespace tyndall
{
inline constexpr int LatticeWays[18][3] = LATTICE_WAYS;
}
#endif
