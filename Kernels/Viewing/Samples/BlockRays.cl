// Clips rays to one block of a larger grid.
//
// A ray takes the same steps as through the whole grid; each step belongs to the block that contains its midpoint.
// Samples thus lie at the same places as in the whole grid, and every step is taken exactly once.

#pragma once
#include "Viewing/Samples/Sampling.cl"
#include "Viewing/Scene/ViewShared.h"

#define BEYOND 1e30f // longer than any ray

// Number of steps of a ray whose midpoints are closer than `distance` to its entry into the whole grid.
inline real steps_before(real distance, real step, real steps, real last_middle)
{
  const real nominal = ceil(distance / step - (real)0.5f);
  const real full = lesser(greater(nominal, (real)0.0f), greater(steps - (real)1.0f, (real)0.0f));
  const integer all = (steps > (real)0.0f) & (last_middle < distance);
  return full + (all ? (real)1.0f : (real)0.0f);
}

// Computes the section of each ray that belongs to the block, in the block's voxel coordinates.
//   from    start of the rays, voxels of the whole grid
//   stride  step, voxels
//   before  receives the length of the ray in front of the block
//   enters  whether the ray enters the whole grid in this block
//   leaves  whether it leaves the whole grid from this block, or misses the grid while this block shows the background
//           to such rays
inline rays clip_to_block(real3 from, real3 direction, real farthest, const BlockInfo* b, float stride, real* before,
  integer* enters, integer* leaves)
{
  const rays whole = clip_to_box(from, direction, farthest, b->whole, before);
  const real step = step_length(direction, stride);
  const real steps = ceil(whole.length / step);
  const real last_middle = (real)0.5f * (whole.length + (steps - (real)1.0f) * step);

  // Distances from the entry to the planes between blocks: bitwise the same in both adjacent blocks.
  real in = (real)-BEYOND, out = (real)BEYOND;
#define CLIP(c)                                                                                            \
  {                                                                                                        \
    const real inverse = (real)1.0f / at_least_tiny(direction.c);                                          \
    const real beyond = copysign((real)BEYOND, inverse);                                                   \
    const real lower = b->begin.c > 0 ? ((real)(float)b->begin.c - whole.entry.c) * inverse : -beyond;     \
    const real upper = b->end.c < b->whole.c ? ((real)(float)b->end.c - whole.entry.c) * inverse : beyond; \
    in = greater(in, lesser(lower, upper));                                                                \
    out = lesser(out, greater(lower, upper));                                                              \
  }
  CLIP(x)
  CLIP(y)
  CLIP(z)
#undef CLIP
  const real first = steps_before(in, step, steps, last_middle);
  const real last = steps_before(out, step, steps, last_middle);
  const integer crosses = last > first;
  *enters = crosses & (first == (real)0.0f);
  *leaves = (crosses & (last == steps)) | ((whole.length == (real)0.0f) & (integer)(b->first.w != 0 ? -1 : 0));

  rays part;
  const real skipped = first * step;
  part.direction = direction;
  part.length = crosses ? lesser(last * step, whole.length) - skipped : (real)0.0f;
  part.entry.x = crosses ? fma(skipped, direction.x, whole.entry.x) - (real)(float)b->first.x : (real)0.0f;
  part.entry.y = crosses ? fma(skipped, direction.y, whole.entry.y) - (real)(float)b->first.y : (real)0.0f;
  part.entry.z = crosses ? fma(skipped, direction.z, whole.entry.z) - (real)(float)b->first.z : (real)0.0f;
  *before = crosses ? *before + skipped : (real)0.0f;
  return part;
}
