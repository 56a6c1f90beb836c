#include "vtkPhotonImportance.h"

#include "Common/DeviceBudget.h"
#include "Common/LightTransportData.h"
#include "Photons/ImportanceData.h"
#include "Photons/PhotonData.h"
#include "Photons/RefractiveInput.h"
#include "Ranks/WholeImage.h"
#include "Work/GuardedWork.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace
{
tyndall::ImportanceSettings SettingsOf(vtkPhotonImportance* filter)
{
  tyndall::ImportanceSettings settings;
  settings.pilotCount = static_cast<std::size_t>(std::max(filter->GetPilotCount(), 0));
  std::copy_n(filter->GetPilotDimensions(), 3, settings.cells.begin());
  settings.seed = static_cast<std::uint64_t>(filter->GetSeed());
  settings.automatic = filter->GetThresholds() == vtkPhotonImportance::AUTOMATIC;
  settings.gradientThreshold = filter->GetGradientThreshold();
  settings.luminanceThreshold = filter->GetLuminanceThreshold();
  settings.background = filter->GetBackground();
  return settings;
}

void SetGrid(vtkInformation* information, const tyndall::Grid& grid)
{
  const int extent[6] = { 0, grid.size[0], 0, grid.size[1], 0, grid.size[2] };
  information->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  information->Set(vtkDataObject::ORIGIN(), grid.origin.data(), 3);
  information->Set(vtkDataObject::SPACING(), grid.spacing.data(), 3);
}

/// The map as far as it is known before there are lights: of one.
tyndall::Grid MapGrid(int pilotCount)
{
  const int edge = static_cast<int>(std::sqrt(std::max(pilotCount, 1)));
  tyndall::Grid grid;
  grid.size = { edge, edge, 1 };
  grid.spacing = { 1.0 / edge, 1.0 / edge, 1.0 };
  return grid;
}

/// The coarse cells that fill a medium's box.
tyndall::Grid PilotGrid(vtkInformation* medium, const int* dimensions)
{
  int extent[6] = { 0, 1, 0, 1, 0, 1 };
  double origin[3] = { 0.0, 0.0, 0.0 };
  double spacing[3] = { 1.0, 1.0, 1.0 };
  if (medium && medium->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()))
  {
    medium->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
  }
  if (medium && medium->Has(vtkDataObject::ORIGIN()) && medium->Has(vtkDataObject::SPACING()))
  {
    medium->Get(vtkDataObject::ORIGIN(), origin);
    medium->Get(vtkDataObject::SPACING(), spacing);
  }
  tyndall::Grid grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int voxels = std::max(extent[2 * axis + 1] - extent[2 * axis], 1);
    grid.size[axis] = std::clamp(dimensions[axis], 1, voxels);
    grid.spacing[axis] = voxels * spacing[axis] / grid.size[axis];
    grid.origin[axis] = origin[axis] + extent[2 * axis] * spacing[axis];
  }
  return grid;
}
}

vtkStandardNewMacro(vtkPhotonImportance);

vtkPhotonImportance::vtkPhotonImportance()
  : Kept(std::make_unique<tyndall::KeptMarcher>())
{
  const tyndall::ImportanceSettings defaults;
  this->PilotCount = static_cast<int>(defaults.pilotCount);
  this->GradientThreshold = defaults.gradientThreshold;
  this->LuminanceThreshold = defaults.luminanceThreshold;
  this->Background = defaults.background;
  std::copy(defaults.cells.begin(), defaults.cells.end(), this->PilotDimensions);
  this->SetNumberOfOutputPorts(2);
}

vtkPhotonImportance::~vtkPhotonImportance() = default;

void vtkPhotonImportance::SetInputConnection(int port, vtkAlgorithmOutput* input)
{
  if (port == MEDIUM && input != this->GetInputConnection(port, 0))
  {
    this->Kept->Forget();
  }
  this->Superclass::SetInputConnection(port, input);
}

int vtkPhotonImportance::RequestInformation(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  SetGrid(outputs->GetInformationObject(0), MapGrid(this->PilotCount));
  SetGrid(outputs->GetInformationObject(1), PilotGrid(inputs[MEDIUM]->GetInformationObject(0), this->PilotDimensions));
  return 1;
}

