// Conjugate gradients, preconditioned by multigrid, for the diffusion system (MultigridSolver.h). Options:
//   REAL_WIDTH  number of floats in a vector, 4 or 8; 1: one voxel per work-item, on a GPU
//   GROUP       number of work-items that sum together (GroupSum.cl); on a GPU at least the number of voxels of the
//               coarsest level
//   DOUBLES     1: the device has double precision
//
// Each kernel processes rows (MultigridRows.cl). All arrays but the solution are float, since the residual from which a
// solve starts is computed in double. Entries beyond a row's last voxel are 0 in right-hand sides and residuals, and
// not used in other arrays.

#include "LightPropagation/Diffusion/MultigridRows.cl"
#include "Numerics/Exact.cl"

#if REAL_WIDTH == 1
typedef exact exact_real;
#define to_exact_real (exact)
#define load_exact(index, pointer) ((pointer)[index])
#define store_exact(value, index, pointer) ((pointer)[index] = (value))
#else
#if DOUBLES
typedef TYNDALL_JOIN(double, REAL_WIDTH) exact_real;
#define to_exact_real TYNDALL_JOIN(convert_double, REAL_WIDTH)
#else
typedef real exact_real;
#define to_exact_real
#endif
typedef exact_real __attribute__((aligned(4))) exact_anywhere;
#define load_exact(index, pointer) (*(const __global exact_anywhere*)((pointer) + (index)))
#define store_exact(value, index, pointer) (*(__global exact_anywhere*)((pointer) + (index)) = (value))
#endif

inline exact sum_of_exact(exact_real values)
{
#if REAL_WIDTH == 1
  return values;
#elif REAL_WIDTH == 4
  return (values.s0 + values.s1) + (values.s2 + values.s3);
#else
  return ((values.s0 + values.s1) + (values.s2 + values.s3)) + ((values.s4 + values.s5) + (values.s6 + values.s7));
#endif
}

// Computes damping / diagonal of a level's matrix for Jacobi's method; 0 where the diagonal is 0.
__kernel void level_invert(MultigridLevel level, const __global float* conductance, const __global float* loss,
  __global float* inverse, float damping)
{
  FOR_ROWS(level)
  {
    const int y = ROW_Y(level, r), z = ROW_Z(level, r);
    const matrix_row row = find_matrix_row(&level, y, z, conductance, loss, inverse);
    FOR_VECTORS(x, level.first[0], level.end[0])
    {
      const real diagonal = diagonal_of(&row, x);
      const real value = select((real)0.0f, (real)damping / diagonal, diagonal > (real)0.0f);
      store_real(in_row(value, level.end[0] - x), x, inverse + row_at(&level, y, z));
    }
  }
}

inline bool owns_row(const MultigridLevel* level, int y, int z)
{
  return y >= level->first[1] && y < level->end[1] && z >= level->first[2] && z < level->end[2];
}

// Matrix entries of voxels of a coarser level (numerics.md, Eq. (70)): loss, and conductances of the low faces by axis.
// Conductances of fine faces side by side are summed; along a halved axis the sum is halved, since centres are twice as
// far apart.
typedef struct
{
  real loss, passes[3];
} coarse_entries;

// Adds the matrix entries of the finer level's row y = v, z = w to those of a vector of the coarser level's voxels from
// x on. b, c: 1 if that row is the second one within the coarse voxels along y, along z; 0 if it is the first.
static void add_fine_row(const MultigridLevel* fine, int v, int w, int b, int c, int x,
  const __global float* conductance, const __global float* loss, coarse_entries* sum)
{
  const int here = row_at(fine, v, w), u = (x << fine->halved[0]) + fine->shift[0];
  const __global float* sources[4] = { loss + here, conductance + here, conductance + fine->floats + here,
    conductance + 2 * fine->floats + here };
  real values[4];
  for (int k = 0; k < 4; ++k)
  {
    if (!fine->halved[0])
    {
      values[k] = in_own(fine, load_real(u, sources[k]), u);
      continue;
    }
    const real low = in_own(fine, load_real(u, sources[k]), u);
    const real high = in_own(fine, load_real(u + REAL_WIDTH, sources[k]), u + REAL_WIDTH);
    values[k] = k == 1 ? first_of_pairs(low, high) : pair_sums(low, high);
  }
  sum->loss += values[0];
  sum->passes[0] += values[1];
  sum->passes[1] += b == 0 ? values[2] : (real)0.0f;
  sum->passes[2] += c == 0 ? values[3] : (real)0.0f;
}

