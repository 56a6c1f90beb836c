// Arguments of the kernel in ParallelBeam.cl, shared with C++.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/BeyondFacesShared.h"

SHARED_BEGIN
/// A parallel beam of light through the box, or through a block of it. The three elements of an array belong to x, y
/// and z.
typedef struct
{
  int size[3];
  int periodic[3];
  int up[3]; ///< 1: the beam propagates towards +; 0: towards -
  float spacing[3];
  float lengths[3]; ///< length of a ray between opposite faces of a voxel
  float thin;       ///< optical thickness of a voxel below which its loss is taken as uniform in the voxel
  BeyondFacesInfo beyond;
} BeamInfo;
SHARED_END
