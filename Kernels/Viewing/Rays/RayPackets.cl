// State of packets of rays that march through a medium whose refractive index varies, and inputs of the march.
//
// Macros set by the host:
//   BENDS   1: the refractive index varies
//   ROUNDS  1: the medium is a block of a larger grid, and rays travel from block to block

#pragma once
#include "Viewing/Rays/Crossing.cl"
#include "Viewing/Rays/View.cl"
#include "Viewing/Samples/Sampling.cl"
#include "Viewing/Scene/ViewShared.h"

// State of rays: position in voxels, velocity T in voxels per unit of t (dt = ds / n), and whether they are inside the
// box.
typedef struct
{
  real3 at, velocity;
  integer inside;
#if ROUNDS
  integer steps; // number of steps since the ray's entry into the domain
#endif
  real end;        // depth along the view axis at which an opaque surface ends the rays; ENDLESS: none does
  integer stopped; // whether the rays have reached the depth `end`
} ray_packets;

// Reflected or mirrored rays of a packet, which are marched after the current rays. A transmittance of zero marks a
// lane without such a ray.
typedef struct
{
  real3 at, velocity;
  spectrum left;
} waiting;

// State by which primary rays detect the reflecting surface, and the rays that it has reflected. The surface is where n
// rises through a given value.
typedef struct
{
  integer met;       // whether the ray has met the surface already, or is not to be split by it
  real square;       // n^2 at the midpoint of the last bent step
  real since;        // time t since the midpoint of the last bent step
  integer forgotten; // whether `square` is unknown, so that n^2 must be sampled first
  waiting reflected;
} watch;