__kernel void level_coarsen(MultigridLevel fine, MultigridLevel coarse, const __global float* conductance,
  const __global float* loss, __global float* coarse_conductance, __global float* coarse_loss)
{
  FOR_ROWS(coarse)
  {
    const int y = ROW_Y(coarse, r), z = ROW_Z(coarse, r);
    const int here = row_at(&coarse, y, z);
    FOR_VECTORS(x, coarse.first[0], coarse.end[0])
    {
      coarse_entries sum = { (real)0.0f, { (real)0.0f, (real)0.0f, (real)0.0f } };
      for (int c = 0; c <= fine.halved[2]; ++c)
      {
        for (int b = 0; b <= fine.halved[1]; ++b)
        {
          const int v = (y << fine.halved[1]) + fine.shift[1] + b, w = (z << fine.halved[2]) + fine.shift[2] + c;
          if (owns_row(&fine, v, w))
          {
            add_fine_row(&fine, v, w, b, c, x, conductance, loss, &sum);
          }
        }
      }
      store_real(sum.loss, x, coarse_loss + here);
      for (int axis = 0; axis < 3; ++axis)
      {
        const float part = coarse.single[axis] ? 0.0f : fine.halved[axis] ? 0.5f : 1.0f;
        store_real(sum.passes[axis] * part, x, coarse_conductance + axis * coarse.floats + here);
      }
    }
    FILL_GHOSTS(coarse_conductance + here, coarse.size[0]);
  }
}

// Residual b - A x of one voxel, in exact arithmetic (Exact.cl). `values` is x, [voxel], without ghosts between rows.
static float residual_at(
  const MultigridLevel* level, const matrix_row* row, const __global exact* values, int x, int y, int z, float right)
{
  const int* n = level->size;
  const __global exact* own = values + ((ulong)z * n[1] + y) * n[0];
  const __global exact* low_y = values + ((ulong)z * n[1] + (y > 0 ? y - 1 : n[1] - 1)) * n[0];
  const __global exact* high_y = values + ((ulong)z * n[1] + (y < n[1] - 1 ? y + 1 : 0)) * n[0];
  const __global exact* low_z = values + ((ulong)(z > 0 ? z - 1 : n[2] - 1) * n[1] + y) * n[0];
  const __global exact* high_z = values + ((ulong)(z < n[2] - 1 ? z + 1 : 0) * n[1] + y) * n[0];
  exact sum = row->loss[x] * own[x];
  sum += row->passes_x[x] * (own[x] - own[x > 0 ? x - 1 : n[0] - 1]);
  sum += row->passes_x[x + 1] * (own[x] - own[x < n[0] - 1 ? x + 1 : 0]);
  sum += row->passes_y[x] * (own[x] - low_y[x]) + row->passes_high_y[x] * (own[x] - high_y[x]);
  sum += row->passes_z[x] * (own[x] - low_z[x]) + row->passes_high_z[x] * (own[x] - high_z[x]);
  return (float)(right - sum);
}

