#include "ExtentAfterUpdate.h"

#include "vtkAlgorithm.h"
#include "vtkAlgorithmOutput.h"
#include "vtkCallbackCommand.h"
#include "vtkClientServerInterpreter.h"
#include "vtkClientServerInterpreterInitializer.h"
#include "vtkCommand.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerVectorKey.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkSISourceProxy.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>

namespace
{
using Pipeline = vtkStreamingDemandDrivenPipeline;

/// Copies the whole extent and the update extent from the input of a post filter (vtkPVPostFilter, which ParaView
/// appends to each output) to its output. VTK crops the data to the update extent (EXACT_EXTENT, which representations
/// request).
void PassExtentOn(vtkObject* caller, unsigned long, void*, void*)
{
  auto* const filter = vtkAlgorithm::SafeDownCast(caller);
  vtkInformation* const input = filter->GetExecutive()->GetInputInformation(0, 0);
  vtkInformation* const output = filter->GetOutputInformation(0);
  const int* const whole = input ? input->Get(Pipeline::WHOLE_EXTENT()) : nullptr;
  const int* const before = output->Get(Pipeline::WHOLE_EXTENT());
  if (whole && before && !std::equal(whole, whole + 6, before))
  {
    output->CopyEntry(input, Pipeline::WHOLE_EXTENT());
    output->CopyEntry(input, Pipeline::UPDATE_EXTENT());
  }
}
}

class vtkSIExtentAfterUpdateProxy : public vtkSISourceProxy
{
public:
  static vtkSIExtentAfterUpdateProxy* New();
  vtkTypeMacro(vtkSIExtentAfterUpdateProxy, vtkSISourceProxy);

  /// Output port of the post filter, which ParaView appends to each output. The superclass creates the post filter in
  /// the first call; this method then starts to observe it.
  vtkAlgorithmOutput* GetOutputPort(int port) override
  {
    vtkAlgorithmOutput* const output = this->Superclass::GetOutputPort(port);
    vtkAlgorithm* const filter = output ? output->GetProducer() : nullptr;
    if (filter && filter != this->GetVTKObject() && !filter->HasObserver(vtkCommand::EndEvent, this->Passing))
    {
      filter->AddObserver(vtkCommand::EndEvent, this->Passing);
    }
    return output;
  }

protected:
  vtkSIExtentAfterUpdateProxy() { this->Passing->SetCallback(&PassExtentOn); }

private:
  vtkNew<vtkCallbackCommand> Passing;
};

vtkStandardNewMacro(vtkSIExtentAfterUpdateProxy);

namespace
{
/// Registers vtkSIExtentAfterUpdateProxy with a client-server interpreter, with the commands of its superclass, which
/// the interpreter looks up by class name.
void Teach(vtkClientServerInterpreter* interpreter)
{
  const char* const name = "vtkSIExtentAfterUpdateProxy";
  interpreter->AddNewInstanceFunction(name, [](void*) -> vtkObjectBase* { return vtkSIExtentAfterUpdateProxy::New(); });
  interpreter->AddCommandFunction(name,
    [](vtkClientServerInterpreter* own, vtkObjectBase* proxy, const char* method, const vtkClientServerStream& message,
      vtkClientServerStream& result,
      void*) { return own->CallCommandFunction("vtkSISourceProxy", proxy, method, message, result); });
}
}

/// Registers the class with the client-server interpreters of all sessions: each session has its own.
void TeachExtentAfterUpdate()
{
  vtkClientServerInterpreterInitializer::GetInitializer()->RegisterCallback(&Teach);
}
