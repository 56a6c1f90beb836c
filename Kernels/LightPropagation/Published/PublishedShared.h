// Data types shared by C++ and the kernels of the published algorithm (PublishedPropagate.cl, PublishedCollect.cl).
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Two memory layouts of volumes, both padded: layout 0 is [z][y][x]; layout 1, for ray maps that march along x, is
/// [x][z][y].
typedef struct
{
  int size[3];
  int row[2], plane[2], volume[2]; ///< strides of rows, planes and channels in floats, by layout
} PublishedLayouts;

/// A source U: sigma_s times `factor` times a moment. It is stored in the memory layout `layout` (0 or 1), at index
/// `slot` among the sources in that layout.
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
  int rowStride; ///< distance in a volume, floats, between the voxels of consecutive rows of the map
  int volume;    ///< floats per volume of one channel
  int rayRow;    ///< floats per row of a ray map
  int periodicU, periodicV;
  /// Whether rays wrap around the marching axis, i.e. start with the radiance that they had at the end of the previous
  /// order.
  int periodicW;
  int directions; ///< number of directions in the batch
} PublishedMap;

/// Path through one voxel, the same for all rays of a direction, in one launch of cross_voxels().
typedef struct
{
  int direction; ///< index of the direction within the batch
  int parity;    ///< which of the two ray maps (0 or 1) holds the rays before the crossing; the other one receives them
  int moveU, moveV;
  int source;   ///< index, among the sources U in this memory layout, of the one for this direction
  float length; ///< path length in the voxel
} PublishedCrossing;
SHARED_END
