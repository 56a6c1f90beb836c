// Rays that meet the table, a face of the box.
//
// The host gives
//   TABLE  1: there is one

#pragma once
#include "Viewing/Rays/RayPackets.cl"

#if TABLE
#define REACH_OF_TABLE 2e-3f // voxels; rounding error of a ray's exit point relative to the face

// Radiance of a white table where rays meet it, interpolated between voxel centres.
inline rgb table_light(const surroundings* s, __global const float4* lit, real3 place)
{
  const real3 p = in_block(s, place);
  const int axis = s->o->face.x;
  const int row = s->o->face.z + 2;
  const real x = (axis == 0 ? p.y : p.x) + (real)0.5f;
  const real y = (axis == 2 ? p.y : p.z) + (real)0.5f;
  const integer i = to_integer(x);
  const integer j = to_integer(y);
  const real across = x - to_real(i);
  const real up = y - to_real(j);
  const integer first = j * row + i;
  return between_four(lit, first, first + row, across, up);
}

// Selects the rays that leave the box through the table.
inline integer meet_table(const surroundings* s, const ray_packets* t, integer left_box)
{
  const int axis = s->o->face.x;
  const real sign = (real)(s->o->face.y ? 1.0f : -1.0f);
  const real place = axis == 0 ? t->at.x : axis == 1 ? t->at.y : t->at.z;
  const real heading = axis == 0 ? t->velocity.x : axis == 1 ? t->velocity.y : t->velocity.z;
  const float face = s->o->face.y ? (float)(axis == 0 ? s->v->size.x : axis == 1 ? s->v->size.y : s->v->size.z) : 0.0f;
  return left_box & (fabs(place - (real)face) < (real)REACH_OF_TABLE) & (heading * sign > (real)0.0f);
}

// Adds the table's diffuse radiance to rays that end on it; `towards` becomes their mirrored direction.
//   lit  see table_light
inline void end_on_table(
  const surroundings* s, __global const float4* lit, real3 p, integer ends, light* l, real3* towards)
{
  const float4 table = s->o->table;
  rgb shine = table_light(s, lit, p);
  shine.r *= (real)table.x;
  shine.g *= (real)table.y;
  shine.b *= (real)table.z;
  add_background(shine, ends ? (real)1.0f : (real)0.0f, l);
  *towards = chosen(ends, stretched(*towards, s->o->flip), *towards);
}
#endif
