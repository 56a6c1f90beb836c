// Voxel indices for kernels of the diffusion system: voxels of the grid, their neighbours, and voxels at the box's
// faces.

#pragma once
#include "LightPropagation/Diffusion/Conductance.cl"
#include "Numerics/Exact.cl"

// Defines the indices x, y, z of the work-item's voxel, and its index i in arrays.
#define VOXEL(count)                                                          \
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2); \
  if (x >= (count)[0] || y >= (count)[1] || z >= (count)[2])                  \
  {                                                                           \
    return;                                                                   \
  }                                                                           \
  const int i = (z * (count)[1] + y) * (count)[0] + x;

#define IS_OUTERMOST(layout, at)                                                    \
  ((!(layout).periodic[0] && ((at)[0] == 0 || (at)[0] == (layout).size[0] - 1)) ||  \
    (!(layout).periodic[1] && ((at)[1] == 0 || (at)[1] == (layout).size[1] - 1)) || \
    (!(layout).periodic[2] && ((at)[2] == 0 || (at)[2] == (layout).size[2] - 1)))

// Indices of the six neighbours of a voxel, wrapped around every axis. A neighbour across the box's boundary has no
// effect, because the conductance there is 0, unless the axis is periodic.
static void find_neighbours(const int* size, int x, int y, int z, int i, int* next)
{
  const int row = size[0];
  const int plane = size[0] * size[1];
  next[0] = i + (x > 0 ? -1 : size[0] - 1);
  next[1] = i + (x < size[0] - 1 ? 1 : 1 - size[0]);
  next[2] = i + (y > 0 ? -row : (size[1] - 1) * row);
  next[3] = i + (y < size[1] - 1 ? row : (1 - size[1]) * row);
  next[4] = i + (z > 0 ? -plane : (size[2] - 1) * plane);
  next[5] = i + (z < size[2] - 1 ? plane : (1 - size[2]) * plane);
}

static bool is_border(const DiffusionLayout* layout, const int* at, int d)
{
  const int axis = d / 2;
  return !layout->periodic[axis] && at[axis] == (d & 1 ? layout->size[axis] - 1 : 0);
}

// Finds the voxel of a cell of the box's faces (numbered as in Medium/BoxFaces.h). Voxels at edges and corners of the
// box have several cells. @return whether the cell is the first one of its voxel and lies on a face that is not
// periodic
static bool find_border_voxel(const DiffusionLayout* layout, int cell, int* at)
{
  const int* n = layout->size;
  for (int d = 0; d < 6; ++d)
  {
    const int axis = d / 2, u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const int cells = n[u] * n[v];
    if (cell < cells)
    {
      at[axis] = d & 1 ? n[axis] - 1 : 0;
      at[u] = cell % n[u];
      at[v] = cell / n[u];
      bool first = !layout->periodic[axis];
      for (int before = 0; before < d; ++before)
      {
        first = first && !is_border(layout, at, before);
      }
      return first;
    }
    cell -= cells;
  }
  return false;
}

// Defines the indices x, y, z and the array index i of the work-item's voxel, a voxel at the box's faces. Work-items
// are numbered by cells of the faces.
#define BORDER_VOXEL(layout)                                        \
  int border[3];                                                    \
  if (!find_border_voxel(&(layout), (int)get_global_id(0), border)) \
  {                                                                 \
    return;                                                         \
  }                                                                 \
  const int x = border[0], y = border[1], z = border[2];            \
  const int i = (z * (layout).size[1] + y) * (layout).size[0] + x;

// Factors in the net outgoing power through a reflecting face of the box (numerics.md, Eqs. (76b), (76c)). The net
// power is ofMedium times the power that the medium sends through the face when no light is incident, minus ofLight
// times the incident power.
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
