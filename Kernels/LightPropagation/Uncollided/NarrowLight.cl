// Angular moments of light that has a single direction, or nearly one, in each voxel, such as that of lamps. One
// work-item per voxel of a row, row, and channel. The host defines
//   DEGREE  highest degree of the moments

#include "LightPropagation/Sweep/MomentPlacesShared.h"

#include "Numerics/SphericalHarmonics.cl"

#define MOMENTS ((DEGREE + 1) * (DEGREE + 1))

// Adds the angular moments of light whose direction in each voxel is that of its net flux.
// basis    coefficients of the angular functions, [function][harmonic], AngularBasis.h
// path     W length, [channel][voxel]
// flux     net flux of the same light, W length, [channel][x, y, z][voxel]
// moments  W length, with angular moments (MomentPlacesShared.h); the kernel adds to it
// peak     1: moments follow from the net flux; below 1: moments of degree l are multiplied by peak^(l (l + 1) / 2 - 1)
__kernel void add_narrow_moments(MomentPlaces places, const __global float* basis, const __global float* path,
  const __global float* flux, __global float* moments, ulong stride, float peak)
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
  // Light is taken to be spread diffusively about its mean direction, so its moment of degree l is spread^(l (l + 1) /
  // 2), with spread = |flux| / path.
  const float spread = fmin(size / power, 1.0f) * peak;
  float whole = 1.0f / peak, step = spread;
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

// Adds the angular moments of light that has the same direction in all voxels.
// values   values of the angular functions in the light's direction, [function]
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
