// Conjugate gradients, preconditioned by multigrid, for the diffusion system.
//
// A level's matrix: row i is sum over faces of conductance (x_i - x_j) + loss_i x_i. Vectors of multigrid are float: it
// only has to point in about the right direction.

#include "LightPropagation/Diffusion/DiffusionLayout.cl"

static float neighbours_sum(
  const __global float* conductance, int count, const __global float* values, int i, const int* next, float* passes)
{
  const float a = conductance[i], b = conductance[next[1]];
  const float c = conductance[count + i], d = conductance[count + next[3]];
  const float e = conductance[2 * count + i], f = conductance[2 * count + next[5]];
  *passes = ((a + b) + (c + d)) + (e + f);
  return ((a * values[next[0]] + b * values[next[1]]) + (c * values[next[2]] + d * values[next[3]])) +
    (e * values[next[4]] + f * values[next[5]]);
}

// y = b - A x where `right` is true, else A x
__kernel void diffusion_apply(MultigridLevel level, const __global float* conductance, const __global float* loss,
  const __global exact* values, const __global exact* right, int subtract, __global exact* result)
{
  VOXEL(level.size)
  const int count = level.size[0] * level.size[1] * level.size[2];
  int next[6];
  find_neighbours(level.size, x, y, z, i, next);
  const exact own = values[i];
  exact sum = loss[i] * own;
  for (int axis = 0; axis < 3; ++axis)
  {
    const __global float* passes = conductance + axis * count;
    sum += passes[i] * (own - values[next[2 * axis]]) + passes[next[2 * axis + 1]] * (own - values[next[2 * axis + 1]]);
  }
  result[i] = subtract ? right[i] - sum : sum;
}

// The first guess on a level: right / diagonal.
__kernel void level_begin(MultigridLevel level, const __global float* conductance, const __global float* loss,
  const __global float* right, __global float* values, float damping)
{
  VOXEL(level.size)
  const int count = level.size[0] * level.size[1] * level.size[2];
  int next[6];
  find_neighbours(level.size, x, y, z, i, next);
  const float passes =
    ((conductance[i] + conductance[next[1]]) + (conductance[count + i] + conductance[count + next[3]])) +
    (conductance[2 * count + i] + conductance[2 * count + next[5]]);
  const float diagonal = passes + loss[i];
  values[i] = diagonal > 0.0f ? damping * right[i] / diagonal : 0.0f;
}

// As level_begin, from the residual of conjugate gradients in units of `unit`.
__kernel void finest_begin(MultigridLevel level, const __global float* conductance, const __global float* loss,
  const __global exact* residual, float per_unit, __global float* right, __global float* values, float damping)
{
  VOXEL(level.size)
  const int count = level.size[0] * level.size[1] * level.size[2];
  int next[6];
  find_neighbours(level.size, x, y, z, i, next);
  const float passes =
    ((conductance[i] + conductance[next[1]]) + (conductance[count + i] + conductance[count + next[3]])) +
    (conductance[2 * count + i] + conductance[2 * count + next[5]]);
  const float diagonal = passes + loss[i];
  right[i] = (float)(residual[i] * per_unit);
  values[i] = diagonal > 0.0f ? damping * right[i] / diagonal : 0.0f;
}

__kernel void level_smooth(MultigridLevel level, const __global float* conductance, const __global float* loss,
  const __global float* right, const __global float* values, __global float* better, float damping)
{
  VOXEL(level.size)
  const int count = level.size[0] * level.size[1] * level.size[2];
  int next[6];
  find_neighbours(level.size, x, y, z, i, next);
  float passes;
  const float sum = neighbours_sum(conductance, count, values, i, next, &passes);
  const float diagonal = passes + loss[i];
  better[i] = diagonal > 0.0f ? values[i] + damping * ((right[i] + sum) / diagonal - values[i]) : 0.0f;
}

__kernel void level_residual(MultigridLevel level, const __global float* conductance, const __global float* loss,
  const __global float* right, const __global float* values, __global float* residual)
{
  VOXEL(level.size)
  const int count = level.size[0] * level.size[1] * level.size[2];
  int next[6];
  find_neighbours(level.size, x, y, z, i, next);
  float passes;
  const float sum = neighbours_sum(conductance, count, values, i, next, &passes);
  residual[i] = right[i] + sum - (passes + loss[i]) * values[i];
}

// Sum over the finer level's voxels in each of this one. A work-item a coarse voxel.
__kernel void level_restrict(
  MultigridLevel fine, MultigridLevel coarse, const __global float* residual, __global float* right)
{
  VOXEL(coarse.size)
  float sum = 0.0f;
  for (int c = 0; c <= fine.halved[2]; ++c)
  {
    for (int b = 0; b <= fine.halved[1]; ++b)
    {
      for (int a = 0; a <= fine.halved[0]; ++a)
      {
        const int u = (x << fine.halved[0]) + a, v = (y << fine.halved[1]) + b, w = (z << fine.halved[2]) + c;
        sum += u < fine.size[0] && v < fine.size[1] && w < fine.size[2]
          ? residual[(w * fine.size[1] + v) * fine.size[0] + u]
          : 0.0f;
      }
    }
  }
  right[i] = sum;
}

