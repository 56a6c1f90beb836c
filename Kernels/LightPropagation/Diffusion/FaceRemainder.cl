// The transport correction of the diffusion system's inner faces (numerics.md, Eqs. (54), (55), (62)). On `real`
// (Numerics.cl). The host gives
//   MOMENTS  1: sweeps carry light that goes straight on where it is scattered forwards, or has angular moments

#pragma once
#include "LightPropagation/Diffusion/Conductance.cl"

// From 0 to 1: how thick a voxel of optical length tau is beside one of length beyond (numerics.md, Eq. (62)).
inline real contrast(real tau, real beyond)
{
  const real bounded = fmin(tau, (real)1e4f); // from there on it is as thick as can be, and a fourth power has an end
  const real thick = 0.8f * bounded * bounded;
  const real unlike = select((real)0.0f, 1.0f - beyond / fmax(tau, (real)1e-37f), tau > beyond);
  return unlike * unlike * thick * thick / ((1.0f + thick * thick) * (1.0f + beyond * beyond));
}

// The weight of the transport correction (numerics.md, Eq. (55)): 1 in thin voxels, little in thick or absorbing
// ones, where the sweep's power holds nothing but the errors of its source.
inline real weight_of_transport(const DiffusionLayout* layout, real tau, real absorbing)
{
  const real weight = 1.0f / (1.0f + tau * (0.25f * tau + (MOMENTS ? 0.0f : 3.0f) * absorbing));
  return layout->linear ? weight : (real)1.0f;
}

// Power of rays that cross a face in their repeated pattern, over its mean (numerics.md, Eq. (65)), of the mean that
// `crossing` tells.
inline real pattern_of(real crossing, real tau)
{
  const real thick = 1.0f - 1.0f / (1.0f + tau * tau); // in thin voxels it is in the light too
  return 1.0f + thick * (crossing - 1.0f);
}

// An inner face across an axis, of the voxels 0 and 1 on its sides.
typedef struct
{
  real sigma_t[2], sigma_a[2]; // 1/length
  real flatSource[2];          // flat_source_current
  real model[2];               // the model's fluence, W / length^2
  real passes;                 // conductance, length^2
  real net;                    // W from 0 to 1, that the sweep found
  real driven;                 // the part of it that the given source's own net flux drives
  real crossing;               // of the pattern of rays
} inner_face;

// Power through it from 0 to 1: that of the sweep less that of the model (numerics.md, Eq. (54)).
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
