// Radiance at both ends of a ray. Where a ray leaves the box, it receives the environment, the background colour or the
// light of a reflecting face. Where it enters, it receives a correction for optically thick voxels at the surface. All
// these values are in one array, `backdrop`; ViewInfo::backdrop holds the indices at which each begins (Backdrop.h).

#pragma once
#include "Viewing/Samples/Sampling.cl"
#include "Viewing/Scene/ViewShared.h"

// Angle of (x, y) from +x, in [-pi, pi], accurate to 1e-7. PoCL's atan2 is scalar and takes ten times as long.
inline real angle_of(real y, real x)
{
  const real ax = fabs(x);
  const real ay = fabs(y);
  const real a = lesser(ax, ay) / greater(greater(ax, ay), (real)1e-30f);
  const real s = a * a;
  real p = fma((real)-0.00466877331f, s, (real)0.0241661895f);
  p = fma(p, s, (real)-0.0593671008f);
  p = fma(p, s, (real)0.099060969f);
  p = fma(p, s, (real)-0.14016585f);
  p = fma(p, s, (real)0.199692354f);
  p = fma(p, s, (real)-0.333319597f);
  p = fma(p, s, (real)0.999999898f) * a;
  p = ay > ax ? (real)M_PI_2_F - p : p;
  p = x < (real)0.0f ? (real)M_PI_F - p : p;
  return copysign(p, y);
}

// Radiance of the environment in each direction d, in the environment's axes; equals Lookup in Lights.h. The image of
// the environment is stored with an additional column of pixels on either side, so that interpolation wraps around z.
inline rgb look_up(__global const float4* environment, real3 d, int4 size)
{
  const real polar = angle_of(sqrt(fma(d.x, d.x, d.y * d.y)), d.z);
  real turn = angle_of(d.y, d.x) * (real)(0.5f * M_1_PI_F);
  turn = turn < (real)0.0f ? turn + (real)1.0f : turn;
  const real column = fma(turn, (real)(float)size.x, (real)-0.5f);
  const real row = fma(polar, (real)(-M_1_PI_F * (float)size.y), (real)((float)size.y - 0.5f));
  const real left = floor(column);
  const real below = floor(row);
  const real x = column - left;
  const real y = row - below;
  const integer i = to_integer(lesser(greater(left, (real)-1.0f), (real)(float)(size.x - 1))) + 1;
  const real last = (real)(float)(size.y - 1);
  const integer j0 = to_integer(lesser(greater(below, (real)0.0f), last)) * (size.x + 2) + i;
  const integer j1 = to_integer(lesser(greater(below + (real)1.0f, (real)0.0f), last)) * (size.x + 2) + i;
  return between_four(environment, j0, j1, x, y);
}

// Background radiance in each direction d, which is given in world coordinates.
inline rgb look_behind(const ViewInfo* v, real3 d, __global const float4* backdrop)
{
  rgb behind = { (real)v->background.x, (real)v->background.y, (real)v->background.z };
  if (v->environment.x > 0)
  {
    const float4* m = v->toPicture;
    const real3 turned = { d.x * m[0].x + d.y * m[0].y + d.z * m[0].z, d.x * m[1].x + d.y * m[1].y + d.z * m[1].z,
      d.x * m[2].x + d.y * m[2].y + d.z * m[2].z };
    const rgb seen = look_up(backdrop + v->backdrop.x, turned, v->environment);
    behind.r += seen.r;
    behind.g += seen.g;
    behind.b += seen.b;
  }
  return behind;
}

// Interpolation of values that are given per cell of the box's faces, in an array [face][row][cell of the row] with
// faces in the order -x to +z. Each face has a border of one cell, which repeats its outermost cells.

typedef struct
{
  integer by_x, by_y; // whether the face's normal is along x, along y; neither: along z
  integer face;       // index of the face: -x, +x, -y, +y, -z, +z
  integer at, row;    // index of the lower left of the four cells around the point, and cells per row
  real a, b;          // interpolation weights of the next cell along the row, and of the next row
} face_place;

