// Photons by bricks of voxels, where most of these are empty. In an empty brick a photon goes to the brick's wall in
// one stretch, and what it leaves there goes to the brick's one record; in a filled one it goes from voxel to voxel. A
// voxel's place is the number of its record (PhotonBricks.h). The index is constant.

#pragma once
#include "Medium/BrickShared.h"
#include "Photons/Marching/PhotonLanes.cl"

#define NO_SLOPE 1e37f // time across a voxel where a photon does not move along an axis

// The records of voxels, and `last`: of their step, the last of the voxels along an edge, 0 where it is a single one.
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

// The voxels between which a photon's step is.
static integer lower_end(integer voxel, integer last)
{
  return voxel & ~last;
}
static integer upper_end(integer voxel, integer last, int size)
{
  return min((voxel & ~last) + last + 1, (integer)size);
}

// Times of the walls ahead.
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

// All photons set off from p in `voxel`, with velocity u.
static void set_off_in_bricks(
  const march_arrays* arrays, photon_lanes* lanes, const integer* voxel, const real* p, const real* u)
{
  FOR_AXES(a)
  {
    const integer still = truth(u[a] == (real)0.0f);
    // One that goes along the grid's upper face is not to leave through it.
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

// Through the walls that are reached at time `next`. What is known of the other axes is the time alone: a voxel that
// rounding puts into a neighbouring step is the last one of this step.
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
