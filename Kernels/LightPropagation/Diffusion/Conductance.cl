// How easily light passes the faces of voxels in the diffusion system, see DiffusionSystem.h. tau is the optical length
// of a voxel along an axis.

#pragma once
#include "LightPropagation/Diffusion/DiffusionLayout.cl"

// Part of the partial current of a source that is constant in each voxel and falls by one from mean free path to mean
// free path (numerics.md, Eq. (51); 4 Gauss points): 1/6 for thin voxels, tau / 8 for thick ones.
static float flat_source_current(float tau)
{
  const float mu[4] = { 0.0694318442f, 0.3300094782f, 0.6699905218f, 0.9305681558f };
  const float half_weight[4] = { 0.0869637113f, 0.1630362887f, 0.1630362887f, 0.0869637113f };
  float sum = 0.0f;
  for (int k = 0; k < 4; ++k)
  {
    const float x = 0.5f * tau / mu[k];
    sum += half_weight[k] * mu[k] * mu[k] * (x < 0.02f ? 1.0f + x * x / 3.0f : x / tanh(x));
  }
  return sum;
}

// Half of a voxel in units of the diffusion length, y = tau sqrt(3 (1 - albedo)) / 2.
static float half_diffusion_length(float tau, float sigma_t, float sigma_a)
{
  return sigma_t > 0.0f ? 0.5f * tau * sqrt(3.0f * fmin(sigma_a / sigma_t, 1.0f)) : 0.0f;
}

// Conductance of an absorbing half voxel over that of tau / 2 (numerics.md, Eq. (57)): of light that falls off
// exponentially from a border...
static float at_border(float y)
{
  return y < 0.02f ? 1.0f + y * (2.0f / 3.0f) : 2.0f * y * y / (2.0f * y - 1.0f + exp(-2.0f * y));
}
// ...and between voxels of the same kind.
static float among_equals(float y)
{
  const float x = y < 40.0f ? y / sinh(fmax(y, 1e-3f)) : 0.0f;
  return y < 0.01f ? 1.0f : fmax(x * x, 1e-20f);
}

// Conductance of an inner face per area (numerics.md, Eq. (57)).
static float pass_face(const DiffusionLayout* layout, float tau0, float tau1, float y0, float y1, float flat_source)
{
  const float mean = 0.5f * (tau0 + tau1);
  if (!layout->linear)
  {
    return flat_source / fmax(mean, layout->floor);
  }
  const float sum = tau0 + tau1;
  const float equal = sum > 0.0f ? 1.0f - fabs(tau0 - tau1) / sum : 1.0f;
  const float same = equal * equal;
  const float way0 = tau0 / mix(at_border(y0), among_equals(y0), same);
  const float way1 = tau1 / mix(at_border(y1), among_equals(y1), same);
  return 1.0f / (3.0f * fmax(0.5f * (way0 + way1), layout->floor));
}

static float face_area(const DiffusionLayout* layout, int axis)
{
  return layout->spacing[(axis + 1) % 3] * layout->spacing[(axis + 2) % 3];
}
static float volume_of(const DiffusionLayout* layout)
{
  return layout->spacing[0] * layout->spacing[1] * layout->spacing[2];
}

// Twice the optical length from the voxel's middle to a face of the box, shorter where the voxel absorbs (numerics.md,
// Eq. (58)).
static float way_to_boundary(const DiffusionLayout* layout, float tau, float sigma_t, float sigma_a)
{
  return layout->linear ? tau / at_border(half_diffusion_length(tau, sigma_t, sigma_a)) : tau;
}
static float pass_boundary(const DiffusionLayout* layout, float way)
{
  const float x = 3.0f * layout->halfRange * way;
  return 2.0f * layout->halfRange / (1.0f + (layout->linear ? x : x / (1.0f + x)));
}

static bool is_border(const DiffusionLayout* layout, const int* at, int d)
{
  const int axis = d / 2;
  return !layout->periodic[axis] && at[axis] == (d & 1 ? layout->size[axis] - 1 : 0);
}

// Power through a face of the box that gives back a part of what leaves, out less in (numerics.md, Eqs. (76b), (76c)):
//   ofMedium times what it would be without light from outside, less ofLight times the light that comes in from there.
typedef struct
{
  float ofMedium, ofLight;
} face_factors;

static face_factors reflecting_face(const DiffusionLayout* layout, int d, float passes)
{
  const float albedo = layout->albedo[d], passes_in = passes / layout->halfRange;
  const float whole = 1.0f - albedo + albedo * passes_in;
  const face_factors factors = { (1.0f - albedo) / whole, passes_in / whole };
  return factors;
}
