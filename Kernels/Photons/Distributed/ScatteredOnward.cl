// Scattered photons that go from one block of a grid into another: part of ScatterPhotons.cl, with BLOCKS.

#pragma once
#include "Photons/Distributed/WaysOnward.cl"

// Whether a photon that sets off from a place does so in another block, to which rounding may have put it. It then has
// place and direction as its way; it sets off there.
static bool sets_off_elsewhere(const march_arrays* arrays, photon_lanes* lanes, float3 place, float3 direction)
{
  const MarchInfo* info = arrays->info;
  const real p[3] = { place.x, place.y, place.z };
  integer voxel[3];
  voxels_of_starts(info, p, voxel);
  FOR_AXES(a)
  {
    voxel[a] = clamp(voxel[a], info->first[a] - 1, info->first[a] + info->grid.size[a]);
  }
  const int at = padded(info, voxel);
  const bool elsewhere = arrays->sigma[at] == OUTSIDE;
  if (elsewhere)
  {
    lanes->at[0] = at;
    lanes->start[0][0] = place.x;
    lanes->start[1][0] = place.y;
    lanes->start[2][0] = place.z;
    lanes->velocity[0][0] = direction.x;
    lanes->velocity[1][0] = direction.y;
    lanes->velocity[2][0] = direction.z;
  }
  return elsewhere;
}

static void hand_on(
  const march_arrays* arrays, const photon_lanes* lanes, const scattered_flight* flight, __global ScatteredOnItsWay* to)
{
  hand_way_on(arrays, lanes, 0, &to->way);
  to->number = flight->random.stream;
  to->blocks = flight->random.block;
  to->drawn = flight->random.left;
  to->events = flight->events;
  to->scatterings = flight->end.scatterings;
  to->depth = flight->depth;
  to->dim = flight->dim;
  to->power = flight->end.power;
  to->absorbedAtFirst = flight->end.absorbedAtFirst;
  to->exchanged = flight->end.exchanged;
}

static void take_over(const march_arrays* arrays, const ScatterInfo* how, const __global ScatteredOnItsWay* from,
  photon_lanes* lanes, scattered_flight* flight)
{
  const ScatterEnd end = { -1, from->scatterings, from->power, from->absorbedAtFirst, from->exchanged };
  flight->end = end;
  flight->random = random_after(how->seed, from->number, from->blocks, from->drawn);
  flight->dim = from->dim;
  flight->depth = from->depth;
  flight->events = from->events;
  take_way_over(lanes, 0, &from->way);
  const integer voxel[3] = { from->way.voxel[0], from->way.voxel[1], from->way.voxel[2] };
  go_on_in(arrays, lanes, voxel);
  lanes->steps[0] = 0;
}
