// Shared by C++ and the kernel of ParallelBeam.cl.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/BeyondFacesShared.h"

SHARED_BEGIN
/// A parallel beam through the box, or through a block of it.
typedef struct
{
  int size[3];
  int periodic[3];
  int up[3]; ///< 1: it propagates towards +, by axis; 0: towards -
  float spacing[3];
  float lengths[3]; ///< of a ray between opposite faces of a voxel, by axis
  float thin;       ///< optical length of a voxel below which its loss is taken as uniform in the voxel
  BeyondFacesInfo beyond;
} BeamInfo;
SHARED_END
