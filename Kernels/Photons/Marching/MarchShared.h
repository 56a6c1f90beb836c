// Constants and structures shared by C++ and the kernels that march and scatter photons and sum their deposits.
#pragma once

#include "Device/SharedTypes.h"
#include "Refraction/Index/IndexShared.h"

SHARED_BEGIN
enum
{
  EndWords = 3, ///< number of integers in a PhotonEnd (final state of a photon); its powers follow them
  /// PhotonEnd::face of a photon that was terminated before it left the volume. Values from this one on denote ends
  /// that are not at a face.
  StillGoing = 6,
  Dark = 7,     ///< PhotonEnd::face of a photon with power below MarchInfo::darkness
  Elsewhere = 8 ///< PhotonEnd::face of a photon that continues in another block of the grid
};

/// Maximum look-ahead of the path integrator along each axis, in half steps. It is more than twice the look-ahead where
/// the refractive index n is smooth.
enum
{
  LeapfrogLooksAhead = 3, ///< limit of the leapfrog, which looks half a step ahead where n is smooth
  YoshidaLooksAhead = 6   ///< limit of Yoshida's integrator, which looks 1.35 steps ahead where n is smooth
};

/// Level of the largest octree cube that a step of order 4 crosses. The integrator's look-ahead along an axis is at
/// most the edge of that cube, 2^4 voxels, or YoshidaLooksAhead half steps, whichever is longer.
enum
{
  YoshidaLevel = 4
};

/// Parameters of marching through a medium. Positions are in voxels of the domain; arrays cover one block of it.
typedef struct
{
  IndexGrid grid;    ///< size of the block, for extinction and sums of deposits
  IndexGrid whole;   ///< size of the domain
  IndexGrid known;   ///< size of the region in which the refractive index is known: the block and its halo
  int first[3];      ///< first voxel of the block in the domain
  int knownFirst[3]; ///< first voxel of `known` in the domain
  float spacing[3];  ///< edges of a voxel, in units of its diagonal
  float stepSize;    ///< length of a step, in voxels, without an octree or in an octree node of a single voxel
  float slowest;     ///< lower bound of the speed, in voxels per time, from which the duration of a step is computed
  float darkness;    ///< power, in units of PackedPhotons::unit, below which a photon ends as dark
  int eventLimit;    ///< maximum number of path segments (walls and velocity changes) of a photon
  int levels;        ///< 1: there are octree levels
  ulong copy;        ///< number of records of extinction per channel: voxels of the padded grid, or records of bricks
} MarchInfo;

/// Parameters of one launch of a kernel of PhotonMarch.cl.
typedef struct
{
  ulong copyStride; ///< number of 64-bit numbers in one copy of the sums of deposits
  /// `copies`: number of copies of the sums of deposits. `batches`: number of batches of photons, at most `copies`;
  /// copy c belongs to batch c % batches.
  int copies, batches;
  int first, count; ///< first photon within each batch, and number of photons in each batch
  /// 1: photons continue, since they arrived from another block or marched in an earlier turn (a launch over a limited
  /// number of path segments); 0: photons start
  int resumes;
  int events; ///< maximum number of path segments per photon in this launch
  int last;   ///< 1: photons that have not ended after this launch are terminated
  int writes; ///< if paths are traced, 1: their vertices are written; 0: vertices are only counted
} MarchLaunch;

/// Final state of a photon that was followed without scattering. In kernels, the remaining power of each channel
/// follows.
typedef struct
{
  int face;      ///< face through which the photon left, -x, +x, ... +z; or StillGoing, Dark, Elsewhere
  int crossings; ///< number of path segments on which the photon deposited light
  /// Number of steps that the path integrator has taken for this photon, in all blocks together; 0: straight path
  int steps;
#ifdef __OPENCL_C_VERSION__
  float power[CHANNELS];
#endif
} PhotonEnd;

