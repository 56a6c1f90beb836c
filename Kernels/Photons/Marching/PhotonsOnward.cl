// Photons that pass from one block of a grid into another: part of PhotonMarch.cl, with BLOCKS.

#pragma once
#include "Photons/Marching/WaysOnward.cl"

static void keep_owed(photon_lanes* lanes, const photon_flight* flight)
{
  FOR_CHANNELS(c)
  {
    PUT(lanes->owed[c], flight->owed[c]);
  }
#if CELLS
  PUT_INTEGERS(lanes->counted, flight->counted);
#endif
}

// Appends photon k, which has entered a voxel of another block, to `gone`.
static void hand_on(const march_arrays* arrays, const photon_lanes* lanes, int k)
{
  __global PhotonOnItsWay* photon = arrays->gone + atomic_add(arrays->gone_count, 1);
  hand_way_on(arrays, lanes, k, &photon->way);
  FOR_CHANNELS(c)
  {
    photon->power[c] = lanes->power[c][k];
    photon->owed[c] = lanes->owed[c][k];
  }
  photon->crossings = lanes->crossings[k];
  photon->steps = lanes->steps[k];
#if CELLS
  photon->counted = lanes->counted[k];
#endif
#if MARKS
  photon->mark = lanes->mark[k];
#endif
}

static void take_one_over(photon_lanes* lanes, int k, const __global PhotonOnItsWay* photon)
{
  take_way_over(lanes, k, &photon->way);
  FOR_CHANNELS(c)
  {
    lanes->power[c][k] = photon->power[c];
    lanes->owed[c][k] = photon->owed[c];
  }
  lanes->crossings[k] = photon->crossings;
  lanes->steps[k] = photon->steps;
#if CELLS
  lanes->counted[k] = photon->counted;
#endif
#if MARKS
  lanes->mark[k] = photon->mark;
#endif
}

// Loads photons `first` to `first + REAL_WIDTH`, but only those before `end`, of those that have arrived.
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
      voxel[a][k] = photon->way.voxel[a];
    }
  }
  integer places[3];
  FOR_AXES(a)
  {
    places[a] = INTEGERS(voxel[a]);
  }
  go_on_in(arrays, lanes, places);
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
#if CELLS // a cell may extend over several blocks
  flight->counted = INTEGERS(lanes->counted);
#elif COUNTS
  flight->counted = -1;
#endif
}
