// From angular moments of the light that was found to those of what is scattered of it, but for the first, which is
// fluence: IsotropicScattering.cl. A work-item a voxel of a row, by row and by angular function from the second on.
//   sigma_s  1/length, [degree][channel][stride]
//   path     W length, with its moments (MomentPlacesShared.h)
//   source   W / (length^3 sr), the same

#include "LightPropagation/Sweep/MomentPlacesShared.h"

// Degree of an angular function.
static int degree_of(int function)
{
  int l = 1;
  while ((l + 1) * (l + 1) <= function)
  {
    ++l;
  }
  return l;
}

// Of a work-item, in the moments and in sigma_s.
static ulong moment_of(const MomentPlaces* places, int channel)
{
  const int function = get_global_id(2) + 1;
  return MOMENT_PLACE(*places, function, channel, (ulong)get_global_id(1), get_global_id(0));
}
static ulong coefficient_of(const MomentPlaces* places, ulong stride, int channel)
{
  return (degree_of(get_global_id(2) + 1) * places->channels + channel) * stride +
    (ulong)get_global_id(1) * places->sizeX + get_global_id(0);
}

// One order: replaces the source, clears the path.
__kernel void scatter_moments(MomentPlaces places, int channel, __global float* path, __global float* source,
  const __global float* sigma_s, ulong stride, float per_path)
{
  const ulong at = moment_of(&places, channel);
  source[at] = sigma_s[coefficient_of(&places, stride, channel)] * path[at] * per_path;
  path[at] = 0.0f;
}

__kernel void add_scattered_moments(MomentPlaces places, int channel, const __global float* path,
  __global float* source, const __global float* sigma_s, ulong stride, float per_path)
{
  const ulong at = moment_of(&places, channel);
  source[at] += sigma_s[coefficient_of(&places, stride, channel)] * path[at] * per_path;
}

// What is given and what is scattered.
__kernel void scatter_given_moments(MomentPlaces places, int channel, const __global float* path,
  const __global float* given, __global float* source, const __global float* sigma_s, ulong stride, float per_path)
{
  const ulong at = moment_of(&places, channel);
  source[at] = given[at] + sigma_s[coefficient_of(&places, stride, channel)] * path[at] * per_path;
}

__kernel void add_moments(MomentPlaces places, int channel, const __global float* path, __global float* to)
{
  const ulong at = moment_of(&places, channel);
  to[at] += path[at];
}

// A beam's own source, in voxels of the highest degree: the others scatter it in moments alone. A work-item a value.
// values  of all channels
__kernel void scatter_beam(MomentPlaces places, const __global float* path, __global float* source,
  const __global float* sigma_s, ulong values, int beam, int degree, float per_path)
{
  const ulong i = get_global_id(0);
  source[places.beams + beam * values + i] +=
    sigma_s[degree * values + i] != 0.0f ? sigma_s[i] * path[i] * per_path : 0.0f;
}

// Net flux, W length, [channel][x, y, z][stride], added to, from the moments of degree 1, which are sqrt(3) times y, z,
// x. A work-item a voxel of a row, by row.
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
