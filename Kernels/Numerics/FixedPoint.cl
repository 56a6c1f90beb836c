// Sums in 64-bit fixed point, which do not depend on the order of their terms (numerics.md, Eq. (35)). The host defines
//   ATOMICS  1: several work-items may add to a sum at the same time; 0: only one work-item adds to a sum, which
//            needs no 64-bit atomics

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
