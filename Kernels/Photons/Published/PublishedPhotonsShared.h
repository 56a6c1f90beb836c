// Shared by C++ and the kernels of PublishedPhotons.cl.
#pragma once

#include "Refraction/Index/IndexShared.h"

SHARED_BEGIN
/// A block of a grid. Places are those of the whole grid, in voxels.
typedef struct
{
  IndexGrid whole;
  IndexGrid own;     ///< the block: of coefficients, octree levels and light
  IndexGrid known;   ///< of the refractive index: the block and two voxels round it
  int first[3];      ///< voxel of the block, in the whole
  int knownFirst[3]; ///< voxel of `known`
  float spacing[3];
  int stepLimit;
} PublishedMarchInfo;

/// Where a photon that is on its way is; before that the face through which it left.
enum
{
  PublishedGivenUp = 6,  ///< after stepLimit steps
  PublishedElsewhere = 7 ///< it goes on in another block
};

/// One end of a step.
typedef struct
{
  float position[3];
  float velocity[3]; ///< n times direction; direction alone, of a photon that has made no step
  float power[3];    ///< in units
} PublishedPlace;

/// A photon as it goes from step to step, and from block to block: all that it depends on from there on.
typedef struct
{
  int voxel[3];            ///< where it goes on, if that is elsewhere
  int face;                ///< that it left through, or one of the above
  int steps;               ///< that were begun; 0: it sets off
  int done;                ///< voxels of the last one's line that have got their deposits
  int deposits;            ///< to voxels
  int givenUp;             ///< of them, after all tries
  PublishedPlace from, to; ///< the ends of the last step
  float deposited[3];      ///< sum of all deposits
} PublishedPhoton;
SHARED_END
