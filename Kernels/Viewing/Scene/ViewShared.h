// Shared by C++ and the kernels of the ray caster.
#pragma once

#include "Device/SharedTypes.h"
#include "Medium/BrickShared.h"

SHARED_BEGIN
enum
{
  // Rows of the tables of phase functions; each table has a row more behind its last.
  SchlickRows = 1024,
  CosineRows = 2048,
  SpreadRows = 128,
  AureoleColumns = 1024, // by cosine
  AureoleRows = 64,      // by the root of the optical length
  AureoleDepth = 40      // the largest of these
};

/// What tells phase functions of one kind apart, of red, green and blue.
typedef struct
{
  float4 first;  ///< g; of two lobes that of the first
  float4 second; ///< g of the second lobe
  float4 part;   ///< of the light in the first lobe
} PhaseInfo;

/// Components of each array of the medium and its light: 0 (there is none), 1 or 3.
typedef struct
{
  int absorption, scattering, emission, fluence, unscattered, meanCosines, straightOn, unused;
} ViewedComponents;

/// A block of a larger grid, see GridBlock; voxels of the whole.
typedef struct
{
  int4 whole; ///< 0: this is no block
  int4 first; ///< w: 1 it shows the background beside the whole
  int4 begin, end;
} BlockInfo;

/// The picture and its camera.
typedef struct
{
  float4 eye;     ///< voxels; w: 0 the rays come from one point, 1 they are parallel
  float4 forward; ///< unit vector, world
  float4 right;   ///< to the picture's right edge; of the world at unit distance, or where parallel of the world;
                  ///< w: from the view axis to the picture's middle, in such lengths
  float4 up;      ///< to its upper edge; w: likewise
  float4 inverseSpacing; ///< voxels per length
  float4 background;     ///< W / (length^2 sr), added to the environment; w: 0 nothing is to be seen behind the medium
  float4 marching;       ///< step in voxels, transmittance at which to stop, depth where nothing is
  int4 picture;          ///< width, height in pixels, first row and first column of packets
  int4 size;             ///< voxels; of rays that go from block to block (RayRounds.h) those of the whole
  int4 held;             ///< voxels of the arrays of such a block
  int4 bricks;           ///< bricks
  int4 environment;      ///< width, height in pixels, 0: there is none; a bit for each face that gives back light
  float4 toPicture[3];   ///< of the environment: rows of the matrix from the world's axes to the picture's
  /// 1: pixels have depths at which their rays end; other blocks are before this one, through which rays have come;
  /// there is light at the surface of thick voxels.
  int4 has;
  BlockInfo block;
  PhaseInfo phase;
} ViewInfo;

/// Surface, table, and how rays bend.
typedef struct
{
  float4 spacing; ///< length per voxel
  float4 surface; ///< n^2 of the surface, reflectance, voxels from it to where the indices on its sides are taken
  float4 table;   ///< diffuse reflectance, mirrored part
  int4 face;      ///< axis of the table, 1 at the upper end and 0 at the lower, voxels of its longer rows
  float4 flip;    ///< what the table does to directions
  int4 limits;    ///< steps of a ray, steps of a bent stretch, halvings of the step in which the surface is met
  // Of a block whose rays go from block to block: the voxels of the whole of which it is known how rays bend.
  int4 knownFirst, knownSize;
} OpticsInfo;

enum
{
  // Of a RayOnItsWay.
  RayGoesOn = 0,
  RayIsOut = 1,  // it has left the box, and sees what is behind
  RayMisses = 2, // the box
  RayHasEnded = 3,
  RayIsPrimary = 0,
  RayIsReflected = 1, // by the surface
  RayIsMirrored = 2   // by the table
};

/// A ray that goes from one block of a grid into another, or has ended: all that is known of it. Voxels are those of
/// the whole.
typedef struct
{
  int pixel;    ///< of the picture; -1: there is no ray
  int kind;     ///< RayIsPrimary, ...
  int state;    ///< RayGoesOn, ...
  int steps;    ///< taken
  int where[3]; ///< the voxel in which its next step has its middle, or in which it is where it has left the box
  int met;      ///< the surface was met, or is not looked for
  float at[3], velocity[3];
  float left[3];     ///< of light from behind
  float radiance[3]; ///< gathered, by n^2
  float halfWay[4];  ///< the step in which half of the light was lost: start, length, before, after
  float square;      ///< n^2 in the middle of the last bent step
  float since;       ///< time since then; negative: n^2 is to be asked for first
  float entrySquare; ///< n^2 where the primary ray entered
  float seen, depth; ///< of one that has ended: mean transmittance, and where it was a half
} RayOnItsWay;

/// A light as the shadow rays see it: parallel light, or a point of one.
typedef struct
{
  float4 place; ///< world, from the lower corner of the box, of the whole; w: 1 a point, 0 parallel light
  float4
    axis; ///< unit vector, the way the light travels; w: tangent of a quarter of the cone's angle, 0 without a cone
  float4 power; ///< irradiance, or radiant intensity along the axis; w: 1 falls with the cosine to the axis, else 0
} SmallLight;

/// What shadow rays are told.
typedef struct
{
  float4 spacing;              ///< length per voxel
  float4 eye;                  ///< world, from the same corner; w: 0 the rays come from one point, 1 they are parallel
  float4 forward;              ///< unit vector, world
  int4 size;                   ///< voxels
  int4 bricks;                 ///< bricks
  BlockInfo block;             ///< of which the medium is one; without other blocks `first` is 0
  int4 asked;                  ///< by whom depths are asked for: the first voxel of the whole
  int4 askedSize;              ///< and how many voxels
  PhaseInfo phase;             ///< where it is the same everywhere
  ViewedComponents components; ///< of the medium's arrays
  float step;                  ///< voxels
  float nearestSquare;      ///< keeps a voxel that holds a light finite: its mean of 1/r^2 is 3/R^2 of a ball as large
  int firstLight, lights;   ///< those from the first on, before the other
  int firstSlice, firstRow; ///< of the launch
} ShadowInfo;
SHARED_END
