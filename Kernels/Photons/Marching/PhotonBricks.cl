// Marching through a medium that is stored by bricks of voxels, most of them empty. A photon crosses an empty brick in
// one segment and deposits to the brick's single record. It crosses a filled brick voxel by voxel. Voxels are addressed
// by the indices of their records (MarchMedium.h). The refractive index is constant.

#pragma once
#include "Medium/BrickShared.h"
#include "Photons/Marching/PhotonLanes.cl"

#define NO_SLOPE 1e37f // stands for the infinite time to cross a voxel along an axis with zero velocity

// Finds the records (MarchMedium.h) that hold the sums and the extinction of the photons' voxels.
//   last  edge, in voxels, of the region that a photon crosses in one segment, minus 1: BrickEdge - 1 in an empty
//         brick, 0 in a single voxel
static void find_records(const march_arrays* arrays, const integer* voxel, integer* record, integer* last)
{
  const IndexGrid* grid = &arrays->info->grid;
  const int nx = (grid->size[0] + BrickEdge - 1) / BrickEdge, ny = (grid->size[1] + BrickEdge - 1) / BrickEdge;
  integer outside = 0;
  FOR_AXES(a)
  {
    outside |= truth(voxel[a] < 0) | truth(voxel[a] >= (integer)grid->size[a]);
  }
  const integer brick = ((voxel[2] >> BrickBits) * ny + (voxel[1] >> BrickBits)) * nx + (voxel[0] >> BrickBits);
  const integer first = gather(int, arrays->cells, ~outside& brick);
  const integer empty = truth(first < 0);
  const integer within = (integer)(BrickEdge - 1);
  const integer voxels = ((voxel[2] & within) * BrickEdge + (voxel[1] & within)) * BrickEdge + (voxel[0] & within);
  *record = ~outside & (empty ? -first : first + voxels);
  *last = empty & ~outside & within;
}

// Along one axis, the first voxel and the end of the region that a photon crosses in one segment: a voxel, or an empty
// brick.
static integer lower_end(integer voxel, integer last)
{
  return voxel & ~last;
}
static integer upper_end(integer voxel, integer last, int size)
{
  return min((voxel & ~last) + last + 1, (integer)size);
}

// Computes the times at which the photons reach the next wall along each axis.
static void find_walls(
  const march_arrays* arrays, const photon_lanes* lanes, const integer* voxel, integer last, real* wall)
{
  FOR_AXES(a)
  {
    const real inverse = VECTOR(lanes->inverse[a]);
    const integer place =
      inverse > (real)0.0f ? upper_end(voxel[a], last, arrays->info->grid.size[a]) : lower_end(voxel[a], last);
    wall[a] = (to_real(place) - VECTOR(lanes->start[a])) * inverse;
  }
}

// Starts all photons of a packet at positions p in `voxel`, with velocities u.
static void set_off_in_bricks(
  const march_arrays* arrays, photon_lanes* lanes, const integer* voxel, const real* p, const real* u)
{
  FOR_AXES(a)
  {
    const integer still = truth(u[a] == (real)0.0f);
    // A photon that moves along the grid's upper face must not leave through it.
    PUT(lanes->start[a], still ? lesser(p[a], to_real(voxel[a]) + (real)0.999f) : p[a]);
    PUT(lanes->inverse[a], still ? (real)NO_SLOPE : (real)1.0f / u[a]);
    PUT_INTEGERS(lanes->voxel[a], voxel[a]);
  }
  integer record, last;
  real wall[3];
  find_records(arrays, voxel, &record, &last);
  find_walls(arrays, lanes, voxel, last, wall);
  PUT_INTEGERS(lanes->at, record);
  PUT_INTEGERS(lanes->last, last);
  FOR_AXES(a)
  {
    PUT(lanes->wall[a], wall[a]);
  }
}

// Moves photons through the walls that they reach at time `next`. Along axes without such a wall, the voxel is computed
// from the position at that time. It is limited to the current region, because of rounding.
static void cross_in_bricks(const march_arrays* arrays, const photon_lanes* lanes, real next, integer* voxel,
  integer* last, real* wall, integer* record)
{
  FOR_AXES(a)
  {
    const integer low = lower_end(voxel[a], *last), high = upper_end(voxel[a], *last, arrays->info->grid.size[a]);
    const real place = VECTOR(lanes->start[a]) + VECTOR(lanes->velocity[a]) * next;
    const integer within = min(max(to_integer(place), low), high - 1);
    const integer beyond = VECTOR(lanes->inverse[a]) > (real)0.0f ? high : low - 1;
    voxel[a] = wall[a] <= next ? beyond : within;
  }
  find_records(arrays, voxel, record, last);
  find_walls(arrays, lanes, voxel, *last, wall);
}
