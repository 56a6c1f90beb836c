// Scattering source in angular moments, except the first moment (fluence), which IsotropicScattering.cl handles. One
// work-item per row of voxels; for each group of MomentGroup voxels it processes the moments, one per angular function,
// in the order in which they are stored.
//   sigma_s  1/length, [degree][channel][voxel]
//   path     path integrals and their moments, W length (MomentPlacesShared.h)
//   source   source and its moments, W / (length^3 sr), with the same layout

#include "LightPropagation/Sweep/MomentPlacesShared.h"

// Loads the values of a group of MomentGroup (16) voxels along x, of which `voxels` lie in the row; 0 beyond the row's
// end.
static float16 load_group(const __global float* values, int voxels)
{
  if (voxels >= MomentGroup)
  {
    return vload16(0, values);
  }
  float some[MomentGroup] = { 0.0f };
  for (int i = 0; i < voxels; ++i)
  {
    some[i] = values[i];
  }
  return vload16(0, some);
}

static bool is_zero(float16 values)
{
  const int8 eight = as_int16(values).lo | as_int16(values).hi;
  const int4 four = eight.lo | eight.hi;
  const int2 two = four.lo | four.hi;
  return (two.x | two.y) == 0;
}

// Runs ACTION for each angular function from the second on and each group of MomentGroup voxels in a row. In ACTION,
// `at` is the index of the first of the group's moments for that function, and `scale` the factors of the group's
// voxels that convert path integral to source.
#define FOR_MOMENTS(ACTION)                                                                                      \
  const ulong line = get_global_id(0);                                                                           \
  for (int x = 0; x < places.sizeX; x += MomentGroup)                                                            \
  {                                                                                                              \
    ulong at = MOMENT_PLACE(places, 1, channel, line, x);                                                        \
    for (int l = 1, function = 1; function < places.functions; ++l)                                              \
    {                                                                                                            \
      const __global float* here = sigma_s + (l * places.channels + channel) * stride + line * places.sizeX + x; \
      const float16 scale = per_path * load_group(here, places.sizeX - x);                                       \
      for (; function < (l + 1) * (l + 1); ++function, at += MomentGroup)                                        \
      {                                                                                                          \
        ACTION                                                                                                   \
      }                                                                                                          \
    }                                                                                                            \
  }

// Processes one scattering order: overwrites the moments of the source, from the second on, by those that are scattered
// from `path`, and sets the moments of `path` to 0. Nothing is written where nothing scatters and `path` is 0, as in
// empty voxels of sweeps with SweepInfo::skips: the moments of the source are 0 there.
__kernel void scatter_moments(MomentPlaces places, int channel, __global float* path, __global float* source,
  const __global float* sigma_s, ulong stride, float per_path)
{
#define REPLACE                                  \
  const float16 moments = vload16(0, path + at); \
  if (!(is_zero(scale) && is_zero(moments)))     \
  {                                              \
    vstore16(moments* scale, 0, source + at);    \
    vstore16((float16)0.0f, 0, path + at);       \
  }
  FOR_MOMENTS(REPLACE)
#undef REPLACE
}

__kernel void add_scattered_moments(MomentPlaces places, int channel, const __global float* path,
  __global float* source, const __global float* sigma_s, ulong stride, float per_path)
{
#define ADD vstore16(vload16(0, source + at) + vload16(0, path + at) * scale, 0, source + at);
  FOR_MOMENTS(ADD)
#undef ADD
}

// Sets `source` to the given source (emission and first collisions) plus the scattering source.
__kernel void scatter_given_moments(MomentPlaces places, int channel, const __global float* path,
  const __global float* given, __global float* source, const __global float* sigma_s, ulong stride, float per_path)
{
#define ADD_TO_GIVEN vstore16(vload16(0, given + at) + vload16(0, path + at) * scale, 0, source + at);
  FOR_MOMENTS(ADD_TO_GIVEN)
#undef ADD_TO_GIVEN
}

// Adds the moments of `path`, except the first, to those of `to`. One work-item per value.
__kernel void add_moments(MomentPlaces places, const __global float* path, __global float* to)
{
  const ulong at = places.second + get_global_id(0);
  to[at] += path[at];
}

// Computes shown = source + part * shown, for all angular moments; `shown` are the moments that are stored for
// pictures. One work-item per value.
__kernel void add_to_shown(const __global float* source, __global float* shown, float part)
{
  const ulong at = get_global_id(0);
  shown[at] = source[at] + part * shown[at];
}

// Converts moments in the functions of an AngularBasis to moments in spherical harmonics, for consecutive voxels. One
// work-item per voxel of a row, row, and harmonic.
//   basis    coefficients, [function][harmonic]
//   moments  laid out as in MomentPlacesShared.h; there are at most as many harmonics as functions
//   scale    factor by which each voxel's moments are multiplied, [channel][voxel]
//   out      [voxel][harmonic][channel]
__kernel void to_harmonics(MomentPlaces places, int channel, const __global float* basis, const __global float* moments,
  const __global float* scale, ulong stride, __global float* out)
{
  const ulong line = get_global_id(1);
  const int x = get_global_id(0);
  const ulong j = get_global_id(2);
  const ulong voxel = line * places.sizeX + x;
  float sum = j == 0 ? basis[0] * moments[channel * stride + voxel] : 0.0f;
  for (int q = max((int)j, 1); q < places.functions; ++q)
  {
    const float part = basis[q * places.functions + j];
    sum += part != 0.0f ? part * moments[MOMENT_PLACE(places, q, channel, line, x)] : 0.0f;
  }
  out[(voxel * get_global_size(2) + j) * places.channels + channel] = scale[channel * stride + voxel] * sum;
}

// Adds the first-collision source of a beam to its range of `source`, in voxels whose moments have the highest degree;
// in other voxels the light of beams is scattered in moments only. One work-item per value.
//   values  number of values of all channels
//   degree  highest degree of the moments
__kernel void scatter_beam(MomentPlaces places, const __global float* path, __global float* source,
  const __global float* sigma_s, ulong values, int beam, int degree, float per_path)
{
  const ulong i = get_global_id(0);
  source[places.beams + beam * values + i] +=
    sigma_s[degree * values + i] != 0.0f ? sigma_s[i] * path[i] * per_path : 0.0f;
}

// Adds the net flux of one channel to `flux`, W length, [channel][x, y, z][voxel], from the moments of degree 1 of
// `path`, which are sqrt(3) times the y, z and x components. One work-item per voxel of a row, and row.
__kernel void add_flux_of_moments(
  MomentPlaces places, int channel, const __global float* path, __global float* flux, ulong stride)
{
  const int x = get_global_id(0);
  const ulong line = get_global_id(1);
  for (int axis = 0; axis < 3; ++axis)
  {
    const int function = axis == 0 ? 3 : axis;
    flux[(3 * channel + axis) * stride + line * places.sizeX + x] +=
      0.57735027f * path[MOMENT_PLACE(places, function, channel, line, x)];
  }
}
