// Voxels one by one at the box's faces, in the diffusion system.

#pragma once
#include "LightPropagation/Diffusion/Conductance.cl"
#include "LightPropagation/Diffusion/DiffusionLayout.cl"

static bool is_border(const DiffusionLayout* layout, const int* at, int d)
{
  const int axis = d / 2;
  return !layout->periodic[axis] && at[axis] == (d & 1 ? layout->size[axis] - 1 : 0);
}

// Power through a face of the box that gives back a part, out less in (numerics.md, Eqs. (76b), (76c)):
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
