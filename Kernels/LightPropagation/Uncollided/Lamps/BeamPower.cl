// Functions for the fixed-point units of a lamp's sums, the solid angles of rectangles, and the power of a lamp's
// beams. Options as for LampBeams.cl.
#pragma once
#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"

// Factor b by which path integrals are multiplied before they are converted to fixed point (numerics.md, Eq. (35)). It
// keeps their precision in optically thick voxels, where path integrals are small.
static float units_of(float sigma, float diagonal)
{
  return fmax(sigma * diagonal, 1.0f);
}

#define FIRST_OF_FLUX (1 + 3 * MOMENTS) // index of the net flux among the fixed-point sums of a voxel
#define FIRST_OF_VACUUM (FIRST_OF_FLUX + 3 * NET_FLUX)

static float corner_angle(float a, float b, float d)
{
  return atan2(a * b, d * sqrt(a * a + b * b + d * d));
}

static float solid_angle_nearby(float a, float b, float width, float height, float d)
{
  const float a0 = a - 0.5f * width, a1 = a + 0.5f * width, b0 = b - 0.5f * height, b1 = b + 0.5f * height;
  return corner_angle(a1, b1, d) - corner_angle(a0, b1, d) - corner_angle(a1, b0, d) + corner_angle(a0, b0, d);
}

// Solid angle of a rectangle, as for solid_angle(), by a Gauss rule of 2 x 2 points.
static float solid_angle_far_away(float a, float b, float width, float height, float d)
{
  float sum = 0.0f;
  for (int i = 0; i < 4; ++i)
  {
    const float x = a + (i & 1 ? 0.288675135f : -0.288675135f) * width;
    const float y = b + (i & 2 ? 0.288675135f : -0.288675135f) * height;
    const float inverse = rsqrt(x * x + y * y + d * d);
    sum += inverse * inverse * inverse;
  }
  return 0.25f * sum * width * height * d;
}

// Solid angle, sr, of a rectangle of this width and height, centred at (a, b), in a plane at distance d. A closed form
// is used near the rectangle (numerics.md, Eq. (16)), and numerical quadrature far away, where the closed form is a
// small difference of large angles.
//   far  quadrature is used if the squared ratio of distance to longer edge is at least this value
static float solid_angle(float a, float b, float width, float height, float d, float far)
{
  return a * a + b * b + d * d < far * fmax(width * width, height * height)
    ? solid_angle_nearby(a, b, width, height, d)
    : solid_angle_far_away(a, b, width, height, d);
}

// Cosine of the angle between the lamp's direction and a ray of this tangent (lateral voxels per layer of voxels).
static float cosine_at(const LampInfo* lamp, const BeamRow* row, float2 tangent)
{
  const int u = (row->axis + 1) % 3;
  const int v = (row->axis + 2) % 3;
  float way[3];
  way[row->axis] = row->up ? lamp->spacing[row->axis] : -lamp->spacing[row->axis];
  way[u] = tangent.x * lamp->spacing[u];
  way[v] = tangent.y * lamp->spacing[v];
  return (way[0] * lamp->direction[0] + way[1] * lamp->direction[1] + way[2] * lamp->direction[2]) *
    rsqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
}

#define SLICES 512 // number of slices into which a beam is divided if the border of the cone crosses it

// Slice of a pyramid of beams: the rays d = (ahead, u + x, v) at fixed v. A pyramid has all directions nearest to one
// sense of an axis. Rays in the cone satisfy a x^2 + 2 b x + c <= 0 and along + x slope >= 0 (numerics.md, Eq. (33a)).
typedef struct
{
  float ahead, u, v;
  float a, b, c, root;
  float along, slope;
} cone_slice;

// Slice of the pyramid at v.
// @param v  lateral position of the slice, a length, at a distance of one layer of voxels along the pyramid's axis;
//   relative to the position at the reference tangent (BeamRow::baseV)
static cone_slice slice_at(const LampInfo* lamp, const BeamRow* row, float v)
{
  const int i = row->axis, j = (i + 1) % 3, k = (i + 2) % 3;
  const float c[3] = { lamp->direction[i], lamp->direction[j], lamp->direction[k] };
  const float m[3] = { row->crossing[0] - v * c[1], row->crossing[1] + v * c[0], row->crossing[2] };
  const float s2 = lamp->sineSquare, k2 = lamp->cosine * lamp->cosine;
  cone_slice slice;
  slice.ahead = row->up ? lamp->spacing[i] : -lamp->spacing[i];
  slice.u = row->baseU * lamp->spacing[j];
  slice.v = row->baseV * lamp->spacing[k] + v;
  const float plane = slice.ahead * slice.ahead + slice.v * slice.v, square = plane + slice.u * slice.u;
  slice.along = slice.ahead * c[0] + slice.u * c[1] + slice.v * c[2];
  slice.slope = c[1];
  if (s2 < 0.5f)
  {
    slice.a = c[0] * c[0] + c[2] * c[2] - s2;
    slice.b = m[0] * c[2] - m[2] * c[0] - s2 * slice.u;
    slice.c = m[0] * m[0] + m[1] * m[1] + m[2] * m[2] - s2 * square;
  }
  else
  {
    slice.a = k2 - c[1] * c[1];
    slice.b = k2 * slice.u - slice.along * c[1];
    slice.c = k2 * square - slice.along * slice.along;
  }
  slice.root = k2 * (s2 * plane - m[1] * m[1]);
  return slice;
}

