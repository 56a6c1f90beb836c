// Values of the neighbouring voxels outside a block (BeyondFaces.h).

#include "LightPropagation/Sweep/BeyondFacesShared.h"

// Index of the value of a voxel's neighbour across face d; -1: the neighbour is in the block, or outside the domain.
static long place_beyond(const BeyondFacesInfo* beyond, const int* size, const int* at, int d)
{
  const int axis = d / 2, u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  const bool last = at[axis] == (d & 1 ? size[axis] - 1 : 0);
  return last && beyond->first[d] >= 0 ? beyond->first[d] + at[u] + (long)size[u] * at[v] : -1;
}
