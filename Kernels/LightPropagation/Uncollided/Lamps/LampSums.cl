// What beams of a lamp put down in fixed point, added to a deposit. The host gives what LampBeams.cl asks for.

#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"
#include "LightPropagation/Uncollided/Lamps/LampUnits.cl"

// path   W length, [channel][stride], added to
// units  [channel] W length of a fixed point unit
// sigma  1/length, shared by the channels
__kernel void add_fixed(const __global long* fixed_path, __global float* path, ulong first, ulong stride, float4 units,
  const __global float* sigma, ulong sigma_first, float diagonal)
{
  const ulong i = get_global_id(0);
  const int channel = get_global_id(1);
  const float unit = channel == 0 ? units.x : channel == 1 ? units.y : units.z;
  path[first + channel * stride + i] += (float)fixed_path[i] * unit / units_of(sigma[sigma_first + i], diagonal);
}

#if FACE_OUT
// cells     as in follow_lamp (LampBeams.cl)
// face_out  W, [channel][cell], added to
// watts     [channel] of the lamp
__kernel void add_fixed_cells(
  const __global long* cells, __global float* face_out, ulong first, ulong stride, float4 watts)
{
  const ulong i = get_global_id(0);
  const int channel = get_global_id(1);
  const float unit = (channel == 0 ? watts.x : channel == 1 ? watts.y : watts.z) / LampPowerUnits;
  face_out[first + channel * stride + i] += (float)cells[i] * unit;
}
#endif

#if NET_FLUX
// fixed_path  as in follow_lamp (LampBeams.cl)
// flux  W length, [channel][x, y, z][stride], added to
__kernel void add_fixed_flux(const __global long* fixed_path, __global float* flux, ulong first, ulong stride,
  float4 units, const __global float* sigma, ulong sigma_first, float diagonal)
{
  const ulong i = get_global_id(0);
  const int channel = get_global_id(1);
  const float unit = channel == 0 ? units.x : channel == 1 ? units.y : units.z;
  for (int axis = 0; axis < 3; ++axis)
  {
    flux[3 * (first + channel * stride) + axis * stride + i] +=
      (float)fixed_path[(FIRST_OF_FLUX + axis) * stride + i] * unit / units_of(sigma[sigma_first + i], diagonal);
  }
}
#endif

#if MOMENTS
// fixed_path  as in follow_lamp (LampBeams.cl)
// first_moments  W length, [channel][-x, +x, -y, +y, -z, +z][stride], added to
__kernel void add_fixed_moments(const __global long* fixed_path, __global float* first_moments, ulong first,
  ulong stride, float4 units, const __global float* sigma, ulong sigma_first, float diagonal)
{
  const ulong i = get_global_id(0);
  const int channel = get_global_id(1);
  const float unit = channel == 0 ? units.x : channel == 1 ? units.y : units.z;
  for (int axis = 0; axis < 3; ++axis)
  {
    const float towards =
      (float)fixed_path[(1 + axis) * stride + i] * unit / units_of(sigma[sigma_first + i], diagonal);
    __global float* of_axis = first_moments + 6 * (first + channel * stride) + 2 * axis * stride + i;
    of_axis[0] += fmax(-towards, 0.0f);
    of_axis[stride] += fmax(towards, 0.0f);
  }
}
#endif

// The same path, W length, in every voxel.
__kernel void add_evenly(__global float* path, ulong first, float each)
{
  path[first + get_global_id(0)] += each;
}
