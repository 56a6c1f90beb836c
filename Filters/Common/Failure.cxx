#include "Common/Failure.h"

#include "Common/LightTransportData.h"
#include "Device/Errors.h"
#include "Device/OpenCL.h"

#include <new>
#include <stdexcept>

namespace tyndall
{
namespace
{
const char* const NoMemory =
  "The machine's memory does not suffice. Ask for less: fewer photons, a smaller grid, or fewer outputs.";
}

Ending EndingOf(const std::function<void()>& work)
{
  try
  {
    work();
  }
  catch (const Aborted&)
  {
    return { Ending::Aborted, "" };
  }
  catch (const InputFailed&)
  {
    return { Ending::InputFailed, "" };
  }
  catch (const InputIsEmpty&)
  {
    return { Ending::Empty, "" };
  }
  catch (const cl::Error& error)
  {
    const bool ofMemory = error.err() == CL_MEM_OBJECT_ALLOCATION_FAILURE || error.err() == CL_OUT_OF_HOST_MEMORY;
    return { Ending::Failed,
      std::string("The OpenCL device failed in ") + error.what() + " (OpenCL error " + std::to_string(error.err()) +
        "). " + (ofMemory ? NoMemory : "Try another device (property Device or variable TYNDALL_DEVICE).") };
  }
  catch (const std::bad_alloc&)
  {
    return { Ending::Failed, NoMemory };
  }
  catch (const std::length_error&) // thrown by a container whose requested size exceeds any memory
  {
    return { Ending::Failed, NoMemory };
  }
  catch (const std::exception& error)
  {
    return { Ending::Failed, error.what() };
  }
  return {};
}

void Throw(const Ending& ending)
{
  switch (ending.kind)
  {
    case Ending::Done: return;
    case Ending::Aborted: throw Aborted();
    case Ending::InputFailed: throw InputFailed();
    case Ending::Empty: throw InputIsEmpty();
    case Ending::Failed: throw InvalidInput(ending.why);
  }
}

void StopIfUpstreamFailed(vtkDataObject* input)
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
