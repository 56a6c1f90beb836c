// Renders a medium that bends rays, with a reflecting surface and a table. Each packet of neighbouring pixels, one per
// work-item, is marched up to three times: primary rays, rays reflected by the surface, and rays mirrored by the table.

#include "Viewing/Rays/Arrival.cl"
#include "Viewing/Rays/BentRays.cl"
#include "Viewing/Rays/View.cl"
#include "Viewing/Samples/Sampling.cl"

// Starts the march of the reflected or mirrored rays `next`, which were stored until an earlier march ended. Returns
// false if there are none.
inline int send_off(const waiting* next, ray_packets* t, light* l)
{
  l->left = next->left;
  t->at = next->at;
  t->velocity = next->velocity;
  t->inside = most_left(*l) > (real)0.0f;
  // Opaque surfaces end camera rays only: their depths are not known along reflected and mirrored rays.
  t->end = (real)ENDLESS;
  t->stopped = (integer)0;
  return any_lane(t->inside);
}

// Renders the picture, one work-item per packet of neighbouring pixels.
//   bending  at voxel centres: x, y, z: acceleration of the rays in voxel coordinates (half the difference of n^2 per
//            voxel along the axis, divided by the squared spacing); w: n^2
//   bricks   signed distances of bricks, by which rays skip empty ones (Sampling.cl)
//   limits   depths along the view axis at which opaque surfaces end the rays, one per pixel; not read unless v.has.x
//   picture  output: radiance (3 values per pixel, W / (length^2 sr)) of all pixels, then alpha (1 - mean
//            transmittance) of all pixels, then depth along the view axis at which the mean transmittance falls to 1/2
__kernel void cast_bent_rays(RayPass pass, __global const float4* restrict samples,
  __global const float4* restrict extinctions, __global const float4* restrict flow,
  __global const float4* restrict glow, __global const float4* restrict cosines,
  __global const float* restrict phase_rows, __global const float4* restrict bending,
  __global const char* restrict bricks, __global const float4* restrict backdrop, __global const float* restrict limits,
  __global float* restrict picture)
{
  const ViewInfo* v = &pass.view;
  const OpticsInfo* o = &pass.optics;
  const int column = (get_global_id(0) + v->picture.w) * PACKET_WIDTH;
  const int row = (get_global_id(1) + v->picture.z) * PACKET_HEIGHT;
  if (column >= v->picture.x || row >= v->picture.y)
  {
    return;
  }
  const surroundings s = { v, o, { samples, extinctions, flow, glow, cosines, phase_rows, v->phase }, bending, bricks };
  seeing to;
  const real end = v->has.x ? ends_of(v, limits, column, row) : (real)ENDLESS;
  const int marches = 1 + (SURFACE(&s) > 0) + o->face.w;
  ray_packets t = enter(&s, rays_through(v, column, row), end, &to.entrySquare);
  to.l = unlit((real)1.0f);
  const waiting nothing = { t.at, t.velocity, unlit((real)0.0f).left };
  to.mirrored = nothing;
  watch w = { (integer)0, (real)0.0f, (real)0.0f, (integer)-1, nothing };
  crossed half_way = { (real)0.0f, (real)0.0f, (real)1.0f, (real)1.0f };
  for (int turn = 0; turn < marches; ++turn)
  {
    if (turn > 0)
    {
      const waiting next = SURFACE(&s) && turn == 1 ? w.reflected : to.mirrored;
      if (!send_off(&next, &t, &to.l))
      {
        continue;
      }
      w.met = (integer)-1;
    }
    const integer set_off = t.inside;
    march(&s, &t, &to.l, &half_way, &w);
    arrive(&s, &t, (integer)-1, set_off, (integer)(turn == 0 ? -1 : 0), backdrop, &half_way, &to);
  }
  to.l.radiance.r *= to.entrySquare;
  to.l.radiance.g *= to.entrySquare;
  to.l.radiance.b *= to.entrySquare;
  paint(v, picture, column, row, to.l.radiance, (real)1.0f - to.left, to.depth);
}
