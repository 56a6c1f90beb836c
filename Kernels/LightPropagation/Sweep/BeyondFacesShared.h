// Shared by C++ and the kernels that read values from beyond the faces of a block: memory layout of these values.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// See BeyondFaces in Pipelined/AcrossFaces.h.
typedef struct
{
  int first[6]; ///< index of the first cell of each face of the block, -x to +z; -1: a face of the domain
  ulong stride; ///< number of cells of all faces
} BeyondFacesInfo;
SHARED_END

#ifdef __OPENCL_C_VERSION__
// Index of the value of a voxel's neighbour across face d; -1: the neighbour is in the block, or outside the domain.
static long place_beyond(const BeyondFacesInfo* beyond, const int* size, const int* at, int d)
{
  const int axis = d / 2, u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  const bool last = at[axis] == (d & 1 ? size[axis] - 1 : 0);
  return last && beyond->first[d] >= 0 ? beyond->first[d] + at[u] + (long)size[u] * at[v] : -1;
}
#endif
