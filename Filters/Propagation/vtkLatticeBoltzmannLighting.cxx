#include "vtkLatticeBoltzmannLighting.h"

#include "Common/DeviceBudget.h"
#include "Common/LightTransportData.h"
#include "Device/Clock.h"
#include "Device/Device.h"
#include "LatticeBoltzmann/Distributed/LatticeInBlocks.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "LatticeBoltzmann/LatticeQuality.h"
#include "LightPropagation/Accuracy/PreviewLight.h"
#include "Photons/PhotonData.h"
#include "Propagation/PieceOfMedium.h"
#include "Ranks/PieceBlocks.h"
#include "Work/GuardedWork.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace
{
/// Light, and how long it took to find.
template <class Solve>
tyndall::LightField Timed(double& seconds, const Solve& solve)
{
  const double start = tyndall::ClockSeconds();
  tyndall::LightField light = solve();
  seconds = tyndall::ClockSeconds() - start;
  return light;
}

/// Whether a preview is of fewer voxels: grids that cannot be halved to cubes have their own.
bool IsOnCoarse(vtkLatticeBoltzmannLighting* filter, const tyndall::Grid& grid)
{
  return filter->GetPreview() && tyndall::CubicPreviewGrid(grid).size != grid.size;
}

tyndall::PreviewSolver SolverOfWhole(vtkLatticeBoltzmannLighting* filter, const tyndall::LatticeSettings& settings)
{
  return [filter, settings](const tyndall::PreviewScene& scene) {
    const std::shared_ptr<tyndall::Device> device = tyndall::Device::Find(filter->GetDevice());
    tyndall::Device within(*device, tyndall::BudgetOf(filter->GetMemoryBudget(), true));
    return tyndall::SolveLatticeBoltzmann(
      within, scene.medium, scene.index, scene.illumination, settings, tyndall::MonitorOf(filter));
  };
}

/// Of few voxels as a whole, of more by blocks.
tyndall::LightField SolvePreviewOfPiece(vtkLatticeBoltzmannLighting* filter, tyndall::Device& device,
  const tyndall::SceneInBlocks& own, const tyndall::Field& ior, const tyndall::LatticeSettings& settings)
{
  const tyndall::PropagationSettings alike = tyndall::AsPropagation(settings);
  const tyndall::Grid coarse = tyndall::CubicPreviewGrid(own.partition.whole);
  if (coarse.VoxelCount() <= tyndall::PreviewVoxels)
  {
    return tyndall::SolvePreviewOnFirst(own, ior, alike, coarse, SolverOfWhole(filter, settings));
  }
  return tyndall::SolvePreviewInBlocks(
    own, ior, alike, coarse, [&](const tyndall::PreviewScene& scene, const tyndall::BlockPartition& blocks) {
      return tyndall::SolveLatticeInBlocks(device, own.others, blocks, scene.medium, scene.index, scene.illumination,
        settings, tyndall::MonitorOf(filter));
    });
}

/// Of all power, what has neither been absorbed nor escaped, the worst channel.
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

void vtkLatticeBoltzmannLighting::SetPhotonsConnection(vtkAlgorithmOutput* photons)
{
  this->SetInputConnection(PHOTONS, photons);
}

void vtkLatticeBoltzmannLighting::SetPhotonsData(vtkDataObject* photons)
{
  this->SetInputDataObject(PHOTONS, photons);
}

void vtkLatticeBoltzmannLighting::RemovePhotons()
{
  this->SetInputConnection(PHOTONS, nullptr);
}

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
  if (this->Preview)
  {
    settings.directions = 6;
    settings.tolerance = std::max(settings.tolerance, tyndall::PreviewTolerance);
    settings.netFlux = false;
    return settings;
  }
  return tyndall::AtQuality(static_cast<tyndall::Quality>(this->Quality), settings);
}

tyndall::LightField vtkLatticeBoltzmannLighting::SolveWithPhotons(
  vtkInformationVector** inputs, const tyndall::MediumInput& input, const tyndall::FloatField& ior)
{
  vtkPolyData* const given = vtkPolyData::GetData(inputs[PHOTONS]);
  if (vtkImageData::GetData(inputs[UNCOLLIDED]))
  {
    throw tyndall::InvalidInput(
      "Photons and UncollidedLight are both connected, and are the same light in two forms. Disconnect one of them.");
  }
  const std::string doubt = tyndall::DoubtOfBox(given, input.medium.grid);
  if (!doubt.empty())
  {
    vtkWarningMacro(<< doubt);
  }
  tyndall::Illumination illumination;
  tyndall::AddFaceAlbedo(illumination, this->FaceAlbedo, this->FaceAlbedoColor);
  const std::vector<tyndall::Photon> photons = tyndall::ReadPhotons(given, tyndall::OwnAxesOf(this));
  return Timed(this->Seconds, [&] {
    const std::shared_ptr<tyndall::Device> device = tyndall::Device::Find(this->GetDevice());
    tyndall::Device within(*device, tyndall::BudgetOf(this->MemoryBudget, true));
    return tyndall::SolveLatticeBoltzmann(
      within, input.medium, ior, photons, illumination, this->Settings(), tyndall::MonitorOf(this));
  });
}

