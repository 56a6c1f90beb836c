// Shared by C++ and the kernel of ParallelBeam.cl.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/BeyondFacesShared.h"

SHARED_BEGIN
/// A beam of parallel light through the box.
typedef struct
{
  int size[3];
  int periodic[3];
  int up[3]; ///< the way it goes along each axis
  float spacing[3];
  float lengths[3]; ///< of a ray from face to face
  float thin;       ///< optical length of voxels below which light is taken as lost evenly
  BeyondFacesInfo beyond;
} BeamInfo;
SHARED_END
