// Functions for the rays that enter and leave through the sides of the box. Sides 0 to 3 are the faces -u, +u, -v, +v.
// The host defines
//   SIDES  1: the box is a block of a larger domain: rays enter from its neighbours and leave to them. Requires that
//          PERIODIC, FACES and SweepInfo::border are 0
//   FACES  1: escaped power may be summed, and incident radiance given, per cell of the box's faces; FaceInfo tells
//          which
//
// Memory layout of the power of rays exchanged with neighbours: [plane][ray][SIDE_FLOATS]. The power of a ray is stored
// for the voxel from which it moves. First come the rays that cross the face normal to v, one per column, then the rays
// that cross the face normal to u, one per row, and last the ray that crosses both faces at once. Incoming rays move
// from voxels just outside the box, outgoing rays from its outermost columns and rows. Rays are in the order
// [bundle][member][channel].

#pragma once
#include "LightPropagation/Sweep/OnCpu/SweepLayout.cl"

#if SIDES
#define SIDE_FLOATS(state) ((state)->sizeU + (state)->sizeV + 1)
#define SIDE_OF_RAY(state, sides, bundle, ray) ((sides) + ((bundle)->border + (ray)) * SIDE_FLOATS(state))

// Fills the row state->outside with the power of the rays that enter through the face normal to v, in all directions of
// the bundle.
static BY_ROW void take_across_v(sweep_state* state, const __global BundleInfo* bundle, int rays)
{
  for (int ray = 0; ray < rays; ++ray)
  {
    const __global float* in = SIDE_OF_RAY(state, state->sidesIn, bundle, ray);
    __global float* row = state->outside + ray * ROW + PAD;
    for (int x = 0; x < state->sizeU; ++x)
    {
      row[x] = in[x];
    }
    row[-1] = in[state->sizeU + state->sizeV];
    row[state->sizeU] = in[state->sizeU + state->sizeV];
  }
}

// Fills the column beside row y with the power of the rays that enter this row through the face normal to u, for one
// direction (member) of a bundle. `du` is the move by which they enter.
static BY_ROW void take_across_u(
  sweep_state* state, const __global BundleInfo* bundle, int member, int y, int du, __global float* out)
{
  for (int ray = member * CHANNELS; ray < (member + 1) * CHANNELS; ++ray)
  {
    const __global float* in = SIDE_OF_RAY(state, state->sidesIn, bundle, ray);
    out[ray * ROW + PAD + (du > 0 ? -1 : state->sizeU)] = in[state->sizeU + y];
  }
}

// Writes to state->sidesOut, for the neighbouring blocks, the power of the rays that leave the box from row y in a move
// of (du, dv), for one direction (member) of a bundle.
static BY_ROW void give_sides(
  sweep_state* state, const __global BundleInfo* bundle, int member, const __global float* row, int y, int du, int dv)
{
  const bool across_v = (dv < 0 && y == 0) || (dv > 0 && y == state->sizeV - 1);
  for (int ray = member * CHANNELS; ray < (member + 1) * CHANNELS; ++ray)
  {
    __global float* side = SIDE_OF_RAY(state, state->sidesOut, bundle, ray);
    const __global float* rays = row + ray * ROW + PAD;
    for (int x = 0; across_v && x < state->sizeU; ++x)
    {
      side[x] = rays[x];
    }
    if (du != 0)
    {
      side[state->sizeU + y] = rays[du > 0 ? state->sizeU - 1 : 0];
    }
  }
}

// Whether light that crosses side `side` of the box leaves the domain.
#define LEAVES_GRID(state, side) (((state)->outerSides >> (side)) & 1)
#else
#define LEAVES_GRID(state, side) true
#endif

// Index of cell i of a side among the cells of the box's faces, for the plane that is crossed. Cell i is in row i of
// the plane (sides normal to u) or in column i (sides normal to v).
#if FACES
#define FACE_CELL(state, side, i, c) \
  ((state)->faceFirst[side] + (i) * (state)->faces->along[side] + (c) * (state)->faces->stride)

// Sets faceFirst, the index of the first cell of each of the four sides, for plane `plane` of the grid.
static BY_ROW void go_to_faces(sweep_state* state, int plane)
{
  for (int side = 0; side < 4; ++side)
  {
    state->faceFirst[side] =
      state->faces->firstChannel + state->faces->first[side] + (ulong)plane * state->faces->plane[side];
  }
}

// Range of planes through whose cells a ray leaves. Rays nearly parallel to a face meet it only every few planes. If
// FaceInfo::spread, the power of a ray leaves through all cells between this ray and the next one.
typedef struct
{
  float begin, end;
} face_planes;

// Range of planes through whose cells a ray leaves. The ray moves sideways in the current plane.
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

// Pointer to the escaped power of the first cell of plane p on a side, W.
static __global exact* cells_of_plane(const sweep_state* state, int side, int p, int c)
{
  p = (p + state->facePlanes) % state->facePlanes; // wraps around a periodic axis
  const long planes = p - state->facePlane;
  return state->faceOut + FACE_CELL(state, side, 0, c) + planes * state->faces->plane[side];
}

// Fraction of a ray's power that leaves through the cells of plane p.
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

// Adds the power of a row of rays that leave through one side of the box to the escaped power per cell.
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

// Mean incident radiance of cells i and i + move, or of cell i alone if the other one is not on the face. Of the rays
// that move along u and v at once, half pass through each of the two cells.
static BY_ROW float light_of_cells(const sweep_state* state, int side, int i, int move, int c)
{
  const int size = side < 2 ? state->sizeV : state->sizeU;
  const float here = light_of_cell(state, side, i, c);
  const int beside = PERIODIC_V && side < 2 ? (i + move + size) % size : i + move;
  return move == 0 || beside < 0 || beside >= size ? here : 0.5f * (here + light_of_cell(state, side, beside, c));
}
#endif
