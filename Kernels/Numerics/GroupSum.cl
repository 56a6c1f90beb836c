// Sums over work-groups. The host gives
//   GROUP  work-items of a group, a power of 2; 1: a work-item is one, as kernels are organised for a CPU

#pragma once

// Writes the sum of what the work-items of a group have to `place`. At the end of a kernel's outermost scope, to which
// all of them come.
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

// Where the values of a chunk are added up by one group, side by side: the first vector of this work-item, and from
// one to its next.
#define FIRST_IN_CHUNK(width) (get_local_id(0) * (GROUP == 1 ? 0 : (width)))
#define STEP_IN_CHUNK(width) (GROUP * (width))
