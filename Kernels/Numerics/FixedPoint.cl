// Sums in 64-bit fixed point, which do not depend on the order of their terms (numerics.md, Eq. (35)). The host
// defines
//   ATOMICS  1: several work-items may add to one sum at once; 0: only one at a time does (the device has no 64-bit
//            atomics, or needs none)

#pragma once

#if ATOMICS
#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable
#endif

static void add_units(__global long* sum, long units)
{
#if ATOMICS
  atom_add(sum, units);
#else
  *sum += units;
#endif
}
