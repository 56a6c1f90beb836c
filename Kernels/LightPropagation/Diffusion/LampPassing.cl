// Lamps' light in thick voxels, see DiffusionSystem.h: it is scattered first near the faces that it comes in through,
// and part of it passes those at once.

#pragma once
#include "LightPropagation/Diffusion/DiffusionLayout.cl"

// Of light that falls off over tau from a face of a voxel as exp(-b t), what comes back to the face while it is
// diffused and absorbed over k a mean free path. r, 0 to 1, is how near to the face it is scattered: 1 - 2 t / tau for
// a mean depth t.
static float comes_back(float tau, float r, float k)
{
  const float b = 2.0f * r * (3.0f - 2.0f * r) / (tau * fmax(1.0f - r, 1e-6f)); // exact for r near 0 and near 1
  const float x = b * tau, y = (b + k) * tau;
  const float shone = x < 1e-3f ? 1.0f - 0.5f * x : -expm1(-x) / x;
  const float back = y < 1e-3f ? 1.0f - 0.5f * y : -expm1(-y) / y;
  return back / shone;
}

// How much of the light of a voxel passes on, because it is scattered near a face, than if it were scattered evenly.
static float passes_inside(float tau, float r, float k)
{
  if (k * tau < 0.02f)
  {
    return r;
  }
  const float even = -expm1(-k * tau) / (k * tau);
  return fmax((comes_back(tau, r, k) - even) / (1.0f - even), 0.0f);
}

// Mean of Hopf's function over exp(-t / depth): H(depth) / sqrt(3) - depth, to 0.2%.
static float hopf(float depth)
{
  const float c = 0.34f - 0.17f / (1.0f + 4.0f * depth);
  return 0.57735f + 0.13310f * depth / (depth + c);
}

// In voxels that are neither thin nor thick sweeps say that even light passes less than that: fitted to slabs.
static float beside_sweeps(float tau)
{
  const float transport_weight = 1.0f / (1.0f + 0.25f * tau * tau);
  return 1.0f + transport_weight * (0.02f + 0.17f * transport_weight);
}

// The same at a face of the box. In a half-space, light scattered at depth t reaches far as t + hopf(t).
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
