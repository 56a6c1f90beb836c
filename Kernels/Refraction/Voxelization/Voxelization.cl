// Kernels that find the samples of a fine grid that lie inside a closed mesh (Eisemann and Decoret 2008; Pfeuti 2009,
// section 3.1.2). A column of samples is a row of words, one bit per sample. In principle every triangle toggles all
// samples that lie before it in the columns that it crosses.
//
// In practice a triangle toggles only the last sample before its crossing; a final scan of each column then toggles all
// samples before each crossing, for all triangles at once.
//
// All arithmetic is in integers. Points lie on a lattice (SampleLattice.h), and samples at odd multiples of half a
// pitch. A sample that touches a plane or an edge is treated as if moved by (e, e^2, e^3), with e infinitely small. A
// column therefore never meets an edge or a corner, and the set of samples inside does not depend on the axis of the
// columns.
//
// The host defines SAMPLES, the number of samples per edge of a voxel, and WINDING, 1 to count crossings with their
// sign instead.

#pragma once
#include "Refraction/Voxelization/VoxelizationShared.h"

// Permutations of a point's coordinates to (along, across, up) for columns along axis 0 to 2, and back.
#define BY_COLUMNS(p, axis) ((axis) == 0 ? (p) : (axis) == 1 ? (p).yxz : (p).zxy)
#define FROM_COLUMNS(p, axis) ((axis) == 0 ? (p) : (axis) == 1 ? (p).yxz : (p).yzx)
#define ALONG(p) ((p).x)
#define ACROSS(p) ((p).y)
#define UP(p) ((p).z)

#if WINDING
// With WINDING, each sample has a mark of one signed byte: the sum over the crossings between this sample and the next,
// +1 if a line along the column leaves the mesh, -1 if it enters.
#define CELLS 4
#define BITS 4
#else
// Number of voxels per word, and of bits used in it: the samples of a voxel are never split between two words.
#define CELLS (32 / SAMPLES)
#define BITS (CELLS * SAMPLES)
#endif
#define ALL_BITS ((uint)((1UL << BITS) - 1UL))
#define ONE_CELL ((uint)((1UL << SAMPLES) - 1UL))

// Edge function of a triangle's edge, projected along the columns: >= 0 on the inner side.
typedef struct
{
  long value, across, up; // value of the edge function in a column; its increments to the next column and the next row
} edge;

inline edge edge_in_column(int3 from, int3 to, long across, long up, int pitch)
{
  const long right = (long)UP(from) - UP(to);
  const long above = (long)ACROSS(to) - ACROSS(from);
  edge e;
  e.value = above * (up - UP(from)) + right * (across - ACROSS(from));
  // A column exactly on the edge counts as moved by an infinitesimal distance, which decides whether it is on the inner
  // side.
  e.value -= right > 0 || (right == 0 && above > 0) ? 0 : 1;
  e.across = right * pitch;
  e.up = above * pitch;
  return e;
}

// Number of samples before a plane, among samples 0, 1, ... of a column: those with number * step < excess, at most
// `samples`.
inline int samples_before(long excess, long step, int samples)
{
  if (excess <= 0)
  {
    return 0;
  }
  if (excess > step * (samples - 1))
  {
    return samples;
  }
  // The quotient in float is wrong by less than one, because there are fewer than 2^20 samples.
  const long wanted = excess - 1;
  long number = (long)((float)wanted / (float)step);
  const long rest = wanted - number * step;
  number += rest < 0 ? -1 : rest >= step ? 1 : 0;
  return (int)number + 1;
}

