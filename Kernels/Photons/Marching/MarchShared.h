// Shared by C++ and the kernels that march photons.
#pragma once

#include "Device/SharedTypes.h"
#include "Refraction/Index/IndexShared.h"

SHARED_BEGIN
enum
{
  EndWords = 3,   ///< integers of a PhotonEnd, before its powers
  StillGoing = 6, ///< face of a photon that has not come to its end; this and above: not a face of the volume
  Dark = 7        ///< of one of which nothing is left
};

/// The medium, and how photons are marched through it.
typedef struct
{
  IndexGrid grid;
  float spacing[3]; ///< over the voxel's diagonal
  float stepSize;   ///< voxels, of a step where the octree has single voxels
  float slowest;    ///< voxels per time that a photon keeps to wherever n is its least; steps are no longer than for it
  float darkness;   ///< power below which nothing is left of a photon
  int eventLimit;   ///< walls and turns of a photon at most
  ulong copy;       ///< voxels of the padded grid
} MarchInfo;

/// What became of a photon. In kernels the power of each channel that is left of it follows.
typedef struct
{
  int face;      ///< it left through, -x, +x, ... +z; or StillGoing, Dark
  int crossings; ///< stretches of it that were deposited
  int steps;     ///< of the integrator
#ifdef __OPENCL_C_VERSION__
  float power[CHANNELS];
#endif
} PhotonEnd;
SHARED_END
