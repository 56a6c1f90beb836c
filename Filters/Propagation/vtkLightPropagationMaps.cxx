#include "vtkLightPropagationMaps.h"

#include "Common/AvailableMemory.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Device/Device.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "LightPropagation/Accuracy/PreviewLight.h"
#include "LightPropagation/Accuracy/TargetError.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Problem/PropagationQuality.h"
#include "LightPropagation/Published/ParallelPropagation.h"
#include "LightPropagation/Published/SequentialPropagation.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/Ranks.h"

#include "Propagation/LastOutputs.h"
#include "Propagation/SolverScene.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

#include <utility>
#include <vector>

namespace
{
tyndall::PropagationSource SourceOf(int source)
{
  switch (source)
  {
    case vtkLightPropagationMaps::CONSTANT: return tyndall::PropagationSource::Constant;
    case vtkLightPropagationMaps::LINEAR: return tyndall::PropagationSource::Linear;
    case vtkLightPropagationMaps::OCTANTS: return tyndall::PropagationSource::Octants;
    default: return tyndall::PropagationSource::Automatic;
  }
}

tyndall::PropagationSettings SettingsOf(vtkLightPropagationMaps* filter)
{
  tyndall::PropagationSettings settings;
  settings.source = SourceOf(filter->GetSource());
  settings.acceleration = filter->GetAcceleration() == vtkLightPropagationMaps::NONE
    ? tyndall::PropagationAcceleration::None
    : tyndall::PropagationAcceleration::Automatic;
  settings.directionsPerFace = filter->GetDirectionsPerFace();
  settings.uncollidedDirections = filter->GetUncollidedDirections();
  settings.angularDegree = filter->GetAngularDegree();
  settings.storeMoments = filter->GetStoreMoments();
  settings.emissionError = filter->GetEmissionError();
  settings.staggeredRays = filter->GetStaggeredRays();
  settings.mapResolution = filter->GetMapResolution();
  settings.maximumOrders = filter->GetMaximumOrders();
  settings.tolerance = filter->GetTolerance();
  settings.periodic = { filter->GetPeriodicX(), filter->GetPeriodicY(), filter->GetPeriodicZ() };
  settings.storedDirections = filter->GetStoredDirections();
  settings.netFlux = filter->GetNetFlux();
  settings.leaveOut = filter->GetLeaveOut();
  settings.memoryBudget = static_cast<std::size_t>(filter->GetMemoryBudget()) << 20;
  return settings;
}

std::vector<std::string> UsedFor(
  const tyndall::LightField& light, const tyndall::PropagationSettings& settings, vtkLightPropagationMaps* filter)
{
  return filter->GetScheme() == vtkLightPropagationMaps::PUBLISHED ? tyndall::WordsAsPublished(settings)
                                                                   : tyndall::Words(settings, light);
}

/// Solves by the published scheme on the device.
/// @throws DeviceError if the arrays of the scheme, which stores one volume per direction, exceed the memory budget
tyndall::LightField SolvePublished(vtkLightPropagationMaps* filter, tyndall::Device& device,
  const tyndall::Medium& medium, const tyndall::Illumination& illumination,
  const tyndall::PropagationSettings& settings, const tyndall::Monitor& monitor)
{
  tyndall::Device within(device, tyndall::BudgetOf(filter->GetMemoryBudget(), false));
  return tyndall::SolveParallel(within, medium, illumination, settings, monitor);
}

/// Solver function for the filter's Scheme and Algorithm.
/// @param device  null for the sequential algorithm
tyndall::PropagationSolver SolverOf(vtkLightPropagationMaps* filter, const std::shared_ptr<tyndall::Device>& device)
{
  return [=](const tyndall::SceneBlock& scene, const tyndall::PropagationSettings& how, const tyndall::Monitor& watch) {
    return !device ? tyndall::SolveSequential(scene.medium, scene.illumination, how, watch)
      : filter->GetScheme() == vtkLightPropagationMaps::PUBLISHED
      ? SolvePublished(filter, *device, scene.medium, scene.illumination, how, watch)
      : tyndall::SolveConservative(*device, scene.domain, scene.medium, scene.illumination, how, watch, scene.kept);
  };
}

std::shared_ptr<tyndall::Device> DeviceOnAll(vtkLightPropagationMaps* filter, const tyndall::Domain& domain)
{
  const bool published = filter->GetScheme() == vtkLightPropagationMaps::PUBLISHED;
  const bool sequential = published && filter->GetAlgorithm() == vtkLightPropagationMaps::SEQUENTIAL;
  std::shared_ptr<tyndall::Device> device;
  domain.Collective([&] { device = sequential ? nullptr : tyndall::Device::Find(filter->GetDevice()); });
  return device;
}

/// Settings of a solve: the filter's properties, changed by Preview or, without TargetError, by Quality. The changes
/// depend on the medium of all ranks. Collective.
/// @throws InvalidInput if TargetError is set with the published scheme
tyndall::PropagationSettings SettingsOn(vtkLightPropagationMaps* filter, const tyndall::SolverScene& scene)
{
  if (filter->GetPreview())
  {
    return tyndall::SettingsOfPreview(SettingsOf(filter));
  }
  if (filter->GetTargetError() > 0.0)
  {
    tyndall::RefuseAsPublished(filter->GetScheme() == vtkLightPropagationMaps::PUBLISHED, "TargetError");
    return SettingsOf(filter);
  }
  return tyndall::AtQuality(scene.domain, static_cast<tyndall::Quality>(filter->GetQuality()), SettingsOf(filter),
    scene.medium, scene.shining.illumination);
}
}

