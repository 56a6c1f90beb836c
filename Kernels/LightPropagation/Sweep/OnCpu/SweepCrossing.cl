// Functions for the effect of a segment (a ray's path through one voxel) on the power of the ray, for a vector of
// voxels.

#pragma once
#include "LightPropagation/Sweep/OnCpu/SweepLayout.cl"
#include "Numerics/Prefetch.cl"

// Effect of a segment on rays of power P with a source q: path += p1 P, P' = P - sigma p1 P + power q p1, with the mean
// transmitted length p1 = (1 - exp(-tau)) / sigma (numerics.md, Eqs. (23), (24)). P' is computed as P keep + P change +
// power q p1, which avoids cancellation: for small tau this is P minus the loss, for large tau P times the
// transmittance.
typedef struct
{
  real tau;
  real meanLength; // mean transmitted length p1
  // 1 for small tau, where `change` is minus the lost fraction of P; else 0, where `change` is the transmittance
  real keep;
  real change;
} real_crossing;

// Computes the effect of a segment (path through one voxel) on rays. If the whole row of voxels is optically thin, p1
// is evaluated as a polynomial, which halves the work. `thin` must be a compile-time constant.
static inline __attribute__((always_inline)) real_crossing cross_length(const sweep_state* state, int x,
  const __global float* sigma_row, const __global float* inverse_row, float length, bool thin)
{
  real_crossing crossing;
  const real tau = load_real(x, sigma_row) * length;
  crossing.tau = tau;
  if (thin)
  {
    real mean = (real)state->meanLength[MeanLengthTerms - 1];
#pragma unroll
    for (int i = MeanLengthTerms - 2; i >= 0; --i)
    {
      mean = multiply_add(mean, tau, (real)state->meanLength[i]);
    }
    mean = multiply_add(mean, tau, (real)1.0f);
    crossing.meanLength = mean * length;
    crossing.keep = (real)1.0f;
    crossing.change = -tau * mean;
  }
  else
  {
    real left;
    const real lost = extinguished(tau, &left);
    const integer losesLess = tau < (real)1.0f;
    crossing.meanLength = lost * load_real(x, inverse_row);
    crossing.keep = select((real)0.0f, (real)1.0f, losesLess);
    crossing.change = select(left, -lost, losesLess);
  }
  return crossing;
}

// Path integral that a unit source in a voxel causes within that voxel, divided by a ray's power at radiance 1: (length
// - p1) / sigma (numerics.md, Eq. (24)).
static inline __attribute__((always_inline)) real own_path_of(
  int x, const real_crossing* crossing, const __global float* inverse_row, float length)
{
  const real thin_path = multiply_add(crossing->tau, (real)(-length * length / 6.0f), (real)(0.5f * length * length));
  const real thick_path = (length - crossing->meanLength) * load_real(x, inverse_row);
  return select(thick_path, thin_path, crossing->tau < (real)1e-2f);
}

// Signs of the components along u and v of one direction (member m) of a bundle.
static inline float2 signs_of(const __global BundleInfo* bundle, int m)
{
  return (float2)(bundle->move[m][0] + bundle->move[m][1], bundle->move[m][2] + bundle->move[m][3]);
}

// Prefetches the next cache lines of the map of ray powers from main memory into the second-level cache: a few lines at
// each vector of voxels, because prefetching a whole row at once would stall the core.
static inline __attribute__((always_inline)) void ask_for_lines(sweep_state* state)
{
  for (int i = 0; i < state->asks; ++i)
  {
    PREFETCH(state->asked + i * FloatsOfLine, 0, 2);
  }
  state->asked += state->asks * FloatsOfLine;
}

// Selects the part of row y of a map that stage g of `stages` stages is to prefetch; y < 0: nothing. A row has `floats`
// floats.
static inline void ask_ahead(sweep_state* state, const __global float* map, int y, int floats, int g, int stages)
{
  state->asks = 0;
  state->asked = map;
  if (state->tile > 0 && y >= 0)
  {
    const int vectors = state->width / REAL_WIDTH, lines = (floats + FloatsOfLine - 1) / FloatsOfLine;
    state->asks = (lines + stages * vectors - 1) / (stages * vectors);
    state->asked = map + y * floats + g * state->asks * vectors * FloatsOfLine;
  }
}