// Replaces the right-hand side by the residual r of `values`, multiplied by per_unit (the reciprocal of a typical
// right-hand side), and computes Jacobi's initial guess for the correction of `values`.
//   sums  partial sums of r r, [work-group]
__kernel void begin_residual(MultigridLevel level, const __global float* conductance, const __global float* loss,
  const __global float* inverse, const __global exact* values, float per_unit, __global float* right,
  __global float* guess, __global exact* sums)
{
  exact sum = 0;
  FOR_ROWS(level)
  {
    const int y = ROW_Y(level, r), z = ROW_Z(level, r), here = row_at(&level, y, z);
    const matrix_row row = find_matrix_row(&level, y, z, conductance, loss, guess);
    FOR_VOXELS(x, level.first[0], level.end[0])
    {
      const float left = residual_at(&level, &row, values, x, y, z, right[here + x]) * per_unit;
      right[here + x] = left;
      guess[here + x] = inverse[here + x] * left;
      sum += (exact)left * left;
    }
    for (int x = level.end[0]; (x - level.first[0]) % REAL_WIDTH != 0; ++x)
    {
      right[here + x] = 0.0f; // clears the padding, which may be a ghost of the next row
    }
    FILL_GHOSTS(guess + here, level.size[0]);
  }
  PUT_SUM_OF_GROUP(exact, sum, sums[get_group_id(0)])
}

// Residual of a vector of voxels from x on in a row; 0 in voxels that this rank does not own. level_restrict sums it
// over the fine voxels of each coarse voxel, and computes Jacobi's initial guess of the coarse level.
static real left_of_row(const MultigridLevel* fine, const matrix_row* row, const __global float* right, int x)
{
  return in_own(fine, load_real(x, right) - apply_row(row, x), x);
}

__kernel void level_restrict(MultigridLevel fine, MultigridLevel coarse, const __global float* conductance,
  const __global float* loss, const __global float* right, const __global float* values,
  const __global float* coarse_inverse, __global float* coarse_right, __global float* coarse_values)
{
  FOR_ROWS(coarse)
  {
    const int y = ROW_Y(coarse, r), z = ROW_Z(coarse, r), here = row_at(&coarse, y, z);
    bool first = true;
    for (int c = 0; c <= fine.halved[2]; ++c)
    {
      for (int b = 0; b <= fine.halved[1]; ++b)
      {
        const int v = (y << fine.halved[1]) + fine.shift[1] + b, w = (z << fine.halved[2]) + fine.shift[2] + c;
        if (!owns_row(&fine, v, w))
        {
          continue;
        }
        const matrix_row row = find_matrix_row(&fine, v, w, conductance, loss, values);
        const __global float* fine_right = right + row_at(&fine, v, w);
        FOR_VECTORS(x, coarse.first[0], coarse.end[0])
        {
          const int u = (x << fine.halved[0]) + fine.shift[0];
          real left = left_of_row(&fine, &row, fine_right, u);
          if (fine.halved[0])
          {
            left = pair_sums(left, left_of_row(&fine, &row, fine_right, u + REAL_WIDTH));
          }
          store_real(first ? left : load_real(x, coarse_right + here) + left, x, coarse_right + here);
        }
        first = false;
      }
    }
    FOR_VECTORS(x, coarse.first[0], coarse.end[0])
    {
      store_real(load_real(x, coarse_right + here) * load_real(x, coarse_inverse + here), x, coarse_values + here);
    }
    FILL_GHOSTS(coarse_values + here, coarse.size[0]);
  }
}

// Computes Jacobi's initial guess for a right-hand side: right times inverse.
__kernel void level_guess(
  MultigridLevel level, const __global float* inverse, const __global float* right, __global float* guess)
{
  FOR_ROWS(level)
  {
    const int here = row_at(&level, ROW_Y(level, r), ROW_Z(level, r));
    FOR_VECTORS(x, level.first[0], level.end[0])
    {
      store_real(load_real(x, right + here) * load_real(x, inverse + here), x, guess + here);
    }
    FILL_GHOSTS(guess + here, level.size[0]);
  }
}

// Copies the values at the indices `places` of an array to a message for a rank that holds these voxels as ghosts;
// put_places() copies a received message to the ghosts.
__kernel void pick_places(const __global float* values, const __global int* places, __global float* picked)
{
  picked[get_global_id(0)] = values[places[get_global_id(0)]];
}
__kernel void put_places(const __global float* picked, const __global int* places, __global float* values)
{
  values[places[get_global_id(0)]] = picked[get_global_id(0)];
}

