// Shared by C++ and the kernels that read values from beyond the faces of a block: memory layout of these values.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// See BeyondFaces.h.
typedef struct
{
  int first[6]; ///< index of the first cell of each face of the block, -x to +z; -1: a face of the domain
  ulong stride; ///< number of cells of all faces
} BeyondFacesInfo;
SHARED_END
