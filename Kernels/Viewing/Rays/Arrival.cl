// Entry of rays into the medium's box, and the radiance that they receive where they leave it. Included by BentView.cl
// and RayRounds.cl.
//
// Along a bent ray L / n^2, radiance over squared refractive index, changes only by emission, scattering and absorption
// (numerics.md, Eq. (109)). Sources and backgrounds are therefore divided by the local n^2, and the picture is
// multiplied by n^2 at the ray's entry.

#pragma once
#include "Viewing/Backdrop/Backdrop.cl"
#include "Viewing/Rays/BentRays.cl"
#include "Viewing/Rays/Crossing.cl"
#include "Viewing/Rays/RayPackets.cl"
#include "Viewing/Rays/View.cl"
#include "Viewing/Samples/Sampling.cl"

// A ray meets the table if its exit point is at most this distance, in voxels, from the table's face. The distance
// allows for rounding. The table is a plane at one face of the box that reflects light.
#define REACH_OF_TABLE 2e-3f

// Radiance, divided by n^2, of a white table (diffuse reflectance 1) at points of its face, interpolated between voxel
// centres.
//   place  points on the table, in voxels of the whole grid
inline rgb table_light(const surroundings* s, __global const float4* backdrop, real3 place)
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
  return between_four(backdrop + s->v->backdrop.w, first, first + row, across, up);
}

// Mask of those rays of `left_box` that leave the box through the face on which the table is.
inline integer meet_table(const surroundings* s, const ray_packets* t, integer left_box)
{
  const int axis = s->o->face.x;
  const real sign = (real)(s->o->face.y ? 1.0f : -1.0f);
  const real place = axis == 0 ? t->at.x : axis == 1 ? t->at.y : t->at.z;
  const real heading = axis == 0 ? t->velocity.x : axis == 1 ? t->velocity.y : t->velocity.z;
  const float face = s->o->face.y ? (float)(axis == 0 ? s->v->size.x : axis == 1 ? s->v->size.y : s->v->size.z) : 0.0f;
  return left_box & (fabs(place - (real)face) < (real)REACH_OF_TABLE) & (heading * sign > (real)0.0f);
}

// Adds the radiance that the table reflects diffusely to the rays `ends`, which end on it at `p`, and mirrors their
// directions `towards` in the table.
inline void end_on_table(
  const surroundings* s, __global const float4* backdrop, real3 p, integer ends, light* l, real3* towards)
{
  const float4 table = s->o->table;
  rgb shine = table_light(s, backdrop, p);
  shine.r *= (real)table.x;
  shine.g *= (real)table.y;
  shine.b *= (real)table.z;
  add_background(shine, ends ? (real)1.0f : (real)0.0f, l);
  *towards = chosen(ends, stretched(*towards, s->o->flip), *towards);
}

// Result of all marches of a pixel (primary, reflected and mirrored rays): accumulated radiance divided by n^2, and
// transmittance and depth along the primary ray.
typedef struct
{
  light l;
  real entrySquare; // n^2 at the primary ray's entry into the box
  real left, depth;
  waiting mirrored;
} seeing;

// State of camera rays at their entry into the box, where their velocity T has magnitude n, the local refractive index.
//   end  depth along the view axis at which each ray ends
//   entry_square  receives n^2 at the entry
inline ray_packets enter(const surroundings* s, camera_rays seen, real end, real* entry_square)
{
  const real3 direction = stretched(seen.d, s->v->inverseSpacing);
  real before;
  const rays packet = clip_to_box(seen.from, direction, end / seen.cosine, s->v->size, &before);
  ray_packets t = { packet.entry, direction, packet.length > (real)0.0f };
  t.end = end;
  t.stopped = (integer)0;
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

inline spectrum mirrored_part(integer mirrors, spectrum now, spectrum before)
{
#if COLOURED
  const spectrum left = { mirrors ? now.r : before.r, mirrors ? now.g : before.g, mirrors ? now.b : before.b };
  return left;
#else
  return mirrors ? now : before;
#endif
}

// Adds the radiance at the end of a march: that of background, ground or table, attenuated by the ray's transmittance.
// A ray that never leaves the box receives the background, divided by n^2 at its entry.
//   ends_here  rays whose march ends now; the other rays of the packet are not changed
//   set_off    rays of `ends_here` that have been inside the box
//   primary    rays of `ends_here` that start at the camera
inline void arrive(const surroundings* s, const ray_packets* t, integer ends_here, integer set_off, integer primary,
  __global const float4* backdrop, crossed* half_way, seeing* to)
{
  const integer out = ends_here & set_off & (t->inside == 0) & (t->stopped == 0);
  const real3 world = stretched(t->velocity, s->o->spacing);
  real3 towards = divided(world, sqrt(greater(product(world, world), (real)1e-30f)));
  real square = to->entrySquare;
#if BENDS
  real3 unused;
  const real there = index_at(s, t->at, &unused);
  square = out ? there : square;
#endif
  real part = t->end < (real)ENDLESS ? (real)0.0f : (real)1.0f;
  real left = mean_left(to->l);
  const integer ends = s->o->face.w ? meet_table(s, t, out) : (integer)0;
  if (any_lane(ends))
  {
    end_on_table(s, backdrop, t->at, ends, &to->l, &towards);
    part = ends ? (real)s->o->table.w : part;
    const integer mirrors = ends & primary;
    to->mirrored.at = chosen(mirrors, t->at, to->mirrored.at);
    to->mirrored.velocity = chosen(mirrors, stretched(t->velocity, s->o->flip), to->mirrored.velocity);
    to->mirrored.left = mirrored_part(mirrors, scaled(to->l.left, part), to->mirrored.left);
    part = mirrors ? (real)0.0f : part;
    lose_half(mirrors & (left > (real)0.5f), depth_of(t->at, s->v, s->o->spacing), half_way);
    left = mirrors ? (real)0.0f : left;
  }
  const integer seen = ends_here & primary;
  to->left = seen ? left : to->left;
  const real where = left > (real)0.5f ? (real)s->v->marching.z : distance_to_half(*half_way);
  to->depth = seen ? where : to->depth;
  rgb behind = look_behind(s->v, towards, backdrop);
  if (s->v->environment.z != 0)
  {
    behind =
      ground_or_behind(s->v, backdrop, in_block(s, t->at), t->velocity, out & (ends == 0), SAMPLES_SIZE(s), behind);
  }
  part = ends_here ? part : (real)0.0f;
  add_background(behind, part * (real)s->v->background.w / square, &to->l);
}