/// The memory of an old medium is given back before the filters before run, which may need it.
int vtkPhotonImportance::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Kept->ForgetIfRan(this, { MEDIUM });
  return this->Superclass::RequestUpdateExtent(request, inputs, outputs);
}

tyndall::Importance vtkPhotonImportance::Find(vtkInformationVector** inputs)
{
  this->Kept->ForgetIfRan(this, { MEDIUM });
  vtkImageData* const image = vtkImageData::GetData(inputs[MEDIUM]);
  const tyndall::Grid grid = tyndall::GridOf(image);
  tyndall::Illumination illumination = this->ReadIllumination(inputs);
  std::copy_n(this->SkyColor, 3, illumination.sky.begin());
  if (tyndall::NothingShines(illumination))
  {
    vtkWarningMacro(
      "Nothing shines on the volume, so there is no map. Connect Lights or an Environment, or set SkyColor.");
    return {};
  }
  tyndall::KeptMarcher::Found found = this->Kept->Find(this,
    tyndall::FindWithin(this->Within, this->Device, this->MemoryBudget), image, nullptr, tyndall::MarchSettings{});
  tyndall::Importance importance =
    tyndall::FindImportance(*found.marcher, grid, illumination, SettingsOf(this), tyndall::MonitorOf(this));
  this->DeviceName = found.key.device->Name();
  this->Kept->Keep(std::move(found));
  return importance;
}

int vtkPhotonImportance::RequestData(
  vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->DeviceName.clear();
  this->Note({});
  return tyndall::Guarded(this, request, given, outputs, [&](vtkInformationVector** inputs) {
    tyndall::Importance importance = this->Find(inputs);
    this->Note(importance);
    vtkImageData* const map = vtkImageData::GetData(outputs, 0);
    vtkImageData* const pilot = vtkImageData::GetData(outputs, 1);
    tyndall::WriteImportanceMap(importance, map);
    const std::vector<std::string> leftOut = importance.leftOut;
    if (!importance.pilot.count.empty())
    {
      tyndall::WritePilotLight(std::move(importance), pilot);
    }
    vtkInformation* const asking = tyndall::AskingPort(request, outputs);
    for (int port = 0; port < 2; ++port)
    {
      vtkImageData* const output = vtkImageData::GetData(outputs, port);
      tyndall::AddFact(output, "left_out", leftOut);
      tyndall::AddFact(output, "device", std::vector<std::string>{ this->DeviceName });
      if (output->GetNumberOfCells() > 0) // else what was told before stands, and the next update asks for that
      {
        tyndall::TellExtentAndKeepWhatIsAskedFor(asking, outputs->GetInformationObject(port), output);
      }
    }
  });
}

void vtkPhotonImportance::Note(const tyndall::Importance& importance)
{
  this->Even = importance.even;
  this->UsedGradientThreshold = importance.gradientThreshold;
  this->UsedLuminanceThreshold = importance.luminanceThreshold;
  this->Seconds = importance.seconds;
  this->LeftOut = tyndall::Lines(importance.leftOut);
}

void vtkPhotonImportance::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PilotCount: " << this->PilotCount << "\n";
  os << indent << "PilotDimensions: " << this->PilotDimensions[0] << " " << this->PilotDimensions[1] << " "
     << this->PilotDimensions[2] << "\n";
  os << indent << "Thresholds: " << (this->Thresholds == OWN ? "own" : "automatic") << "\n";
  os << indent << "GradientThreshold: " << this->GradientThreshold << "\n";
  os << indent << "LuminanceThreshold: " << this->LuminanceThreshold << "\n";
  os << indent << "Background: " << this->Background << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  PrintNumbers(os, indent, "SkyColor", this->SkyColor, 3);
  os << indent << "MemoryBudget: " << this->MemoryBudget << "\n";
  os << indent << "Even: " << this->Even << "\n";
  os << indent << "UsedGradientThreshold: " << this->UsedGradientThreshold << "\n";
  os << indent << "UsedLuminanceThreshold: " << this->UsedLuminanceThreshold << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
  os << indent << "DeviceName: " << this->DeviceName << "\n";
  os << indent << "LeftOut: " << this->LeftOut << "\n";
}
