#include "vtkPhotonMarcher.h"

#include "Device/Device.h"
#include "LightTransportData.h"
#include "PhotonData.h"
#include "Photons/PhotonMarcher.h"
#include "Photons/PublishedPhotons.h"
#include "WholeImage.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace
{
enum InputPort
{
  MediumPort,
  PhotonsPort,
  OctreePort,
  InputPortCount
};

/// Number of SetInputArrayToProcess, after those of ReadMedium.
constexpr int RefractiveIndex = 3;

std::string Triple(const std::array<double, 3>& values)
{
  char text[96];
  std::snprintf(text, sizeof(text), "(%.9g, %.9g, %.9g)", values[0], values[1], values[2]);
  return text;
}

std::string Described(const tyndall::Grid& grid)
{
  const std::array<int, 3>& size = grid.size;
  return std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]) +
    " voxels of spacing " + Triple(grid.spacing) + " from origin " + Triple(grid.origin);
}

/// Whether voxels have the same corners, but for rounding.
bool Agree(const tyndall::Grid& a, const tyndall::Grid& b)
{
  constexpr double part = 1e-3; // of a voxel
  bool agree = a.size == b.size;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = std::abs(a.origin[axis] - b.origin[axis]);
    const double high = std::abs(a.origin[axis] + a.Length(axis) - b.origin[axis] - b.Length(axis));
    agree = agree && std::max(low, high) <= part * b.spacing[axis];
  }
  return agree;
}

/// The octree's levels, of its own image or of the medium's.
std::vector<std::uint8_t> LevelsOf(vtkImageData* octree, vtkImageData* medium)
{
  if (!octree)
  {
    return tyndall::ReadLevels(medium);
  }
  const tyndall::Grid ofOctree = tyndall::GridOf(octree);
  const tyndall::Grid ofMedium = tyndall::GridOf(medium);
  if (!Agree(ofOctree, ofMedium))
  {
    throw tyndall::InvalidInput("The octree has " + Described(ofOctree) + ", the medium " + Described(ofMedium) +
      ". Make the octree of the same medium.");
  }
  std::vector<std::uint8_t> levels = tyndall::ReadLevels(octree);
  if (levels.empty())
  {
    throw tyndall::InvalidInput("The octree's image has no cell array 'octree_level'. Make it with RefractionOctree.");
  }
  return levels;
}

/// Light, of the published scheme what its packing lost, and, of the sound scheme's integrator, paths.
struct Marched
{
  tyndall::PhotonLight light;
  double packingLoss = 0.0;
  std::vector<tyndall::PhotonPath> paths;
};

Marched March(vtkPhotonMarcher* filter, const tyndall::Medium& medium, const tyndall::Field& ior,
  const std::vector<std::uint8_t>& levels, const std::vector<tyndall::Photon>& photons)
{
  const std::shared_ptr<tyndall::Device> device = tyndall::Device::Find(filter->GetDevice());
  const std::uint8_t* nodes = levels.empty() ? nullptr : levels.data();
  const tyndall::Monitor monitor = tyndall::MonitorOf(filter);
  const bool published = filter->GetScheme() == vtkPhotonMarcher::PUBLISHED;
  tyndall::MarchSettings settings;
  settings.order = published ? 1 : filter->GetIntegratorOrder();
  settings.stepSize = published ? 1.0 : filter->GetStepSize();

  Marched marched;
  if (!published || filter->GetPathCount() > 0)
  {
    tyndall::PhotonMarcher marcher(*device, medium, ior, settings, nodes);
    if (!published)
    {
      marched.light = marcher.March(photons, monitor);
    }
    marched.paths =
      marcher.Paths(photons, tyndall::ChooseEvenly(photons.size(), static_cast<std::size_t>(filter->GetPathCount())));
  }
  if (published)
  {
    tyndall::PublishedSettings asPublished;
    asPublished.smooth = filter->GetSmoothing();
    tyndall::PackingLoss loss;
    marched.light = tyndall::MarchPublished(*device, medium, ior, nodes, photons, asPublished, &loss, monitor);
    marched.packingLoss = loss.Relative();
  }
  return marched;
}

double Sum(const tyndall::Rgb& rgb)
{
  return rgb[0] + rgb[1] + rgb[2];
}
}

vtkStandardNewMacro(vtkPhotonMarcher);

vtkPhotonMarcher::vtkPhotonMarcher()
{
  this->SetNumberOfInputPorts(InputPortCount);
  this->SetNumberOfOutputPorts(2);
}

vtkPhotonMarcher::~vtkPhotonMarcher() = default;

void vtkPhotonMarcher::SetPhotonsConnection(vtkAlgorithmOutput* photons)
{
  this->SetInputConnection(PhotonsPort, photons);
}

void vtkPhotonMarcher::SetPhotonsData(vtkDataObject* photons)
{
  this->SetInputDataObject(PhotonsPort, photons);
}

