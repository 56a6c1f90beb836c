// What a camera sees of a medium that bends rays, of a surface and of a table: rays from the camera, what the surface
// reflects of them, and what the table mirrors of them, one march each. One work-item is a packet of neighbouring
// pixels.
//
// Along a bent ray L / n^2 is conserved but for what the medium does (numerics.md, Eq. (109)): sources and backgrounds
// are divided by n^2 of their place, and the picture is multiplied by n^2 where the ray enters.

#include "Viewing/Backdrop/Background.cl"
#include "Viewing/Backdrop/GroundLight.cl"
#include "Viewing/Rays/BentRays.cl"
#include "Viewing/Rays/Crossing.cl"
#include "Viewing/Rays/RayPackets.cl"
#include "Viewing/Rays/SurfaceReflection.cl"
#include "Viewing/Rays/Table.cl"
#include "Viewing/Rays/View.cl"
#include "Viewing/Samples/Sampling.cl"

#define PASSES (1 + (SURFACE > 0) + TABLE)

// What all marches gather together: light with n^2 divided out, and transmittance and depth along the camera's own ray.
typedef struct
{
  light l;
  real entrySquare; // n^2 where the ray enters
  real left, depth;
  waiting mirrored;
} seeing;

// Rays from the camera where they enter the box, as fast as the index there has it.
inline ray_packets enter(const surroundings* s, camera_rays seen, real end, real* entry_square)
{
  const real3 direction = stretched(seen.d, s->v->inverseSpacing);
  real before;
  const rays packet = clip_to_box(seen.from, direction, end / seen.cosine, s->v->size, &before);
  ray_packets t = { packet.entry, direction, packet.length > (real)0.0f };
#if ENDS
  t.end = end;
  t.stopped = (integer)0;
#endif
  *entry_square = (real)1.0f;
#if BENDS
  real3 unused;
  const real square = index_at(s, t.at, &unused);
  *entry_square = t.inside ? square : (real)1.0f;
  const real3 still = { (real)0.0f, (real)0.0f, (real)0.0f };
  t.velocity = further(still, sqrt(*entry_square), direction);
#endif
  return t;
}

// Sends off what waits for a later march; false where nothing does.
inline int send_off(const waiting* next, ray_packets* t, light* l)
{
  l->left = next->left;
  t->at = next->at;
  t->velocity = next->velocity;
  t->inside = most_left(*l) > (real)0.0f;
#if ENDS
  t->end = (real)ENDLESS; // what ends the camera's rays is not known to be in the way of others
  t->stopped = (integer)0;
#endif
  return any_lane(t->inside);
}

// What a march comes to: background, or table. Rays that did not find out see the background as if the index were there
// what it is at their entry.
inline void arrive(const surroundings* s, const ray_packets* t, integer set_off, int primary,
  __global const float4* lit, __global const float4* environment, __global const float4* ground, crossed* half_way,
  seeing* to)
{
  integer out = set_off & (t->inside == 0);
#if ENDS
  out &= t->stopped == 0;
#endif
  const real3 world = stretched(t->velocity, s->o->spacing);
  real3 towards = divided(world, sqrt(greater(product(world, world), (real)1e-30f)));
  real square = to->entrySquare;
#if BENDS
  real3 unused;
  const real there = index_at(s, t->at, &unused);
  square = out ? there : square;
#endif
#if ENDS
  real part = t->end < (real)ENDLESS ? (real)0.0f : (real)1.0f;
#else
  real part = (real)1.0f;
#endif
  real left = mean_left(to->l);
  integer ends = (integer)0;
#if TABLE
  ends = meet_table(s, t, out);
  if (any_lane(ends))
  {
    end_on_table(s, lit, t->at, ends, &to->l, &towards);
    part = ends ? (real)s->o->table.w : part;
    if (primary)
    {
      to->mirrored.at = t->at;
      to->mirrored.velocity = stretched(t->velocity, s->o->flip);
      to->mirrored.left = scaled(to->l.left, ends ? part : (real)0.0f);
      part = ends ? (real)0.0f : part;
      lose_half(ends & (left > (real)0.5f), depth_of(t->at, s->v, s->o->spacing), half_way);
      left = ends ? (real)0.0f : left;
    }
  }
#endif
  if (primary)
  {
    to->left = left;
    to->depth = left > (real)0.5f ? (real)s->v->marching.z : distance_to_half(*half_way);
  }
  rgb behind = look_behind(s->v, towards, environment);
#if GROUND
  behind = ground_or_behind(ground, kept_within(t->at, s->v->size), t->velocity, out & (ends == 0), s->v->size, behind);
#endif
  add_background(behind, part * (real)s->v->background.w / square, &to->l);
}

// lit      what a white table shines by n^2, a float4 a voxel with a border
// bending  see surroundings
__kernel void cast_bent_rays(ViewInfo v, OpticsInfo o, __global const float4* restrict samples,
  __global const float4* restrict extinctions, __global const float4* restrict flow,
  __global const float4* restrict glow, __global const float4* restrict cosines,
  __global const float* restrict phase_rows, __global const float4* restrict bending,
  __global const float4* restrict lit, __global const char* restrict bricks,
  __global const float4* restrict environment, __global const float4* restrict ground,
  __global const float* restrict ends, __global float* restrict radiance, __global float* restrict alpha,
  __global float* restrict depth)
{
  const int column = (get_global_id(0) + v.picture.w) * PACKET_WIDTH;
  const int row = (get_global_id(1) + v.picture.z) * PACKET_HEIGHT;
  if (column >= v.picture.x || row >= v.picture.y)
  {
    return;
  }
  const surroundings s = { &v, &o, { samples, extinctions, flow, glow, cosines, phase_rows, v.phase }, bending,
    bricks };
  seeing to;
#if ENDS
  const real end = ends_of(&v, ends, column, row);
#else
  const real end = (real)ENDLESS;
#endif
  ray_packets t = enter(&s, rays_through(&v, column, row), end, &to.entrySquare);
  to.l = unlit((real)1.0f);
  const waiting nothing = { t.at, t.velocity, unlit((real)0.0f).left };
  to.mirrored = nothing;
  watch w = { (integer)0, (real)0.0f, (real)0.0f, 1, nothing };
  crossed half_way = { (real)0.0f, (real)0.0f, (real)1.0f, (real)1.0f };
  for (int pass = 0; pass < PASSES; ++pass)
  {
    if (pass > 0)
    {
      const waiting next = SURFACE && pass == 1 ? w.reflected : to.mirrored;
      if (!send_off(&next, &t, &to.l))
      {
        continue;
      }
      w.met = (integer)-1;
    }
    const integer set_off = t.inside;
    march(&s, &t, &to.l, &half_way, &w);
    arrive(&s, &t, set_off, pass == 0, lit, environment, ground, &half_way, &to);
  }
  to.l.radiance.r *= to.entrySquare;
  to.l.radiance.g *= to.entrySquare;
  to.l.radiance.b *= to.entrySquare;
  const canvas picture = { radiance, alpha, depth };
  paint(&v, picture, column, row, to.l.radiance, (real)1.0f - to.left, to.depth);
}
