// Sums over the work-items of a work-group. The host defines
//   GROUP  work-items per group, a power of 2; 1: each work-item sums alone, as on a CPU

#pragma once

// Writes the sum of `value` over a group's work-items to `place`. Must be the last statement of a kernel's outermost
// scope, and be reached by all work-items.
#if GROUP == 1
#define PUT_SUM_OF_GROUP(type, value, place) place = value;
#else
#define PUT_SUM_OF_GROUP(type, value, place)                                          \
  __local type value##_of_items[GROUP];                                               \
  value##_of_items[get_local_id(0)] = value;                                          \
  for (int width = GROUP / 2; width > 0; width /= 2)                                  \
  {                                                                                   \
    barrier(CLK_LOCAL_MEM_FENCE);                                                     \
    if (get_local_id(0) < width)                                                      \
    {                                                                                 \
      value##_of_items[get_local_id(0)] += value##_of_items[get_local_id(0) + width]; \
    }                                                                                 \
  }                                                                                   \
  if (get_local_id(0) == 0)                                                           \
  {                                                                                   \
    place = value##_of_items[0];                                                      \
  }
#endif

// Access to values in chunks, each summed by one work-group. A work-item reads vectors of `width` values:
// FIRST_IN_CHUNK is the index of its first vector in the chunk, STEP_IN_CHUNK the stride to its next one. Adjacent
// work-items read adjacent vectors.
#define FIRST_IN_CHUNK(width) (get_local_id(0) * (GROUP == 1 ? 0 : (width)))
#define STEP_IN_CHUNK(width) (GROUP * (width))
