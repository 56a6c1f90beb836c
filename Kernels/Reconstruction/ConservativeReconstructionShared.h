// Shared by C++ and the kernels of the conservative estimator.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Fields of the gains, a cell for 2 x 2 x 2 of the finer level.
enum
{
  GainField = 0,    ///< part of the details that is kept
  RemovedField = 1, ///< squared details that are taken off and are more than noise
  KeptField = 2,    ///< squared noise that is kept
  ErrorField = 3,   ///< squared error of these cells
  GainFields = 4
};

enum
{
  BesideResults = 2 ///< fields of a level of the result after what is smoothed: level it is from, squared error
};
SHARED_END
