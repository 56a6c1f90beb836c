#include "Propagation/LastOutputs.h"

#include "Common/ContentKey.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleKey.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationIntegerVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <utility>

namespace tyndall
{
namespace
{
/// The time is that of the input that was asked for, not of when the same was made.
void CopyButTime(vtkDataObject* from, vtkDataObject* to)
{
  vtkInformation* const facts = to->GetInformation();
  const bool hasTime = facts->Has(vtkDataObject::DATA_TIME_STEP()) != 0;
  const double time = hasTime ? facts->Get(vtkDataObject::DATA_TIME_STEP()) : 0.0;
  to->ShallowCopy(from);
  if (hasTime)
  {
    facts->Set(vtkDataObject::DATA_TIME_STEP(), time);
  }
  else
  {
    facts->Remove(vtkDataObject::DATA_TIME_STEP());
  }
}

/// Which part of the output is asked for.
void AddRequest(std::vector<std::uint64_t>& key, vtkInformation* output)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  for (vtkInformationIntegerKey* piece :
    { Pipeline::UPDATE_PIECE_NUMBER(), Pipeline::UPDATE_NUMBER_OF_PIECES(), Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS() })
  {
    key.push_back(static_cast<std::uint64_t>(output->Get(piece)));
  }
  const int* const extent = output->Get(Pipeline::UPDATE_EXTENT());
  key.insert(key.end(), extent, extent + (extent ? output->Length(Pipeline::UPDATE_EXTENT()) : 0));
}
}

LastOutputs::Key LastOutputs::KeyOf(vtkAlgorithm* filter, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  Key key = { filter->GetMTime() };
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      key.push_back(ContentKey(vtkDataObject::GetData(inputs[port], i)));
    }
  }
  AddRequest(key, outputs->GetInformationObject(0));
  return key;
}

bool LastOutputs::GiveBack(vtkAlgorithm* filter, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  Key key = KeyOf(filter, inputs, outputs);
  if (key != this->MadeOf || this->Outputs.empty())
  {
    this->MadeOf = std::move(key);
    this->Outputs.clear();
    return false;
  }
  for (std::size_t port = 0; port < this->Outputs.size(); ++port)
  {
    CopyButTime(this->Outputs[port], vtkDataObject::GetData(outputs, static_cast<int>(port)));
  }
  return true;
}

void LastOutputs::Keep(vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* const made = vtkDataObject::GetData(outputs, port);
    const auto kept = vtkSmartPointer<vtkDataObject>::Take(made->NewInstance());
    kept->ShallowCopy(made);
    this->Outputs.push_back(kept);
  }
}
}
