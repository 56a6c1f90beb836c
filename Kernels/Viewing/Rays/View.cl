// Camera rays through the pixels of a packet, and output of their radiance, alpha and depth to the picture.

#pragma once
#include "Viewing/Samples/Sampling.cl"
#include "Viewing/Scene/ViewShared.h"

// Shape of a packet of REAL_WIDTH rays, in pixels.
#if REAL_WIDTH == 16
#define PACKET_WIDTH 4
#define PACKET_HEIGHT 4
#define ACROSS (real)(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3)
#define UPWARDS (real)(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3)
#elif REAL_WIDTH == 8
#define PACKET_WIDTH 4
#define PACKET_HEIGHT 2
#define ACROSS (real)(0, 1, 2, 3, 0, 1, 2, 3)
#define UPWARDS (real)(0, 0, 0, 0, 1, 1, 1, 1)
#elif REAL_WIDTH == 4
#define PACKET_WIDTH 2
#define PACKET_HEIGHT 2
#define ACROSS (real)(0, 1, 0, 1)
#define UPWARDS (real)(0, 0, 1, 1)
#else
#define PACKET_WIDTH 1
#define PACKET_HEIGHT 1
#define ACROSS 0.0f
#define UPWARDS 0.0f
#endif

// Camera rays of a packet: start in voxels, unit vectors in world coordinates, and cosine of the angle to the view
// axis.
typedef struct
{
  real3 from, d;
  real cosine;
} camera_rays;

inline camera_rays rays_through(const ViewInfo* v, int column, int row)
{
  const real x =
    ((real)(float)column + ACROSS + (real)0.5f) * (real)(2.0f / (float)v->picture.x) - (real)1.0f + (real)v->right.w;
  const real y =
    ((real)(float)row + UPWARDS + (real)0.5f) * (real)(2.0f / (float)v->picture.y) - (real)1.0f + (real)v->up.w;
  const real3 offset = { fma(x, (real)v->right.x, y * (real)v->up.x), fma(x, (real)v->right.y, y * (real)v->up.y),
    fma(x, (real)v->right.z, y * (real)v->up.z) };
  const real spread = (real)(1.0f - v->eye.w);
  camera_rays r;
  r.d.x = fma(spread, offset.x, (real)v->forward.x);
  r.d.y = fma(spread, offset.y, (real)v->forward.y);
  r.d.z = fma(spread, offset.z, (real)v->forward.z);
  r.cosine = (real)1.0f / sqrt(fma(r.d.x, r.d.x, fma(r.d.y, r.d.y, r.d.z * r.d.z)));
  r.d.x *= r.cosine;
  r.d.y *= r.cosine;
  r.d.z *= r.cosine;
  r.from.x = fma((real)(v->eye.w * v->inverseSpacing.x), offset.x, (real)v->eye.x);
  r.from.y = fma((real)(v->eye.w * v->inverseSpacing.y), offset.y, (real)v->eye.y);
  r.from.z = fma((real)(v->eye.w * v->inverseSpacing.z), offset.z, (real)v->eye.z);
  return r;
}

#define ENDLESS 1e30f // depth larger than any other: no opaque surface ends the ray

// Indices in the picture of the pixels of a packet whose first pixel is (column, row). Packet positions outside the
// picture are given the index of the nearest pixel inside.
inline integer nearest_pixels(const ViewInfo* v, int column, int row)
{
  const integer i = to_integer(lesser(ACROSS + (real)(float)column, (real)(float)(v->picture.x - 1)));
  const integer j = to_integer(lesser(UPWARDS + (real)(float)row, (real)(float)(v->picture.y - 1)));
  return j * v->picture.x + i;
}

// Depths along the view axis at which opaque surfaces end a packet's rays; ENDLESS for other rays.
//   limits  these depths, one per pixel if v.has.x, then the transmittance of the blocks in front, three per pixel if
//           v.has.y
inline real ends_of(const ViewInfo* v, __global const float* limits, int column, int row)
{
  const integer pixel = nearest_pixels(v, column, row);
  real end;
#define FETCH(n) LANE(end, n) = limits[LANE(pixel, n)];
  EACH_LANE(FETCH)
#undef FETCH
  return end;
}

// Indices in the picture of the pixels of a packet whose first pixel is (column, row); valid only for pixels that are
// in_picture.
inline integer pixels_of(const ViewInfo* v, int column, int row)
{
  return (integer)(row * v->picture.x + column) + to_integer(UPWARDS) * v->picture.x + to_integer(ACROSS);
}

inline integer in_picture(const ViewInfo* v, int column, int row)
{
  return (to_integer(ACROSS) + column < (integer)v->picture.x) & (to_integer(UPWARDS) + row < (integer)v->picture.y);
}

// A picture is one array that consists of several images one after the other, each with one or three values per pixel:
//   radiance  3, W / (length^2 sr)
//   alpha     1, 1 - mean transmittance
//   depth     1, along the view axis, where the mean transmittance falls to 1/2
//   for a block of a larger grid: 3, its transmittance; then, if present, 3, the correction for light at the surface
#define PIXELS(v) ((size_t)(v)->picture.x * (v)->picture.y)
#define PASSED_PART(v) (5 * PIXELS(v))
#define MISSING_LIGHT(v) (8 * PIXELS(v))

// Writes three values for each pixel of a packet to `part`, an image of three values per pixel within the picture.
inline void paint_triple(const ViewInfo* v, __global float* part, int column, int row, rgb triple)
{
  const integer pixel = pixels_of(v, column, row), inside = in_picture(v, column, row);
#define PAINT(n)                         \
  if (LANE(inside, n))                   \
  {                                      \
    const int p = LANE(pixel, n);        \
    part[3 * p] = LANE(triple.r, n);     \
    part[3 * p + 1] = LANE(triple.g, n); \
    part[3 * p + 2] = LANE(triple.b, n); \
  }
  EACH_LANE(PAINT)
#undef PAINT
}

inline void paint(
  const ViewInfo* v, __global float* picture, int column, int row, rgb radiance, real opaque, real where)
{
  paint_triple(v, picture, column, row, radiance);
  __global float* alpha = picture + 3 * PIXELS(v);
  __global float* depth = picture + 4 * PIXELS(v);
  const integer pixel = pixels_of(v, column, row), inside = in_picture(v, column, row);
#define PAINT(n)                             \
  if (LANE(inside, n))                       \
  {                                          \
    alpha[LANE(pixel, n)] = LANE(opaque, n); \
    depth[LANE(pixel, n)] = LANE(where, n);  \
  }
  EACH_LANE(PAINT)
#undef PAINT
}
