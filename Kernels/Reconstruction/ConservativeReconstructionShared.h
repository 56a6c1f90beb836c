// Shared by C++ and the kernels of the conservative estimator.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Fields of the gains, one cell for 2 x 2 x 2 cells of the finer level.
enum
{
  GainField = 0,    ///< fraction of the details that is kept
  RemovedField = 1, ///< squared details that are removed, minus their noise
  KeptField = 2,    ///< squared noise that is kept
  ErrorField = 3,   ///< squared error of the finer level's cells
  GainFields = 4
};

enum
{
  BesideResults = 2 ///< fields of a level of the result after the smoothed quantities: source level, squared error
};
SHARED_END
