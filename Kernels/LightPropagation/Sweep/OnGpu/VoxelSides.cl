// Rays that enter and leave through the sides of the box, stored for each voxel at its sides; for SweepOnGpu.cl. The
// host defines
//   SIDES  1: the box is a block of a larger domain; its axes are then open.
//         2: the box is the domain, with light given and counted by cells of its faces (LaneFaces.cl).
//         0 (default): none
//
// Layout: [plane, counted from where rays start][ray][channel][SIDE_FLOATS], see SweepSides.cl.

#pragma once
#ifndef SIDES
#define SIDES 0
#endif

#if SIDES
#define SIDE_FLOATS(state) ((state)->sizeU + (state)->sizeV + 1)
#define SIDES_ARGUMENTS , const __global float *sides_in, __global float *sides_out, int outer_sides
// Sides 0 to 3 are the faces -u, +u, -v, +v. True if light that crosses the side leaves the domain.
#define LEAVES_GRID(state, side) (((state)->outerSides >> (side)) & 1)
#else
#define SIDES_ARGUMENTS
#define LEAVES_GRID(state, side) true
#endif
