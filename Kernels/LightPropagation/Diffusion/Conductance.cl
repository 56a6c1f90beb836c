// Conductances of voxel faces in the diffusion system (DiffusionSystem.h), and the transport correction at inner faces
// (numerics.md, Eqs. (54), (55), (62)). tau is the optical length of a voxel along an axis. All functions operate on
// `real` (Numerics.cl): one voxel, or a vector of voxels.

#pragma once
#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "Numerics/Numerics.cl"

// Partial current that a sweep carries for a fluence that decreases by one per mean free path, with a source that is
// constant in each voxel (numerics.md, Eq. (51)): 1/6 for thin voxels, tau / 8 for optically thick ones.
//   sigma   extinction, 1/length
//   edge    length of the voxel along the axis
//   nodes   directions of the sweep, in `count` groups
inline real flat_source_current(real sigma, float edge, const __global FlatSourceNode* nodes, int count)
{
  real sum = (real)0.0f;
  for (int k = 0; k < count; ++k)
  {
    const real x = sigma * nodes[k].chord;
    real left;
    const real gone = extinguished(x, &left);
    const real falls = select(x * left / fmax(gone, (real)1e-20f), 1.0f - x * (0.5f - x / 12.0f), x < (real)0.02f);
    sum += nodes[k].weight * (0.5f * edge * sigma + nodes[k].cosine * falls);
  }
  return sum;
}

// Half the edge of a voxel in diffusion lengths, y = tau sqrt(3 sigma_a / sigma_t) / 2.
inline real half_diffusion_length(real tau, real sigma_t, real sigma_a)
{
  const real absorbed = fmin(sigma_a / fmax(sigma_t, (real)1e-37f), (real)1.0f);
  return select((real)0.0f, 0.5f * tau * sqrt(3.0f * absorbed), sigma_t > (real)0.0f);
}

// Conductance of an absorbing half voxel, relative to that of a half voxel without absorption (numerics.md, Eq. (57)).
// The half voxel lies next to a boundary, from which light decays exponentially.
inline real at_border(real y)
{
  real left;
  extinguished(2.0f * y, &left);
  const real whole = y * (2.0f * y / (2.0f * fmax(y, (real)0.02f) - 1.0f + left));
  return select(whole, 1.0f + y * (2.0f / 3.0f), y < (real)0.02f);
}
// Conductance of an absorbing half voxel between equal voxels, relative to that of a half voxel without absorption
// (numerics.md, Eq. (57)).
inline real among_equals(real y)
{
  const real bounded = clamp(y, (real)1e-3f, (real)40.0f);
  real left;
  const real gone = extinguished(2.0f * bounded, &left);
  const real x = 2.0f * bounded * sqrt(left) / gone; // y / sinh(y), with y = bounded
  return select(fmax(select(x * x, (real)0.0f, y >= (real)40.0f), (real)1e-20f), (real)1.0f, y < (real)0.01f);
}

// Conductance per area of the inner face between voxels 0 and 1 (D / A of numerics.md, Eq. (57)). tau0, tau1 are their
// optical lengths, y0, y1 their half_diffusion_length(), and flat_source is the sum of their flat_source_current(),
// used if DiffusionLayout::linear is 0.
inline real pass_face(const DiffusionLayout* layout, real tau0, real tau1, real y0, real y1, real flat_source)
{
  if (!layout->linear)
  {
    return flat_source / fmax(0.5f * (tau0 + tau1), (real)layout->floor);
  }
  const real sum = tau0 + tau1;
  const real equal = 1.0f - fabs(tau0 - tau1) / fmax(sum, (real)1e-37f);
  const real same = equal * equal;
  const real way0 = tau0 / mix(at_border(y0), among_equals(y0), same);
  const real way1 = tau1 / mix(at_border(y1), among_equals(y1), same);
  return 1.0f / (3.0f * fmax(0.5f * (way0 + way1), (real)layout->floor));
}

