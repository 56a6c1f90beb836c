// Layout, shared by C++ and OpenCL kernels, of the values of voxels just beyond the faces of a block (subdomain).
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Memory layout of the values that a block received from its neighbours, one per cell of the block's faces
/// (BeyondFaces in Pipelined/AcrossFaces.h).
typedef struct
{
  /// Index of the first cell of each face of the block, -x to +z; -1: the face is on the domain's boundary
  int first[6];
  ulong stride; ///< number of cells of all faces of the block
} BeyondFacesInfo;
SHARED_END

#ifdef __OPENCL_C_VERSION__
// Index of the value of the voxel that adjoins voxel `at` at face d; -1 if the adjoining voxel is in the block or
// outside the domain.
static long place_beyond(const BeyondFacesInfo* beyond, const int* size, const int* at, int d)
{
  const int axis = d / 2, u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  const bool last = at[axis] == (d & 1 ? size[axis] - 1 : 0);
  return last && beyond->first[d] >= 0 ? beyond->first[d] + at[u] + (long)size[u] * at[v] : -1;
}
#endif