// Inputs of a march: parameters of the picture (v) and of the optics (o), packed samples (scene), the field that bends
// rays, and a distance per brick by which rays skip empty bricks (Sampling.cl).
typedef struct
{
  const ViewInfo* v;
  const OpticsInfo* o;
  scenery scene;
  __global const float4* bending; // x, y, z: half the gradient of n^2, divided by the squared spacing; w: n^2
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

// These macros give the boxes of the whole grid that the arrays of samples and of the bending field cover: number of
// voxels (SIZE) and first voxel (FIRST).
#if ROUNDS
#define SAMPLES_SIZE(s) (s)->v->held
#define SAMPLES_FIRST(s) (s)->v->block.first
#define INDEX_SIZE(s) (s)->o->knownSize
#define INDEX_FIRST(s) (s)->o->knownFirst
#else
#define SAMPLES_SIZE(s) (s)->v->size
#define SAMPLES_FIRST(s) (int4)(0)
#define INDEX_SIZE(s) (s)->v->size
#define INDEX_FIRST(s) (int4)(0)
#endif

#if ROUNDS
// Clamps points to the box of an array: rays in another block must not read outside it.
inline real3 kept_in_array(real3 p, int4 first, int4 size)
{
#define KEPT(c) lesser(greater(p.c, (real)(float)first.c), (real)(float)(first.c + size.c))
  const real3 q = { KEPT(x), KEPT(y), KEPT(z) };
#undef KEPT
  return q;
}

// Converts voxel coordinates of the whole grid to voxel coordinates of the block's arrays.
inline real3 in_block(const surroundings* s, real3 p)
{
  const int4 first = s->v->block.first;
  const real3 kept = kept_in_array(p, first, s->v->held);
  const real3 q = { kept.x - (real)(float)first.x, kept.y - (real)(float)first.y, kept.z - (real)(float)first.z };
  return q;
}

// Whether points lie in voxels that the block owns, ghost cells excluded.
inline integer is_own(const surroundings* s, real3 p)
{
  const BlockInfo* b = &s->v->block;
#define OWN(c) \
  ((p.c >= (real)(float)b->begin.c) & ((p.c < (real)(float)b->end.c) | (integer)(b->end.c == b->whole.c ? -1 : 0)))
  return OWN(x) & OWN(y) & OWN(z);
#undef OWN
}
#else
#define in_block(s, p) (p)
#endif

// Finds the eight voxel centres around points, and their weights, in arrays that begin at voxel `first` of the whole
// grid.
inline void corners_in(real3 p, int4 first, int4 size, corners* at)
{
#if ROUNDS
  p = kept_in_array(p, first, size);
#endif
  find_corners_from(p, first, size, at);
}
#define corners_of_samples(s, p, at) corners_in(p, SAMPLES_FIRST(s), SAMPLES_SIZE(s), at)
#define corners_of_index(s, p, at) corners_in(p, INDEX_FIRST(s), INDEX_SIZE(s), at)

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

// Time t until each ray, continued in a straight line, leaves the box.
inline real time_to_face(real3 p, real3 velocity, int4 size)
{
  const real3 v = { at_least_tiny(velocity.x), at_least_tiny(velocity.y), at_least_tiny(velocity.z) };
#define TO_FACE(c) (((v.c > (real)0.0f ? (real)(float)size.c : (real)0.0f) - p.c) / v.c)
  return greater(lesser(lesser(TO_FACE(x), TO_FACE(y)), TO_FACE(z)), (real)0.0f);
#undef TO_FACE
}

#if ROUNDS
// Midpoint of each ray's next step, which decides the block that computes this step. Bent and straight steps have equal
// length.
inline real3 middle_of_next(const surroundings* s, const ray_packets* t)
{
  const real per_voxel = (real)1.0f / sqrt(greater(product(t->velocity, t->velocity), (real)1e-30f));
  const real time = lesser((real)s->v->marching.x * per_voxel, time_to_face(t->at, t->velocity, s->v->size));
  return kept_within(further(t->at, (real)0.5f * time, t->velocity), s->v->size);
}

// Length of the straight steps that can follow while their midpoints lie in the block's own voxels; at least one step.
inline real own_stretch(const surroundings* s, real3 p, real3 direction, real step)
{
  const BlockInfo* b = &s->v->block;
  real out = (real)ENDLESS;
#define CLIP(c)                                                                                   \
  {                                                                                               \
    const real v = at_least_tiny(direction.c);                                                    \
    const real upper = b->end.c < b->whole.c ? ((real)(float)b->end.c - p.c) / v : (real)ENDLESS; \
    const real lower = b->begin.c > 0 ? ((real)(float)b->begin.c - p.c) / v : (real)ENDLESS;      \
    out = lesser(out, v > (real)0.0f ? upper : lower);                                            \
  }
  CLIP(x)
  CLIP(y)
  CLIP(z)
#undef CLIP
  return greater(ceil(lesser(out / step, (real)1e7f) - (real)0.5f), (real)1.0f) * step;
}
#endif

inline real depth_of(real3 p, const ViewInfo* v, float4 spacing)
{
  const real3 from_eye = { p.x - (real)v->eye.x, p.y - (real)v->eye.y, p.z - (real)v->eye.z };
  const real3 forward = { (real)(v->forward.x * spacing.x), (real)(v->forward.y * spacing.y),
    (real)(v->forward.z * spacing.z) };
  return product(from_eye, forward);
}

// Time t until each ray, continued in a straight line, reaches `t->end`, the depth of an opaque surface.
inline real time_to_end(const ray_packets* t, real3 velocity, const surroundings* s)
{
  const real3 forward = { (real)s->v->forward.x, (real)s->v->forward.y, (real)s->v->forward.z };
  const real pace = product(stretched(velocity, s->o->spacing), forward);
  const real gap = greater(t->end - depth_of(t->at, s->v, s->o->spacing), (real)0.0f);
  return pace > (real)1e-20f ? gap / pace : (real)ENDLESS;
}

#if BENDS
inline real index_at(const surroundings* s, real3 p, real3* bend)
{
  corners at;
  corners_of_index(s, p, &at);
  rgb xyz;
  real square;
  gather(s->bending, &at, INDEX_SIZE(s), &xyz, &square);
  bend->x = xyz.r;
  bend->y = xyz.g;
  bend->z = xyz.b;
  return square;
}
#endif