__kernel void level_prolong(
  MultigridLevel fine, MultigridLevel coarse, const __global float* correction, __global float* values)
{
  VOXEL(fine.size)
  const int parent =
    ((z >> fine.halved[2]) * coarse.size[1] + (y >> fine.halved[1])) * coarse.size[0] + (x >> fine.halved[0]);
  values[i] += correction[parent];
}

// The coarser level's matrix (numerics.md, Eq. (70)): faces side by side add up; along a halved axis centres are twice
// as far apart.
__kernel void level_coarsen(MultigridLevel fine, MultigridLevel coarse, const __global float* conductance,
  const __global float* loss, __global float* coarse_conductance, __global float* coarse_loss)
{
  VOXEL(coarse.size)
  const int count = fine.size[0] * fine.size[1] * fine.size[2];
  const int coarse_count = coarse.size[0] * coarse.size[1] * coarse.size[2];
  float passes[3] = { 0.0f, 0.0f, 0.0f };
  float taken = 0.0f;
  for (int c = 0; c <= fine.halved[2]; ++c)
  {
    for (int b = 0; b <= fine.halved[1]; ++b)
    {
      for (int a = 0; a <= fine.halved[0]; ++a)
      {
        const int u = (x << fine.halved[0]) + a, v = (y << fine.halved[1]) + b, w = (z << fine.halved[2]) + c;
        if (u < fine.size[0] && v < fine.size[1] && w < fine.size[2])
        {
          const int j = (w * fine.size[1] + v) * fine.size[0] + u;
          taken += loss[j];
          passes[0] += a == 0 ? conductance[j] : 0.0f;
          passes[1] += b == 0 ? conductance[count + j] : 0.0f;
          passes[2] += c == 0 ? conductance[2 * count + j] : 0.0f;
        }
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const float part = coarse.size[axis] == 1 ? 0.0f : fine.halved[axis] ? 0.5f : 1.0f;
    coarse_conductance[axis * coarse_count + i] = part * passes[axis];
  }
  coarse_loss[i] = taken;
}

// A few voxels: Gauss and Seidel there and back, by one work-item.
__kernel void level_finish(MultigridLevel level, const __global float* conductance, const __global float* loss,
  const __global float* right, __global float* values, int rounds)
{
  const int count = level.size[0] * level.size[1] * level.size[2];
  for (int i = 0; i < count; ++i)
  {
    values[i] = 0.0f;
  }
  for (int round = 0; round < 2 * rounds; ++round)
  {
    for (int k = 0; k < count; ++k)
    {
      const int i = round & 1 ? count - 1 - k : k;
      const int x = i % level.size[0], y = i / level.size[0] % level.size[1], z = i / (level.size[0] * level.size[1]);
      int next[6];
      find_neighbours(level.size, x, y, z, i, next);
      float passes;
      const float sum = neighbours_sum(conductance, count, values, i, next, &passes);
      const float diagonal = passes + loss[i];
      values[i] = diagonal > 0.0f ? (right[i] + sum) / diagonal : 0.0f;
    }
  }
}

// Chunks of the sum of a b; a work-item a chunk.
#define DOT(name, type)                                                                                \
  __kernel void name(const __global exact* a, const __global type* b, int count, __global exact* sums) \
  {                                                                                                    \
    const int begin = get_global_id(0) * DiffusionChunk;                                               \
    const int end = min(count, begin + DiffusionChunk);                                                \
    exact part[4] = { 0, 0, 0, 0 };                                                                    \
    int i = begin;                                                                                     \
    for (; i + 4 <= end; i += 4)                                                                       \
    {                                                                                                  \
      for (int k = 0; k < 4; ++k)                                                                      \
      {                                                                                                \
        part[k] += a[i + k] * b[i + k];                                                                \
      }                                                                                                \
    }                                                                                                  \
    for (; i < end; ++i)                                                                               \
    {                                                                                                  \
      part[0] += a[i] * b[i];                                                                          \
    }                                                                                                  \
    sums[get_global_id(0)] = (part[0] + part[1]) + (part[2] + part[3]);                                \
  }
DOT(diffusion_dot, exact)
DOT(diffusion_dot_float, float)
#undef DOT

// x += step p, r -= step q
__kernel void diffusion_step(__global exact* values, __global exact* residual, const __global exact* direction,
  const __global exact* applied, exact step)
{
  const int i = get_global_id(0);
  values[i] += step * direction[i];
  residual[i] -= step * applied[i];
}
// p = z + part p
__kernel void diffusion_turn(__global exact* direction, const __global float* preconditioned, exact part)
{
  const int i = get_global_id(0);
  direction[i] = preconditioned[i] + part * direction[i];
}
