// Shared by C++ and the kernels of the diffusion system.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  DiffusionChunk = 4096, ///< values that a work-item sums up before the host adds the chunks in double
  AndersonSums = 8       ///< of a chunk
};

/// The grid and arrays of one channel.
typedef struct
{
  int size[3];
  int periodic[3];
  int linear;        ///< 1: the light between voxels' centres is linear; 0: each voxel is as one
  int stride;        ///< of channels in the solver's arrays
  int firstT, first; ///< where this channel begins: of sigma_t, of all others (currents: six times that, flux: three)
  int pattern[6];    ///< where the tables of crossings begin: [axis][other axes in order]
  float spacing[3];
  float halfRange;   ///< sum over directions of w mu / 4 pi, mu > 0: 1/4 but for the direction set
  float floor;       ///< optical length between voxels' centres below which they pass no more
  float incoming[6]; ///< W / length^2 through each face of the box
  float albedo[6];   ///< part that each face gives back of what leaves through it
} DiffusionLayout;

/// Light by cells of the box's faces, W: rows of the array `faces`.
enum
{
  FaceCame = 0,  ///< came back in the sweep
  FaceGiven = 1, ///< of it, what comes back of light that was not swept
  FaceLeft = 2,  ///< left in the sweep
  FaceLeaves = 3 ///< leaves by the solution
};

/// A level of multigrid.
typedef struct
{
  int size[3];
  int halved[3]; ///< to the next coarser level
} MultigridLevel;
SHARED_END
