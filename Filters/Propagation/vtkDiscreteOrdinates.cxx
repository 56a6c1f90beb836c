#include "vtkDiscreteOrdinates.h"

#include "Common/AvailableMemory.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Device/Device.h"
#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "DiscreteOrdinates/OrdinatesError.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"
#include "LightPropagation/Accuracy/PreviewLight.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/Ranks.h"

#include "Propagation/LastOutputs.h"
#include "Propagation/SolverScene.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

#include <algorithm>

namespace
{
/// Settings from the filter's properties, before Quality modifies them.
tyndall::OrdinatesSettings GivenSettings(vtkDiscreteOrdinates* filter)
{
  tyndall::OrdinatesSettings settings;
  settings.scheme = static_cast<tyndall::OrdinatesScheme>(filter->GetScheme());
  settings.scattering = static_cast<tyndall::OrdinatesScattering>(filter->GetScattering());
  settings.directionsPerFace = filter->GetDirectionsPerFace();
  settings.spiralDirections = filter->GetSpiralDirections();
  settings.terms = filter->GetTerms();
  settings.maximumOrders = filter->GetMaximumOrders();
  settings.tolerance = filter->GetTolerance();
  settings.acceleration = filter->GetAcceleration() == vtkDiscreteOrdinates::NONE
    ? tyndall::PropagationAcceleration::None
    : tyndall::PropagationAcceleration::Automatic;
  settings.periodic = { filter->GetPeriodicX(), filter->GetPeriodicY(), filter->GetPeriodicZ() };
  settings.netFlux = filter->GetNetFlux();
  settings.leaveOut = filter->GetLeaveOut();
  return settings;
}

tyndall::OrdinatesSettings OfPreview(tyndall::OrdinatesSettings settings)
{
  settings.directionsPerFace = std::min(settings.directionsPerFace, tyndall::PreviewDirections);
  settings.spiralDirections = 0;
  settings.terms = std::min(settings.terms, settings.directionsPerFace);
  settings.tolerance = std::max(settings.tolerance, tyndall::PreviewTolerance);
  settings.seriesAfter = tyndall::PreviewOrders;
  settings.netFlux = false;
  return settings;
}

tyndall::OrdinatesSettings SettingsOf(
  vtkDiscreteOrdinates* filter, const tyndall::SolverScene& scene, const tyndall::Device& device)
{
  const tyndall::OrdinatesSettings given = GivenSettings(filter);
  if (filter->GetPreview())
  {
    return OfPreview(given);
  }
  const auto quality = static_cast<tyndall::Quality>(filter->GetQuality());
  return filter->GetTargetError() > 0.0
    ? given
    : tyndall::AtQuality(scene.domain, quality, given, scene.medium, tyndall::MemoryOf(device));
}

tyndall::LightField SolvePreview(vtkDiscreteOrdinates* filter, tyndall::Device& device,
  const tyndall::SolverScene& scene, const tyndall::OrdinatesSettings& settings)
{
  const tyndall::Illumination& illumination = scene.shining.illumination;
  const tyndall::Grid coarse = tyndall::PreviewGrid(scene.domain.Whole());
  return tyndall::SolvePreview({ scene.domain, scene.medium, illumination }, tyndall::AsPropagation(settings), coarse,
    [&](const tyndall::SceneBlock& block) {
      return tyndall::SolveDiscreteOrdinates(
        device, block.domain, block.medium, block.illumination, settings, tyndall::MonitorOf(filter));
    });
}
}

vtkStandardNewMacro(vtkDiscreteOrdinates);

vtkDiscreteOrdinates::vtkDiscreteOrdinates()
{
  const tyndall::OrdinatesSettings defaults;
  this->DirectionsPerFace = defaults.directionsPerFace;
  this->SpiralDirections = defaults.spiralDirections;
  this->Terms = defaults.terms;
  this->MaximumOrders = defaults.maximumOrders;
  this->NetFlux = defaults.netFlux;
  this->Last = std::make_unique<tyndall::LastLight>();
}

vtkDiscreteOrdinates::~vtkDiscreteOrdinates() = default;

std::string vtkDiscreteOrdinates::NotByBlocks(vtkInformationVector**) const
{
  return this->Scheme == PUBLISHED && !this->Preview ? "Scheme as published" : "";
}

tyndall::LightField vtkDiscreteOrdinates::Solve(const tyndall::SolverScene& scene)
{
  tyndall::KeptLight* const last = this->Last->Where(this->WarmStart && !this->Preview);
  std::shared_ptr<tyndall::Device> device;
  scene.domain.Collective([&] { device = tyndall::Device::Find(this->GetDevice()); });
  tyndall::Device within(*device, tyndall::BudgetOf(this->MemoryBudget, false));
  const tyndall::OrdinatesSettings settings = SettingsOf(this, scene, *device);
  const tyndall::SceneBlock block = { scene.domain, scene.medium, scene.shining.illumination, {}, last };
  const tyndall::Monitor monitor = tyndall::MonitorOf(this);
  if (this->TargetError > 0.0 && !this->Preview)
  {
    return tyndall::SolveOrdinatesToTarget(within, block, settings, this->TargetError, monitor);
  }
  tyndall::LightField light = this->Preview ? SolvePreview(this, within, scene, settings)
    : this->EstimateError
    ? tyndall::EstimateOrdinates(within, block, settings, monitor)
    : tyndall::SolveDiscreteOrdinates(within, block.domain, block.medium, block.illumination, settings, monitor, last);
  light.settingsUsed = tyndall::Words(settings, light);
  return light;
}

void vtkDiscreteOrdinates::Note(const tyndall::LightField& light)
{
  this->Superclass::Note(light);
  this->Orders = static_cast<int>(light.convergence.size());
  this->SweepsSaved = light.sweepsSaved.empty() ? 0 : light.sweepsSaved.back();
  this->HalfRangeFlux = light.halfRangeFlux[0];
}

void vtkDiscreteOrdinates::ShareResults(tyndall::Communicator& ranks)
{
  this->Superclass::ShareResults(ranks);
  tyndall::TakeFromFirstRank(ranks, this->Orders, this->SweepsSaved, this->HalfRangeFlux);
}

void vtkDiscreteOrdinates::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(Scheme, Scattering, DirectionsPerFace, SpiralDirections, Terms, MaximumOrders, Acceleration,
    WarmStart, NetFlux, Orders, SweepsSaved, HalfRangeFlux);
}
