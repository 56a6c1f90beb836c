// Packing and unpacking (see SweepPacking.cl) of angular moments and of sources by octant.

#pragma once
#include "LightPropagation/Sweep/OnCpu/SweepPacking.cl"

#if ANGULAR
// Index in the volume of the moments (from the second function on) of position (u, v) and a channel, for planes from
// `first` on, which must lie in one group.
static ulong moments_of(const SweepInfo* info, int channel, int u, int v, int first)
{
  const PlaneInfo* layout = &info->planes;
  const ulong line = (ulong)(layout->firstV + v) * info->sizeY + layout->firstU + u; // along x rows are y and z
  const int higher = info->moments.functions - 1;
  return (line * info->moments.channels + channel) * info->moments.groups * (higher * MomentGroup) +
    IN_ROW(layout->firstP + first, higher);
}

// The same index in packed planes.
static int packed_moments_of(const SweepInfo* info, int channel, int u, int v)
{
  return v * info->packedMoments + channel * (info->packedMoments / CHANNELS) + IN_ROW(u, info->moments.functions - 1);
}

// Number of planes in the same group, from the next plane that rays cross.
static int of_one_group(const PlaneInfo* layout, int next, int backward)
{
  const int plane = layout->firstP + (backward ? layout->sizeP - 1 - next : next);
  return backward ? plane % MomentGroup + 1 : MomentGroup - plane % MomentGroup;
}

static BY_ROW void pack_moments(
  const SweepInfo* info, __global float* to, int first, int count, const __global float* source)
{
  const PlaneInfo* layout = &info->planes;
  const int higher = info->moments.functions - 1;
  const ulong step = (ulong)info->moments.channels * info->moments.groups * (higher * MomentGroup);
  const int plane = layout->sizeV * info->packedMoments;
  for (int v = 0; v < layout->sizeV; ++v)
  {
    for (int u = 0; u < layout->width; u += REAL_WIDTH)
    {
      const integer beyond = LANES >= layout->sizeU - u;
      for (int c = 0; c < CHANNELS; ++c)
      {
        const __global float* from = source + moments_of(info, c, u, v, first);
        __global float* here = to + packed_moments_of(info, c, u, v);
        for (int k = 0; k < higher; ++k)
        {
          pack_block(from + k * MomentGroup, step, layout->sizeU - 1 - u, beyond, here + k * MomentGroup, plane, count);
        }
      }
    }
  }
}

static BY_ROW void unpack_moments(
  const SweepInfo* info, const __global float* from, int first, int count, __global float* path)
{
  const PlaneInfo* layout = &info->planes;
  const int higher = info->moments.functions - 1;
  const ulong step = (ulong)info->moments.channels * info->moments.groups * (higher * MomentGroup);
  const int plane = layout->sizeV * info->packedMoments;
  for (int v = 0; v < layout->sizeV; ++v)
  {
    for (int u = 0; u < layout->sizeU; u += REAL_WIDTH)
    {
      const int used = min(REAL_WIDTH, layout->sizeU - u);
      for (int c = 0; c < CHANNELS; ++c)
      {
        const __global float* here = from + packed_moments_of(info, c, u, v);
        __global float* to = path + moments_of(info, c, u, v, first);
        for (int k = 0; k < higher; ++k, here += MomentGroup, to += MomentGroup)
        {
          if (count == REAL_WIDTH)
          {
            unpack_block(here, plane, 1.0f, to, 0, step, used);
            continue;
          }
          for (int i = 0; i < used; ++i)
          {
            for (int j = 0; j < count; ++j)
            {
              to[i * step + j] += here[j * plane + i];
            }
          }
        }
      }
    }
  }
}
#endif

#if OCTANT_SOURCE
// Packs the additional source for the octants of one way along the axis.
static void pack_octants(const SweepInfo* info, __global float* planes, int first, int count, int2 rows,
  const __global float* octants, int backward)
{
  const int axis = info->axis;
  const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  for (int c = 0; c < CHANNELS; ++c)
  {
    for (int way = 0; way < WaysAside; ++way)
    {
      const int octant = (backward ? 0 : 1 << axis) + (way & 1 ? 1 << u : 0) + (way & 2 ? 1 << v : 0);
      pack(&info->planes, planes + (PLANE_OCTANTS + WaysAside * c + way) * ROW, first, count, rows,
        octants + (8 * c + octant) * info->stride);
    }
  }
}
#endif
