// The cells of the box's faces, in a sweep: what leaves through each, and what comes in through each. The host gives
//   FACE_OUT  1 where the power that leaves through each cell is wanted
//   FACE_IN   1 where light comes in by cells, besides that which is the same for a whole face
//
// Side 0 to 3 is the face -u, +u, -v, +v; cell i of a side is row i or column i of the plane that is crossed.

#pragma once
#include "LightPropagation/Sweep/SweepLayout.cl"

#if FACE_OUT || FACE_IN
#define FACE_CELL(state, side, i, c) \
  ((state)->faceFirst[side] + (i) * (state)->faces->along[side] + (c) * (state)->faces->stride)

// To the cells of plane `plane` of the grid.
static void go_to_faces(sweep_state* state, int plane)
{
  for (int side = 0; side < 4; ++side)
  {
    state->faceFirst[side] =
      state->faces->firstChannel + state->faces->first[side] + (ulong)plane * state->faces->plane[side];
  }
}
#endif

#if FACE_OUT
static void leave_through(const sweep_state* state, int side, int i, int c, float power)
{
  state->faceOut[FACE_CELL(state, side, i, c)] += power;
}

// A row of rays, through the cells of one side.
static void leave_all_through(const sweep_state* state, int side, int c, const __global float* rays, float part)
{
  __global float* out = state->faceOut + FACE_CELL(state, side, 0, c);
  const int along = state->faces->along[side];
  for (int x = 0; x < state->sizeU; ++x)
  {
    out[x * along] += part * rays[x];
  }
}
#endif

#if FACE_IN
static float light_of_cell(const sweep_state* state, int side, int i, int c)
{
  return state->faceIn[FACE_CELL(state, side, i, c)];
}

// In the mean over cell i and the one at i + move, where it is on the face: of rays that move both ways at once half
// pass either.
static float light_of_cells(const sweep_state* state, int side, int i, int move, int c)
{
  const int size = side < 2 ? state->sizeV : state->sizeU;
  const float here = light_of_cell(state, side, i, c);
#if PERIODIC_V
  const int beside = side < 2 ? (i + move + size) % size : i + move;
#else
  const int beside = i + move;
#endif
  return move == 0 || beside < 0 || beside >= size ? here : 0.5f * (here + light_of_cell(state, side, beside, c));
}
#endif
