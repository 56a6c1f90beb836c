// Functions that copy planes from the volume to scratch and back. In scratch, the rows that rays cross are contiguous
// and padded to whole vectors, whatever the orientation of the axis in the volume.

#pragma once
#include "LightPropagation/Sweep/OnCpu/SweepLayout.cl"

#if REAL_WIDTH == 16
#define ROUNDS 4
#elif REAL_WIDTH == 8
#define ROUNDS 3
#else
#define ROUNDS 2
#endif

// Transposes a square of REAL_WIDTH vectors, by interleaving its halves log2(REAL_WIDTH) times.
static void transpose(real* rows)
{
#pragma unroll
  for (int round = 0; round < ROUNDS; ++round)
  {
    real mixed[REAL_WIDTH];
#pragma unroll
    for (int i = 0; i < REAL_WIDTH / 2; ++i)
    {
      mixed[2 * i].even = rows[i].lo;
      mixed[2 * i].odd = rows[i + REAL_WIDTH / 2].lo;
      mixed[2 * i + 1].even = rows[i].hi;
      mixed[2 * i + 1].odd = rows[i + REAL_WIDTH / 2].hi;
    }
#pragma unroll
    for (int i = 0; i < REAL_WIDTH; ++i)
    {
      rows[i] = mixed[i];
    }
  }
}

// Index, in the arrays of the volume, of voxel (u, v) of a plane of the box.
static ulong place_of(const PlaneInfo* layout, int u, int v, int plane)
{
  return (ulong)(layout->firstU + u) * layout->stepU + (ulong)(layout->firstV + v) * layout->stepV +
    (ulong)(layout->firstP + plane) * layout->stepP;
}

// Number of floats of all quantities of a plane.
static int plane_floats(const PlaneInfo* layout)
{
  return layout->quantities * (KEPT_ROWS ? KEPT_ROWS : layout->sizeV) * ROW;
}

// Sets the first `count` floats, a multiple of the vector width, of each of `rows` padded rows to zero.
static BY_ROW void clear_rows(__global float* row, int rows, int count)
{
  for (int r = 0; r < rows; ++r)
  {
    for (int i = 0; i < count; i += REAL_WIDTH)
    {
      store_real((real)0.0f, r * ROW + i, row);
    }
  }
}

// Copies a block of voxels and transposes it: reads REAL_WIDTH rows, `step` floats apart, of REAL_WIDTH planes, and
// writes REAL_WIDTH vectors along the rows, `plane` floats apart.
// @param last  index of the last row that exists
// @param count  number of planes to write
static inline __attribute__((always_inline)) void pack_block(
  const __global float* from, ulong step, int last, integer beyond, __global float* to, int plane, int count)
{
  real columns[REAL_WIDTH];
#pragma unroll
  for (int i = 0; i < REAL_WIDTH; ++i)
  {
    columns[i] = load_real(min(i, last) * step, from);
  }
  transpose(columns);
#pragma unroll
  for (int j = 0; j < REAL_WIDTH; ++j)
  {
    if (j < count)
    {
      store_real(select(columns[j], (real)0.0f, beyond), j * plane, to);
    }
  }
}

// Copies one quantity, for rows [rows.x, rows.y) of planes [first, first + count), to scratch, padded with zeros. Reads
// up to one vector beyond the last voxel, but does not use it.
static BY_ROW void pack(
  const PlaneInfo* layout, __global float* to, int first, int count, int2 rows, const __global float* volume)
{
  for (int v = rows.x; v < rows.y; ++v)
  {
    for (int u = 0; u < layout->width; u += REAL_WIDTH)
    {
      const integer beyond = LANES >= layout->sizeU - u;
      const __global float* from = volume + place_of(layout, u, v, first);
      __global float* here = ROW_IN(layout, to, 0, v) + u;
      if (layout->block == 1)
      {
        for (int j = 0; j < count; ++j)
        {
          const real values = load_real(0, from + (ulong)j * layout->stepP);
          store_real(select(values, (real)0.0f, beyond), j * plane_floats(layout), here);
        }
        continue;
      }
      pack_block(from, layout->stepU, layout->sizeU - 1 - u, beyond, here, plane_floats(layout), count);
    }
  }
}

// Adds a vector to sums, with compensated (Kahan) summation if `lost` is not null.
static void add_real(real value, __global float* sum, __global float* lost)
{
  const real before = load_real(0, sum);
  if (!lost)
  {
    store_real(before + value, 0, sum);
    return;
  }
  const real y = value - load_real(0, lost);
  const real t = before + y;
  store_real((t - before) - y, 0, lost);
  store_real(t, 0, sum);
}

static void add_one(float value, __global float* sum, __global float* lost)
{
  float total = *sum, rounding = lost ? *lost : 0.0f;
  add_exactly(&total, &rounding, value);
  *sum = total;
  if (lost)
  {
    *lost = rounding;
  }
}

// Adds a block of packed planes to the volume, multiplied by `sign`: the inverse of pack_block.
// @param used  number of rows of the block that exist in the volume
static inline __attribute__((always_inline)) void unpack_block(
  const __global float* from, int plane, float sign, __global float* volume, __global float* lost, ulong step, int used)
{
  real rows[REAL_WIDTH];
#pragma unroll
  for (int j = 0; j < REAL_WIDTH; ++j)
  {
    rows[j] = sign * load_real(j * plane, from);
  }
  transpose(rows);
#pragma unroll
  for (int i = 0; i < REAL_WIDTH; ++i)
  {
    if (i < used)
    {
      add_real(rows[i], volume + i * step, lost ? lost + i * step : 0);
    }
  }
}

