// Row layout and vector access for all kernels of the reconstruction, with REAL_WIDTH 8 (CPUs) or 1.
//
// A level of a pyramid consists of `fields` volumes of rows, one volume per quantity. A row is padded to a multiple of
// 2 REAL_WIDTH, and has GUARD values before and after it. Padding and guards repeat the row's end values, so that loads
// along x need no bounds checks. The int4 `size` of a level is cells along x, y, z, then the pitch of rows in floats.
//
// Voxel arrays in the host's layout interleave their components and have no guards; the w component of their `size`
// is the pitch of rows in voxels, a multiple of 2 REAL_WIDTH.

#pragma once
#include "Numerics/Numerics.cl"

#if REAL_WIDTH == 8
typedef float16 pair;
#define GUARD 8
#else
typedef float2 pair;
#define GUARD 2
#endif
typedef pair __attribute__((aligned(4))) pair_anywhere;
#define load_pair(index, pointer) (*(const __global pair_anywhere*)((pointer) + (index)))
#define store_pair(value, index, pointer) (*(__global pair_anywhere*)((pointer) + (index)) = (value))

// Loop over the cells of a row: one work-item per row on CPUs, one per cell on GPUs.
#if REAL_WIDTH > 1
#define ROW_Y get_global_id(0)
#define ROW_Z get_global_id(1)
#define FOR_CELLS(x, count) for (int x = 0; x < (count); x += REAL_WIDTH)
#else
#define ROW_Y get_global_id(1)
#define ROW_Z get_global_id(2)
#define FOR_CELLS(x, count) for (int x = get_global_id(0), end_ = x + 1; x < end_; ++x)
#endif

// Interleaves the values of even and of odd cells.
inline pair woven(real even, real odd)
{
#if REAL_WIDTH == 8
  return (float16)(even.s0, odd.s0, even.s1, odd.s1, even.s2, odd.s2, even.s3, odd.s3, even.s4, odd.s4, even.s5, odd.s5,
    even.s6, odd.s6, even.s7, odd.s7);
#else
  return (float2)(even, odd);
#endif
}

// Vectors of voxels with three components, which are interleaved in memory and separate here.
typedef struct
{
  real x, y, z;
} real_of_three;
typedef struct
{
  pair x, y, z;
} pair_of_three;

#if REAL_WIDTH == 8
// Selects lanes 0, 3, 6 of a, 1, 4, 7 of b, and 2, 5 of c. In three vectors of voxels with interleaved components, each
// component occupies every lane once. This selection and one permutation therefore separate the components. A single
// shuffle would compile to sixteen moves.
inline float8 lanes_of(float8 a, float8 b, float8 c)
{
  const int8 second = (int8)(0, -1, 0, 0, -1, 0, 0, -1), third = (int8)(0, 0, -1, 0, 0, -1, 0, 0);
  return third ? c : second ? b : a;
}
#endif

inline real_of_three load_reals_of_three(size_t voxel, const __global float* values)
{
  const __global float* from = values + 3 * voxel;
  real_of_three r;
#if REAL_WIDTH == 8
  const float8 a = load_real(0, from), b = load_real(8, from), c = load_real(16, from);
  r.x = lanes_of(a, b, c).s03614725;
  r.y = lanes_of(c, a, b).s14725036;
  r.z = lanes_of(b, c, a).s25036147;
#else
  r.x = from[0];
  r.y = from[1];
  r.z = from[2];
#endif
  return r;
}

inline void store_reals_of_three(real x, real y, real z, size_t voxel, __global float* values)
{
  __global float* to = values + 3 * voxel;
#if REAL_WIDTH == 8
  const float8 a = x.s03614725, b = y.s50361472, c = z.s25036147;
  store_real(lanes_of(a, b, c), 0, to);
  store_real(lanes_of(c, a, b), 8, to);
  store_real(lanes_of(b, c, a), 16, to);
#else
  to[0] = x;
  to[1] = y;
  to[2] = z;
#endif
}

