// A box that is a block of a larger one: what rays bring in through its sides from the blocks beside it, and what they
// take out to those. The host gives
//   SIDES  1 where the box is such a block; not set: 0. PERIODIC and FACES are 0 then, as is
//          SweepInfo's border
//
// Of each ray of a bundle and each plane, [plane][ray][SIDE_FLOATS]: rays by where they come from, or are, before they
// move; across v one for each column, then across u one for each row, then the one across both, of moves both ways at
// once. They are taken in from beyond the box, and given out from its last columns and rows. Rays are counted as
// bundles' radiances are, [bundle][member][channel].

#pragma once
#include "LightPropagation/Sweep/OnCpu/SweepLayout.cl"

#if SIDES
#define SIDE_FLOATS(state) ((state)->sizeU + (state)->sizeV + 1)
#define SIDE_OF_RAY(state, sides, bundle, ray) ((sides) + ((bundle)->border + (ray)) * SIDE_FLOATS(state))

// The row of rays that come in across v, of all members, as `outside` is laid out.
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

// A member's rays that come in across u at a move of `du`, into the column beside row y.
static BY_ROW void take_across_u(
  sweep_state* state, const __global BundleInfo* bundle, int member, int y, int du, __global float* out)
{
  for (int ray = member * CHANNELS; ray < (member + 1) * CHANNELS; ++ray)
  {
    const __global float* in = SIDE_OF_RAY(state, state->sidesIn, bundle, ray);
    out[ray * ROW + PAD + (du > 0 ? -1 : state->sizeU)] = in[state->sizeU + y];
  }
}

// What a member's row y holds of rays that go out at a move of (du, dv).
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
// Side 0 to 3 is the face -u, +u, -v, +v: light that goes through leaves the whole grid.
#define LEAVES_GRID(state, side) (((state)->outerSides >> (side)) & 1)
#else
#define SIDES_ARGUMENTS
#define LEAVES_GRID(state, side) true
#endif
