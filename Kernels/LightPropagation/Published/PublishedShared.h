// Shared by C++ and the kernels of the published algorithm.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Memory layouts of volumes: layout 0 is [z][y][x]; layout 1, for maps that march along x, is [x][z][y].
typedef struct
{
  int size[3];
  int row[2], plane[2], volume[2]; ///< strides of rows, planes and channels in floats, by layout
} PublishedLayouts;

/// A source U as a multiple of a moment, and where it is stored.
typedef struct
{
  int moment;
  float factor;
  int layout;
  int slot;
} PublishedPart;

/// A ray map.
typedef struct
{
  int sizeU, sizeV;
  int rowStride; ///< floats between rows of a volume
  int volume;    ///< floats of a volume of one channel
  int rayRow;    ///< floats of a row of a ray map
  int periodicU, periodicV;
  int periodicW;  ///< rays start with their radiance beyond the last plane in the previous order
  int directions; ///< in the batch
} PublishedMap;

/// The rays of one direction in one launch.
typedef struct
{
  int direction; ///< within the batch
  int parity;    ///< index of the ray map that holds them
  int moveU, moveV;
  int source;   ///< index of U
  float length; ///< of the segment in the voxel
} PublishedCrossing;
SHARED_END
