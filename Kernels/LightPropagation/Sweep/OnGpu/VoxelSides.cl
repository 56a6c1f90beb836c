// A box with light of its own for each voxel at its sides, for SweepOnGpu.cl: what rays bring in there, and take out.
// The host gives
//   SIDES  1: the box is a block of a larger one, whose axes are open then. 2: it is the whole, whose light comes and
//          goes by cells of its faces (LaneFaces.cl). May be left out: 0
//
// Of each plane, counted from where rays start, [ray][channel][SIDE_FLOATS]: as SweepSides.cl has it.

#pragma once
#ifndef SIDES
#define SIDES 0
#endif

#if SIDES
#define SIDE_FLOATS(state) ((state)->sizeU + (state)->sizeV + 1)
#define SIDES_ARGUMENTS , const __global float *sides_in, __global float *sides_out, int outer_sides
// Side 0 to 3 is the face -u, +u, -v, +v: light that goes through leaves the whole grid.
#define LEAVES_GRID(state, side) (((state)->outerSides >> (side)) & 1)
#else
#define SIDES_ARGUMENTS
#define LEAVES_GRID(state, side) true
#endif
