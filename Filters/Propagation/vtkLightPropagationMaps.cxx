#include "vtkLightPropagationMaps.h"

#include "Common/DeviceBudget.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Device/Device.h"
#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "LightPropagation/Accuracy/ErrorInBlocks.h"
#include "LightPropagation/Accuracy/PreviewLight.h"
#include "LightPropagation/Accuracy/TargetError.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Problem/PropagationQuality.h"
#include "LightPropagation/Published/ParallelPropagation.h"
#include "LightPropagation/Published/SequentialPropagation.h"
#include "Pieces/GuardedWork.h"

#include "Propagation/LastOutputs.h"
#include "Propagation/SolverScene.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

#include <algorithm>
#include <memory>
#include <string>
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

tyndall::LightField LightOf(tyndall::TargetLight&& found)
{
  found.light.settingsUsed = tyndall::Words(found.settings, found.light);
  found.light.settingsUsed.push_back("VoxelsDividedBy = " + std::to_string(found.divided ? 2 : 1));
  found.light.solves = found.solves;
  found.light.secondsOfAll = found.seconds;
  return std::move(found.light);
}

/// @throws InvalidInput if the published scheme has a TargetError
void CheckTarget(vtkLightPropagationMaps* filter)
{
  tyndall::Require(filter->GetScheme() != vtkLightPropagationMaps::PUBLISHED || filter->GetTargetError() == 0.0,
    "TargetError is for the conservative scheme: as published the error does not fall with directions. Set "
    "TargetError to 0, or Scheme to conservative.");
}

/// Solves with the directions, tolerance and voxels that TargetError needs; Quality is not read.
tyndall::LightField SolveToTarget(vtkLightPropagationMaps* filter, const tyndall::Medium& medium,
  const tyndall::Illumination& illumination, const tyndall::Monitor& monitor, const tyndall::PropagationSolver& solve)
{
  CheckTarget(filter);
  return LightOf(
    tyndall::SolveToTargetError(medium, illumination, SettingsOf(filter), filter->GetTargetError(), monitor, solve));
}

tyndall::PropagationSettings OfPreview(tyndall::PropagationSettings settings)
{
  settings.directionsPerFace = std::min(settings.directionsPerFace, tyndall::PreviewDirections);
  settings.uncollidedDirections = 0;
  settings.adaptDirections = false;
  settings.angularDegree = 0;
  settings.storeMoments = false;
  settings.emissionError = 0.0;
  settings.storedDirections = 1;
  settings.netFlux = false;
  settings.tolerance = std::max(settings.tolerance, tyndall::PreviewTolerance);
  return settings;
}

/// A medium that does not fit in the memory budget is an error: this scheme stores one volume per direction.
tyndall::LightField SolvePublished(vtkLightPropagationMaps* filter, tyndall::Device& device,
  const tyndall::Medium& medium, const tyndall::Illumination& illumination,
  const tyndall::PropagationSettings& settings, const tyndall::Monitor& monitor)
{
  tyndall::Device within(device, tyndall::BudgetOf(filter->GetMemoryBudget(), false));
  return tyndall::SolveParallel(within, medium, illumination, settings, monitor);
}

/// A serial solver of the filter's Scheme.
/// @param ofGrid  the medium whose solution `last` keeps; solutions on coarser or divided grids are not kept
tyndall::PropagationSolver SolverOf(
  vtkLightPropagationMaps* filter, const tyndall::Medium* ofGrid, tyndall::KeptLight* last)
{
  const bool published = filter->GetScheme() == vtkLightPropagationMaps::PUBLISHED;
  const bool sequential = published && filter->GetAlgorithm() == vtkLightPropagationMaps::SEQUENTIAL;
  const std::shared_ptr<tyndall::Device> device = sequential ? nullptr : tyndall::Device::Find(filter->GetDevice());
  return [=](const tyndall::Medium& inside, const tyndall::Illumination& shining,
           const tyndall::PropagationSettings& how, const tyndall::Monitor& watch) {
    tyndall::KeptLight* const kept = &inside == ofGrid ? last : nullptr;
    return sequential ? tyndall::SolveSequential(inside, shining, how, watch)
      : published     ? SolvePublished(filter, *device, inside, shining, how, watch)
                      : tyndall::SolveConservative(*device, inside, shining, how, watch, kept);
  };
}

tyndall::LightField Solve(vtkLightPropagationMaps* filter, const tyndall::Medium& medium,
  const tyndall::Illumination& illumination, tyndall::KeptLight* last)
{
  const tyndall::PropagationSettings settings = filter->GetPreview()
    ? OfPreview(SettingsOf(filter))
    : tyndall::AtQuality(static_cast<tyndall::Quality>(filter->GetQuality()), SettingsOf(filter), medium, illumination);
  const tyndall::Monitor monitor = tyndall::MonitorOf(filter);
  const tyndall::PropagationSolver solve = SolverOf(filter, &medium, last);
  tyndall::LightField light = filter->GetPreview()
    ? tyndall::SolvePreview({ medium, illumination, {} }, tyndall::PreviewGrid(medium.grid),
        [&](const tyndall::PreviewScene& scene) { return solve(scene.medium, scene.illumination, settings, monitor); })
    : filter->GetTargetError() > 0.0 ? SolveToTarget(filter, medium, illumination, monitor, solve)
    : filter->GetEstimateError()     ? tyndall::SolveWithErrorEstimate(medium, illumination, settings, monitor, solve)
                                     : solve(medium, illumination, settings, monitor);
  if (light.settingsUsed.empty())
  {
    light.settingsUsed = UsedFor(light, settings, filter);
  }
  if (filter->GetScheme() == vtkLightPropagationMaps::PUBLISHED && filter->GetWarmStart() && !filter->GetPreview())
  {
    light.leftOut.push_back(tyndall::WordsOfWarmStart(tyndall::NotBegunAsPublished));
  }
  return light;
}
}