// Loads 2 REAL_WIDTH voxels of three components from an array of interleaved components.
inline pair_of_three load_three(size_t voxel, const __global float* values)
{
  const real_of_three low = load_reals_of_three(voxel, values), high = load_reals_of_three(voxel + REAL_WIDTH, values);
  pair_of_three r;
  r.x.lo = low.x;
  r.x.hi = high.x;
  r.y.lo = low.y;
  r.y.hi = high.y;
  r.z.lo = low.z;
  r.z.hi = high.z;
  return r;
}

inline void store_three(pair x, pair y, pair z, size_t voxel, __global float* values)
{
  store_reals_of_three(x.lo, y.lo, z.lo, voxel, values);
  store_reals_of_three(x.hi, y.hi, z.hi, voxel + REAL_WIDTH, values);
}

#if REAL_WIDTH == 1
#define any_of(condition) (condition)
#else
#define any_of(condition) any(condition)
#endif

// x if positive, else 0. fmax is not used, since it also tests for NaN.
#define positive_part(x) ((x) > 0.0f ? (x) : 0.0f)

inline int within(int i, int count)
{
  return i < 0 ? 0 : i < count ? i : count - 1;
}

// Pitches in floats of a layer of rows (layer_of) and of a quantity's volume (field_of). Neither is a multiple of 4 kB:
// with such a pitch, layers would evict each other from the cache (LightPyramid.cxx).
inline size_t layer_of(int4 size)
{
  const size_t layer = (size_t)size.y * size.w;
  return layer < 1024 ? layer : layer + 48;
}
inline size_t field_of(int4 size)
{
  const size_t field = layer_of(size) * size.z;
  return field < 1024 ? field : field + 656;
}

// Offset of a row's first value from the beginning of its level. Rows y and z outside the level are clamped.
inline size_t row_of(int4 size, int field, int y, int z)
{
  return field * field_of(size) + within(z, size.z) * layer_of(size) + (size_t)within(y, size.y) * size.w + GUARD;
}

// Fills the guards and the padding of a row. The GUARD values before the row repeat its first value; the padding and
// the guards after it repeat its last one. A side is filled only if the cell at that end of the row is among the
// `width` cells that were written from x on. `count` is the number of cells in the row.
inline void repeat_ends(__global float* row, int x, int width, int count)
{
  if (x == 0)
  {
    row[-1] = row[0];
    row[-2] = row[0];
  }
  if (x + width >= count)
  {
    const int end = (count + 2 * REAL_WIDTH - 1) / (2 * REAL_WIDTH) * (2 * REAL_WIDTH) + 2;
    const float last = row[count - 1];
    for (int i = count; i < end; ++i)
    {
      row[i] = last;
    }
  }
}

inline real nearer(real near, real far)
{
  return multiply_add((real)0.25f, far, (real)0.75f * near);
}

// A cell at (y, z) has eight children, in four rows of pairs: row k is at y = k % 2, z = k / 2. Holds the offsets,
// within a field of the cell's level, of the four rows from which a row of children is interpolated.
typedef struct
{
  size_t here, beside, behind, opposite;
} rows_about;

inline rows_about rows_for_children(int4 size, int y, int z, int k)
{
  const int other_y = y - 1 + 2 * (k % 2), other_z = z - 1 + 2 * (k / 2);
  const rows_about r = { row_of(size, 0, y, z), row_of(size, 0, other_y, z), row_of(size, 0, y, other_z),
    row_of(size, 0, other_y, other_z) };
  return r;
}

typedef struct
{
  real even, odd;
} children;

inline real cells_for_children(const __global float* field, const rows_about* rows, int x)
{
  return nearer(nearer(load_real(rows->here + x, field), load_real(rows->beside + x, field)),
    nearer(load_real(rows->behind + x, field), load_real(rows->opposite + x, field)));
}

// Interpolates REAL_WIDTH cells, from x on, trilinearly to row k of their children (rows_for_children). Rows are
// interpolated one at a time, because all eight children of several quantities do not fit into a CPU's registers.
inline children interpolate(const __global float* field, const rows_about* rows, int x)
{
  const real middle = cells_for_children(field, rows, x);
  const children c = { nearer(middle, cells_for_children(field, rows, x - 1)),
    nearer(middle, cells_for_children(field, rows, x + 1)) };
  return c;
}