static bool is_in_cone(const cone_slice* slice, float x)
{
  return (slice->a * x + 2.0f * slice->b) * x + slice->c <= 0.0f && slice->along + slice->slope * x >= 0.0f;
}

// Interval of x in the slice, from edges.x to edges.y, whose rays are in the cone.
static float2 part_of_slice(const cone_slice* slice, float2 edges)
{
  const bool low = is_in_cone(slice, edges.x), high = is_in_cone(slice, edges.y);
  if (low && high)
  {
    return edges;
  }
  const float q = -(slice->b + copysign(sqrt(fmax(slice->root, 0.0f)), slice->b));
  const float r0 = slice->a != 0.0f ? q / slice->a : INFINITY, r1 = q != 0.0f ? slice->c / q : r0;
  if (low != high)
  {
    const float middle = 0.5f * (edges.x + edges.y);
    const float border = clamp(fabs(r0 - middle) < fabs(r1 - middle) ? r0 : r1, edges.x, edges.y);
    return low ? (float2)(edges.x, border) : (float2)(border, edges.y);
  }
  const float first = fmin(r0, r1), second = fmax(r0, r1);
  const bool within = slice->a > 0.0f && slice->root > 0.0f && first > edges.x && second < edges.y &&
    slice->along + slice->slope * 0.5f * (first + second) > 0.0f;
  return within ? (float2)(first, second) : edges.xx;
}

// Solid angle of the interval `part` of x in a slice, divided by the slice's height along v.
static float angle_of_slice(const cone_slice* slice, float2 part)
{
  const float x = slice->u + 0.5f * (part.x + part.y);
  const float inverse = rsqrt(slice->ahead * slice->ahead + x * x + slice->v * slice->v);
  return (part.y - part.x) * inverse * inverse * inverse;
}

// Fraction of a beam's solid angle that is in the cone.
//   middle  tangents of the beam's centre, relative to the pyramid's reference tangents (BeamRow::baseU, baseV)
static float part_in_cone(const LampInfo* lamp, const BeamRow* row, float2 middle)
{
  const float2 spacing = (float2)(lamp->spacing[(row->axis + 1) % 3], lamp->spacing[(row->axis + 2) % 3]);
  const float2 low = (middle - 0.5f * (float2)(row->widthU, row->widthV)) * spacing;
  const float2 width = (float2)(row->widthU, row->widthV) * spacing, edges = (float2)(low.x, low.x + width.x);
  const cone_slice bottom = slice_at(lamp, row, low.y), top = slice_at(lamp, row, low.y + width.y);
  if (is_in_cone(&bottom, edges.x) && is_in_cone(&bottom, edges.y) && is_in_cone(&top, edges.x) &&
    is_in_cone(&top, edges.y)) // all corners of the beam are in the convex cone
  {
    return 1.0f;
  }
  float inside = 0.0f, all = 0.0f;
  for (int i = 0; i < SLICES; ++i)
  {
    const cone_slice slice = slice_at(lamp, row, low.y + (i + 0.5f) / SLICES * width.y);
    inside += angle_of_slice(&slice, part_of_slice(&slice, edges));
    all += angle_of_slice(&slice, edges);
  }
  return inside / all;
}

// Tangents of a beam's centre. tangent_from_base() returns them relative to the reference tangents of its pyramid
// (BeamRow::baseU, baseV), tangent_of() relative to the pyramid's axis. begin_of() returns the position of the beam's
// centre at its start, voxels.
static float2 tangent_from_base(const BeamRow* row, int beam)
{
  return (float2)(row->tangentU + beam * row->widthU, row->tangentV);
}

static float2 tangent_of(const BeamRow* row, int beam)
{
  return (float2)(row->baseU, row->baseV) + tangent_from_base(row, beam);
}

static float2 begin_of(const BeamRow* row, int beam)
{
  return (float2)(row->startU + beam * row->openU, row->startV);
}

// Initial power of a beam, as a fraction of the traced power (the share of the lamp's power that may reach the box).
static float power_of_beam(const LampInfo* lamp, const BeamRow* row, int beam)
{
  const float2 spacing = (float2)(lamp->spacing[(row->axis + 1) % 3], lamp->spacing[(row->axis + 2) % 3]);
  const float2 tangent = tangent_of(row, beam), size = (float2)(row->widthU, row->widthV) * spacing;
  float angle =
    solid_angle(tangent.x * spacing.x, tangent.y * spacing.y, size.x, size.y, lamp->spacing[row->axis], 64.0f);
  if (LAMBERT)
  {
    angle *= fmax(cosine_at(lamp, row, tangent), 0.0f);
  }
  else if (CONE)
  {
    angle *= part_in_cone(lamp, row, tangent_from_base(row, beam));
  }
  return angle > 0.0f ? row->share * lamp->intensity * angle : 0.0f;
}
