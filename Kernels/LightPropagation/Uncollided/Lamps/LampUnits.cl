// The sums of a lamp's beams in fixed point.

#pragma once

// Factor of a path in a voxel in fixed point (numerics.md, Eq. (35)): light goes little path through what is thick.
static float units_of(float sigma, float diagonal)
{
  return fmax(sigma * diagonal, 1.0f);
}

#define FIRST_OF_FLUX (1 + 3 * MOMENTS) // of the sums