// Adds the correction of a coarser level to the values of the finer level; all fine voxels of a coarse voxel get the
// same correction.
__kernel void level_prolong(
  MultigridLevel fine, MultigridLevel coarse, const __global float* correction, __global float* values)
{
  FOR_ROWS(fine)
  {
    const int y = ROW_Y(fine, r), z = ROW_Z(fine, r);
    const __global float* from =
      correction + row_at(&coarse, (y - fine.shift[1]) >> fine.halved[1], (z - fine.shift[2]) >> fine.halved[2]);
    __global float* to = values + row_at(&fine, y, z);
#if REAL_WIDTH == 1
    to[own_x] += from[(own_x - fine.shift[0]) >> fine.halved[0]];
#else
    if (fine.halved[0])
    {
      for (int x = 0; 2 * x + fine.shift[0] < fine.end[0]; x += REAL_WIDTH)
      {
        const real parents = load_real(x, from);
        const int u = 2 * x + fine.shift[0];
#if REAL_WIDTH == 4
        store_real(load_real(u, to) + parents.s0011, u, to);
        store_real(load_real(u + 4, to) + parents.s2233, u + 4, to);
#else
        store_real(load_real(u, to) + parents.s00112233, u, to);
        if (u + 8 < fine.end[0])
        {
          store_real(load_real(u + 8, to) + parents.s44556677, u + 8, to);
        }
#endif
      }
    }
    else
    {
      FOR_VECTORS(x, fine.first[0], fine.end[0])
      {
        store_real(load_real(x, to) + load_real(x - fine.shift[0], from), x, to);
      }
    }
#endif
    FILL_GHOSTS(to, fine.size[0]);
  }
}

// One step of Jacobi's method: better = values + inverse (right - A values).
//   sums  partial sums of right times better, [work-group]
__kernel void level_smooth(MultigridLevel level, const __global float* conductance, const __global float* loss,
  const __global float* inverse, const __global float* right, const __global float* values, __global float* better,
  __global exact* sums)
{
  exact sum = 0;
  FOR_ROWS(level)
  {
    const int y = ROW_Y(level, r), z = ROW_Z(level, r), here = row_at(&level, y, z);
    const matrix_row row = find_matrix_row(&level, y, z, conductance, loss, values);
    exact_real of_row = (exact_real)0;
    FOR_VECTORS(x, level.first[0], level.end[0])
    {
      const real b = load_real(x, right + here);
      const real value =
        multiply_add(b - apply_row(&row, x), load_real(x, inverse + here), load_real(x, values + here));
      of_row += to_exact_real(b) * to_exact_real(value);
      store_real(value, x, better + here);
    }
    FILL_GHOSTS(better + here, level.size[0]);
    sum += sum_of_exact(of_row);
  }
  PUT_SUM_OF_GROUP(exact, sum, sums[get_group_id(0)])
}

// Between two visits of a level: kept = part * found, right -= part * A found (A the matrix), and Jacobi's initial
// guess for the new right-hand side. `found` is the correction of the first visit.
__kernel void level_revisit(MultigridLevel level, const __global float* conductance, const __global float* loss,
  const __global float* inverse, const __global float* found, float part, __global float* kept, __global float* right,
  __global float* guess)
{
  FOR_ROWS(level)
  {
    const int y = ROW_Y(level, r), z = ROW_Z(level, r), here = row_at(&level, y, z);
    const matrix_row row = find_matrix_row(&level, y, z, conductance, loss, found);
    FOR_VECTORS(x, level.first[0], level.end[0])
    {
      const real left =
        in_row(multiply_add(apply_row(&row, x), (real)-part, load_real(x, right + here)), level.end[0] - x);
      store_real(load_real(x, found + here) * part, x, kept + here);
      store_real(left, x, right + here);
      store_real(left * load_real(x, inverse + here), x, guess + here);
    }
    FILL_GHOSTS(guess + here, level.size[0]);
  }
}

