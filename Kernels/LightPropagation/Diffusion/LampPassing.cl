// Lamps' light in thick voxels, see DiffusionSystem.h: it is scattered first near the faces that it comes in through,
// and part of it passes those at once.

#pragma once
#include "LightPropagation/Diffusion/DiffusionLayout.cl"

// Part that returns to the face of light that is lost as exp(-b t) over tau and absorbed at k a mean free path on its
// way back (numerics.md, Eq. (69)). r, 0 to 1, is how near to the face it is scattered: 1 - 2 t / tau for a mean
// depth t.
static float comes_back(float tau, float r, float k)
{
  const float b = 2.0f * r * (3.0f - 2.0f * r) / (tau * fmax(1.0f - r, 1e-6f)); // exact for r near 0 and near 1
  const float x = b * tau, y = (b + k) * tau;
  const float shone = x < 1e-3f ? 1.0f - 0.5f * x : -expm1(-x) / x;
  const float back = y < 1e-3f ? 1.0f - 0.5f * y : -expm1(-y) / y;
  return back / shone;
}

// Part of a voxel's scattered light that passes an inner face besides what it would if it were scattered at the centre
// (numerics.md, Eqs. (66), (69)), but for the ratio of the ways.
static float passes_inside(float tau, float r, float k)
{
  if (k * tau < 0.02f)
  {
    return r;
  }
  const float even = -expm1(-k * tau) / (k * tau);
  return fmax((comes_back(tau, r, k) - even) / (1.0f - even), 0.0f);
}

// Mean of Hopf's function over exp(-t / depth): H(depth) / sqrt(3) - depth, to 0.5% (numerics.md, Eq. (67)).
static float hopf(float depth)
{
  const float c = 0.34f - 0.17f / (1.0f + 4.0f * depth);
  return 0.57735f + 0.13310f * depth / (depth + c);
}

// Correction of what passes in voxels that are neither thin nor thick, fitted to slabs (numerics.md, Eq. (68)).
static float beside_sweeps(float tau)
{
  const float transport_weight = 1.0f / (1.0f + 0.25f * tau * tau);
  return 1.0f + transport_weight * (0.02f + 0.17f * transport_weight);
}

// The same at a face of the box (numerics.md, Eqs. (66), (69)).
static float passes_border(float tau, float r, float k)
{
  const float depth = 0.5f * (1.0f - r) * tau;
  const float q = mix(2.0f / 3.0f, hopf(depth), r);
  if (k * tau < 0.02f)
  {
    return fmax(1.0f - (depth + q) / (0.5f * tau + 2.0f / 3.0f), 0.0f);
  }
  const float even = -expm1(-k * tau) / (k * tau * (1.0f + k * (2.0f / 3.0f)));
  const float kept = 1.0f - comes_back(tau, r, k) / (1.0f + k * q);
  return fmax(1.0f - kept / (1.0f - even), 0.0f);
}
