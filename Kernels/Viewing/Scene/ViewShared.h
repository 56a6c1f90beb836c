// Shared by C++ and the kernels of the ray caster.
#pragma once

#include "Device/SharedTypes.h"
#include "Medium/BrickShared.h"

SHARED_BEGIN
enum
{
  // Number of rows of the phase function tables; each table has one more row after its last.
  SchlickRows = 1024,
  CosineRows = 2048,
  SpreadRows = 128,
  AureoleColumns = 1024,     // by cosine
  AureoleRows = 64,          // by the square root of the optical length
  AureoleDepth = 40,         // the largest optical length
  SampleEdge = BrickEdge + 1 // samples along an edge of a brick of cells (SampleBricks)
};

/// Parameters of a phase function, for red, green and blue.
typedef struct
{
  float4 first;  ///< g; for two lobes, g of the first
  float4 second; ///< g of the second lobe
  float4 part;   ///< fraction of the light in the first lobe
} PhaseInfo;

/// Number of components of each array of the medium and its light: 0 (no array), 1 or 3.
typedef struct
{
  int absorption, scattering, emission, fluence, unscattered, meanCosines, straightOn;
  int direct; ///< 6 if shadow rays found the light of the lamps
} ViewedComponents;

/// Parameters of the kernels that pack samples.
typedef struct
{
  int4 size;   ///< voxels
  int4 bricks; ///< number of bricks along each axis
  int4 known;  ///< voxels whose gradient of n^2 is stored
  int4 before; ///< how many of them precede the first sample, along each axis
  ViewedComponents components;
  int single; ///< 1: only single scattering
  float g;    ///< mean cosine, if it is the same in all voxels
} PackInfo;

/// A block of a larger grid, see GridBlock; indices of voxels of the whole grid.
typedef struct
{
  int4 whole; ///< size of the whole grid; 0: the medium is not a block
  int4 first; ///< first voxel of the block's arrays; w = 1: shows the background to rays that miss the domain
  int4 begin, end;
} BlockInfo;

/// The picture and its camera.
typedef struct
{
  float4 eye;     ///< position, voxels; w = 0: perspective, 1: parallel projection
  float4 forward; ///< unit vector, world
  /// from the picture's centre to its right edge: world length at unit distance, or world length in a parallel
  /// projection; w: shift of the picture's centre (Camera::shift), in such lengths
  float4 right;
  float4 up;             ///< to the upper edge, likewise; w: shift
  float4 inverseSpacing; ///< voxels per length
  float4 background;     ///< W / (length^2 sr), added to the environment; w = 0: nothing behind the medium is shown
  float4 marching;       ///< step in voxels, transmittance at which rays stop, depth that stands for none
  int4 picture;          ///< width and height in pixels, first row and first column of packets
  int4 size;             ///< voxels; for rays that travel between blocks (RayRounds.cl) those of the whole grid
  int4 held;             ///< voxels of the block's arrays, for such rays
  int4 bricks;           ///< number of bricks along each axis
  int4 environment;      ///< width and height in pixels, 0: no environment; bit mask of reflecting faces
  int4 backdrop;         ///< where environment, ground, surface light and table begin in the backdrop's array
  int4 range;            ///< first ray of a launch and the one after its last, for rays that travel between blocks
  float4 toPicture[3];   ///< rows of the matrix from world axes to the environment's axes
  /// Flags, 1: rays end at a depth given for each pixel; other blocks are in front of this one, whose transmittance is
  /// given; there is surface light for optically thick voxels; rays skip empty bricks.
  int4 has;
  BlockInfo block;
  PhaseInfo phase;
} ViewInfo;

/// Parameters of surface, table and bent rays.
typedef struct
{
  float4 spacing; ///< length per voxel
  float4 surface; ///< n^2 at the surface, reflectance, distance in voxels at which the indices on both sides are taken
  float4 table;   ///< diffuse reflectance of the channels, specular reflectance
  /// axis of the table; 1 at its upper and 0 at its lower end; voxels along the rows of this face; 1: there is a table
  int4 face;
  float4 flip; ///< factors of a direction's components in a reflection by the table
  int4 limits; ///< most steps of a ray, steps of a stretch of the leapfrog, bisections that locate the surface
  // For a block whose rays travel between blocks: the voxels of the whole grid whose gradient of n^2 is stored.
  int4 knownFirst, knownSize;
} OpticsInfo;

/// Kernel parameters of a picture, or of one of the two passes of a picture of angular moments.
typedef struct
{
  ViewInfo view;
  OpticsInfo optics;
} RayPass;

enum
{
  // States and kinds of a RayOnItsWay.
  RayGoesOn = 0,
  RayIsOut = 1,  // has left the domain and will see the background
  RayMisses = 2, // misses the domain
  RayHasEnded = 3,
  RayIsPrimary = 0,
  RayIsReflected = 1, // by the surface
  RayIsMirrored = 2   // by the table
};

/// Complete state of a ray that travels from one block to another, or has ended. Positions are in voxels of the whole
/// grid.
typedef struct
{
  int pixel;    ///< index in the picture; -1: no ray
  int kind;     ///< RayIsPrimary, ...
  int state;    ///< RayGoesOn, ...
  int steps;    ///< number of steps so far
  int where[3]; ///< voxel that contains the midpoint of the next step or, once the ray has left the box, its position
  int met;      ///< nonzero: the surface was already met, or is not searched for
  float at[3], velocity[3];
  float left[3];     ///< transmittance for light from behind
  float radiance[3]; ///< accumulated, divided by n^2
  float halfWay[4];  ///< step in which the transmittance fell below 1/2: start, length, transmittance before, after
  float square;      ///< n^2 at the midpoint of the last bent step
  float since;       ///< time since that midpoint; negative: n^2 must be sampled first
  float entrySquare; ///< n^2 at the primary ray's entry
  float seen, depth; ///< once ended: mean transmittance, and depth at which it was 1/2
} RayOnItsWay;

/// A light for shadow rays: a parallel beam or a point light.
typedef struct
{
  /// world position relative to the lower corner of the whole domain; w = 1: point light, 0: parallel beam
  float4 place;
  float4 axis; ///< unit vector along which the light travels; w: tangent of a quarter of the cone's angle, 0: no cone
  /// irradiance, or radiant intensity along the axis; w = 1: proportional to the cosine to the axis, 0: constant
  float4 power;
} SmallLight;

/// Parameters of the shadow ray kernels.
typedef struct
{
  float4 spacing;  ///< length per voxel
  float4 eye;      ///< world position relative to the same corner; w = 0: perspective, 1: parallel projection
  float4 forward;  ///< unit vector, world
  int4 size;       ///< voxels
  int4 bricks;     ///< number of bricks along each axis
  BlockInfo block; ///< place of the medium in the whole grid; `first` is 0 if there are no other blocks
  int4 asked;      ///< first voxel, in the whole grid, of the box for which optical lengths are requested
  int4 askedSize;  ///< size of that box, voxels
  PhaseInfo phase; ///< if it is the same in all voxels
  ViewedComponents components; ///< number of components of the medium's arrays
  float step;                  ///< voxels
  /// smallest squared distance used in 1/r^2: keeps a voxel that contains a light finite, at 3/R^2, the mean of 1/r^2
  /// in a ball of the same volume
  float nearestSquare;
  int firstLight, lights;   ///< range of lights [firstLight, lights)
  int firstSlice, firstRow; ///< offsets of this launch
  int beside;               ///< 1: also in voxels that have a scattering neighbour
  int isGiven;              ///< 1: optical lengths towards the light are given, for a block of a larger grid
} ShadowInfo;
SHARED_END