vtkStandardNewMacro(vtkLightPropagationMaps);

vtkLightPropagationMaps::vtkLightPropagationMaps()
{
  const tyndall::PropagationSettings defaults;
  this->DirectionsPerFace = defaults.directionsPerFace;
  this->UncollidedDirections = defaults.uncollidedDirections;
  this->AngularDegree = defaults.angularDegree;
  this->StoreMoments = defaults.storeMoments;
  this->EmissionError = defaults.emissionError;
  this->StaggeredRays = defaults.staggeredRays;
  this->MapResolution = defaults.mapResolution;
  this->MaximumOrders = defaults.maximumOrders;
  this->NetFlux = defaults.netFlux;
  this->StoredDirections = defaults.storedDirections;
  this->Last = std::make_unique<tyndall::LastLight>();
}

vtkLightPropagationMaps::~vtkLightPropagationMaps() = default;

std::string vtkLightPropagationMaps::NotByBlocks(vtkInformationVector**) const
{
  return this->Scheme == PUBLISHED && !this->Preview ? "Scheme as published" : "";
}

std::string vtkLightPropagationMaps::ReasonNotToDecompose(const tyndall::SolverScene& scene)
{
  const std::shared_ptr<tyndall::Device> device = DeviceOnAll(this, scene.domain);
  return tyndall::ReasonNotToDecompose(
    *device, scene.domain, scene.medium, scene.shining.illumination, SettingsOn(this, scene));
}

tyndall::LightField vtkLightPropagationMaps::Solve(const tyndall::SolverScene& given)
{
  tyndall::PropagationSettings settings = SettingsOn(this, given);
  const tyndall::SceneBlock scene = { given.domain, given.medium, given.shining.illumination, {},
    this->Last->Where(this->WarmStart) };
  const tyndall::PropagationSolver solve = SolverOf(this, DeviceOnAll(this, given.domain));
  const tyndall::Monitor monitor = tyndall::MonitorOf(this);
  if (this->TargetError > 0.0 && !this->Preview)
  {
    settings.facePower |= tyndall::Reflects(scene.illumination); // also in colours that no face reflects
    return tyndall::SolveColours(scene, monitor, [&](const tyndall::SceneBlock& colour, const tyndall::Monitor& watch) {
      tyndall::TargetLight found = tyndall::SolveToTargetError(colour, settings, this->TargetError, watch, solve);
      std::vector<std::string> used = tyndall::Words(found.settings, found.light);
      return tyndall::LightOf(std::move(found), std::move(used));
    });
  }
  tyndall::LightField light = this->Preview
    ? tyndall::SolvePreview(scene, settings, tyndall::PreviewGrid(given.domain.Whole()),
        [&](const tyndall::SceneBlock& coarse) { return solve(coarse, settings, monitor); })
    : this->EstimateError ? tyndall::SolveWithErrorEstimate(scene, settings, monitor, solve)
                          : solve(scene, settings, monitor);
  light.settingsUsed = UsedFor(light, settings, this);
  if (this->Scheme == PUBLISHED && this->WarmStart && !this->Preview)
  {
    light.leftOut.push_back(tyndall::WordsOfWarmStart(tyndall::NotBegunAsPublished));
  }
  return light;
}

void vtkLightPropagationMaps::Note(const tyndall::LightField& light)
{
  this->Superclass::Note(light);
  this->Orders = static_cast<int>(light.convergence.size());
  this->SweepsSaved = light.sweepsSaved.empty() ? 0 : light.sweepsSaved.back();
  this->HalfRangeFlux = light.halfRangeFlux[0];
}

void vtkLightPropagationMaps::ShareResults(tyndall::Communicator& ranks)
{
  this->Superclass::ShareResults(ranks);
  tyndall::TakeFromFirstRank(ranks, this->Orders, this->SweepsSaved, this->HalfRangeFlux);
}

void vtkLightPropagationMaps::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Scheme: " << (this->Scheme == CONSERVATIVE ? "conservative" : "as published") << "\n";
  os << indent << "Algorithm: " << (this->Algorithm == SEQUENTIAL ? "sequential" : "parallel") << "\n";
  tyndallPrintMacro(Source, Acceleration, DirectionsPerFace, UncollidedDirections, AngularDegree, StoreMoments,
    EmissionError, StaggeredRays, MapResolution, MaximumOrders, WarmStart, NetFlux, StoredDirections, Orders,
    SweepsSaved, HalfRangeFlux);
}