tyndall::LightField vtkLatticeBoltzmannLighting::Solve(vtkInformationVector** inputs)
{
  vtkImageData* image = vtkImageData::GetData(inputs[MEDIUM]);
  const tyndall::MediumInput input = tyndall::ReadMedium(this, image);
  const tyndall::FloatField ior =
    tyndall::ReadChosenCells(this, tyndall::RefractiveIndex, image, "ior", tyndall::Need::Optional, { 1 });
  if (vtkPolyData::GetData(inputs[PHOTONS]))
  {
    return this->SolveWithPhotons(inputs, input, ior);
  }
  const bool emits = input.Emits();
  const tyndall::IlluminationInput shining = this->ReadShining(inputs, emits);
  this->WarnWhereDark(shining.illumination, emits);
  const tyndall::PreviewScene scene = { input.medium, shining.illumination, ior };
  tyndall::LightField light = Timed(this->Seconds, [&] {
    const tyndall::PreviewSolver solve = SolverOfWhole(this, this->Settings());
    const tyndall::Grid& grid = input.medium.grid;
    return IsOnCoarse(this, grid) ? tyndall::SolvePreview(scene, tyndall::CubicPreviewGrid(grid), solve) : solve(scene);
  });
  TellOfDefaultSky(shining, light.leftOut);
  return light;
}

std::string vtkLatticeBoltzmannLighting::NotByBlocks(vtkInformationVector** inputs) const
{
  const bool both = inputs[PHOTONS]->GetNumberOfInformationObjects() > 0 &&
    inputs[UNCOLLIDED]->GetNumberOfInformationObjects() > 0; // an error on one rank, too
  return both ? "Photons beside UncollidedLight" : tyndall::NotInBlocks(this->Settings());
}

tyndall::IlluminationInput vtkLatticeBoltzmannLighting::ReadShiningOn(
  const tyndall::PieceBlocks& pieces, tyndall::PieceOfMedium& piece, vtkInformationVector** inputs)
{
  if (!piece.share)
  {
    return this->Superclass::ReadShiningOn(pieces, piece, inputs);
  }
  tyndall::IlluminationInput ofFaces;
  tyndall::AddFaceAlbedo(ofFaces.illumination, this->FaceAlbedo, this->FaceAlbedoColor);
  return ofFaces;
}

tyndall::LightField vtkLatticeBoltzmannLighting::SolvePiece(tyndall::Communicator& communicator,
  const tyndall::PieceBlocks& pieces, const tyndall::PieceOfMedium& piece, const tyndall::IlluminationInput& shining)
{
  const tyndall::LatticeSettings settings = this->Settings();
  tyndall::FloatField ior;
  std::shared_ptr<tyndall::Device> device;
  communicator.Collective([&] {
    device = tyndall::Device::Find(this->GetDevice());
    if (piece.image)
    {
      ior =
        tyndall::ReadChosenCells(this, tyndall::RefractiveIndex, piece.image, "ior", tyndall::Need::Optional, { 1 });
    }
  });
  std::vector<tyndall::Photon> photons;
  if (piece.share)
  {
    photons = tyndall::ShareOfPhotons(communicator, piece.share, tyndall::OwnAxesOf(this));
    const std::string doubt = tyndall::DoubtOfBox(piece.share, pieces.Partition().whole);
    if (!doubt.empty() && communicator.Rank() == 0)
    {
      vtkWarningMacro(<< doubt);
    }
  }
  tyndall::LightField light = Timed(this->Seconds, [&] {
    const tyndall::BlockPartition& blocks = pieces.Partition();
    const tyndall::Monitor monitor = tyndall::MonitorOf(this);
    tyndall::Device within(*device, tyndall::BudgetOf(this->MemoryBudget, true));
    if (!piece.share && IsOnCoarse(this, blocks.whole))
    {
      return SolvePreviewOfPiece(
        this, within, { communicator, blocks, piece.medium, shining.illumination }, ior, settings);
    }
    return piece.share ? tyndall::SolveLatticeInBlocks(within, communicator, blocks, piece.medium, ior, photons,
                           shining.illumination, settings, monitor)
                       : tyndall::SolveLatticeInBlocks(
                           within, communicator, blocks, piece.medium, ior, shining.illumination, settings, monitor);
  });
  light.settingsUsed = tyndall::Words(settings);
  return light;
}

int vtkLatticeBoltzmannLighting::RequestData(
  vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  return this->UpdateCachedOrSolve(request, given, outputs, [&](vtkInformationVector** inputs) {
    tyndall::LightField light = this->Solve(inputs);
    light.settingsUsed = tyndall::Words(this->Settings());
    this->WriteSolved(std::move(light), inputs, outputs);
  });
}

void vtkLatticeBoltzmannLighting::Note(const tyndall::LightField& light)
{
  const bool any = !light.convergence.empty();
  this->Steps = any ? light.convergence.back().iteration : 0;
  this->Residual = any ? light.convergence.back().residual : 0.0;
  this->BalanceError = UnaccountedPart(light);
  this->DeviceName = light.device;
  this->LeftOut = tyndall::Lines(light.leftOut);
  this->SettingsUsed = tyndall::Lines(light.settingsUsed);
  this->Seconds = any ? this->Seconds : 0.0;
}

void vtkLatticeBoltzmannLighting::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Lattice: " << this->Lattice << "\n";
  os << indent << "Scheme: " << this->Scheme << "\n";
  os << indent << "BlockSize: " << this->BlockSize << "\n";
  os << indent << "Interleaved: " << this->Interleaved << "\n";
  os << indent << "VoxelsPerTurn: " << this->VoxelsPerTurn << "\n";
  os << indent << "Probes: " << this->Probes << "\n";
  os << indent << "StepsPerExchange: " << this->StepsPerExchange << "\n";
  os << indent << "MaximumOrders: " << this->MaximumOrders << "\n";
  os << indent << "NetFlux: " << this->NetFlux << "\n";
  os << indent << "Steps: " << this->Steps << "\n";
  os << indent << "Residual: " << this->Residual << "\n";
  os << indent << "BalanceError: " << this->BalanceError << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
  os << indent << "DeviceName: " << this->DeviceName << "\n";
  os << indent << "LeftOut: " << this->LeftOut << "\n";
}
