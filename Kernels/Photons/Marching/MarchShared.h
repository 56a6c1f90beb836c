// Shared by C++ and the kernels that march and scatter photons, and sum their deposits.
#pragma once

#include "Device/SharedTypes.h"
#include "Refraction/Index/IndexShared.h"

SHARED_BEGIN
enum
{
  EndWords = 3, ///< integers of a PhotonEnd, which precede its powers
  /// Face of a photon that has not ended; from this value on, `face` is not a face of the volume.
  StillGoing = 6,
  Dark = 7,     ///< the photon has no power left
  Elsewhere = 8 ///< the photon continues in another block of the grid
};

/// Maximum look-ahead of the integrator along each axis, in half steps: more than twice what it needs where n is
/// smooth.
enum
{
  LeapfrogLooksAhead = 3, ///< the leapfrog looks half a step ahead where n is smooth
  YoshidaLooksAhead = 6   ///< Yoshida's integrator looks 1.35 steps ahead there
};

/// Level of the largest octree cube that a step of order 4 crosses. The integrator's look-ahead along an axis is at
/// most the edge of that cube, 2^4 voxels, or the half steps above, whichever is longer.
enum
{
  YoshidaLevel = 4
};

/// The medium, and the parameters of marching. Positions are in the whole grid; arrays cover one block of it.
typedef struct
{
  IndexGrid grid;    ///< size of the block: extinction and sums
  IndexGrid whole;   ///< size of the whole grid
  IndexGrid known;   ///< size of the region with a refractive index: the block and its halo
  int first[3];      ///< first voxel of the block in the whole grid
  int knownFirst[3]; ///< first voxel of `known` in the whole grid
  float spacing[3];  ///< edges of a voxel over its diagonal
  float stepSize;    ///< length of a step in voxels, where the octree has single voxels
  float slowest;     ///< lower bound of the speed, voxels per time, from which the duration of a step is computed
  float darkness;    ///< power below which a photon counts as extinguished
  int eventLimit;    ///< maximum number of path segments (walls and velocity changes) of a photon
  ulong copy;        ///< voxels of the padded grid
} MarchInfo;

/// The photons of one launch of a kernel of PhotonMarch.cl, and where they deposit.
typedef struct
{
  ulong copyStride;    ///< numbers from copy to copy of the sums
  int copies, batches; ///< of the sums, at least as many copies as batches; copy c belongs to batch c modulo batches
  int first, count;    ///< photons within each batch
  int resumes;         ///< 1: photons that are under way; 0: photons that start
  int events;          ///< number of path segments in a turn
  int last;            ///< 1: photons that have not ended are given up after this turn
  int writes;          ///< 1: vertices of paths are written; 0: they are counted
} MarchLaunch;

/// What became of a photon. In kernels, the remaining power of each channel follows.
typedef struct
{
  int face;      ///< face through which it left, -x, +x, ... +z; or StillGoing, Dark, Elsewhere
  int crossings; ///< path segments that were deposited
  int steps;     ///< steps of the integrator
#ifdef __OPENCL_C_VERSION__
  float power[CHANNELS];
#endif
} PhotonEnd;

/// State of a photon's path as it passes into another block: everything that the rest of the path depends on, so that
/// it is the same, bit for bit, as on an undivided grid. In the kernels' units.
typedef struct
{
  int voxel[3];   ///< the voxel of the whole grid that it enters
  float wall[3];  ///< time at which it reaches the next wall along each axis
  float now;      ///< time since the step began
  float turn;     ///< time when the step ends
  float settled;  ///< time before which a varying index does not start a new step
  float step;     ///< duration of the current step
  float start[3]; ///< position at which the step began
  float velocity[3];
  float momentum[3];
} WayOnward;

/// A photon that passes from one block of a grid into another. Only the channels in use are valid.
typedef struct
{
  ulong mark; ///< its mark, see PhotonMarch.cl
  WayOnward way;
  int batch;     ///< its batch
  int counted;   ///< coarse cell that counted it last
  int crossings; ///< path segments that were deposited
  int steps;     ///< steps of the integrator
  float power[3];
  float owed[3]; ///< compensation of rounding errors in `power` (Kahan)
} PhotonOnItsWay;

enum
{
  CountShift = 40 ///< bit position of photon counts, above the bits of weights
};

/// Parameters of the conversion of sums to light.
typedef struct
{
  IndexGrid grid;
  float diagonal;             ///< length of a voxel's diagonal
  float fluence;              ///< W / length^2 per unit of power along a voxel's diagonal, divided by 2^exponent
  int exponent;               ///< kept apart, as the product may be below the range of float
  float colour[3];            ///< colour of the single channel, if CHANNELS is 1
  float weight;               ///< photon weight per unit of the sums
  int absorption, scattering; ///< components of sigma_a and sigma_s; 0: absent
  int copies, batches;        ///< of the sums: copy c belongs to batch c modulo batches
} LightSumsInfo;

/// Parameters of a launch that follows photons beyond their first scattering.
typedef struct
{
  ulong seed;
  ulong copyStride; ///< numbers from copy to copy of the sums
  /// Maximum number of scatterings of a photon; it is given up where it would be scattered once more.
  int mostScatterings;
  int first, count; ///< the photons of the launch
  int resumes;      ///< 1: photons that have arrived from other blocks; 0: photons that start
} ScatterInfo;

/// What became of a photon; powers are in units.
typedef struct
{
  int face;              ///< as PhotonEnd::face
  int scatterings;       ///< number of its scatterings
  float power;           ///< power left when it ended
  float absorbedAtFirst; ///< power absorbed before its first scattering
  float exchanged;       ///< net power added to it by Russian roulette
} ScatterEnd;

/// A photon that passes from one block of a grid into another, with all that its further path and scatterings depend
/// on.
typedef struct
{
  ulong number; ///< key of its random numbers
  WayOnward way;
  uint blocks; ///< number of blocks of random numbers it has drawn
  int drawn;   ///< unused numbers of the last block
  int events;  ///< path segments since its last scattering; 0: it starts anew, in the direction `way.velocity`
  int scatterings;
  float depth;                             ///< optical depth to the next scattering
  float dim;                               ///< power below which Russian roulette is played
  float power, absorbedAtFirst, exchanged; ///< as in ScatterEnd
} ScatteredOnItsWay;
SHARED_END