// Finds where a ray through point p, traced backwards, first meets a face of the box, and the four cells of this face
// around p whose values are interpolated.
inline face_place face_behind(real3 p, real3 direction, int4 size)
{
  // Traced backwards, the ray meets first the face whose plane it crossed last.
#define SINCE(c) \
  ((direction.c > (real)0.0f ? p.c : (real)(float)size.c - p.c) / greater(fabs(direction.c), (real)1e-20f))
  const real x = SINCE(x), y = SINCE(y), z = SINCE(z);
#undef SINCE
  face_place to;
  to.by_x = (x <= y) & (x <= z);
  to.by_y = (to.by_x == 0) & (y <= z);
  const integer back = (to.by_x ? direction.x : to.by_y ? direction.y : direction.z) < (real)0.0f;
  const integer one = (integer)1, none = (integer)0;
  to.face = (to.by_x ? none : to.by_y ? (integer)2 : (integer)4) + (back ? one : none);

  const int cells_x = (size.y + 2) * (size.z + 2), cells_y = (size.x + 2) * (size.z + 2),
            cells_z = (size.x + 2) * (size.y + 2);
  const integer first = to.by_x ? (back ? (integer)cells_x : (integer)0)
    : to.by_y                   ? (back ? (integer)(2 * cells_x + cells_y) : (integer)(2 * cells_x))
              : (back ? (integer)(2 * cells_x + 2 * cells_y + cells_z) : (integer)(2 * cells_x + 2 * cells_y));
  to.row = to.by_x ? (integer)(size.y + 2) : (integer)(size.x + 2);
  const real u = (to.by_x ? p.y : p.x) + (real)0.5f;
  const real v = (to.by_x | to.by_y ? p.z : p.y) + (real)0.5f;
  const integer i = to_integer(u);
  const integer j = to_integer(v);
  to.at = first + j * to.row + i;
  to.a = u - to_real(i);
  to.b = v - to_real(j);
  return to;
}

// Reflecting faces of the box, seen from inside, such as matt ground or snow.

// Radiance from behind the medium. Rays of the mask `leaves` that leave the box through a reflecting face receive the
// radiance of this face; all other rays receive `behind`.
// Where light enters through a face, a picture made of angular moments adds this light in its pass for scattered light
// and subtracts it in its pass for unscattered light. The transmittances of the two passes differ by the light that was
// scattered through small angles.
//   p     a point, in voxels, from which the ray leaves the box in a straight line
//   size  number of voxels of the box along each axis; `backdrop` has the radiance of the cells of its faces
inline rgb ground_or_behind(
  const ViewInfo* v, __global const float4* backdrop, real3 p, real3 direction, integer leaves, int4 size, rgb behind)
{
  const real3 back = { -direction.x, -direction.y, -direction.z };
  const face_place to = face_behind(p, back, size);
  const integer bits = (integer)v->environment.z >> to.face;
  const integer is_ground = leaves & ((bits & (integer)1) != (integer)0);
  const integer emits = leaves & ((bits & (integer)64) != (integer)0);
  const rgb seen = between_four(backdrop + v->backdrop.y, to.at, to.at + to.row, to.a, to.b);
#if SHOWN == 2
  // This is the pass for unscattered light. Reflecting faces are black here, since the pass for scattered light shows
  // them; the two passes are added.
  const real shown = (real)0.0f, emitted = emits ? (real)-1.0f : (real)0.0f;
#else
  const real shown = (real)1.0f, emitted = emits ? (real)1.0f : (real)0.0f;
#endif
  const rgb light = { is_ground ? shown * seen.r : fma(emitted, seen.r, behind.r),
    is_ground ? shown * seen.g : fma(emitted, seen.g, behind.g),
    is_ground ? shown * seen.b : fma(emitted, seen.b, behind.b) };
  return light;
}

// Correction for light at the surface of optically thick voxels (SurfaceLight in Backdrop.cxx), added to rays where
// they enter the box.

// Lagrange basis polynomial at the cosine x that is 1 at the node a and 0 at b, c and d; the nodes are the cosines
// 0.05, 0.25, 0.6 and 1 (SurfaceCosines in BoxFaces.h).
#define PART_AT(x, a, b, c, d) (((x)-b) * ((x)-c) * ((x)-d) * (1.0f / ((a - b) * (a - c) * (a - d))))

// Correction (SurfaceLight in Backdrop.cxx) for rays that enter the box, W / (length^2 sr); 0 for rays that start
// inside.
//   d       unit vectors along the rays, world coordinates
//   before  length of the ray in front of the entry; 0 for rays that do not enter
inline rgb surface_light(
  const ViewInfo* v, __global const float4* backdrop, rays packet, real3 d, real before, int4 size)
{
  __global const float4* table = backdrop + v->backdrop.z;
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
