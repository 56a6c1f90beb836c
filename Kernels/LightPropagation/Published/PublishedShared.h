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

/// A U as a multiple of a moment, and where it goes.
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
  int given, kept; ///< rays begin with the radiance that they had behind the planes before; it is kept for those after
  int directions;  ///< in the batch
} PublishedMap;

/// What the rays of one direction do in one launch.
typedef struct
{
  int direction; ///< within the batch
  int parity;    ///< which of the two ray maps they are in
  int moveU, moveV;
  int source;   ///< which U
  float length; ///< in the voxel
} PublishedCrossing;

/// How the cells of the box's faces are numbered (BoxFaces.h), as a map's rays meet them; steps between numbers.
typedef struct
{
  int planes;                    ///< that rays march through
  int cells;                     ///< of all faces
  int firstW, stepWU, stepWV;    ///< of the face through which they come in ahead
  int firstU[2], stepUW, stepUV; ///< of the low and the high face across u
  int firstV[2], stepVW, stepVU; ///< of those across v
} PublishedFaceCells;
SHARED_END
