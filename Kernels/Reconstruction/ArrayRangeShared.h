// Shared by C++ and the kernel of ArrayRange.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  RunStep = 48,       ///< values of a run that are looked at together: a run has a multiple of them
  RangeSumUnit = 8192 ///< of sums, so that these do not overflow where values do not
};

/// What a run of values holds.
typedef struct
{
  int unfit;      ///< 1: one of them is not a number, or outside of what was asked for
  float largest;  ///< magnitude
  float total[3]; ///< of each component, in RangeSumUnit; of one component all is in the first
} RunRange;
SHARED_END