// Computes values = added + part * values.
__kernel void scale_and_add(MultigridLevel level, const __global float* added, float part, __global float* values)
{
  FOR_ROWS(level)
  {
    const int here = row_at(&level, ROW_Y(level, r), ROW_Z(level, r));
    FOR_VECTORS(x, level.first[0], level.end[0])
    {
      store_real(multiply_add(load_real(x, values + here), (real)part, load_real(x, added + here)), x, values + here);
    }
    FILL_GHOSTS(values + here, level.size[0]);
  }
}

// Solves a level of few voxels approximately, by `rounds` symmetric Gauss-Seidel iterations from 0. @return the sum of
// right times values
static exact finish(const MultigridLevel* level, const __global float* conductance, const __global float* loss,
  const __global float* right, __global float* values, int rounds)
{
  const int* n = level->size;
  const int count = n[0] * n[1] * n[2];
  for (int i = 0; i < n[1] * n[2]; ++i)
  {
    __global float* row = values + row_at(level, i % n[1], i / n[1]);
    for (int x = -1; x <= n[0]; ++x)
    {
      row[x] = 0.0f;
    }
  }
  exact sum = 0;
  for (int round = 0; round < 2 * rounds; ++round)
  {
    for (int k = 0; k < count; ++k)
    {
      const int i = round & 1 ? count - 1 - k : k;
      const int x = i % n[0], y = i / n[0] % n[1], z = i / (n[0] * n[1]), here = row_at(level, y, z);
      const matrix_row row = find_matrix_row(level, y, z, conductance, loss, values);
      const float in_x = row.passes_x[x] * row.own[x - 1] + row.passes_x[x + 1] * row.own[x + 1];
      const float in_y = row.passes_y[x] * row.low_y[x] + row.passes_high_y[x] * row.high_y[x];
      const float in_z = row.passes_z[x] * row.low_z[x] + row.passes_high_z[x] * row.high_z[x];
      const float passes = ((row.passes_x[x] + row.passes_x[x + 1]) + (row.passes_y[x] + row.passes_high_y[x])) +
        (row.passes_z[x] + row.passes_high_z[x]);
      const float diagonal = passes + row.loss[x];
      values[here + x] = diagonal > 0.0f ? (right[here + x] + ((in_x + in_y) + in_z)) / diagonal : 0.0f;
      fill_ghosts(values + here, n[0]);
      sum += round == 2 * rounds - 1 ? (exact)right[here + x] * values[here + x] : 0;
    }
  }
  return sum;
}

// Runs finish(), the approximate solution of a level of few voxels, in one work-item.
//   sums  [0] sum of right times values
__kernel void level_finish(MultigridLevel level, const __global float* conductance, const __global float* loss,
  const __global float* right, __global float* values, __global exact* sums, int rounds)
{
  sums[0] = finish(&level, conductance, loss, right, values, rounds);
}

// Computes the result of level_finish, which is linear in the right-hand side, as a matrix: used on GPUs, where a
// single work-item takes half a millisecond for level_finish. One work-item per voxel, with a right-hand side of 1 in
// this voxel.
//   rights, values  scratch, [voxel][floats of the level]; rights are 0 on entry
//   answers         [voxel of the right-hand side][voxel of the result]
__kernel void level_answers(MultigridLevel level, const __global float* conductance, const __global float* loss,
  __global float* rights, __global float* values, __global float* answers, int rounds)
{
  const int* n = level.size;
  const int of = get_global_id(0), count = n[0] * n[1] * n[2];
  rights += of * level.floats;
  values += of * level.floats;
  rights[row_at(&level, of / n[0] % n[1], of / (n[0] * n[1])) + of % n[0]] = 1.0f;
  finish(&level, conductance, loss, rights, values, rounds);
  for (int i = 0; i < count; ++i)
  {
    answers[of * count + i] = values[row_at(&level, i / n[0] % n[1], i / (n[0] * n[1])) + i % n[0]];
  }
}

