// Path state of photons that pass from one block of a grid into another: part of PhotonMarch.cl and ScatterPhotons.cl,
// with BLOCKS.
//
// All coordinates are those of the whole grid, so a path continues as it would on an undivided grid. An arriving photon
// is on the entry wall of its new voxel, and has not yet been processed there (end, or change of velocity).

#pragma once
#include "Photons/Marching/PhotonSteps.cl"

// Stores the path state of photon k, which has entered a voxel of another block.
static void hand_way_on(const march_arrays* arrays, const photon_lanes* lanes, int k, __global WayOnward* way)
{
  vstore3(voxel_of(arrays->info, lanes->at[k]), 0, way->voxel);
  FOR_AXES(a)
  {
    way->wall[a] = lanes->wall[a][k];
    way->start[a] = lanes->start[a][k];
    way->velocity[a] = lanes->velocity[a][k];
#if BENDS
    way->momentum[a] = lanes->momentum[a][k];
#endif
  }
  way->now = lanes->now[k];
  way->turn = lanes->turn[k];
  way->settled = lanes->settled[k];
  way->step = lanes->step[k];
}

static void take_way_over(photon_lanes* lanes, int k, const __global WayOnward* way)
{
  FOR_AXES(a)
  {
    lanes->wall[a][k] = way->wall[a];
    lanes->start[a][k] = way->start[a];
    lanes->velocity[a][k] = way->velocity[a];
#if BENDS
    lanes->momentum[a][k] = way->momentum[a];
#endif
  }
  lanes->now[k] = way->now;
  lanes->turn[k] = way->turn;
  lanes->settled[k] = way->settled;
  lanes->step[k] = way->step;
}

// Resumes the paths of all photons in the packet, whose states have been loaded, in these voxels.
static void go_on_in(const march_arrays* arrays, photon_lanes* lanes, const integer* voxel)
{
  real u[3], inverse[3];
  FOR_AXES(a)
  {
    u[a] = VECTOR(lanes->velocity[a]);
    inverse[a] = (real)1.0f / u[a];
  }
  aim(arrays->info, lanes, (integer)-1, u, inverse);
  PUT_INTEGERS(lanes->at, padded(arrays->info, voxel));
  PUT_INTEGERS(lanes->alive, (integer)-1);
}
