// Which samples of a fine grid lie inside a closed mesh (Eisemann and Decoret 2008; Pfeuti 2009, section 3.1.2): a
// column of samples is a row of words, a bit a sample, and every triangle toggles all samples of its columns that lie
// before it.
//
// Toggling the samples before a crossing is left to the end: a triangle toggles only the last of them, and one scan of
// the column then does the rest, for all triangles at once.
//
// All is whole numbers. Points lie on a lattice (see SampleLattice.h), samples at odd multiples of half a pitch, and a
// sample that touches a plane or an edge is decided as if it were moved by (e, e^2, e^3) with e infinitely small. A
// column so never meets an edge or a corner, and which samples are inside is the same whichever axis the columns run
// along.
//
// Defined before: SAMPLES, samples per edge of a voxel; WINDING, 1 where crossings are counted with their sign instead.

#pragma once

// Points as columns along an axis, 0 to 2, have them: along, across and up; and back.
#define BY_COLUMNS(p, axis) ((axis) == 0 ? (p) : (axis) == 1 ? (p).yxz : (p).zxy)
#define FROM_COLUMNS(p, axis) ((axis) == 0 ? (p) : (axis) == 1 ? (p).yxz : (p).yzx)
#define ALONG(p) ((p).x)
#define ACROSS(p) ((p).y)
#define UP(p) ((p).z)

#if WINDING
// The winding number of the mesh about each sample: a byte counts the crossings between it and the next one, +1
// for each at which a line along the column leaves the mesh, -1 where it enters.
#define CELLS 4
#define BITS 4
#else
// Voxels of a word, and bits used of it: a voxel's samples are never in two words.
#define CELLS (32 / SAMPLES)
#define BITS (CELLS * SAMPLES)
#endif
#define ALL_BITS ((uint)((1UL << BITS) - 1UL))
#define ONE_CELL ((uint)((1UL << SAMPLES) - 1UL))

// An edge of a triangle, seen along the columns, in a column: >= 0 on the inner side.
typedef struct
{
  long value, across, up; // and what a step to the next column and to the next row adds
} edge;

inline edge edge_in_column(int3 from, int3 to, long across, long up, int pitch)
{
  const long right = (long)UP(from) - UP(to);
  const long above = (long)ACROSS(to) - ACROSS(from);
  edge e;
  e.value = above * (up - UP(from)) + right * (across - ACROSS(from));
  e.value -= right > 0 || (right == 0 && above > 0) ? 0 : 1; // on the edge: where the sample was moved to
  e.across = right * pitch;
  e.up = above * pitch;
  return e;
}

// Of samples 0, 1, ..., each `step` above the one before, those that lie before a plane: those with
// number * step < excess. What lies beyond the column counts as its end.
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
  // Rounding in float is by less than one, as there are less than 2^20 samples.
  const long wanted = excess - 1;
  long number = (long)((float)wanted / (float)step);
  const long rest = wanted - number * step;
  number += rest < 0 ? -1 : rest >= step ? 1 : 0;
  return (int)number + 1;
}

#if !WINDING
// A random number a sample, by which crossings are summed.
inline uint weight_of(int sample)
{
  uint h = (uint)sample * 0x9e3779b1u + 0x7f4a7c15u;
  h = (h ^ (h >> 15)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  return h ^ (h >> 16);
}
#endif

inline void mark_crossing(
  __global uint* column, __global uint* sum, int before, int samples, int leaving, int from_above)
{
#if WINDING
  if (before > 0)
  {
    const int sample = before - 1;
    atomic_add(column + sample / 4, (uint)leaving << (8 * (sample % 4)));
  }
#else
  const int sample = from_above ? before : before - 1;
  if (sample >= 0 && sample < samples)
  {
    atomic_xor(column + sample / BITS, 1u << (sample % BITS));
    atomic_add(sum, (uint)leaving * weight_of(sample));
  }
#endif
}

// A triangle over the columns of a tile: which of them its edges enclose, and where its plane crosses them. All is as
// the columns have it.
typedef struct
{
  edge e0, e1, e2;             // in the first column of a row
  long3 normal;                // of the plane, made to point along the columns
  int leaving;                 // 1 where it did before: a line along a column leaves the mesh; -1 where it enters
  long step;                   // from sample to sample, as `excess` measures
  long excess;                 // how far the column's first sample is before the plane, and `tie`
  int tie;                     // 1 where a sample on the plane counts as before it
  long excessAcross, excessUp; // what is taken off in the next column and in the next row
} sheet;

// Returns 0 where the triangle crosses no column.
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
    return 0; // no column, moved as they are, crosses it
  }
  const int turned = ALONG(normal) > 0 ? 1 : -1;
  s->leaving = axis == 1 ? -turned : turned; // across and along are exchanged
  normal *= turned;
  s->normal = normal;
  const long3 facing = FROM_COLUMNS(normal, axis);
  const int towards = facing.x != 0 ? facing.x > 0 : facing.y != 0 ? facing.y > 0 : facing.z > 0;
  s->tie = towards ? 0 : 1;

  // The edges, run counterclockwise in (across, up).
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

