// Shared by C++ and the kernels of PublishedPhotons.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
typedef struct
{
  int size[3];
  float spacing[3];
  int stepLimit;
} PublishedMarchInfo;

/// What became of a photon.
typedef struct
{
  int face;     ///< it left through, or 6: it was given up
  int deposits; ///< to voxels
  int givenUp;  ///< of them, after all tries
  int steps;
  float power[3];     ///< that is left
  float deposited[3]; ///< sum of all deposits
} PublishedPhotonEnd;
SHARED_END