namespace
{
std::shared_ptr<tyndall::Device> DeviceOnAll(vtkLightPropagationMaps* filter, tyndall::Communicator& communicator)
{
  std::shared_ptr<tyndall::Device> device;
  communicator.Collective([&] { device = tyndall::Device::Find(filter->GetDevice()); });
  return device;
}

/// Solves a preview on the coarse grid, serially on the first rank, so the limits of decomposed solves do not apply.
tyndall::LightField SolvePreviewOfPiece(vtkLightPropagationMaps* filter, const tyndall::SceneInBlocks& scene)
{
  tyndall::PropagationSolver solve;
  scene.others.Collective([&] { solve = SolverOf(filter, nullptr, nullptr); });
  const tyndall::PropagationSettings settings = OfPreview(SettingsOf(filter));
  const tyndall::Monitor monitor = tyndall::MonitorOf(filter);
  tyndall::LightField light = tyndall::SolvePreviewOnFirst(scene, {}, settings,
    tyndall::PreviewGrid(scene.partition.whole),
    [&](const tyndall::PreviewScene& coarse) { return solve(coarse.medium, coarse.illumination, settings, monitor); });
  light.settingsUsed = UsedFor(light, settings, filter);
  return light;
}

/// Settings as Quality chooses them for the medium of all ranks; with TargetError, as the properties say.
tyndall::PropagationSettings SettingsOn(vtkLightPropagationMaps* filter, const tyndall::SolverScene& scene)
{
  tyndall::RequireSame(scene.domain.Comm(), "TargetError or EstimateError", true,
    { filter->GetTargetError(), filter->GetEstimateError() ? 1.0 : 0.0 });
  if (filter->GetTargetError() > 0.0)
  {
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
  this->LeaveOut = defaults.leaveOut;
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
  const std::shared_ptr<tyndall::Device> device = DeviceOnAll(this, scene.domain.Comm());
  return tyndall::ReasonNotToDecompose(
    *device, scene.domain, scene.medium, scene.shining.illumination, SettingsOn(this, scene));
}

tyndall::LightField vtkLightPropagationMaps::Solve(const tyndall::SolverScene& ofFilter)
{
  const tyndall::Illumination& illumination = ofFilter.shining.illumination;
  if (!ofFilter.decomposed)
  {
    return ::Solve(this, ofFilter.medium, illumination, this->Last->Where(this->WarmStart));
  }
  tyndall::Communicator& communicator = ofFilter.domain.Comm();
  const tyndall::SceneInBlocks scene = { communicator, ofFilter.domain.Partition(), ofFilter.medium, illumination };
  if (this->Preview)
  {
    return SolvePreviewOfPiece(this, scene);
  }
  tyndall::KeptLight* const last = this->Last->Where(this->WarmStart);
  const std::shared_ptr<tyndall::Device> device = DeviceOnAll(this, communicator);
  const tyndall::PropagationSettings settings = SettingsOn(this, ofFilter);
  const tyndall::Monitor monitor = tyndall::MonitorOf(this);
  if (this->TargetError > 0.0)
  {
    return LightOf(tyndall::SolveInBlocksToTargetError(*device, scene, settings, this->TargetError, monitor, last));
  }
  tyndall::LightField light = this->EstimateError
    ? tyndall::SolveInBlocksWithErrorEstimate(*device, scene, settings, monitor, last)
    : tyndall::SolveConservative(*device, ofFilter.domain, ofFilter.medium, illumination, settings, monitor, last);
  light.settingsUsed = UsedFor(light, settings, this);
  return light;
}

void vtkLightPropagationMaps::Note(const tyndall::LightField& light)
{
  const bool any = !light.convergence.empty();
  this->Orders = static_cast<int>(light.convergence.size());
  this->SweepsSaved = light.sweepsSaved.empty() ? 0 : light.sweepsSaved.back();
  this->Residual = any ? light.convergence.back().residual : 0.0;
  this->Seconds = light.secondsOfAll > 0.0 ? light.secondsOfAll : any ? light.convergence.back().seconds : 0.0;
  this->EstimatedError = light.relativeError;
  this->BalanceError = light.balance.RelativeError(light.channels);
  this->HalfRangeFlux = light.halfRangeFlux;
  this->DeviceName = light.device;
  this->LeftOut = tyndall::Lines(light.leftOut);
  this->SettingsUsed = tyndall::Lines(light.settingsUsed);
  this->Solves = any ? light.solves : 0;
}

void vtkLightPropagationMaps::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Scheme: " << (this->Scheme == CONSERVATIVE ? "conservative" : "as published") << "\n";
  os << indent << "Algorithm: " << (this->Algorithm == SEQUENTIAL ? "sequential" : "parallel") << "\n";
  tyndallPrintMacro(Source, Acceleration, DirectionsPerFace, UncollidedDirections, AngularDegree, StoreMoments,
    EmissionError, StaggeredRays, MapResolution, MaximumOrders, WarmStart, NetFlux, LeaveOut, StoredDirections,
    TargetError, Solves, Orders, SweepsSaved, Residual, EstimatedError, BalanceError, HalfRangeFlux, Seconds,
    DeviceName, LeftOut);
}
