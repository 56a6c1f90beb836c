#include "vtkPhotonImportance.h"

#include "Common/AvailableMemory.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Device/Device.h"
#include "Distribution/SharedMedium.h"
#include "Photons/PhotonData.h"
#include "Photons/RefractiveInput.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/PieceBlocks.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
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

/// Grid of the importance map that RequestInformation announces, before the number of lights is known: one layer.
tyndall::Grid MapGrid(int pilotCount)
{
  const int edge = static_cast<int>(std::sqrt(std::max(pilotCount, 1)));
  tyndall::Grid grid;
  grid.size = { edge, edge, 1 };
  grid.spacing = { 1.0 / edge, 1.0 / edge, 1.0 };
  return grid;
}

/// Grid of the coarse cells of the pilot light, over the medium's box.
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

int vtkPhotonImportance::FillOutputPortInformation(int port, vtkInformation* information)
{
  if (port == 0)
  {
    tyndall::TakePictures(information);
  }
  return this->Superclass::FillOutputPortInformation(port, information);
}

int vtkPhotonImportance::RequestInformation(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  SetGrid(outputs->GetInformationObject(0), MapGrid(this->PilotCount));
  SetGrid(outputs->GetInformationObject(1), PilotGrid(inputs[MEDIUM]->GetInformationObject(0), this->PilotDimensions));
  // The importance map has no direction matrix; the one that is removed was copied from the medium.
  outputs->GetInformationObject(0)->Remove(vtkDataObject::DIRECTION());
  return 1;
}

/// Frees the device memory of a cached medium that is out of date before upstream filters run, and requests this rank's
/// piece of the medium.
int vtkPhotonImportance::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Kept->ForgetIfRan(this, { MEDIUM });
  const int done = this->Superclass::RequestUpdateExtent(request, inputs, outputs);
  // The superclass requests the complete medium; this rank needs only its piece, whatever extent of the map is
  // requested.
  tyndall::AskForPiece(request, inputs[MEDIUM], outputs);
  return done;
}

/// Reads the light sources: lights, environment and SkyColor.
/// @return the light sources; nothing, after a warning, if none emits light
std::optional<tyndall::Illumination> vtkPhotonImportance::ReadLight(vtkInformationVector** inputs)
{
  tyndall::Illumination illumination = this->ReadIllumination(inputs);
  std::copy_n(this->SkyColor, 3, illumination.sky.begin());
  if (tyndall::NothingShines(illumination))
  {
    vtkWarningMacro(
      "Nothing shines on the volume, so there is no map. Connect Lights or an Environment, or set SkyColor.");
    return {};
  }
  return illumination;
}

/// Computes the importance map with pilot photons that march through the ranks' blocks of the medium. Collective.
tyndall::Importance vtkPhotonImportance::Find(const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs)
{
  const tyndall::Domain& domain = pieces.GetDomain();
  this->Kept->ForgetIfRan(this, { MEDIUM });
  vtkSmartPointer<vtkImageData> own;
  std::optional<tyndall::Illumination> light;
  std::shared_ptr<tyndall::Device> device;
  domain.Collective([&] {
    own = pieces.OwnImage(vtkImageData::GetData(inputs[MEDIUM]));
    if (own || domain.IsSerial())
    {
      tyndall::GridOf(own); // throws for an invalid image, before the warning that there is no light
    }
    light = this->ReadLight(inputs);
    device = light ? tyndall::FindWithin(this->Within, this->Device, this->MemoryBudget) : nullptr;
  });
  const tyndall::ImportanceSettings settings = SettingsOf(this);
  tyndall::RequireSame(domain.Comm(), "settings, or how many lights shine", true,
    { light ? 1.0 * static_cast<double>(light->lights.size()) : -1.0, light ? tyndall::Sum(light->sky) : 0.0,
      light ? 1.0 * light->environment.width : 0.0, 1.0 * static_cast<double>(settings.pilotCount),
      1.0 * settings.cells[0], 1.0 * settings.cells[1], 1.0 * settings.cells[2],
      1.0 * static_cast<double>(settings.seed), 1.0 * settings.automatic, settings.gradientThreshold,
      settings.luminanceThreshold, settings.background });
  if (!light)
  {
    return {};
  }
  tyndall::MarchSettings march;
  march.leaveOut = this->LeaveOut;
  tyndall::KeptMarcher::Found found = this->Kept->Find(this, device, domain, own, nullptr, march);
  tyndall::Importance importance =
    tyndall::FindImportance(*found.marcher, domain.Whole(), *light, settings, tyndall::MonitorOf(this));
  this->DeviceName = device->Name();
  if (domain.IsSerial())
  {
    this->Kept->Keep(std::move(found));
  }
  return importance;
}

int vtkPhotonImportance::RequestData(
  vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->DeviceName.clear();
  this->Note({});
  tyndall::WorkOnSubdomains work;
  work.port = MEDIUM;
  work.tellsExtents = true;
  work.wantsPieces = [](vtkInformationVector**) { return true; };
  work.work = [&](const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs) {
    this->Write(outputs, this->Find(pieces, inputs));
    return true;
  };
  work.shareResults = [this](tyndall::Communicator& ranks) {
    tyndall::TakeFromFirstRank(
      ranks, this->Even, this->UsedGradientThreshold, this->UsedLuminanceThreshold, this->DeviceName);
  };
  return tyndall::Guarded(this, request, given, outputs, work);
}

void vtkPhotonImportance::Write(vtkInformationVector* outputs, tyndall::Importance&& importance)
{
  this->Note(importance);
  vtkImageData* const pilot = vtkImageData::GetData(outputs, 1);
  tyndall::WriteImportanceMap(importance, vtkImageData::GetData(outputs, 0));
  const std::vector<std::string> leftOut = importance.leftOut;
  if (!importance.pilot.count.empty())
  {
    tyndall::WritePilotLight(std::move(importance), pilot);
  }
  for (int port = 0; port < 2; ++port)
  {
    vtkImageData* const output = vtkImageData::GetData(outputs, port);
    tyndall::AddFact(output, "left_out", leftOut);
    tyndall::AddFact(output, "device", std::vector<std::string>{ this->DeviceName });
  }
}

void vtkPhotonImportance::Note(const tyndall::Importance& importance)
{
  this->Even = importance.even;
  this->UsedGradientThreshold = importance.gradientThreshold;
  this->UsedLuminanceThreshold = importance.luminanceThreshold;
  tyndall::NoteLeftOut(this, tyndall::Lines(importance.leftOut));
}

void vtkPhotonImportance::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(Device, PilotCount);
  os << indent << "PilotDimensions: " << this->PilotDimensions[0] << " " << this->PilotDimensions[1] << " "
     << this->PilotDimensions[2] << "\n";
  os << indent << "Thresholds: " << (this->Thresholds == OWN ? "own" : "automatic") << "\n";
  tyndallPrintMacro(GradientThreshold, LuminanceThreshold, Background, Seed, SkyColor, LeaveOut, MemoryBudget, Even,
    UsedGradientThreshold, UsedLuminanceThreshold, DeviceName);
  tyndall::PrintRun(os, indent, this);
}
