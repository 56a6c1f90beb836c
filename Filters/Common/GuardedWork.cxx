#include "Common/GuardedWork.h"

// How filters do their work, report and fail: see LightTransportData.h.
#include "Common/GhostFlags.h"
#include "Common/ImageInput.h"
#include "Common/LastFailure.h"
#include "Common/LightTransportWriting.h"
#include "Device/CompilationListener.h"
#include "Device/Device.h"
#include "Device/OpenCL.h"
#include "PropertyRange.h"

#include "vtkAlgorithm.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkVersionMacros.h"

#include <new>
#include <stdexcept>

namespace tyndall
{
Monitor MonitorOf(vtkAlgorithm* filter)
{
  return [filter](double fractionDone) {
    filter->SetProgressText(nullptr);
    filter->UpdateProgress(fractionDone);
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
    return !filter->CheckAbort();
#else
    return filter->GetAbortExecute() == 0;
#endif
  };
}

namespace
{
const char* const Compiling = "compiling kernels (once)";

const char* const NoMemory =
  "The machine's memory does not suffice. Ask for less: fewer photons, a smaller grid, or fewer outputs.";

void EmptyOutputs(vtkInformationVector* outputs, const char* why)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* output = vtkDataObject::GetData(outputs, port))
    {
      output->Initialize();
      AddFact(output, why, std::vector<double>{ 1.0 });
    }
  }
}

/// Newer VTK leaves both set, and would run the filter again with every update until they are reset.
void ForgetAbort(vtkAlgorithm* filter)
{
  filter->AbortExecute = 0;
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
  filter->SetAbortOutput(false);
#endif
}
}

namespace
{
/// By whichever filter opened the device, once in a process.
void WarnOfDevices(vtkAlgorithm* filter)
{
  for (const std::string& warning : Device::TakeWarnings())
  {
    vtkWarningWithObjectMacro(filter, << warning);
  }
}
}

int Guarded(vtkAlgorithm* filter, vtkInformationVector* outputs, const std::function<void()>& work)
{
  LastFailure last(filter);
  if (last.StillHolds())
  {
    EmptyOutputs(outputs, last.Was(LastFailure::Abort) ? AbortedFact : FailedFact);
    return 1;
  }
  last.Forget();
  const auto fail = [&](const std::string& why) {
    EmptyOutputs(outputs, FailedFact);
    vtkErrorWithObjectMacro(filter, << why);
    last.Note(LastFailure::Error);
  };
  const CompilationListener listener([filter] {
    if (filter->GetAbortExecute() == 0) // the compiler cannot be stopped; the filter stops when it is done
    {
      filter->SetProgressText(Compiling);
      filter->UpdateProgress(filter->GetProgress());
    }
  });
  try
  {
    RequireImages(filter);
    CheckProperties(filter);
    CheckDuplicates(filter, outputs);
    work();
  }
  catch (const Aborted&)
  {
    EmptyOutputs(outputs, AbortedFact);
    ForgetAbort(filter);
    last.Note(LastFailure::Abort);
  }
  catch (const InputFailed&)
  {
    EmptyOutputs(outputs, FailedFact);
    last.Note(LastFailure::Error);
  }
  catch (const cl::Error& error)
  {
    fail(std::string("The OpenCL device failed in ") + error.what() + " (OpenCL error " + std::to_string(error.err()) +
      "). Try another device (property Device or variable TYNDALL_DEVICE).");
  }
  catch (const std::bad_alloc&)
  {
    fail(NoMemory);
  }
  catch (const std::length_error&) // more than any memory has
  {
    fail(NoMemory);
  }
  catch (const std::exception& error)
  {
    fail(error.what());
  }
  filter->SetProgressText(nullptr);
  WarnOfDevices(filter);
  return 1;
}

bool GuardedInformation(vtkAlgorithm* filter, const std::function<void()>& work)
{
  LastFailure last(filter);
  try
  {
    if (filter->GetNumberOfInputPorts() == 0) // others are told by Guarded: what they read may be newer than this
    {
      CheckProperties(filter);
    }
    work();
  }
  catch (const std::exception& error)
  {
    if (!last.Was(LastFailure::Information) || !last.StillHolds())
    {
      vtkErrorWithObjectMacro(filter, << error.what());
    }
    last.Note(LastFailure::Information);
    return false;
  }
  if (last.Was(LastFailure::Information))
  {
    last.Forget();
  }
  return true;
}
}
