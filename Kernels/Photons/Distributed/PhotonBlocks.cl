// Photons that go from one block of a grid into another: part of PhotonMarch.cl, with BLOCKS.
//
// What is handed on is all that a photon's way depends on, in coordinates of the whole grid: it goes on as it would
// in one block. It arrives with a voxel's wall behind it, and has not been attended to there yet.

#pragma once

// Those that have been as often at walls and turns as photons may.
static integer spent(const march_arrays* arrays, const photon_flight* flight)
{
  return truth(flight->crossings >= (integer)arrays->info->eventLimit);
}

static void keep_owed(photon_lanes* lanes, const photon_flight* flight)
{
  FOR_CHANNELS(c)
  {
    PUT(lanes->owed[c], flight->owed[c]);
  }
}

// Photon k has landed in another block's voxel.
static void hand_on(const march_arrays* arrays, const photon_lanes* lanes, int k)
{
  __global PhotonOnItsWay* photon = arrays->gone + atomic_add(arrays->gone_count, 1);
  vstore3(voxel_of(arrays->info, lanes->at[k]), 0, photon->voxel);
  FOR_AXES(a)
  {
    photon->wall[a] = lanes->wall[a][k];
    photon->start[a] = lanes->start[a][k];
    photon->velocity[a] = lanes->velocity[a][k];
#if BENDS
    photon->momentum[a] = lanes->momentum[a][k];
#endif
  }
  FOR_CHANNELS(c)
  {
    photon->power[c] = lanes->power[c][k];
    photon->owed[c] = lanes->owed[c][k];
  }
  photon->crossings = lanes->crossings[k];
  photon->steps = lanes->steps[k];
  photon->now = lanes->now[k];
  photon->turn = lanes->turn[k];
  photon->settled = lanes->settled[k];
  photon->step = lanes->step[k];
#if COUNTS
  photon->mark = lanes->mark[k];
#endif
}

static void take_one_over(photon_lanes* lanes, int k, const __global PhotonOnItsWay* photon)
{
  FOR_AXES(a)
  {
    lanes->wall[a][k] = photon->wall[a];
    lanes->start[a][k] = photon->start[a];
    lanes->velocity[a][k] = photon->velocity[a];
#if BENDS
    lanes->momentum[a][k] = photon->momentum[a];
#endif
  }
  FOR_CHANNELS(c)
  {
    lanes->power[c][k] = photon->power[c];
    lanes->owed[c][k] = photon->owed[c];
  }
  lanes->crossings[k] = photon->crossings;
  lanes->steps[k] = photon->steps;
  lanes->now[k] = photon->now;
  lanes->turn[k] = photon->turn;
  lanes->settled[k] = photon->settled;
  lanes->step[k] = photon->step;
#if COUNTS
  lanes->mark[k] = photon->mark;
#endif
}

// Photons `first` to `first + REAL_WIDTH`, but before `end`, of those that have arrived.
static void take_over(const march_arrays* arrays, const __global PhotonOnItsWay* arrived, int first, int end,
  photon_lanes* lanes, photon_flight* flight)
{
  LANES_3(int, voxel);
  for (int k = 0; k < REAL_WIDTH; ++k)
  {
    const __global PhotonOnItsWay* photon = arrived + (first + k < end ? first + k : first);
    take_one_over(lanes, k, photon);
    FOR_AXES(a)
    {
      voxel[a][k] = photon->voxel[a];
    }
  }
  real u[3], inverse[3];
  integer places[3];
  FOR_AXES(a)
  {
    u[a] = VECTOR(lanes->velocity[a]);
    inverse[a] = (real)1.0f / u[a];
    places[a] = INTEGERS(voxel[a]);
  }
  aim(arrays->info, lanes, (integer)-1, u, inverse);
  PUT_INTEGERS(lanes->at, padded(arrays->info, places));
  PUT_INTEGERS(lanes->alive, (integer)-1);
  for (int k = end - first; k < REAL_WIDTH; ++k)
  {
    rest(lanes, k);
  }
  flight->crossings = INTEGERS(lanes->crossings);
  FOR_CHANNELS(c)
  {
    flight->power[c] = VECTOR(lanes->power[c]);
    flight->owed[c] = VECTOR(lanes->owed[c]);
  }
#if COUNTS
  flight->counted = -1;
#endif
}
