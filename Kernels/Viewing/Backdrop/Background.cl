// What is behind the medium: an environment, a colour, or nothing.

#pragma once
#include "Viewing/Samples/Sampling.cl"
#include "Viewing/Scene/ViewShared.h"

// Angle of (x, y) from +x, in [-pi, pi], to 1e-7. PoCL's atan2 is scalar and costs ten times this.
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

// Radiance of the environment in each direction, given in the environment's axes; the same as Lookup in Lights.h. The
// picture has an additional column on either side, for periodic interpolation around z.
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

// Background radiance seen in each direction d, in world coordinates.
inline rgb look_behind(const ViewInfo* v, real3 d, __global const float4* environment)
{
  rgb behind = { (real)v->background.x, (real)v->background.y, (real)v->background.z };
  if (v->environment.x > 0)
  {
    const float4* m = v->toPicture;
    const real3 turned = { d.x * m[0].x + d.y * m[0].y + d.z * m[0].z, d.x * m[1].x + d.y * m[1].y + d.z * m[1].z,
      d.x * m[2].x + d.y * m[2].y + d.z * m[2].z };
    const rgb seen = look_up(environment, turned, v->environment);
    behind.r += seen.r;
    behind.g += seen.g;
    behind.b += seen.b;
  }
  return behind;
}
