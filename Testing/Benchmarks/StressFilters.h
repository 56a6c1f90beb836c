#pragma once

#include "StressSolvers.h"

#include "../Filters/MediumScene.h"

#include "vtkLightRig.h"

/// What chains of filters that are put under stress have in common.
namespace bench
{
/// Keeps what a filter says.
class StressListener : public vtkCommand
{
public:
  static StressListener* New() { return new StressListener; }
  void Execute(vtkObject*, unsigned long event, void* text) override
  {
    (event == vtkCommand::ErrorEvent ? this->Outcome->errors : this->Outcome->warnings)
      .emplace_back(static_cast<const char*>(text));
  }
  void Hear(vtkAlgorithm* filter)
  {
    for (const unsigned long event : { vtkCommand::ErrorEvent, vtkCommand::WarningEvent })
    {
      filter->AddObserver(event, this);
      filter->GetExecutive()->AddObserver(event, this);
    }
  }
  StressOutcome* Outcome = nullptr;
};

void AddField(vtkImageData* image, const char* name, const std::vector<float>& values, int components);
vtkSmartPointer<vtkImageData> ImageOf(const StressScene& scene);
void SetRig(vtkLightRig* rig, const StressScene& scene);

std::vector<float> Floats(vtkDataSetAttributes* attributes, const char* name);
void ReadLight(vtkImageData* image, StressOutcome& outcome);
}
