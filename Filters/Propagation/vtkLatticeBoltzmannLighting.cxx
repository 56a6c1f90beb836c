#include "vtkLatticeBoltzmannLighting.h"

#include "Common/AvailableMemory.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Device/Device.h"
#include "Distribution/Domain.h"
#include "LatticeBoltzmann/DiffusionError.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "LightPropagation/Accuracy/PreviewLight.h"
#include "Photons/PhotonData.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/Ranks.h"
#include "Propagation/SolverScene.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <memory>

namespace
{
/// Solves a preview on a coarser grid, or on the grid itself if its voxels cannot be merged to cubes. Collective.
tyndall::LightField SolvePreviewOf(
  const tyndall::SceneBlock& scene, const tyndall::LatticeSettings& settings, const tyndall::PreviewSolver& solve)
{
  const tyndall::Grid &whole = scene.domain.Whole(), coarse = tyndall::CubicPreviewGrid(whole);
  return coarse.size == whole.size ? solve(scene)
                                   : tyndall::SolvePreview(scene, tyndall::AsPropagation(settings), coarse, solve);
}

/// Fraction of the power that was neither absorbed nor escaped, in the channel where this fraction is largest: the
/// relative error of the energy balance if left-over power counts as an error.
double UnaccountedPart(const tyndall::LightField& light)
{
  tyndall::EnergyBalance balance = light.balance;
  balance.leftOver = {};
  return balance.RelativeError(light.channels);
}
}

vtkStandardNewMacro(vtkLatticeBoltzmannLighting);

vtkLatticeBoltzmannLighting::vtkLatticeBoltzmannLighting()
{
  const tyndall::LatticeSettings defaults;
  this->Lattice = defaults.directions;
  this->Scheme = static_cast<int>(defaults.scheme);
  this->BlockSize = defaults.blockSize;
  this->StepsPerExchange = defaults.stepsPerExchange;
  this->Interleaved = defaults.interleaves;
  this->VoxelsPerTurn = defaults.stretches;
  this->Probes = defaults.probes;
  this->MaximumOrders = defaults.maximumSteps;
  this->NetFlux = defaults.netFlux;
  this->SetNumberOfInputPorts(PHOTONS + 1);
}

vtkLatticeBoltzmannLighting::~vtkLatticeBoltzmannLighting() = default;

