// Rows of light for every kernel of the reconstruction, after Numerics.cl with REAL_WIDTH 8 (CPUs) or 1.
//
// A level of a pyramid holds `fields` volumes of rows, one quantity each. A row has GUARD values before and after it that
// repeat its ends, as the values do that fill it up to a multiple of 2 REAL_WIDTH: no load along x asks where a row ends.
// `size` is cells along x, y, z, then floats from a row to the next.
//
// Arrays of voxels as the host has them are not split into quantities and have no guards; their size.w is voxels from a row to
// the next, a multiple of 2 REAL_WIDTH.

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

// A work-item a row on CPUs, a work-item a vector of cells on GPUs.
#if REAL_WIDTH > 1
#define ROW_Y get_global_id(0)
#define ROW_Z get_global_id(1)
#define FOR_CELLS(x, count) for (int x = 0; x < (count); x += REAL_WIDTH)
#else
#define ROW_Y get_global_id(1)
#define ROW_Z get_global_id(2)
#define FOR_CELLS(x, count) for (int x = get_global_id(0), end_ = x + 1; x < end_; ++x)
#endif

// The values of even and odd places in the order of their places.
inline pair woven(real even, real odd)
{
#if REAL_WIDTH == 8
  return (float16)(even.s0, odd.s0, even.s1, odd.s1, even.s2, odd.s2, even.s3, odd.s3, even.s4, odd.s4, even.s5, odd.s5,
    even.s6, odd.s6, even.s7, odd.s7);
#else
  return (float2)(even, odd);
#endif
}

// 2 REAL_WIDTH voxels of three components from `values`, split into components, and back.
typedef struct
{
  pair x, y, z;
} pair_of_three;

inline pair_of_three load_three(size_t voxel, const __global float* values)
{
  const __global float* from = values + 3 * voxel;
  pair_of_three r;
#if REAL_WIDTH == 8
  const float16 a = load_pair(0, from), b = load_pair(16, from), c = load_pair(32, from);
  r.x = (float16)(a.s0, a.s3, a.s6, a.s9, a.sc, a.sf, b.s2, b.s5, b.s8, b.sb, b.se, c.s1, c.s4, c.s7, c.sa, c.sd);
  r.y = (float16)(a.s1, a.s4, a.s7, a.sa, a.sd, b.s0, b.s3, b.s6, b.s9, b.sc, b.sf, c.s2, c.s5, c.s8, c.sb, c.se);
  r.z = (float16)(a.s2, a.s5, a.s8, a.sb, a.se, b.s1, b.s4, b.s7, b.sa, b.sd, c.s0, c.s3, c.s6, c.s9, c.sc, c.sf);
#else
  r.x = (float2)(from[0], from[3]);
  r.y = (float2)(from[1], from[4]);
  r.z = (float2)(from[2], from[5]);
#endif
  return r;
}

inline void store_three(pair x, pair y, pair z, size_t voxel, __global float* values)
{
  __global float* to = values + 3 * voxel;
#if REAL_WIDTH == 8
  store_pair((float16)(x.s0, y.s0, z.s0, x.s1, y.s1, z.s1, x.s2, y.s2, z.s2, x.s3, y.s3, z.s3, x.s4, y.s4, z.s4, x.s5), 0, to);
  store_pair((float16)(y.s5, z.s5, x.s6, y.s6, z.s6, x.s7, y.s7, z.s7, x.s8, y.s8, z.s8, x.s9, y.s9, z.s9, x.sa, y.sa), 16, to);
  store_pair((float16)(z.sa, x.sb, y.sb, z.sb, x.sc, y.sc, z.sc, x.sd, y.sd, z.sd, x.se, y.se, z.se, x.sf, y.sf, z.sf), 32, to);
#else
  to[0] = x.x;
  to[1] = y.x;
  to[2] = z.x;
  to[3] = x.y;
  to[4] = y.y;
  to[5] = z.y;
#endif
}

// Not fmax, which looks for NaN.
#define positive_part(x) ((x) > 0.0f ? (x) : 0.0f)

inline int within(int i, int count)
{
  return i < 0 ? 0 : i < count ? i : count - 1;
}

// First value of a row of a level, from the level's beginning. y and z beyond the ends: the end's row.
inline size_t row_of(int4 size, int field, int y, int z)
{
  return (((size_t)field * size.z + within(z, size.z)) * size.y + within(y, size.y)) * size.w + GUARD;
}
inline size_t field_of(int4 size)
{
  return (size_t)size.w * size.y * size.z;
}

// After `width` cells from x on were written: repeat the row's ends if they are among them.
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

// The cells of a level that interpolation needs around row (y, z): begins of 3 x 3 rows of field 0, y fastest.
typedef struct
{
  size_t at[9];
} rows_around;

inline rows_around rows_about(int4 size, int y, int z)
{
  rows_around r;
#pragma unroll
  for (int k = 0; k < 9; ++k)
  {
    r.at[k] = row_of(size, 0, y + k % 3 - 1, z + k / 3 - 1);
  }
  return r;
}

inline real nearer(real near, real far)
{
  return multiply_add((real)0.25f, far, (real)0.75f * near);
}

// Trilinear interpolation of REAL_WIDTH cells from x on to their eight children each: finer[4 z + 2 y + x].
inline void interpolate(const __global float* field, rows_around rows, int x, real* finer)
{
  real even[9], odd[9];
#pragma unroll
  for (int k = 0; k < 9; ++k)
  {
    const __global float* row = field + rows.at[k] + x;
    const real middle = load_real(0, row);
    even[k] = nearer(middle, load_real(-1, row));
    odd[k] = nearer(middle, load_real(1, row));
  }
#pragma unroll
  for (int y = 0; y < 2; ++y)
  {
    real e[3], o[3];
#pragma unroll
    for (int z = 0; z < 3; ++z)
    {
      e[z] = nearer(even[3 * z + 1], even[3 * z + 2 * y]);
      o[z] = nearer(odd[3 * z + 1], odd[3 * z + 2 * y]);
    }
#pragma unroll
    for (int z = 0; z < 2; ++z)
    {
      finer[4 * z + 2 * y] = nearer(e[1], e[2 * z]);
      finer[4 * z + 2 * y + 1] = nearer(o[1], o[2 * z]);
    }
  }
}
