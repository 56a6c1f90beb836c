// Light by cells of the box's faces, in a sweep: escaped power and incident light of each cell. The host defines
//   FACES  1 if either may be needed; FaceInfo selects which
//
// Sides 0 to 3 are the faces -u, +u, -v, +v. Cell i of a side is at row i or column i of the plane that is crossed.

#pragma once
#include "LightPropagation/Sweep/OnCpu/SweepLayout.cl"

#if FACES
#define FACE_CELL(state, side, i, c) \
  ((state)->faceFirst[side] + (i) * (state)->faces->along[side] + (c) * (state)->faces->stride)

// Selects the cells of plane `plane` of the grid.
static BY_ROW void go_to_faces(sweep_state* state, int plane)
{
  for (int side = 0; side < 4; ++side)
  {
    state->faceFirst[side] =
      state->faces->firstChannel + state->faces->first[side] + (ulong)plane * state->faces->plane[side];
  }
}

// Range of planes through whose cells a ray leaves. Rays nearly parallel to a face meet it only every few planes; if
// `spread`, a ray leaves through all cells between it and the next ray.
typedef struct
{
  float begin, end;
} face_planes;

// @param planes  number of planes from one ray to the next
static face_planes planes_of_ray(const sweep_state* state, float planes)
{
  const float middle = state->facePlane + 0.5f, reach = state->faces->spread ? 0.5f * planes : 0.5f;
  face_planes found = { middle - reach, middle + reach };
  if (!state->roundAxis)
  {
    found.begin = fmax(found.begin, 0.0f);
    found.end = fmin(found.end, (float)state->facePlanes);
  }
  return found;
}

// First cell of plane p of a side.
static __global exact* cells_of_plane(const sweep_state* state, int side, int p, int c)
{
  p = (p + state->facePlanes) % state->facePlanes; // wraps around a periodic axis
  const long planes = p - state->facePlane;
  return state->faceOut + FACE_CELL(state, side, 0, c) + planes * state->faces->plane[side];
}

// Part of a ray's power that leaves through plane p.
static float part_of_plane(face_planes of, int p)
{
  return (fmin(of.end, p + 1.0f) - fmax(of.begin, (float)p)) / (of.end - of.begin);
}

static BY_ROW void leave_through(const sweep_state* state, int side, int i, int c, face_planes of, float power)
{
  for (int p = (int)floor(of.begin); p < of.end; ++p)
  {
    cells_of_plane(state, side, p, c)[i * state->faces->along[side]] += part_of_plane(of, p) * power;
  }
}

// Counts the power of a row of rays that leaves through the cells of one side.
static BY_ROW void leave_all_through(
  const sweep_state* state, int side, int c, face_planes of, const __global float* rays, float part)
{
  const int along = state->faces->along[side];
  for (int p = (int)floor(of.begin); p < of.end; ++p)
  {
    __global exact* out = cells_of_plane(state, side, p, c);
    const float of_rays = part * part_of_plane(of, p);
    for (int x = 0; x < state->sizeU; ++x)
    {
      out[x * along] += of_rays * rays[x];
    }
  }
}

static float light_of_cell(const sweep_state* state, int side, int i, int c)
{
  return state->faceIn[FACE_CELL(state, side, i, c)];
}

// Mean incident radiance of cell i and, if it is on the face, cell i + move: half of the rays that move along u and v
// at once pass each.
static BY_ROW float light_of_cells(const sweep_state* state, int side, int i, int move, int c)
{
  const int size = side < 2 ? state->sizeV : state->sizeU;
  const float here = light_of_cell(state, side, i, c);
  const int beside = PERIODIC_V && side < 2 ? (i + move + size) % size : i + move;
  return move == 0 || beside < 0 || beside >= size ? here : 0.5f * (here + light_of_cell(state, side, beside, c));
}
#endif