inline float face_area(const DiffusionLayout* layout, int axis)
{
  return layout->spacing[(axis + 1) % 3] * layout->spacing[(axis + 2) % 3];
}
inline float volume_of(const DiffusionLayout* layout)
{
  return layout->spacing[0] * layout->spacing[1] * layout->spacing[2];
}

// Twice the effective optical length from a voxel's centre to a face of the box, smaller if the voxel absorbs (`way` of
// numerics.md, Eq. (58)).
inline real way_to_boundary(const DiffusionLayout* layout, real tau, real sigma_t, real sigma_a)
{
  return layout->linear ? tau / at_border(half_diffusion_length(tau, sigma_t, sigma_a)) : tau;
}
inline real pass_boundary(const DiffusionLayout* layout, real way)
{
  const real x = 3.0f * layout->halfRange * way;
  return 2.0f * layout->halfRange / (1.0f + (layout->linear ? x : x / (1.0f + x)));
}

// Contrast of a face, 0 to 1, between a voxel of optical length tau and a neighbour of optical length `beyond`: near 1
// if the voxel is thick and the neighbour thin, 0 if the neighbour is thicker (numerics.md, Eq. (62)).
inline real contrast(real tau, real beyond)
{
  // limits tau so that its fourth power does not overflow; the contrast of a larger tau is the same
  const real bounded = fmin(tau, (real)1e4f);
  const real thick = 0.8f * bounded * bounded;
  const real unlike = select((real)0.0f, 1.0f - beyond / fmax(tau, (real)1e-37f), tau > beyond);
  return unlike * unlike * thick * thick / ((1.0f + thick * thick) * (1.0f + beyond * beyond));
}

// Weight of the transport correction (numerics.md, Eq. (55)): 1 in thin voxels, small in thick or absorbing voxels,
// where the sweep's deviation from diffusion is the discretisation error of its source.
inline real weight_of_transport(const DiffusionLayout* layout, real tau, real absorbing)
{
  const real weight = 1.0f / (1.0f + tau * (TRANSPORT_FALL(tau) + layout->absorbingWeight * absorbing));
  return layout->linear ? weight : (real)1.0f;
}

// Factor by which the power that diffusion predicts through a face between voxels of optical length tau is multiplied
// before it is compared with the power of the sweep (`pattern` of numerics.md, Eq. (65)). It is needed because rays
// cross some faces more often than others.
//   crossing  crossing pattern of the face (SweepModel.h), relative to the mean over the grid: the factor if the
//             voxels are thick
inline real pattern_of(real crossing, real tau)
{
  // In thin voxels the factor is 1, because diffusion starts from the sweep's fluence in them, which already varies
  // from plane to plane like the power of the rays that cross the faces.
  const real thick = 1.0f - 1.0f / (1.0f + tau * tau);
  return 1.0f + thick * (crossing - 1.0f);
}

// Inner face between voxels 0 and 1, which are neighbours along an axis.
typedef struct
{
  real sigma_t[2], sigma_a[2]; // extinction and absorption coefficients of the two voxels, 1/length
  real flatSource[2];          // result of flat_source_current()
  // Fluence of the two voxels from which diffusion's power through the face is computed, to be compared with the power
  // `net` of the sweep; W / length^2.
  real model[2];
  real passes; // conductance, length^2
  real net;    // net power that crosses the face from voxel 0 to voxel 1 in the sweep, W
  // Part of `net` due to the net flux of the known source (emission and first collisions, Eq. (53a)).
  real driven;
  // crossing pattern of the face (SweepModel.h): power of the rays that cross it, relative to the mean over the
  // grid
  real crossing;
} inner_face;

// Transport correction of the power through the face from voxel 0 to 1, W: the power of the sweep minus that of
// diffusion, times weight_of_transport() (remainder R of numerics.md, Eq. (54)). Between a thick voxel and a thinner
// one, the weight is reduced further.
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
