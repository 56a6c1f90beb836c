// Structures and constants shared by C++ and the kernels of the ray caster.
#pragma once

#include "Device/SharedTypes.h"
#include "Medium/BrickShared.h"

SHARED_BEGIN
enum
{
  // Number of rows of the tables of the phase function. Each table has one more row than this.
  SchlickRows = 1024,
  CosineRows = 2048,
  SpreadRows = 128,
  // Size of an aureole table (AureoleTable in SeenSources.h), which holds the light of a beam that was scattered
  // forwards more than once. Columns: cosine of the scattering angle. Rows: square root of the optical length of
  // scattering along the beam, whose largest value is AureoleDepth.
  AureoleColumns = 1024,
  AureoleRows = 64,
  AureoleDepth = 40,
  SampleEdge = BrickEdge + 1 // number of samples along an edge of a brick of cells (SampleBricks)
};

/// Parameters of a phase function, for red, green and blue.
typedef struct
{
  float4 first;  ///< mean cosine g of the phase function; for two lobes, of the first lobe
  float4 second; ///< mean cosine g of the second lobe
  float4 part;   ///< fraction of the light that is scattered in the first lobe
} PhaseInfo;

/// Number of components, 0 (no array), 1 or 3, of each array of the medium and its light.
typedef struct
{
  int absorption, scattering, emission, fluence, unscattered, meanCosines, straightOn;
  int direct; ///< values per voxel of the lamps' light: 6 if shadow rays computed it, else 0
} ViewedComponents;

/// Parameters of the kernels that pack samples.
typedef struct
{
  int4 size;   ///< number of voxels along each axis
  int4 bricks; ///< number of bricks, cubes of 8^3 voxels, along each axis
  int4 known;  ///< number of voxels along each axis whose gradient of n^2 is stored
  int4 before; ///< number of these voxels that precede the first voxel of the medium's arrays, along each axis
  ViewedComponents components;
  int single; ///< 1: only light that was scattered once is shown
  float g;    ///< mean cosine g of the phase function, if it is equal in all voxels
} PackInfo;

/// Flags that say what packed samples hold. They have the values of the macros COLOURED, GREY, BRICKED, GLOW, BENDS and
/// SHOWN of the kernels that pack the samples.
typedef struct
{
  int coloured, grey, bricked, glow, bends, shown;
} SampleTraits;

/// A block of a larger grid, see GridBlock; all indices are those of voxels of the whole grid.
typedef struct
{
  int4 whole; ///< size of the whole grid, voxels; 0: the medium is not a block
  /// First voxel of the block's arrays; w = 1: the block shows the background to rays that miss the domain.
  int4 first;
  int4 begin, end; ///< first of the block's own voxels, and the one after its last, along each axis
} BlockInfo;

/// Parameters of the picture, its camera and the march.
typedef struct
{
  float4 eye;     ///< position of the camera, voxels; w = 0: perspective, 1: parallel projection
  float4 forward; ///< view axis, unit vector in world coordinates
  /// vector from the picture's centre to its right edge, in world coordinates. Perspective: at unit distance from the
  /// eye. Parallel projection: in units of length. w: shift of the picture's centre (Camera::shift), in units of this
  /// vector
  float4 right;
  /// vector from the picture's centre to its upper edge, as `right`; w: shift upwards
  float4 up;
  float4 inverseSpacing; ///< voxels per length along each axis
  /// radiance of the background, W / (length^2 sr), added to that of the environment; w = 0: no background is shown
  float4 background;
  /// x: step of the march in voxels; y: transmittance at which rays stop; z: depth of pixels whose transmittance stays
  /// above 1/2; w: 1 if the optical length of every step is at most 2, so that a faster formula applies, else 0
  float4 marching;
  /// x, y: width and height in pixels; z, w: first row and first column of a launch, in packets of rays (z in pixels
  /// for start_rays of RayRounds.cl)
  int4 picture;
  /// number of voxels along each axis; of the whole grid for rays that travel between blocks (RayRounds.cl)
  int4 size;
  int4 held;   ///< number of voxels of the block's arrays, for rays that travel between blocks
  int4 bricks; ///< number of bricks, cubes of 8^3 voxels, along each axis
  /// x, y: width and height of the environment in pixels, 0: no environment; z: bit mask of faces (Backdrop::FaceBits)
  int4 environment;
  /// indices in the array Backdrop::Tables at which the tables begin: x environment, y reflecting faces, z correction
  /// for light at the surface, w irradiance of the scene's table
  int4 backdrop;
  /// x, y: first ray of a launch and the one after its last, for rays that travel between blocks
  int4 range;
  float4 toPicture[3]; ///< rows of the matrix from world axes to the environment's axes
  /// Flags. x: rays end at a depth given for each pixel. y: the transmittance of the blocks in front is given for each
  /// pixel. z: there is a correction for light at the surface of optically thick voxels. w: rays skip empty bricks.
  int4 has;
  BlockInfo block;
  PhaseInfo phase;
} ViewInfo;

