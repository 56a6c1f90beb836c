// Shared by C++ and the kernels of the published algorithm (PublishedPropagate.cl, PublishedCollect.cl).
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Two memory layouts of volumes, both padded: layout 0 is [z][y][x]; layout 1, for maps that march along x, is
/// [x][z][y].
typedef struct
{
  int size[3];
  int row[2], plane[2], volume[2]; ///< strides of rows, planes and channels in floats, by layout
} PublishedLayouts;

/// A source U, computed as sigma_s times `factor` times a moment, and its place in memory.
typedef struct
{
  int moment;
  float factor;
  int layout;
  int slot;
} PublishedPart;

/// Size and memory layout of the ray maps of a batch of directions.
typedef struct
{
  int sizeU, sizeV;
  int rowStride; ///< floats between consecutive rows of the map in a volume
  int volume;    ///< floats per volume of one channel
  int rayRow;    ///< floats per row of a ray map
  int periodicU, periodicV;
  /// Whether rays wrap around the marching axis: they start with their radiance at the end of the previous order.
  int periodicW;
  int directions; ///< number of directions in the batch
} PublishedMap;

/// Segment that all rays of one direction cross in one launch of cross_voxels().
typedef struct
{
  int direction; ///< index of the direction within the batch
  int parity;    ///< ray map, 0 or 1, from which radiance is read; the other one is written
  int moveU, moveV;
  int source;   ///< slot of the source U for this direction
  float length; ///< path length in the voxel
} PublishedCrossing;
SHARED_END