/// Complete state of a photon's path as it passes into another block: the path continues there bit for bit as on an
/// undivided grid. Positions are in voxels of the domain, times as in photon_lanes (PhotonSteps.cl).
typedef struct
{
  int voxel[3];  ///< voxel of the domain that the photon enters
  float wall[3]; ///< time since the step began at which the photon reaches the next wall along each axis
  float now;     ///< time since the step began
  float turn;    ///< time since the step began at which the step ends
  /// Time since the step began, before which a varying refractive index in the photon's voxel starts no new step
  float settled;
  float step;        ///< duration of the current step
  float start[3];    ///< position at which the step began
  float velocity[3]; ///< voxels per time, of the current step
  float momentum[3]; ///< T = n dx/ds of numerics.md, Eq. (90), along the path, voxels per time
} WayOnward;

/// A photon without scattering that passes from one block of the domain into another, on a straight or bent path. Only
/// the power channels in use are valid.
typedef struct
{
  /// 64-bit integer of the photon, depending on the kernel's options (PhotonMarch.cl): count and weight that it adds to
  /// voxels; or column and row of its origin; or its index
  ulong mark;
  WayOnward way;
  int batch;     ///< index of the photon's batch
  int counted;   ///< coarse cell in which the photon was last counted
  int crossings; ///< number of path segments on which the photon deposited light
  /// Number of steps that the path integrator has taken for this photon so far, in all blocks; 0: straight path
  int steps;
  float power[3]; ///< remaining power, in units of PackedPhotons::unit
  float owed[3];  ///< Kahan compensation of rounding errors in `power`
} PhotonOnItsWay;

enum
{
  CountShift = 40 ///< lowest bit of a voxel's photon count, above the bits of its sum of weights
};

/// Parameters of the conversion of the sums of photons' deposits to light.
typedef struct
{
  IndexGrid grid;
  float diagonal; ///< length of a voxel's diagonal
  /// Mantissa of the factor that converts deposits, in units of power times voxel diagonal, to fluence, W / length^2.
  /// The factor is fluence 2^exponent
  float fluence;
  /// Binary exponent of the factor from deposits to fluence, which may itself be below the range of float
  int exponent;
  float colour[3];            ///< colour of the single channel, relative to white, if CHANNELS is 1
  float weight;               ///< photon weight that counts as 1 in the voxels' integer sums of weights
  int absorption, scattering; ///< number of components of sigma_a and sigma_s; 0: absent
  /// Number of copies of the sums of deposits, and number of batches; copy c belongs to batch c % batches
  int copies, batches;
} LightSumsInfo;

/// Parameters of a launch that follows photons through scatterings.
typedef struct
{
  ulong seed;       ///< seed of the random numbers
  ulong copyStride; ///< number of 64-bit numbers in one copy of the sums of deposits
  /// Maximum number of scatterings of a photon; at the collision after the last one it is terminated.
  int mostScatterings;
  int first, count; ///< first photon of the launch, and number of photons
  int resumes;      ///< 1: photons that arrived from other blocks; 0: photons that start
} ScatterInfo;

/// Final state of a photon that was followed through scatterings; powers are in units of PackedPhotons::unit.
typedef struct
{
  int face;              ///< face through which the photon left, or another end, as PhotonEnd::face
  int scatterings;       ///< number of scatterings of the photon
  float power;           ///< power left at the end
  float absorbedAtFirst; ///< power absorbed before its first scattering
  float exchanged;       ///< net power added to the photon by Russian roulette
} ScatterEnd;

/// A photon with scattering that passes from one block of the domain into another, with the complete state on which its
/// further path and scatterings depend.
typedef struct
{
  ulong number; ///< index of the photon, which selects its sequence of random numbers
  WayOnward way;
  uint blocks; ///< number of blocks of four random numbers (Philox.cl) that the photon has drawn
  int drawn;   ///< number of unused random numbers in the last of these blocks
  int events;  ///< path segments since the last scattering; 0: the photon starts anew, in the direction `way.velocity`
  int scatterings; ///< number of scatterings of the photon
  float depth;     ///< scattering optical depth to the next collision
  float dim;       ///< power below which Russian roulette is played
  /// absorbed power that is still to be subtracted from `power`, since floats do not hold the difference
  float owed;
  float power, absorbedAtFirst, exchanged; ///< powers, in units of PackedPhotons::unit, see ScatterEnd
} ScatteredOnItsWay;
SHARED_END
