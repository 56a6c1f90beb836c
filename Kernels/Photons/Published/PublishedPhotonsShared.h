// Shared by C++ and the kernels of PublishedPhotons.cl.
#pragma once

#include "Refraction/Index/IndexShared.h"

SHARED_BEGIN
/// A block of a grid. Positions are those of the whole grid, in voxels.
typedef struct
{
  IndexGrid whole;
  IndexGrid own;     ///< size of the block: coefficients, octree levels and light
  IndexGrid known;   ///< size of the region with a refractive index: the block and two voxels around it
  int first[3];      ///< first voxel of the block in the whole grid
  int knownFirst[3]; ///< first voxel of `known` in the whole grid
  float spacing[3];
  int stepLimit;
} PublishedMarchInfo;

/// Values of PublishedPhoton::face above the six faces of the volume.
enum
{
  PublishedGivenUp = 6,  ///< not ended after stepLimit steps
  PublishedElsewhere = 7 ///< it continues in another block
};

/// One end of a step.
typedef struct
{
  float position[3];
  float velocity[3]; ///< n times direction; the direction alone before the first step
  float power[3];    ///< in units
} PublishedPlace;

/// A photon between steps, or between blocks: all state that its further path depends on.
typedef struct
{
  int voxel[3];            ///< voxel in which it continues, if that is in another block
  int face;                ///< face through which it left, or one of the values above
  int steps;               ///< number of steps begun; 0: it has not started
  int done;                ///< number of voxels along the last step that have received their deposits
  int deposits;            ///< number of deposits in voxels
  int givenUp;             ///< number of deposits given up after all tries
  PublishedPlace from, to; ///< ends of the last step
  float deposited[3];      ///< sum of all its deposits
} PublishedPhoton;
SHARED_END
