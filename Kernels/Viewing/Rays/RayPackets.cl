// Rays on their way through a medium that bends them, and what they are given on it.
//
// The host gives
//   BENDS  1: the index varies

#pragma once
#include "Viewing/Rays/Crossing.cl"
#include "Viewing/Rays/View.cl"
#include "Viewing/Samples/Sampling.cl"
#include "Viewing/Scene/ViewShared.h"

// Where rays are (voxels), how fast (voxels per unit of t) and whether inside of the box.
typedef struct
{
  real3 at, velocity;
  integer inside;
#if ENDS
  real end;        // depth at which they end
  integer stopped; // there
#endif
} ray_packets;

// Rays that are marched later; without light left there are none.
typedef struct
{
  real3 at, velocity;
  spectrum left;
} waiting;

// What primary rays remember of n^2, so that they see where they meet the surface, and what is reflected there.
typedef struct
{
  integer met;   // it was met, or is not looked for
  real square;   // n^2 in the middle of the last bent step
  real since;    // time since then
  int forgotten; // n^2 is to be asked for first
  waiting reflected;
} watch;

// What each march is given, besides the rays.
typedef struct
{
  const ViewInfo* v;
  const OpticsInfo* o;
  scenery scene;
  __global const float4* bending; // half the gradient of n^2 by squared spacing (x, y, z), n^2 (w)
  __global const char* bricks;
} surroundings;

inline real3 further(real3 p, real t, real3 velocity)
{
  const real3 q = { fma(t, velocity.x, p.x), fma(t, velocity.y, p.y), fma(t, velocity.z, p.z) };
  return q;
}

inline real3 kept_within(real3 p, int4 size)
{
  const real3 q = { within(p.x, size.x), within(p.y, size.y), within(p.z, size.z) };
  return q;
}

inline real3 stretched(real3 p, float4 by)
{
  const real3 q = { p.x * (real)by.x, p.y * (real)by.y, p.z * (real)by.z };
  return q;
}

inline real3 divided(real3 p, real by)
{
  const real inverse = (real)1.0f / by;
  const real3 q = { p.x * inverse, p.y * inverse, p.z * inverse };
  return q;
}

inline real3 chosen(integer first, real3 a, real3 b)
{
  const real3 c = { first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z };
  return c;
}

// Until each ray that goes straight on leaves the box.
inline real time_to_face(real3 p, real3 velocity, int4 size)
{
  const real3 v = { at_least_tiny(velocity.x), at_least_tiny(velocity.y), at_least_tiny(velocity.z) };
#define TO_FACE(c) (((v.c > (real)0.0f ? (real)(float)size.c : (real)0.0f) - p.c) / v.c)
  return greater(lesser(lesser(TO_FACE(x), TO_FACE(y)), TO_FACE(z)), (real)0.0f);
#undef TO_FACE
}

inline real depth_of(real3 p, const ViewInfo* v, float4 spacing)
{
  const real3 from_eye = { p.x - (real)v->eye.x, p.y - (real)v->eye.y, p.z - (real)v->eye.z };
  const real3 forward = { (real)(v->forward.x * spacing.x), (real)(v->forward.y * spacing.y),
    (real)(v->forward.z * spacing.z) };
  return product(from_eye, forward);
}

#if ENDS
// Until each ray that goes straight on comes to its end.
inline real time_to_end(const ray_packets* t, real3 velocity, const surroundings* s)
{
  const real3 forward = { (real)s->v->forward.x, (real)s->v->forward.y, (real)s->v->forward.z };
  const real pace = product(stretched(velocity, s->o->spacing), forward);
  const real gap = greater(t->end - depth_of(t->at, s->v, s->o->spacing), (real)0.0f);
  return pace > (real)1e-20f ? gap / pace : (real)ENDLESS;
}
#endif

#if BENDS
inline real index_at(const surroundings* s, real3 p, real3* bend)
{
  corners at;
  find_corners(p, s->v->size, &at);
  rgb xyz;
  real square;
  gather(s->bending, &at, s->v->size, &xyz, &square);
  bend->x = xyz.r;
  bend->y = xyz.g;
  bend->z = xyz.b;
  return square;
}
#endif
