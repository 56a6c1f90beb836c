#include "Propagation/LastOutputs.h"

#include "Common/Failure.h"
#include "Common/InputsKey.h"
#include "Common/LightTransportWriting.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleKey.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <cstring>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
/// Copies a data object except its time step: `to` keeps the time step of the current request.
void CopyButTime(vtkDataObject* from, vtkDataObject* to)
{
  vtkInformation* const facts = to->GetInformation();
  const bool hasTime = facts->Has(vtkDataObject::DATA_TIME_STEP()) != 0;
  const double time = hasTime ? facts->Get(vtkDataObject::DATA_TIME_STEP()) : 0.0;
  PassOn(from, to);
  if (hasTime)
  {
    facts->Set(vtkDataObject::DATA_TIME_STEP(), time);
  }
  else
  {
    facts->Remove(vtkDataObject::DATA_TIME_STEP());
  }
}
}

LastOutputs::Key LastOutputs::KeyOf(
  vtkMTimeType settings, const OwnAxes& axes, vtkInformationVector** inputs, int ports)
{
  Key key = { settings };
  for (const double word : axes.Words())
  {
    key.emplace_back();
    std::memcpy(&key.back(), &word, sizeof(word));
  }
  for (int port = 0; port < ports; ++port)
  {
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      key.push_back(ContentKey(vtkDataObject::GetData(inputs[port], i)));
    }
  }
  return key;
}

bool LastOutputs::GiveBack(const Key& key, vtkInformationVector* outputs)
{
  if (key != this->MadeOf || this->Outputs.empty())
  {
    this->LetGo();
    return false;
  }
  for (std::size_t port = 0; port < this->Outputs.size(); ++port)
  {
    CopyButTime(this->Outputs[port], vtkDataObject::GetData(outputs, static_cast<int>(port)));
  }
  return true;
}

namespace
{
std::array<int, 6> ExtentTold(vtkInformationVector* outputs)
{
  std::array<int, 6> told = { 0, -1, 0, -1, 0, -1 };
  outputs->GetInformationObject(0)->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), told.data());
  return told;
}
}

bool LastOutputs::GiveBefore(vtkInformationVector* outputs, OwnAxes& axes) const
{
  if (this->Before.empty() || ExtentTold(outputs) != this->Told)
  {
    return false;
  }
  for (std::size_t port = 0; port < this->Before.size(); ++port)
  {
    vtkDataObject* const output = vtkDataObject::GetData(outputs, static_cast<int>(port));
    CopyButTime(this->Before[port], output);
    AddFact(output, AbortedFact, std::vector<double>{ 1.0 });
  }
  axes = this->AxesBefore;
  AddFact(vtkDataObject::GetData(outputs, 0), "left_out", std::vector<std::string>{ LightOfBefore });
  return true;
}

void LastOutputs::LetGo()
{
  if (!this->Outputs.empty())
  {
    this->Before = std::move(this->Outputs);
    this->AxesBefore = this->Axes;
  }
  this->Outputs.clear();
}

void LastOutputs::Forget()
{
  this->Outputs.clear();
  this->Before.clear();
}

void LastOutputs::Keep(Key key, const OwnAxes& axes, vtkInformationVector* outputs)
{
  this->Forget();
  this->MadeOf = std::move(key);
  this->Axes = axes;
  this->Told = ExtentTold(outputs);
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* const made = vtkDataObject::GetData(outputs, port);
    const auto kept = vtkSmartPointer<vtkDataObject>::Take(made->NewInstance());
    PassOn(made, kept);
    this->Outputs.push_back(kept);
  }
}
}
