// Angular moments of light that goes one way in each voxel, as that of lamps does, or nearly so. The host gives
//   DEGREE  of the moments
//   RAYS    1: by voxel as its net flux tells; 0: the same everywhere
// A work-item a voxel of a row, by row and channel.

#include "LightPropagation/Sweep/MomentPlacesShared.h"

#define MOMENTS ((DEGREE + 1) * (DEGREE + 1))

#if RAYS
// The spherical harmonics of AngularBasis.h.
static void find_harmonics(float3 omega, float* values)
{
  float cosine = 1.0f, sine = 0.0f, diagonal = 1.0f, first = 1.0f;
  for (int m = 0; m <= DEGREE; ++m)
  {
    float before = 0.0f, p = diagonal, ratio = first;
    for (int l = m; l <= DEGREE; ++l)
    {
      const float scale = sqrt((2 * l + 1) * (m == 0 ? 1.0f : 2.0f) * ratio) * p;
      values[l * l + l + m] = scale * cosine;
      if (m > 0)
      {
        values[l * l + l - m] = scale * sine;
      }
      const float next = ((2 * l + 1) * omega.z * p - (l + m) * before) / (l - m + 1);
      before = p;
      p = next;
      ratio *= (float)(l - m + 1) / (l + m + 1);
    }
    const float turned = cosine * omega.x - sine * omega.y;
    sine = cosine * omega.y + sine * omega.x;
    cosine = turned;
    diagonal *= 2 * m + 1;
    first /= (2 * m + 1) * (2 * m + 2);
  }
}

// basis    [function][harmonic], AngularBasis.h
// path     W length, of the light, [channel][stride]
// flux     W length, its net flux, [channel][x, y, z][stride]
// moments  W length, with its angular moments (MomentPlacesShared.h), added to
__kernel void add_narrow_moments(MomentPlaces places, const __global float* basis, const __global float* path,
  const __global float* flux, __global float* moments, ulong stride)
{
  const int x = get_global_id(0);
  const ulong line = get_global_id(1);
  const ulong c = get_global_id(2);
  const ulong i = line * places.sizeX + x;
  const ulong at = c * stride + i;
  const float power = path[at];
  const float3 flow =
    (float3)(flux[3 * c * stride + i], flux[(3 * c + 1) * stride + i], flux[(3 * c + 2) * stride + i]);
  const float size = length(flow);
  moments[at] += power;
  if (!(power > 0.0f) || !(size > 0.0f))
  {
    return;
  }
  float harmonics[MOMENTS];
  find_harmonics(flow / size, harmonics);
  // Directions that spread about their mean as heat does: the moment of degree l is spread^(l (l + 1) / 2).
  const float spread = fmin(size / power, 1.0f);
  float whole = 1.0f, step = spread;
  for (int l = 1; l <= DEGREE; ++l)
  {
    whole *= step;
    step *= spread;
    for (int q = l * l; q < (l + 1) * (l + 1); ++q)
    {
      float value = 0.0f;
      for (int j = 0; j <= q; ++j)
      {
        value += basis[q * MOMENTS + j] * harmonics[j];
      }
      moments[MOMENT_PLACE(places, q, c, line, x)] += whole * value * power;
    }
  }
}
#else

// values   of the angular functions in the light's direction
__kernel void add_beam_moments(
  MomentPlaces places, const __global float* values, const __global float* path, __global float* moments, ulong stride)
{
  const int x = get_global_id(0);
  const ulong line = get_global_id(1);
  const ulong c = get_global_id(2);
  const ulong at = c * stride + line * places.sizeX + x;
  const float power = path[at];
  moments[at] += power;
  for (int q = 1; q < MOMENTS; ++q)
  {
    moments[MOMENT_PLACE(places, q, c, line, x)] += values[q] * power;
  }
}
#endif