#if !WINDING
// Pseudo-random number of a sample, the weight with which a crossing at the sample is summed.
inline uint weight_of(int sample)
{
  uint h = (uint)sample * 0x9e3779b1u + 0x7f4a7c15u;
  h = (h ^ (h >> 15)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  return h ^ (h >> 16);
}
#endif

inline void mark_crossing(__global uint* column, __global uint* sum, int before, int leaving)
{
  if (before > 0)
  {
    const int sample = before - 1;
#if WINDING
    atomic_add(column + sample / 4, (uint)leaving << (8 * (sample % 4)));
#else
    atomic_xor(column + sample / BITS, 1u << (sample % BITS));
    atomic_add(sum, (uint)leaving * weight_of(sample));
#endif
  }
}

// A triangle prepared for the columns of a tile, the rectangle of columns that one work-item processes. Its edge
// functions tell which columns cross it; `excess` tells where. Coordinates are (along, across, up).
typedef struct
{
  edge e0, e1, e2; // edge functions of the three edges, in the first column of a row
  long3 normal;    // normal of the plane, reversed if necessary to point along the columns
  int leaving;     // 1: a line along a column leaves the mesh at the triangle; -1: it enters
  long step;       // decrease of `excess` from one sample to the next: ALONG(normal) times the distance of samples
  long excess;     // ALONG(normal) times the distance from the column's first sample forward to the plane, plus `tie`
  int tie;         // 1 if a sample on the plane counts as before it, else 0
  long excessAcross, excessUp; // decrements of `excess` to the next column and to the next row
} sheet;

// Prepares a triangle for the columns of a tile, the rectangle of columns that one work-item processes. Returns 0 if
// the triangle crosses no column.
inline int start_sheet(
  sheet* s, uint4 tile, __global const int* points, __global const int* triangles, int axis, int pitch)
{
  const int3 corner = vload3(tile.x, triangles);
  const int3 a = BY_COLUMNS(vload3(corner.x, points), axis);
  int3 b = BY_COLUMNS(vload3(corner.y, points), axis);
  int3 c = BY_COLUMNS(vload3(corner.z, points), axis);

  const long3 ab = convert_long3(b - a);
  const long3 ac = convert_long3(c - a);
  long3 normal = (long3)(ab.y * ac.z - ab.z * ac.y, ab.z * ac.x - ab.x * ac.z, ab.x * ac.y - ab.y * ac.x);
  if (ALONG(normal) == 0)
  {
    return 0; // no column crosses it, after the infinitesimal move of the samples
  }
  const int turned = ALONG(normal) > 0 ? 1 : -1;
  s->leaving = axis == 1 ? -turned : turned; // BY_COLUMNS exchanges x and y for axis 1, which reverses the orientation
  normal *= turned;
  s->normal = normal;
  const long3 facing = FROM_COLUMNS(normal, axis);
  const int towards = facing.x != 0 ? facing.x > 0 : facing.y != 0 ? facing.y > 0 : facing.z > 0;
  s->tie = towards ? 0 : 1;

  // Edges are ordered counterclockwise in (across, up).
  if (ACROSS(ab) * UP(ac) - UP(ab) * ACROSS(ac) < 0)
  {
    const int3 other = b;
    b = c;
    c = other;
  }
  const long across = (long)pitch * tile.y + pitch / 2;
  const long up = (long)pitch * tile.z + pitch / 2;
  s->e0 = edge_in_column(a, b, across, up, pitch);
  s->e1 = edge_in_column(b, c, across, up, pitch);
  s->e2 = edge_in_column(c, a, across, up, pitch);

  s->step = ALONG(normal) * pitch;
  s->excess =
    ACROSS(normal) * (ACROSS(a) - across) + UP(normal) * (UP(a) - up) + ALONG(normal) * (ALONG(a) - pitch / 2) + s->tie;
  s->excessAcross = ACROSS(normal) * pitch;
  s->excessUp = UP(normal) * pitch;
  return 1;
}

inline void next_row(sheet* s)
{
  s->e0.value += s->e0.up;
  s->e1.value += s->e1.up;
  s->e2.value += s->e2.up;
  s->excess -= s->excessUp;
}

// Marks the crossings of triangles with the columns of their tiles, one tile per work-item.
//   tiles          triangle, first column, first row, (number of columns << 16) | number of rows
//   axis           axis of the columns
//   pitch          distance of samples, in units of the lattice
//   samples        number of samples per column
//   sums           output: signed sum of the weights of each column's crossings, see fill_columns; not used with
//                  WINDING
__kernel void mark_crossings(int tileCount, __global const uint4* tiles, __global const int* points,
  __global const int* triangles, int axis, int pitch, int samples, SampleRows rows, __global uint* marks,
  __global uint* sums)
{
  const int id = get_global_id(0);
  if (id >= tileCount)
  {
    return;
  }
  const uint4 tile = tiles[id];
  sheet s;
  if (!start_sheet(&s, tile, points, triangles, axis, pitch))
  {
    return;
  }
  const int tileColumns = tile.w >> 16;
  const int tileRows = tile.w & 0xffff;
  const ulong firstColumn = (ulong)(tile.z - rows.firstRow) * rows.columns + tile.y;
  __global uint* row = marks + firstColumn * rows.words;
#if WINDING
  __global uint* rowOfSums = sums;
#else
  __global uint* rowOfSums = sums + firstColumn;
#endif
  for (int j = 0; j < tileRows; ++j)
  {
    long v0 = s.e0.value, v1 = s.e1.value, v2 = s.e2.value, excess = s.excess;
    for (int i = 0; i < tileColumns; ++i)
    {
      if ((v0 | v1 | v2) >= 0)
      {
        mark_crossing(row + (ulong)i * rows.words, rowOfSums + i, samples_before(excess, s.step, samples), s.leaving);
      }
      v0 += s.e0.across;
      v1 += s.e1.across;
      v2 += s.e2.across;
      excess -= s.excessAcross;
    }
    next_row(&s);
    row += (ulong)rows.columns * rows.words;
#if !WINDING
    rowOfSums += rows.columns;
#endif
  }
}

#if WINDING

// Summarises the winding numbers of each column's samples.
//   sign   1; -1 if the mesh is inside out, so that its winding numbers are negated
//   found  output, four numbers for each column: the smallest and the largest of its winding numbers and 0; the number
//          of samples whose winding number is neither 0 nor 1; the index of the first such sample (`samples` if there
//          is none)
__kernel void find_windings(
  int columnCount, int words, int samples, int sign, __global const uint* marks, __global int4* found)
{
  const int id = get_global_id(0);
  if (id >= columnCount)
  {
    return;
  }
  int winding = 0;
  int4 of_column = (int4)(0, 0, 0, samples);
  for (int w = words - 1; w >= 0; --w)
  {
    // The four signed bytes of a word were summed as one integer, so a negative byte has borrowed from the next byte.
    int rest = (int)marks[(ulong)id * words + w];
    int counts[4];
    for (int k = 0; k < 4; ++k)
    {
      counts[k] = (char)(rest & 0xff);
      rest = (rest - counts[k]) >> 8;
    }
    for (int k = 3; k >= 0; --k)
    {
      winding += counts[k];
      const int oriented = winding * sign;
      of_column.x = min(of_column.x, oriented);
      of_column.y = max(of_column.y, oriented);
      if (oriented != 0 && oriented != 1)
      {
        of_column.z += 1;
        of_column.w = 4 * w + k;
      }
    }
  }
  found[id] = of_column;
}

#else

// Converts the marks of each column to bits, 1 for samples inside the mesh, and finds columns with a sample whose
// winding number is neither 0 nor 1.
//
// If all winding numbers in a column are 0 or 1, lines along the column alternately leave and enter the mesh. Then two
// sums are equal: that of the signed weights of the crossings, and that of the weights of the remaining marks with
// alternating signs. Otherwise the sums differ, except by chance in one of 2^32 cases, since weights are random.
//   columns   number of columns per row
//   sums      output of mark_crossings
//   sign      1; -1 if the mesh is inside out; 0 to skip the search for such columns
//   odd       flags, from firstOdd on one per row of voxels of the grid: set if the row has such a column
//   firstRow  index of the first row of columns
__kernel void fill_columns(int columnCount, int columns, int words, __global uint* marks, __global const uint* sums,
  int sign, __global int* odd, int firstOdd, int firstRow)
{
  const int id = get_global_id(0);
  if (id >= columnCount)
  {
    return;
  }
  __global uint* column = marks + (ulong)id * words;
  uint carried = 0;
  uint sum = 0;
  uint turn = 1;
  for (int w = words - 1; w >= 0; --w)
  {
    uint bits = column[w];
    for (uint rest = bits; rest != 0;)
    {
      const int bit = 31 - (int)clz(rest);
      sum += turn * weight_of(w * BITS + bit);
      turn = -turn;
      rest ^= 1u << bit;
    }
    bits ^= bits >> 1;
    bits ^= bits >> 2;
    bits ^= bits >> 4;
    bits ^= bits >> 8;
    bits ^= bits >> 16;
    bits ^= carried;
    column[w] = bits;
    carried = (bits & 1) != 0 ? ALL_BITS : 0;
  }
  if (sign != 0 && sums[id] != (uint)sign * sum)
  {
    atomic_or(odd + firstOdd + (firstRow + id / columns) / SAMPLES, 1);
  }
}

// Counts the samples of each voxel that are inside the mesh and belong to no later mesh. One work-item per column of
// voxels.
//   claimed   samples of later meshes, in the layout of `bits`; the mesh's samples are added. Used only if how.claims
//   counts    output: number of samples counted in each voxel of the slab (the voxels that are processed at a time),
//             times how.units
__kernel void count_samples(
  SampleCounts how, __global const uint* bits, __global uint* claimed, __global ushort* counts)
{
  const int columns = how.columns, words = how.words, claims = how.claims;
  const int across = get_global_id(0);
  const int up = get_global_id(1);
  if (across >= columns || up >= how.rows)
  {
    return;
  }
  const ulong rowOfColumns = (ulong)columns * SAMPLES * words;
  const ulong corner = (((ulong)up * SAMPLES + how.skipped) * columns + across) * SAMPLES * words;
  __global ushort* target = counts + (ulong)across * how.across + (ulong)up * how.up;
  for (int w = 0; w < words; ++w)
  {
    uint any = 0;
    uint every = ALL_BITS;
    for (int j = 0; j < SAMPLES; ++j)
    {
      for (int i = 0; i < SAMPLES; ++i)
      {
        const uint word = bits[corner + j * rowOfColumns + i * words + w];
        any |= word;
        every &= word;
      }
    }
    int number[CELLS];
    const int even = any == 0 || (every == ALL_BITS && !claims);
    for (int cell = 0; cell < CELLS; ++cell)
    {
      number[cell] = any != 0 && even ? SAMPLES * SAMPLES * SAMPLES : 0;
    }
    if (!even)
    {
      for (int j = 0; j < SAMPLES; ++j)
      {
        for (int i = 0; i < SAMPLES; ++i)
        {
          const ulong place = corner + j * rowOfColumns + i * words + w;
          uint word = bits[place];
          if (claims)
          {
            const uint taken = claimed[place];
            claimed[place] = taken | word;
            word &= ~taken;
          }
          for (int cell = 0; cell < CELLS; ++cell)
          {
            number[cell] += popcount((word >> (SAMPLES * cell)) & ONE_CELL);
          }
        }
      }
    }
    for (int cell = 0; cell < CELLS && w * CELLS + cell < how.voxels; ++cell)
    {
      target[(ulong)(w * CELLS + cell) * how.along] = (ushort)(number[cell] * how.units);
    }
  }
}

#endif
