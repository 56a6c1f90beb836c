// Shared by C++ and the kernels that march photons.
#pragma once

#include "Device/SharedTypes.h"
#include "Refraction/Index/IndexShared.h"

SHARED_BEGIN
enum
{
  EndWords = 3,   ///< integers of a PhotonEnd, before its powers
  StillGoing = 6, ///< face of a photon that has not come to its end; this and above: not a face of the volume
  Dark = 7,       ///< of one of which nothing is left
  Elsewhere = 8   ///< of one that goes on in another block of the grid
};

/// Halves of steps, along each axis, that the integrator looks ahead at most: more than twice what it does where n is
/// smooth.
enum
{
  LeapfrogLooksAhead = 3, ///< which looks half a step ahead there
  YoshidaLooksAhead = 6   ///< 1.35 steps
};

/// Level of the largest cube of an octree that a step of order 4 crosses; no way that it looks ahead along an axis is
/// longer than its edge, of 2^4 voxels, or than the halves of steps above, whichever is more.
enum
{
  YoshidaLevel = 4
};

/// The medium, and how photons are marched through it. Places are those of the whole grid; arrays have a block of it.
typedef struct
{
  IndexGrid grid;    ///< the block: of extinction and sums
  IndexGrid whole;   ///< all voxels
  IndexGrid known;   ///< of the refractive index: the block and what photons in it are bent by
  int first[3];      ///< voxel of the block, in the whole
  int knownFirst[3]; ///< voxel of `known`
  float spacing[3];  ///< over the voxel's diagonal
  float stepSize;    ///< voxels, of a step where the octree has single voxels
  float slowest;  ///< voxels per time that a photon keeps to wherever n is its least; steps are no longer than for it
  float darkness; ///< power below which nothing is left of a photon
  int eventLimit; ///< walls and turns of a photon at most
  int pause;      ///< stretches of its way after which a photon in a block waits; eventLimit or more: none does
  ulong copy;     ///< voxels of the padded grid
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

/// The way of a photon that goes from one block of a grid into another: all that it depends on from there on, so that
/// it is the same, bit for bit, as in one block. Units are those of the kernels.
typedef struct
{
  int voxel[3];   ///< of the whole grid, that it comes to
  float wall[3];  ///< time of the next one along each axis
  float now;      ///< time since the step began
  float turn;     ///< time when it ends
  float settled;  ///< time until which the last turn holds
  float step;     ///< time of the step under way
  float start[3]; ///< of the step
  float velocity[3];
  float momentum[3];
} WayOnward;

/// A photon that goes from one block of a grid into another. Only channels that there are count.
typedef struct
{
  ulong mark; ///< by which it counts
  WayOnward way;
  int batch;     ///< that it is of; the host knows
  int counted;   ///< coarse cell that counted it last
  int crossings; ///< stretches that were deposited
  int steps;     ///< of the integrator
  float power[3];
  float owed[3]; ///< what rounding has left of what voxels were to take
} PhotonOnItsWay;
SHARED_END
