// Renders a picture by primary rays through a medium of constant refractive index, one work-item per packet of
// neighbouring pixels.
//
// Macros set by the host:
//   BLOCK  1: the medium is a block of a larger grid

#include "Viewing/Backdrop/Backdrop.cl"
#include "Viewing/Rays/Crossing.cl"
#include "Viewing/Rays/View.cl"
#include "Viewing/Samples/Sampling.cl"

// Marches a packet of straight rays through the medium in steps of v->marching.x voxels. `l` accumulates radiance and
// loses transmittance. Empty bricks are skipped. The march ends once no ray's transmittance exceeds v->marching.y.
//   bricks    distances between bricks of different classes, see Sampling.cl
//   records   index of the first sample of each brick's record, with BRICKED
//   packet    section of the rays in the medium
//   d         unit vectors along the rays, away from the eye
//   half_way  receives the step in which the transmittance falls below 1/2
__attribute__((always_inline)) inline void march_straight(const ViewInfo* v, const scenery* scene,
  __global const char* bricks, __global const int* records, rays packet, real3 d, light* l, crossed* half_way)
{
  const real step = step_length(packet.direction, v->marching.x);
#if !BRICKED
  const real soon = step_length(packet.direction, 5.0f);
#endif
  const int steps = (int)ceil(most_lanes(packet.length / step));
  const real3 strides = strides_per_voxel(packet.direction, step);
  for (int n = 0; n < steps;)
  {
    const real so_far = step * (real)(float)n;
    const integer done = (so_far >= packet.length) | (most_left(*l) <= (real)v->marching.y);
    if (all_lanes(done))
    {
      break;
    }
    int stop = n + BrickEdge;
    if (v->has.w)
    {
      const stretch ahead =
        stretch_ahead(bricks, v->bricks, along(packet, fma(step, (real)0.5f, so_far)), strides, done);
      stop = n + ahead.steps;
      if (ahead.empty)
      {
        n = stop;
        continue;
      }
    }
    stop = min(stop, steps);
    for (; n < stop; ++n)
    {
      // The sample is read before the transmittance is needed, so that reading overlaps the previous step in the
      // processor.
      const real start = step * (real)(float)n;
      const real length = lesser(greater(packet.length - start, (real)0.0f), step);
      corners at;
#if BRICKED
      find_corners_in_bricks(along(packet, fma(length, (real)0.5f, start)), v->size, records, &at);
#else
      find_corners(along(packet, fma(length, (real)0.5f, start)), v->size, &at);
#endif
      const sample s = take_sample(scene, &at, v->size, d);
#if !BRICKED
      fetch_ahead(scene->samples, along(packet, start + soon), v->size);
#endif
      cross_sample(v, s, length, start, length, l, half_way);
    }
  }
}

// Adds the radiance from behind the medium, attenuated by the transmittance. Rays that leave the box through a
// reflecting face receive the face's radiance, other rays the background's.
//   packet       section of the rays in the medium
//   d            unit vectors along the rays, away from the eye
//   sees_behind  rays that leave the domain without meeting an opaque surface; other rays receive nothing
inline void add_light_behind(
  const ViewInfo* v, __global const float4* backdrop, rays packet, real3 d, integer sees_behind, light* l)
{
  rgb behind = look_behind(v, d, backdrop);
  if (v->environment.z != 0)
  {
    behind = ground_or_behind(
      v, backdrop, along(packet, packet.length), packet.direction, packet.length > (real)0.0f, v->size, behind);
  }
  add_background(behind, sees_behind ? (real)v->background.w : (real)0.0f, l);
}

// Renders the medium.
//   bricks   signed distances of bricks, by which rays skip empty ones (Sampling.cl)
//   records  with BRICKED: index of the first sample of each brick's record
//   limits   depths at which opaque surfaces end the rays, one per pixel if v.has.x; then the transmittances of the
//            blocks in front, three per pixel if v.has.y
//   picture  receives radiance, alpha and depth, in the layout of View.cl
__kernel void cast_rays(ViewInfo v, __global const float4* restrict samples,
  __global const float4* restrict extinctions, __global const float4* restrict flow,
  __global const float4* restrict glow, __global const float4* restrict cosines,
  __global const float* restrict phase_rows, __global const char* restrict bricks, __global const int* restrict records,
  __global const float4* restrict backdrop, __global const float* restrict limits, __global float* restrict picture)
{
  const int column = (get_global_id(0) + v.picture.w) * PACKET_WIDTH;
  const int row = (get_global_id(1) + v.picture.z) * PACKET_HEIGHT;
  if (column >= v.picture.x || row >= v.picture.y)
  {
    return;
  }
  const scenery scene = { samples, extinctions, flow, glow, cosines, phase_rows, v.phase };
  const camera_rays seen = rays_through(&v, column, row);
  const real3 direction = { seen.d.x * (real)v.inverseSpacing.x, seen.d.y * (real)v.inverseSpacing.y,
    seen.d.z * (real)v.inverseSpacing.z };
  const real end = v.has.x ? ends_of(&v, limits, column, row) : (real)ENDLESS;
  const integer open = end >= (real)ENDLESS; // rays that no opaque surface ends
  real before;
#if BLOCK
  integer enters, leaves;
  const rays packet =
    clip_to_block(seen.from, direction, end / seen.cosine, &v.block, v.marching.x, &before, &enters, &leaves);
  const integer sees_behind = open & leaves;
#else
  const rays packet = clip_to_box(seen.from, direction, end / seen.cosine, v.size, &before);
  const integer sees_behind = open;
#endif

  light l = unlit((real)1.0f);
#if BLOCK
  l.before = starts_of(&v, limits, column, row);
#endif
  crossed half_way = { (real)0.0f, (real)0.0f, (real)1.0f, (real)1.0f };
  march_straight(&v, &scene, bricks, records, packet, seen.d, &l, &half_way);

  const real left = mean_left(l);
  if (v.has.z)
  {
#if BLOCK
    // This correction is multiplied by 1 - transmittance of all blocks along the ray, when the blocks are composited.
    paint_triple(&v, picture + MISSING_LIGHT(&v), column, row,
      surface_light(&v, backdrop, packet, seen.d, enters ? before : (real)0.0f, v.size));
#else
    add_surface_light(surface_light(&v, backdrop, packet, seen.d, before, v.size), &l);
#endif
  }
  add_light_behind(&v, backdrop, packet, seen.d, sees_behind, &l);
  const real where = left > (real)0.5f ? (real)v.marching.z : (distance_to_half(half_way) + before) * seen.cosine;
#if BLOCK
  // A block that shows the background hides everything behind it, so that alpha is 1.
  const real kept = sees_behind ? (real)(1.0f - v.background.w) : (real)1.0f;
  paint_triple(&v, picture + PASSED_PART(&v), column, row, passed_of(l));
  paint(&v, picture, column, row, l.radiance, (real)1.0f - left * kept, where);
#else
  paint(&v, picture, column, row, l.radiance, (real)1.0f - left, where);
#endif
}