int vtkLatticeBoltzmannLighting::FillInputPortInformation(int port, vtkInformation* information)
{
  if (port != PHOTONS)
  {
    return this->Superclass::FillInputPortInformation(port, information);
  }
  information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  information->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

tyndall::LatticeSettings vtkLatticeBoltzmannLighting::Settings() const
{
  tyndall::LatticeSettings settings;
  settings.directions = this->Lattice;
  settings.scheme = static_cast<tyndall::LatticeScheme>(this->Scheme);
  settings.blockSize = this->BlockSize;
  settings.stepsPerExchange = this->StepsPerExchange;
  settings.interleaves = this->Interleaved;
  settings.stretches = this->VoxelsPerTurn;
  settings.probes = this->Probes;
  settings.maximumSteps = this->MaximumOrders;
  settings.tolerance = this->Tolerance;
  settings.periodic = { this->PeriodicX, this->PeriodicY, this->PeriodicZ };
  settings.netFlux = this->NetFlux;
  settings.leaveOut = this->LeaveOut;
  if (this->Preview)
  {
    settings.directions = 6;
    settings.tolerance = std::max(settings.tolerance, tyndall::PreviewTolerance);
    settings.netFlux = false;
    return settings;
  }
  return tyndall::AtQuality(static_cast<tyndall::Quality>(this->Quality), settings);
}

/// Solves for the light by the filter's settings, as a preview if Preview is on. Collective.
/// @param photons  this rank's photons; null if none are connected
tyndall::LightField vtkLatticeBoltzmannLighting::LightOf(
  const tyndall::SceneBlock& scene, const std::vector<tyndall::Photon>* photons)
{
  const tyndall::LatticeSettings settings = this->Settings();
  const bool estimates = !this->Preview && (this->EstimateError || this->TargetError > 0.0);
  tyndall::RefuseAsPublished(
    estimates && this->Scheme == PUBLISHED, this->TargetError > 0.0 ? "TargetError" : "EstimateError");
  std::shared_ptr<tyndall::Device> device;
  scene.domain.Collective([&] { device = tyndall::Device::Find(this->GetDevice()); });
  tyndall::Device within(*device, tyndall::BudgetOf(this->MemoryBudget, true));
  const tyndall::Monitor all = tyndall::MonitorOf(this);
  const tyndall::Monitor monitor = estimates ? tyndall::OfPart(all, 0.0, 0.8) : all;
  const tyndall::PreviewSolver solve = [&](const tyndall::SceneBlock& solved) {
    return tyndall::SolveLatticeBoltzmann(
      within, solved.domain, solved.medium, solved.index, solved.illumination, settings, monitor);
  };
  tyndall::LightField light;
  if (photons)
  {
    light = tyndall::SolveLatticeBoltzmann(
      within, scene.domain, scene.medium, scene.index, *photons, scene.illumination, settings, monitor);
  }
  else
  {
    light = this->Preview ? SolvePreviewOf(scene, settings, solve) : solve(scene);
  }
  if (estimates)
  {
    const tyndall::Monitor rest = tyndall::OfPart(all, 0.8, 1.0);
    tyndall::EstimateDiffusionError(within, scene, settings, photons != nullptr, rest, light);
    tyndall::JudgeTarget(this->TargetError, light);
  }
  light.settingsUsed = tyndall::Words(settings);
  return light;
}

std::string vtkLatticeBoltzmannLighting::NotByBlocks(vtkInformationVector** inputs) const
{
  // Photons and UncollidedLight are the same light in two forms. Connecting both inputs is an error, also on one rank.
  const bool both =
    inputs[PHOTONS]->GetNumberOfInformationObjects() > 0 && inputs[UNCOLLIDED]->GetNumberOfInformationObjects() > 0;
  return both ? "Photons beside UncollidedLight" : tyndall::NotInBlocks(this->Settings());
}

tyndall::IlluminationInput vtkLatticeBoltzmannLighting::ReadShining(
  tyndall::SolverScene& scene, vtkInformationVector** inputs)
{
  if (!scene.share)
  {
    return this->Superclass::ReadShining(scene, inputs);
  }
  tyndall::Require(!vtkImageData::GetData(inputs[UNCOLLIDED]),
    "Photons and UncollidedLight are both connected, and are the same light in two forms. Disconnect one of them.");
  tyndall::IlluminationInput ofFaces;
  tyndall::AddFaceAlbedo(ofFaces.illumination, this->FaceAlbedo, this->FaceAlbedoColor);
  return ofFaces;
}

tyndall::LightField vtkLatticeBoltzmannLighting::Solve(const tyndall::SolverScene& scene)
{
  tyndall::FloatField ior;
  scene.domain.Collective([&] {
    if (scene.image)
    {
      ior =
        tyndall::ReadChosenCells(this, tyndall::RefractiveIndex, scene.image, "ior", tyndall::Need::Optional, { 1 });
    }
  });
  std::vector<tyndall::Photon> photons;
  if (scene.share)
  {
    photons = tyndall::ShareOfPhotons(scene.domain.Comm(), scene.share, tyndall::OwnAxesOf(this));
    const std::string doubt = tyndall::DoubtOfBox(scene.share, scene.domain.Whole());
    if (!doubt.empty() && scene.domain.Rank() == 0)
    {
      vtkWarningMacro(<< doubt);
    }
  }
  return this->LightOf(
    { scene.domain, scene.medium, scene.shining.illumination, ior }, scene.share ? &photons : nullptr);
}

void vtkLatticeBoltzmannLighting::Note(const tyndall::LightField& light)
{
  this->Superclass::Note(light);
  this->Steps = light.convergence.empty() ? 0 : light.convergence.back().iteration;
  this->BalanceError = UnaccountedPart(light);
}

void vtkLatticeBoltzmannLighting::ShareResults(tyndall::Communicator& ranks)
{
  this->Superclass::ShareResults(ranks);
  tyndall::TakeFromFirstRank(ranks, this->Steps);
}

void vtkLatticeBoltzmannLighting::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(
    Lattice, Scheme, BlockSize, Interleaved, VoxelsPerTurn, Probes, StepsPerExchange, MaximumOrders, NetFlux, Steps);
}
