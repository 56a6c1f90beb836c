// The transport correction of the diffusion system's inner faces (numerics.md, Eqs. (54), (55), (62)). All functions
// operate on `real` (Numerics.cl). Options:
//   MOMENTS  1: sweeps treat forward scattering as unscattered light, or have angular moments

#pragma once
#include "LightPropagation/Diffusion/Conductance.cl"

// Contrast, 0 to 1: how optically thick a voxel of optical length tau is compared with a neighbour of length `beyond`
// (numerics.md, Eq. (62)).
inline real contrast(real tau, real beyond)
{
  // larger values make no difference, and their fourth power would overflow
  const real bounded = fmin(tau, (real)1e4f);
  const real thick = 0.8f * bounded * bounded;
  const real unlike = select((real)0.0f, 1.0f - beyond / fmax(tau, (real)1e-37f), tau > beyond);
  return unlike * unlike * thick * thick / ((1.0f + thick * thick) * (1.0f + beyond * beyond));
}

// Weight of the transport correction (numerics.md, Eq. (55)): 1 in thin voxels, small in thick or absorbing ones, where
// the sweep's powers contain nothing but the discretisation error of its source.
inline real weight_of_transport(const DiffusionLayout* layout, real tau, real absorbing)
{
  const real weight = 1.0f / (1.0f + tau * (0.25f * tau + (MOMENTS ? 0.0f : 3.0f) * absorbing));
  return layout->linear ? weight : (real)1.0f;
}

// Power of the rays that cross a face in their repeating pattern, relative to the mean (numerics.md, Eq. (65)).
//   crossing  the pattern's value for thick voxels
inline real pattern_of(real crossing, real tau)
{
  const real thick = 1.0f - 1.0f / (1.0f + tau * tau); // in thin voxels the fluence has the same pattern
  return 1.0f + thick * (crossing - 1.0f);
}

// An inner face across an axis, between voxels 0 and 1.
typedef struct
{
  real sigma_t[2], sigma_a[2]; // 1/length
  real flatSource[2];          // flat_source_current
  real model[2];               // the model's fluence, W / length^2
  real passes;                 // conductance, length^2
  real net;                    // net power from 0 to 1 in the sweep, W
  real driven;                 // part of `net` that the given source's own net flux drives
  real crossing;               // value of the crossing pattern
} inner_face;

// Power through the face from 0 to 1: that of the sweep minus that of the model (numerics.md, Eq. (54)).
inline real remainder_of(const DiffusionLayout* layout, int axis, const inner_face* face)
{
  const float h = layout->spacing[axis];
  const real tau0 = h * face->sigma_t[0], tau1 = h * face->sigma_t[1];
  const real tau = 0.5f * (tau0 + tau1);
  const real flat_source = face->flatSource[0] + face->flatSource[1];
  const real absorbing = (0.5f * h) * (face->sigma_a[0] + face->sigma_a[1]);
  const real spread =
    layout->linear ? 3.0f * face->passes * flat_source * pattern_of(face->crossing, tau) : face->passes;
  const real skin = layout->linear ? contrast(fmax(tau0, tau1), fmin(tau0, tau1)) : (real)0.0f;
  const real weight = weight_of_transport(layout, tau, absorbing) * (1.0f - skin);
  const real remainder = weight * ((face->net - face->driven) - spread * (face->model[0] - face->model[1]));
  return select((real)0.0f, remainder, weight > (real)1e-12f);
}
