// Rays that enter through the sides of a block from its neighbours, and leave to them, if the box is a block of a
// larger domain. The host defines
//   SIDES  1: the box is such a block; default 0. Requires that PERIODIC, FACES and
//          SweepInfo's border are 0
//
// Layout: [plane][ray][SIDE_FLOATS], with rays by the voxel they come from, or are in, before they move. First the rays
// that move across v, one for each column; then those that move across u, one for each row; then the one that moves
// across both at once. Incoming rays come from beyond the box, outgoing ones from its last columns and rows. Rays are
// numbered as the bundles' radiances are, [bundle][member][channel].

#pragma once
#include "LightPropagation/Sweep/OnCpu/SweepLayout.cl"

#if SIDES
#define SIDE_FLOATS(state) ((state)->sizeU + (state)->sizeV + 1)
#define SIDE_OF_RAY(state, sides, bundle, ray) ((sides) + ((bundle)->border + (ray)) * SIDE_FLOATS(state))

// Reads the row of rays of all members that enter across v, into `outside`.
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

// Writes a member's rays that enter across u in a move of `du` to the column beside row y.
static BY_ROW void take_across_u(
  sweep_state* state, const __global BundleInfo* bundle, int member, int y, int du, __global float* out)
{
  for (int ray = member * CHANNELS; ray < (member + 1) * CHANNELS; ++ray)
  {
    const __global float* in = SIDE_OF_RAY(state, state->sidesIn, bundle, ray);
    out[ray * ROW + PAD + (du > 0 ? -1 : state->sizeU)] = in[state->sizeU + y];
  }
}

// Writes the rays of a member's row y that leave in a move of (du, dv).
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

#define SIDES_ARGUMENTS , const __global float *sides_in, __global float *sides_out, int outer_sides
// Sides 0 to 3 are the faces -u, +u, -v, +v. True if light that crosses the side leaves the domain.
#define LEAVES_GRID(state, side) (((state)->outerSides >> (side)) & 1)
#else
#define SIDES_ARGUMENTS
#define LEAVES_GRID(state, side) true
#endif
