// Loops over the rows of a multigrid level (MultigridLevel), and its matrix along rows:
//   (A x)_i = sum over faces of conductance (x_i - x_j) + loss_i x_i
// Conductances are stored for the low face of each voxel, one array of MultigridLevel::floats per axis; 0 where the box
// ends.
//
// The macros let one kernel serve CPUs and GPUs. On a CPU a work-item processes rows in vectors of REAL_WIDTH voxels.
// On a GPU (REAL_WIDTH 1) it processes single voxels, and neighbouring work-items of a group process neighbouring
// voxels. Also requires the option GROUP (GroupSum.cl).

#pragma once
#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "Numerics/GroupSum.cl"
#include "Numerics/Numerics.cl"

// FOR_ROWS     loops over the rows r of owned voxels that this work-item processes
// ROW_Y, ROW_Z  indices y and z of the row r
// FOR_VECTORS  loops over this work-item's vectors of begin <= x < end in a row
// FOR_VOXELS   loops over this work-item's voxels of begin <= x < end in a row
// FILL_GHOSTS  sets a row's ghosts to the values of the opposite end; within FOR_ROWS, after the last write to the row.
//              On a periodic axis these are the neighbours; elsewhere they have no effect, because the conductance is 0
// ENDS_ROW     true for exactly one iteration per row
#define OWN_SIZE(level, axis) ((level).end[axis] - (level).first[axis])
#define OWN_ROWS(level) (OWN_SIZE(level, 1) * OWN_SIZE(level, 2))
#define ROW_Y(level, r) ((level).first[1] + (r) % OWN_SIZE(level, 1))
#define ROW_Z(level, r) ((level).first[2] + (r) / OWN_SIZE(level, 1))
#if REAL_WIDTH == 1
#define LANES 0
#define FOR_ROWS(level)                                                                                           \
  for (int voxel = get_global_id(0), r = voxel / OWN_SIZE(level, 0),                                              \
           own_x = (level).first[0] + voxel % OWN_SIZE(level, 0);                                                 \
       voxel < OWN_SIZE(level, 0) * OWN_ROWS(level); voxel += get_global_size(0), r = voxel / OWN_SIZE(level, 0), \
           own_x = (level).first[0] + voxel % OWN_SIZE(level, 0))
#define FOR_VECTORS(x, begin, end) for (int x = own_x; x >= (begin) && x < (end); x = (end))
#define FOR_VOXELS FOR_VECTORS
#define FILL_GHOSTS(row, size) fill_ghosts_of(row, size, own_x)
#define ENDS_ROW(size) (own_x == (size)-1)
#else
#if REAL_WIDTH == 4
#define LANES ((int4)(0, 1, 2, 3))
#else
#define LANES ((int8)(0, 1, 2, 3, 4, 5, 6, 7))
#endif
#define FOR_ROWS(level)                                                                                                \
  for (int r = get_global_id(0) * (level).together, row_end = min(OWN_ROWS(level), r + (level).together); r < row_end; \
       ++r)
#define FOR_VECTORS(x, begin, end) for (int x = (begin); x < (end); x += REAL_WIDTH)
#define FOR_VOXELS(x, begin, end) for (int x = (begin); x < (end); ++x)
#define FILL_GHOSTS(row, size) fill_ghosts(row, size)
#define ENDS_ROW(size) true
#endif

inline int row_at(const MultigridLevel* level, int y, int z)
{
  return RowsLead + z * level->plane + y * level->pitch;
}

// Sets the SIMD lanes of `values` that lie beyond the row's end to 0; `left` is the number of voxels from the first
// lane to the row's end.
inline real in_row(real values, int left)
{
  return left >= REAL_WIDTH ? values : select(values, (real)0.0f, LANES >= left);
}

// Sets the SIMD lanes of `values` whose voxels this rank does not own to 0; the first lane is voxel x of the row.
inline real in_own(const MultigridLevel* level, real values, int x)
{
  const real kept = in_row(values, level->end[0] - x);
  return x >= level->first[0] ? kept : select((real)0.0f, kept, LANES + x >= level->first[0]);
}

inline void fill_ghosts(__global float* row, int size)
{
  row[-1] = row[size - 1];
  row[size] = row[0];
}

// Sets the ghosts of a row, as fill_ghosts() does, by the work-items that wrote its first and last voxel; x is the
// voxel of this work-item.
inline void fill_ghosts_of(__global float* row, int size, int x)
{
  if (x == 0)
  {
    row[size] = row[0];
  }
  if (x == size - 1)
  {
    row[-1] = row[x];
  }
}

typedef struct
{
  const __global float *own, *low_y, *high_y, *low_z, *high_z; // values in the row, and in its four neighbouring rows
  // Loss terms of the matrix for the row's voxels, and conductances of the voxels' faces
  const __global float *loss, *passes_x, *passes_y, *passes_high_y, *passes_z, *passes_high_z;
} matrix_row;

inline matrix_row find_matrix_row(const MultigridLevel* level, int y, int z, const __global float* conductance,
  const __global float* loss, const __global float* values)
{
  const int here = row_at(level, y, z);
  const int low_y = row_at(level, y > 0 ? y - 1 : level->size[1] - 1, z);
  const int high_y = row_at(level, y < level->size[1] - 1 ? y + 1 : 0, z);
  const int low_z = row_at(level, y, z > 0 ? z - 1 : level->size[2] - 1);
  const int high_z = row_at(level, y, z < level->size[2] - 1 ? z + 1 : 0);
  const __global float* passes_y = conductance + level->floats;
  const __global float* passes_z = passes_y + level->floats;
  const matrix_row row = { values + here, values + low_y, values + high_y, values + low_z, values + high_z, loss + here,
    conductance + here, passes_y + here, passes_y + high_y, passes_z + here, passes_z + high_z };
  return row;
}

inline real diagonal_of(const matrix_row* row, int x)
{
  return ((load_real(x, row->passes_x) + load_real(x + 1, row->passes_x)) +
           (load_real(x, row->passes_y) + load_real(x, row->passes_high_y))) +
    ((load_real(x, row->passes_z) + load_real(x, row->passes_high_z)) + load_real(x, row->loss));
}

// Product of the matrix with the row's values (matrix_row::own), for the vector of voxels from x on.
inline real apply_row(const matrix_row* row, int x)
{
  const real own = load_real(x, row->own);
  real sum = load_real(x, row->loss) * own;
  sum = multiply_add(load_real(x, row->passes_x), own - load_real(x - 1, row->own), sum);
  sum = multiply_add(load_real(x + 1, row->passes_x), own - load_real(x + 1, row->own), sum);
  real aside = load_real(x, row->passes_y) * (own - load_real(x, row->low_y));
  aside = multiply_add(load_real(x, row->passes_high_y), own - load_real(x, row->high_y), aside);
  aside = multiply_add(load_real(x, row->passes_z), own - load_real(x, row->low_z), aside);
  aside = multiply_add(load_real(x, row->passes_high_z), own - load_real(x, row->high_z), aside);
  return sum + aside;
}

// Adds neighbouring SIMD lanes of two adjacent vectors a, b in pairs. first_of_pairs() returns the first lane of each
// pair instead.
inline real pair_sums(real a, real b)
{
#if REAL_WIDTH == 1
  return a + b;
#else
  return (real)(a.even + a.odd, b.even + b.odd);
#endif
}
inline real first_of_pairs(real a, real b)
{
#if REAL_WIDTH == 1
  return a;
#else
  return (real)(a.even, b.even);
#endif
}
