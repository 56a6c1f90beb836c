// Shared by C++ and the kernels of the published algorithm.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// The volumes: layout 0 is [z][y][x]; layout 1, for maps that march along x, is [x][z][y].
typedef struct
{
  int size[3];
  int row[2], plane[2], volume[2]; ///< floats from row to row, plane to plane and channel to channel, by layout
} PublishedLayouts;

/// A source U as a multiple of a moment, and its place.
typedef struct
{
  int moment;
  float factor;
  int layout;
  int slot;
} PublishedPart;

/// A map of rays.
typedef struct
{
  int sizeU, sizeV;
  int rowStride; ///< floats between rows of a volume
  int volume;    ///< floats of a volume of one channel
  int rayRow;    ///< floats of a row of a ray map
  int periodicU, periodicV;
  int periodicW;  ///< rays start with the radiance they had behind the last plane in the order before
  int directions; ///< in the batch
} PublishedMap;

/// The rays of one direction in one launch.
typedef struct
{
  int direction; ///< within the batch
  int parity;    ///< which of the two ray maps they are in
  int moveU, moveV;
  int source;   ///< which U
  float length; ///< in the voxel
} PublishedCrossing;
SHARED_END
