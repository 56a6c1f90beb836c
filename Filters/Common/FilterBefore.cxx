#include "Common/FilterBefore.h"

#include "Common/Failure.h"
#include "Common/LightTransportData.h"

namespace tyndall
{
void StopWithFilterBefore(vtkDataObject* input)
{
  if (ReadFact(input, AbortedFact, 0.0) > 0.0)
  {
    throw Aborted();
  }
  if (ReadFact(input, FailedFact, 0.0) > 0.0)
  {
    throw InputFailed();
  }
  if (ReadFact(input, EmptyFact, 0.0) > 0.0)
  {
    throw InputIsEmpty();
  }
}
}
