// Shared by C++ and the kernel of LampScattering.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Geometry of a lamp and of the box.
typedef struct
{
  int size[3];
  int parallel; ///< 0: the lamp has a position
  float spacing[3];
  float place[3];   ///< position from the corner of the box; of parallel rays the unit direction
  float meanCosine; ///< mean cosine of scattering to reproduce
  float perVolume;  ///< 1 / length^3
} LampInRays;
/// Layers along z that a sweep crosses, of a grid of this size.
typedef struct
{
  int size[3];
  int begin, end; ///< layers, in the order in which a direction crosses them
  ulong stride;   ///< voxels between groups of directions
} SweptLayers;

/// Voxels that a launch scatters the light of.
typedef struct
{
  ulong voxels; ///< of the grid
  ulong stride; ///< voxels between groups of directions
  ulong begin;  ///< first voxel of the launch
} ScatteringVoxels;
SHARED_END
