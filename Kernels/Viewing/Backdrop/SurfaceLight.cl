// Surface light of optically thick voxels, added where rays enter the box.

#pragma once
#include "Viewing/Backdrop/BoxFacePlaces.cl"
#include "Viewing/Samples/Sampling.cl"

// Lagrange basis polynomial at cosine x, for the node a among the cosines 0.05, 0.25, 0.6 and 1 (SurfaceCosines in
// BoxFaces.h).
#define PART_AT(x, a, b, c, d) (((x)-b) * ((x)-c) * ((x)-d) * (1.0f / ((a - b) * (a - c) * (a - d))))

// Correction for the march of rays that enter the box: radiance at the eye; 0 for rays that start inside.
//   table   see BackdropTables.h
//   d       unit vectors along the rays, world
//   before  length in front of the entry; 0 for rays that do not enter
inline rgb surface_light(__global const float4* table, rays packet, real3 d, real before, int4 size)
{
  const face_place to = face_behind(packet.entry, packet.direction, size);
  const real mu = fabs(to.by_x ? d.x : to.by_y ? d.y : d.z);
  const int all = 2 * ((size.y + 2) * (size.z + 2) + (size.x + 2) * (size.z + 2) + (size.x + 2) * (size.y + 2));

  rgb sum = { (real)0.0f, (real)0.0f, (real)0.0f };
  const integer enters = before > (real)0.0f;
#define ADD(n, part)                                                                   \
  {                                                                                    \
    const rgb seen = between_four(table + n * all, to.at, to.at + to.row, to.a, to.b); \
    const real weight = enters ? part : (real)0.0f;                                    \
    sum.r = fma(seen.r, weight, sum.r);                                                \
    sum.g = fma(seen.g, weight, sum.g);                                                \
    sum.b = fma(seen.b, weight, sum.b);                                                \
  }
  ADD(0, PART_AT(mu, 0.05f, 0.25f, 0.6f, 1.0f))
  ADD(1, PART_AT(mu, 0.25f, 0.05f, 0.6f, 1.0f))
  ADD(2, PART_AT(mu, 0.6f, 0.05f, 0.25f, 1.0f))
  ADD(3, PART_AT(mu, 1.0f, 0.05f, 0.25f, 0.6f))
#undef ADD
  return sum;
}