void vtkPhotonMarcher::SetOctreeConnection(vtkAlgorithmOutput* octree)
{
  this->SetInputConnection(OctreePort, octree);
}

void vtkPhotonMarcher::SetOctreeData(vtkDataObject* octree)
{
  this->SetInputDataObject(OctreePort, octree);
}

void vtkPhotonMarcher::RemoveOctree()
{
  this->SetInputConnection(OctreePort, nullptr);
}

int vtkPhotonMarcher::FillInputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == PhotonsPort ? "vtkPolyData" : "vtkImageData");
  if (port == OctreePort)
  {
    information->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkPhotonMarcher::FillOutputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkPolyData");
  return 1;
}

int vtkPhotonMarcher::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*)
{
  for (int port = 0; port < InputPortCount; ++port)
  {
    tyndall::AskForAll(inputs[port]);
  }
  return 1;
}

int vtkPhotonMarcher::RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Note({});
  this->PackingLoss = 0.0;
  return tyndall::Guarded(this, outputs, [&] {
    vtkImageData* image = vtkImageData::GetData(inputs[MediumPort]);
    const tyndall::MediumInput input = tyndall::ReadMedium(this, image);
    const tyndall::FloatField ior =
      tyndall::ReadChosenCells(this, RefractiveIndex, image, "ior", tyndall::Need::Optional, { 1 });
    const std::vector<std::uint8_t> levels = LevelsOf(vtkImageData::GetData(inputs[OctreePort]), image);
    const std::vector<tyndall::Photon> photons = tyndall::ReadPhotons(vtkPolyData::GetData(inputs[PhotonsPort]));

    Marched marched = March(this, input.medium, ior, levels, photons);

    this->Note(marched.light);
    this->PackingLoss = marched.packingLoss;
    this->Warn(marched.light, photons.size());
    vtkImageData* output = vtkImageData::GetData(outputs, 0);
    tyndall::PassOn(image, output);
    const tyndall::Rgb scattered = marched.light.scattered;
    const int channels = marched.light.light.channels;
    tyndall::WriteLight(std::move(marched.light.light), output);
    tyndall::AddCells(output, "mean_direction", std::move(marched.light.meanDirection), 3);
    tyndall::AddFact(output, "scattered", { scattered.begin(), scattered.begin() + channels }, channels);
    if (this->Scheme == PUBLISHED)
    {
      tyndall::AddFact(output, "packing_loss", std::vector<double>{ marched.packingLoss });
    }
    tyndall::KeepWhatIsAskedFor(outputs->GetInformationObject(0), output);
    if (tyndall::IsFirstPiece(request, outputs))
    {
      tyndall::WritePaths(marched.paths, vtkPolyData::GetData(outputs, 1));
    }
  });
}

void vtkPhotonMarcher::Note(const tyndall::PhotonLight& light)
{
  this->Credits = static_cast<vtkIdType>(light.credits);
  this->Steps = static_cast<vtkIdType>(light.steps);
  this->Missed = static_cast<vtkIdType>(light.missed);
  this->BalanceError = light.light.balance.RelativeError(light.light.channels);
  this->Seconds = light.seconds;
  this->DeviceName = light.light.device;
  this->LeftOut = tyndall::Lines(light.light.leftOut);
}

void vtkPhotonMarcher::Warn(const tyndall::PhotonLight& light, std::size_t photons)
{
  if (this->Missed > 0)
  {
    vtkWarningMacro(
      << this->Missed << " of " << photons
      << " photons do not meet the medium, so their power is not in it. Give PhotonEmitter the same medium.");
  }
  const tyndall::EnergyBalance& balance = light.light.balance;
  const double trapped = Sum(balance.entered) > 0.0 ? Sum(balance.leftOver) / Sum(balance.entered) : 0.0;
  if (trapped > 0.01)
  {
    vtkWarningMacro(
      << std::lround(100.0 * trapped)
      << "% of the power that entered still went round when its photons were given up, and is missing from "
         "fluence: total reflection traps it, as that of a lamp in a ball of a high index. Absorption would "
         "end it.");
  }
}

void vtkPhotonMarcher::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Scheme: " << this->Scheme << "\n";
  os << indent << "IntegratorOrder: " << this->IntegratorOrder << "\n";
  os << indent << "StepSize: " << this->StepSize << "\n";
  os << indent << "PathCount: " << this->PathCount << "\n";
  os << indent << "Smoothing: " << this->Smoothing << "\n";
  os << indent << "Device: " << this->Device << "\n";
  os << indent << "Credits: " << this->Credits << "\n";
  os << indent << "Steps: " << this->Steps << "\n";
  os << indent << "Missed: " << this->Missed << "\n";
  os << indent << "BalanceError: " << this->BalanceError << "\n";
  os << indent << "PackingLoss: " << this->PackingLoss << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
  os << indent << "DeviceName: " << this->DeviceName << "\n";
  os << indent << "LeftOut: " << this->LeftOut << "\n";
}