// Adds one quantity of rows of packed planes to the volume, multiplied by `sign`. Accesses exactly the voxels of these
// rows, since other work-items may access neighbouring voxels concurrently.
static BY_ROW void unpack(const PlaneInfo* layout, const __global float* from, int first, int count, int2 rows,
  float sign, __global float* volume, __global float* lost)
{
  const int plane = plane_floats(layout);
  for (int v = rows.x; v < rows.y; ++v)
  {
    for (int u = 0; u < layout->sizeU; u += REAL_WIDTH)
    {
      const ulong at = place_of(layout, u, v, first);
      const int used = min(REAL_WIDTH, layout->sizeU - u);
      const __global float* here = ROW_IN(layout, from, 0, v) + u;
      if (layout->block == 1 && used == REAL_WIDTH)
      {
        for (int j = 0; j < count; ++j)
        {
          const ulong voxel = at + (ulong)j * layout->stepP;
          add_real(sign * load_real(j * plane, here), volume + voxel, lost ? lost + voxel : 0);
        }
      }
      else if (layout->block > 1 && count == REAL_WIDTH)
      {
        unpack_block(here, plane, sign, volume + at, lost ? lost + at : 0, layout->stepU, used);
      }
      else
      {
        for (int i = 0; i < used; ++i)
        {
          for (int j = 0; j < count; ++j)
          {
            const ulong voxel = at + (ulong)i * layout->stepU + (ulong)j * layout->stepP;
            add_one(sign * here[j * plane + i], volume + voxel, lost ? lost + voxel : 0);
          }
        }
      }
    }
  }
}

#if ANGULAR
// Index, in the volume's array of moments, of the moment of voxel (u, v) for the second angular function and a channel.
// The planes are normal to x; those from `first` on must be in one group of MomentGroup voxels.
static ulong moments_of(const SweepInfo* info, int channel, int u, int v, int first)
{
  const PlaneInfo* layout = &info->planes;
  // For the x axis, u is y and v is z
  const ulong line = (ulong)(layout->firstV + v) * info->sizeY + layout->firstU + u;
  const int higher = info->moments.functions - 1;
  return (line * info->moments.channels + channel) * info->moments.groups * (higher * MomentGroup) +
    IN_ROW(layout->firstP + first, higher);
}

// Index, in the moments of a packed plane, of the moment of voxel (u, v) for the second angular function and a channel.
static int packed_moments_of(const SweepInfo* info, int channel, int u, int v)
{
  return v * info->packedMoments + channel * (info->packedMoments / CHANNELS) + IN_ROW(u, info->moments.functions - 1);
}

// Number of planes, from plane `next` on in marching order, whose moments are in the same group of MomentGroup voxels
// along x. The planes are normal to x.
static int of_one_group(const PlaneInfo* layout, int next, int backward)
{
  const int plane = layout->firstP + (backward ? layout->sizeP - 1 - next : next);
  return backward ? plane % MomentGroup + 1 : MomentGroup - plane % MomentGroup;
}

// Flag word of row v, combined (bitwise or) over `count` packed planes.
//   words  words of the planes' rows, [plane][row]
static int words_of_planes(const PlaneInfo* layout, const __global int* words, int count, int v)
{
  int all = 0;
  for (int j = 0; j < count; ++j)
  {
    all |= words[j * layout->sizeV + v];
  }
  return all;
}

// Sets the moments of packed path integrals to 0, except in rows that are empty in all planes.
static BY_ROW void clear_moments(const SweepInfo* info, const __global int* words, int count, __global float* path)
{
  const int size = info->planes.sizeV, floats = info->packedMoments;
  for (int v = 0; v < size; ++v)
  {
    const bool any = words_of_planes(&info->planes, words, count, v) >> 1 != 0;
    for (int j = 0; any && j < count; ++j)
    {
      clear_rows(path + (j * size + v) * floats, 1, floats);
    }
  }
}

static BY_ROW void pack_moments(const SweepInfo* info, const __global int* words, __global float* to, int first,
  int count, const __global float* source)
{
  const PlaneInfo* layout = &info->planes;
  const int bits = segment_bits(layout->width);
  const int higher = info->moments.functions - 1;
  const ulong step = (ulong)info->moments.channels * info->moments.groups * (higher * MomentGroup);
  const int plane = layout->sizeV * info->packedMoments;
  for (int v = 0; v < layout->sizeV; ++v)
  {
    const int all = words_of_planes(layout, words, count, v);
    for (int u = 0; u < layout->width; u += REAL_WIDTH)
    {
      const integer beyond = LANES >= layout->sizeU - u;
      for (int c = 0; c < CHANNELS && IS_FILLED(all, u, bits); ++c)
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

static BY_ROW void unpack_moments(const SweepInfo* info, const __global int* words, const __global float* from,
  int first, int count, __global float* path)
{
  const PlaneInfo* layout = &info->planes;
  const int bits = segment_bits(layout->width);
  const int higher = info->moments.functions - 1;
  const ulong step = (ulong)info->moments.channels * info->moments.groups * (higher * MomentGroup);
  const int plane = layout->sizeV * info->packedMoments;
  for (int v = 0; v < layout->sizeV; ++v)
  {
    const int all = words_of_planes(layout, words, count, v);
    for (int u = 0; u < layout->sizeU; u += REAL_WIDTH)
    {
      const int used = min(REAL_WIDTH, layout->sizeU - u);
      for (int c = 0; c < CHANNELS && IS_FILLED(all, u, bits); ++c)
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
// Packs (copies to scratch memory) the additional source for the octants of directions that march in one sense along
// the axis.
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