// Marks where a triangle crosses the columns of a tile.
//   tiles          a work-item each: triangle, first column and row, (columns << 16) | rows
//   axis           along which the columns run
//   from_above     1: what lies after a crossing is toggled instead; not used with WINDING
//   pitch          of the samples, in units of the lattice
//   samples        of a column; columns: of a row; words: of a column
//   firstRow       the first row of columns in `marks`
//   sums           of the weights of a column's crossings, each with its sign, see fill_columns; not used with WINDING
__kernel void mark_crossings(int tileCount, __global const uint4* tiles, __global const int* points,
  __global const int* triangles, int axis, int pitch, int samples, int from_above, int columns, int words, int firstRow,
  __global uint* marks, __global uint* sums)
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
  const ulong firstColumn = (ulong)(tile.z - firstRow) * columns + tile.y;
  __global uint* row = marks + firstColumn * words;
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
        mark_crossing(row + (ulong)i * words, rowOfSums + i, samples_before(excess, s.step, samples), samples,
          s.leaving, from_above);
      }
      v0 += s.e0.across;
      v1 += s.e1.across;
      v2 += s.e2.across;
      excess -= s.excessAcross;
    }
    next_row(&s);
    row += (ulong)columns * words;
#if !WINDING
    rowOfSums += columns;
#endif
  }
}

#if WINDING

// Winding numbers of one column's samples: the smallest, the largest, how many are neither 0 nor 1 when multiplied by
// `sign`, and the first such sample.
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
    // The bytes were added up as one number: a negative byte has borrowed from the next one.
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

// Turns the marks of each column into bits that say inside or outside, and finds the columns with a sample about which
// the mesh winds neither 0 times nor once.
//
// Where it winds about all samples of a column 0 times or once, lines along the column leave and enter the mesh by
// turns, and the crossings' weights with their signs add up to those of the marks that are left, with signs by turns.
// Weights are random: other crossings have another sum, but for one in 2^32.
//   columns   of a row
//   from_above  as in mark_crossings
//   sums      of mark_crossings
//   sign      1, -1 where the mesh is inside out, 0 where nothing is to be found
//   odd       from firstOdd on a number for each row of voxels of the grid: set where it has such a column
//   firstRow  of the columns
__kernel void fill_columns(int columnCount, int columns, int words, int from_above, __global uint* marks,
  __global const uint* sums, int sign, __global int* odd, int firstOdd, int firstRow)
{
  const int id = get_global_id(0);
  if (id >= columnCount)
  {
    return;
  }
  __global uint* column = marks + (ulong)id * words;
  uint carried = 0;
  uint sum = 0;
  uint turn = from_above ? (uint)-1 : 1;
  for (int w = 0; from_above && w < words; ++w)
  {
    uint bits = column[w];
    for (uint rest = bits; rest != 0; rest &= rest - 1)
    {
      sum += turn * weight_of(w * BITS + popcount(~rest & (rest - 1)));
      turn = -turn;
    }
    bits ^= bits << 1;
    bits ^= bits << 2;
    bits ^= bits << 4;
    bits ^= bits << 8;
    bits ^= bits << 16;
    bits = (bits ^ carried) & ALL_BITS;
    column[w] = bits;
    carried = (bits >> (BITS - 1)) != 0 ? ALL_BITS : 0;
  }
  for (int w = words - 1; !from_above && w >= 0; --w)
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

// Counts the samples of each voxel that are inside, and not claimed by an object that comes later. A work-item per
// column of voxels.
//   voxels    of a column of voxels; columns, rows: of the columns of voxels that `bits` holds
//   skipped   rows of samples in `bits` before those of the first voxels
//   claimed   as `bits`: samples of later objects; those of this one are added. Not looked at where claims is 0
//   counts    of the slab's voxels, times `units`; strides: from voxel to voxel along, across and up
__kernel void count_samples(int voxels, int columns, int rows, int words, int skipped, __global const uint* bits,
  __global uint* claimed, int claims, __global ushort* counts, int units, int strideAlong, int strideAcross,
  int strideUp)
{
  const int across = get_global_id(0);
  const int up = get_global_id(1);
  if (across >= columns || up >= rows)
  {
    return;
  }
  const ulong rowOfColumns = (ulong)columns * SAMPLES * words;
  const ulong corner = (((ulong)up * SAMPLES + skipped) * columns + across) * SAMPLES * words;
  __global ushort* target = counts + (ulong)across * strideAcross + (ulong)up * strideUp;
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
    for (int cell = 0; cell < CELLS && w * CELLS + cell < voxels; ++cell)
    {
      target[(ulong)(w * CELLS + cell) * strideAlong] = (ushort)(number[cell] * units);
    }
  }
}

#endif