// Applies the matrix of level_answers to a right-hand side, in place of level_finish. One work-group.
//   sums  [0] sum of right times values
__kernel void level_answer(MultigridLevel level, const __global float* answers, const __global float* right,
  __global float* values, __global exact* sums)
{
  const int* n = level.size;
  const int own = get_global_id(0), count = n[0] * n[1] * n[2];
  exact sum = 0;
  if (own < count)
  {
    float value = 0.0f;
    for (int i = 0; i < count; ++i)
    {
      value += right[row_at(&level, i / n[0] % n[1], i / (n[0] * n[1])) + i % n[0]] * answers[i * count + own];
    }
    const int here = row_at(&level, own / n[0] % n[1], own / (n[0] * n[1])), x = own % n[0];
    values[here + x] = value;
    fill_ghosts_of(values + here, n[0], x);
    sum = (exact)right[here + x] * value;
  }
  PUT_SUM_OF_GROUP(exact, sum, sums[0])
}

// Product of the matrix with the search direction: applied = A direction.
//   sums  partial sums of direction times applied, [work-group]
__kernel void apply_matrix(MultigridLevel level, const __global float* conductance, const __global float* loss,
  const __global float* direction, __global float* applied, __global exact* sums)
{
  exact sum = 0;
  FOR_ROWS(level)
  {
    const int y = ROW_Y(level, r), z = ROW_Z(level, r), here = row_at(&level, y, z);
    const matrix_row row = find_matrix_row(&level, y, z, conductance, loss, direction);
    exact_real of_row = (exact_real)0;
    FOR_VECTORS(x, level.first[0], level.end[0])
    {
      const real q = in_row(apply_row(&row, x), level.end[0] - x);
      of_row += to_exact_real(q) * to_exact_real(load_real(x, direction + here));
      store_real(q, x, applied + here);
    }
    sum += sum_of_exact(of_row);
  }
  PUT_SUM_OF_GROUP(exact, sum, sums[get_group_id(0)])
}

// Step of conjugate gradients along the search direction p: x += step_of_values * p, r -= step * A p, and Jacobi's
// initial guess for the new residual r.
//   direction, applied  p and A p
//   left    r
//   values  x by voxel, without ghosts between rows, in W / length^2; r and p are relative to the parameter `unit` of
//           MultigridSolver::Solve()
//   sums    partial sums of r r, [work-group]
__kernel void go_along(MultigridLevel level, const __global float* direction, const __global float* applied,
  const __global float* inverse, float step, exact step_of_values, __global float* left, __global float* guess,
  __global exact* values, __global exact* sums)
{
  exact sum = 0;
  FOR_ROWS(level)
  {
    const int y = ROW_Y(level, r), z = ROW_Z(level, r), here = row_at(&level, y, z), end = level.end[0];
    __global exact* of_voxels = values + ((ulong)z * level.size[1] + y) * level.size[0];
    exact_real of_row = (exact_real)0;
    FOR_VECTORS(x, level.first[0], end)
    {
      const real residual = multiply_add(load_real(x, applied + here), (real)-step, load_real(x, left + here));
      store_real(residual, x, left + here);
      store_real(residual * load_real(x, inverse + here), x, guess + here);
      of_row += to_exact_real(residual) * to_exact_real(residual);
      if (x + REAL_WIDTH <= end)
      {
        store_exact(
          load_exact(x, of_voxels) + to_exact_real(load_real(x, direction + here)) * step_of_values, x, of_voxels);
      }
      else
      {
        for (int k = x; k < end; ++k)
        {
          of_voxels[k] += direction[here + k] * step_of_values;
        }
      }
    }
    FILL_GHOSTS(guess + here, level.size[0]);
    sum += sum_of_exact(of_row);
  }
  PUT_SUM_OF_GROUP(exact, sum, sums[get_group_id(0)])
}
