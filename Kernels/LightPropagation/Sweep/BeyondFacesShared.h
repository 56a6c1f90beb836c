// Shared by C++ and the kernels that look across the faces of a block: where what is beyond them lies.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// See BeyondFaces.h.
typedef struct
{
  int first[6]; ///< where the cells of each face of the block begin, -x to +z; -1: it is a face of the whole
  ulong stride; ///< cells of all faces
} BeyondFacesInfo;
SHARED_END