/// Parameters of the surface, the table and bent rays.
typedef struct
{
  float4 spacing; ///< edges of a voxel, in units of length
  /// x: n^2 at the reflecting surface; y: its reflectance, if constant; z: distance in voxels from the surface at which
  /// the indices on both sides are read
  float4 surface;
  /// The scene's table, a plane at a face of the box: diffuse reflectance of red, green, blue (x, y, z); specular
  /// reflectance (w).
  float4 table;
  /// The face of the box at which the scene's table lies. x: axis of its normal; y: 1 for the upper and 0 for the lower
  /// face along this axis; z: voxels along the rows of the face; w: 1 if there is a table.
  int4 face;
  float4 flip; ///< factors by which reflection at the table multiplies the components of a direction
  /// x: largest number of steps of a ray; y: number of leapfrog steps between two checks of the index; z: number of
  /// bisections that locate the reflecting surface, where the index rises through a given value; w: its reflectance: 0
  /// no surface, 1 by Fresnel's equations, 2 constant
  int4 limits;
  // For a block whose rays travel between blocks: the voxels of the whole grid whose gradient of n^2 is stored.
  int4 knownFirst, knownSize;
} OpticsInfo;

/// Kernel parameters of a picture. A picture made of angular moments has two passes, one for scattered and one for
/// unscattered light; each has its own parameters.
typedef struct
{
  ViewInfo view;
  OpticsInfo optics;
} RayPass;

enum
{
  // Values of RayOnItsWay::state (RayGoesOn to RayHasEnded), and of RayOnItsWay::kind (RayIsPrimary to RayIsMirrored).
  RayGoesOn = 0,
  RayIsOut = 1,  // the ray has left the domain and has not yet received the background
  RayMisses = 2, // the ray misses the domain, and has not yet received the background
  RayHasEnded = 3,
  RayIsPrimary = 0,
  RayIsReflected = 1, // the ray was reflected by the surface
  RayIsMirrored = 2   // the ray was mirrored by the table
};

/// Complete state of a ray that travels from one block to another, or has ended. Positions are in voxels of the whole
/// grid.
typedef struct
{
  int pixel; ///< index of the pixel in the picture; -1: no ray
  int kind;  ///< RayIsPrimary, RayIsReflected or RayIsMirrored
  int state; ///< RayGoesOn, RayIsOut, RayMisses or RayHasEnded
  int steps; ///< number of steps since the ray's entry into the domain
  /// Indices of the voxel that contains the midpoint of the next step. If the ray has left the box: the voxel of its
  /// position.
  int where[3];
  /// Nonzero if the surface must not split the ray, for example because it has already met the surface.
  int met;
  float at[3], velocity[3];
  float left[3];     ///< transmittance from the eye to the current point
  float radiance[3]; ///< accumulated radiance, divided by n^2
  /// The step in which the transmittance fell below 1/2: start, length, transmittance before and after.
  float halfWay[4];
  float square;      ///< n^2 at the midpoint of the last bent step
  float since;       ///< time t since that midpoint (RayPackets.cl); negative: n^2 is unknown and must be sampled first
  float entrySquare; ///< n^2 at the primary ray's entry into the domain
  /// Set once the ray has ended: transmittance, mean over the channels, and depth at which it was 1/2.
  float seen, depth;
} RayOnItsWay;

/// A light for shadow rays: a parallel beam or a point light, of which other lights are composed.
typedef struct
{
  /// Position relative to the lower corner of the whole domain, world coordinates; w = 1: point light, 0: parallel
  /// beam.
  float4 place;
  /// Unit vector along which the light travels; w: tangent of a quarter of the cone's angle, 0: no cone.
  float4 axis;
  /// Irradiance of a beam, or radiant intensity of a point light along its axis; w = 1: proportional to the cosine of
  /// the angle to the axis, 0: constant.
  float4 power;
} SmallLight;

/// Parameters of the kernels of shadow rays.
typedef struct
{
  float4 spacing; ///< edges of a voxel, in units of length
  /// Position of the camera relative to the lower corner of the whole domain, world coordinates; w = 0: perspective, 1:
  /// parallel projection.
  float4 eye;
  float4 forward;  ///< view axis, unit vector in world coordinates
  int4 size;       ///< number of voxels along each axis
  int4 bricks;     ///< number of bricks, cubes of 8^3 voxels, along each axis
  BlockInfo block; ///< the block, if the medium is a block of a larger grid; else its `first` is 0
  /// First voxel, in the whole grid, of the box for whose voxels optical lengths are computed.
  int4 asked;
  int4 askedSize;              ///< size of the box that begins at `asked`, voxels
  PhaseInfo phase;             ///< phase function, if it is equal in all voxels
  ViewedComponents components; ///< number of components of the medium's arrays
  float step;                  ///< step of the march, voxels
  /// Lower bound of r^2 in the inverse-square law 1 / r^2, so that irradiance stays finite in a voxel that contains a
  /// light. The largest 1 / r^2 is then 3 / R^2, the mean of 1 / r^2 over a ball of radius R with the voxel's volume.
  float nearestSquare;
  int firstLight, lights;   ///< lights of this launch, [firstLight, lights)
  int firstSlice, firstRow; ///< first slice and first row of voxels of this launch
  int beside;               ///< 1: light is also computed in voxels that do not scatter but have a scattering neighbour
  int isGiven; ///< 1: optical lengths towards the light are given (for a block of a larger grid) and not computed
} ShadowInfo;
SHARED_END
