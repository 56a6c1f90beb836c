// Functions that sum partial currents, i.e. the power that enters each voxel through each of its faces (numerics.md,
// Eq. (29)). The diffusion system of the acceleration needs them.

#pragma once
#include "LightPropagation/Sweep/OnCpu/SweepLayout.cl"

// Adds the fraction `part` of `count` rows of rays, which enter row y of voxels through `face`, to the partial
// currents. `count` must be a compile-time constant.
inline __attribute__((always_inline)) void add_currents(
  sweep_state* state, int y, int face, const __global float** rays, int count, float part)
{
  for (int c = 0; c < CHANNELS; ++c)
  {
    __global float* sum = ROW_OF(state->planes, PLANE_CURRENTS + CurrentFaces * c + face, y);
    for (int x = 0; x < state->width; x += REAL_WIDTH)
    {
      real all = load_real(x, rays[0] + c * ROW);
#pragma unroll
      for (int k = 1; k < count; ++k)
      {
        all += load_real(x, rays[k] + c * ROW);
      }
      store_real(multiply_add(all, (real)part, load_real(x, sum)), x, sum);
    }
  }
}
static BY_ROW void add_current(sweep_state* state, int y, int face, const __global float* rays, float part)
{
  add_currents(state, y, face, &rays, 1, part);
}

// Adds the fraction `part` of the diagonal rays of row y to the partial currents of the voxels that they pass between
// leaving one voxel and entering the next. A ray that arrives at column x passes through column x - du of row y, which
// it enters through `face`, a face normal to v. It then enters column x through the face normal to u, or leaves the
// box.
static BY_ROW void add_beside(sweep_state* state, int y, int du, int face, const __global float* rays, float part)
{
  const int size = state->sizeU;
  for (int c = 0; c < CHANNELS; ++c)
  {
    const __global float* from = rays + c * ROW;
    __global float* sum = ROW_OF(state->planes, PLANE_CURRENTS + CurrentFaces * c + face, y);
    for (int x = 0; x < state->width; x += REAL_WIDTH)
    {
      // Floats beyond either end of a row are written but never read.
      const real ray = select(load_real(x, from), (real)0.0f, LANES >= size - x);
      store_real(multiply_add(ray, (real)part, load_real(x - du, sum)), x - du, sum);
    }
    const int beyond = PERIODIC_U ? (du > 0 ? 0 : size - 1) : (du > 0 ? size : -1);
    sum[du > 0 ? size - 1 : 0] += part * from[beyond];
  }
}

// Adds the fraction `part` of the rays that cross the edge between four voxels to the partial currents: half passes
// through the neighbour along u, half through the neighbour along v.
//   rays  power of the rays, at the voxel that they enter
//   own   power of the rays of row y, at the voxel that they come from
static BY_ROW void add_through_edge(
  sweep_state* state, int y, int du, int dv, const __global float* rays, const __global float* own, float part)
{
  const float half_part = 0.5f * part;
  const int u_face = du > 0 ? CurrentLowU : CurrentHighU;
  const int v_face = dv > 0 ? CurrentLowV : CurrentHighV;
  const int height = state->sizeV;
  const int before = PERIODIC_V ? (y - dv + height) % height : y - dv;
  if (before >= 0 && before < height)
  {
    add_current(state, before, u_face, rays, half_part);
  }
  add_current(state, y, v_face, rays, half_part);
  add_beside(state, y, du, v_face, rays, half_part);
  add_current(state, y, u_face, rays, half_part);
  if (!PERIODIC_V && y == (dv > 0 ? height - 1 : 0))
  {
    add_current(state, y, u_face, own - du, half_part); // rays that leave the box
  }
}
