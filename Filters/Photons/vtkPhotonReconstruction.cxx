#include "vtkPhotonReconstruction.h"

#include "Common/ImageInput.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Device/Device.h"
#include "Device/HostThreads.h"
#include "Light/LeftOut.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/PieceBlocks.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"
#include "Reconstruction/PhotonReconstruction.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

namespace
{
using tyndall::FloatField;
using tyndall::Need;

/// Indices of the input arrays, for SetInputArrayToProcess.
enum PhotonLightArray
{
  Fluence = 0,
  MeanDirection = 1,
  PhotonCount = 2,
  PhotonWeight = 3,
  FluenceBatches = 4,
};

tyndall::ReconstructionSettings SettingsOf(vtkPhotonReconstruction* filter)
{
  tyndall::ReconstructionSettings settings;
  settings.estimator = static_cast<tyndall::ReconstructionSettings::Estimator>(filter->GetScheme());
  settings.levels = filter->GetLevels();
  settings.weightStep = filter->GetWeightStep();
  settings.level = filter->GetLevel();
  settings.nearest = filter->GetNearestPhotons();
  settings.leaveOut = filter->GetLeaveOut();
  settings.conserve = filter->GetConserveFluence() == vtkPhotonReconstruction::ALWAYS ||
    (filter->GetConserveFluence() == vtkPhotonReconstruction::BY_SCHEME &&
      filter->GetScheme() == vtkPhotonReconstruction::CONSERVATIVE);
  return settings;
}

/// Array of zeros that replaces `fluence_batches`: the marcher does not write that array if the light is zero
/// everywhere. Empty if `light` is above 0 in any voxel.
std::vector<float> DarkBatches(const FloatField& light, std::size_t voxels, int batches)
{
  const std::size_t count = voxels * static_cast<std::size_t>(light.Components());
  const bool dark = std::all_of(light.Values(), light.Values() + count, [](float value) { return value == 0.0f; });
  return std::vector<float>(dark ? count * static_cast<std::size_t>(batches) : 0, 0.0f);
}

/// Number of batches in an array `fluence_batches`: number of components divided by number of channels.
int BatchesOf(const FloatField& light, int channels)
{
  const int components = light.Components();
  if (components % channels != 0)
  {
    throw tyndall::InvalidInput("The array 'fluence_batches' has " + std::to_string(components) +
      " components; it must have " + std::to_string(channels) + " for each batch, as 'fluence' has.");
  }
  return components / channels;
}

/// Input of a reconstruction: the noisy light of an image, and the arrays that own its values.
struct LightOfImage
{
  FloatField fluence, direction, count, weight, batches;
  std::vector<float> dark;
  tyndall::NoisyLight light;
};

LightOfImage Read(vtkPhotonReconstruction* filter, vtkImageData* image)
{
  LightOfImage of;
  tyndall::NoisyLight& light = of.light;
  light.grid = tyndall::GridOf(image);
  const auto read = [&](int number, const char* name, tyndall::Components components) {
    const Need need = number == Fluence ? Need::Required : Need::Optional;
    return tyndall::ReadChosenCells(filter, number, image, name, need, components);
  };
  of.fluence = read(Fluence, "fluence", { 1, 3 });
  of.direction = read(MeanDirection, "mean_direction", { 3 });
  of.count = read(PhotonCount, "photon_count", { 1 });
  of.weight = read(PhotonWeight, "photon_weight", { 1 });
  const bool conservative = filter->GetScheme() == vtkPhotonReconstruction::CONSERVATIVE;
  of.batches = conservative ? read(FluenceBatches, "fluence_batches", {}) : FloatField();
  light.channels = of.fluence.Components();
  if (of.batches.IsThere())
  {
    light.batches = BatchesOf(of.batches, light.channels);
    light.batchFluence = of.batches.Values();
  }
  else if (conservative)
  {
    light.batches = 2;
    of.dark = DarkBatches(of.fluence, light.grid.VoxelCount(), light.batches);
    light.batchFluence = of.dark.empty() ? nullptr : of.dark.data();
  }
  light.fluence = of.fluence.Values();
  light.meanDirection = of.direction.Values();
  light.photonCount = of.count.Values();
  light.photonWeight = of.weight.Values();
  return of;
}

/// Entries of the image's field data `left_out`, followed by the entries of `more`.
std::vector<std::string> Joined(vtkImageData* image, const std::vector<std::string>& more)
{
  std::vector<std::string> all;
  auto* const before = vtkArrayDownCast<vtkStringArray>(image->GetFieldData()->GetAbstractArray("left_out"));
  for (vtkIdType i = 0; before && i < before->GetNumberOfValues(); ++i)
  {
    all.push_back(before->GetValue(i));
  }
  tyndall::AddMissing(all, more);
  return all;
}

double SumOfSquares(const std::vector<float>& values)
{
  return tyndall::SumInThreads(values.size(), 32768, [&](std::size_t begin, std::size_t end) {
    const float* const first = values.data();
    return std::transform_reduce(first + begin, first + end, 0.0, std::plus<double>(),
      [](float value) { return static_cast<double>(value) * value; });
  });
}

void Write(tyndall::ReconstructedLight&& light, vtkImageData* output)
{
  vtkCellData* const cells = output->GetCellData();
  const std::size_t voxels = light.mipLevel.size();
  const int channels = static_cast<int>(light.fluence.size() / voxels);
  for (const char* earlier : { "fluence_batches", "fluence_error" })
  {
    cells->RemoveArray(earlier);
  }
  tyndall::AddLight(output, "fluence", std::move(light.fluence), channels);
  if (tyndall::ReadFact(output, tyndall::ScatteringsFact, 0.0) == 0.0) // no photon was scattered
  {
    tyndall::AddSameLight(output, "fluence_direct", "fluence");
  }
  cells->SetActiveScalars("fluence");
  if (!light.meanDirection.empty())
  {
    tyndall::AddCells(output, "mean_direction", std::move(light.meanDirection), 3);
  }
  if (!light.fluenceError.empty())
  {
    tyndall::AddLight(output, "fluence_error", std::move(light.fluenceError), channels);
  }
  tyndall::AddCells(output, "mip_level", std::move(light.mipLevel), 1);
  tyndall::AddFact(output, "fluence_bias", std::vector<double>{ light.bias });
  tyndall::AddFact(output, "left_out", Joined(output, light.leftOut));
  tyndall::AddFact(output, "device", std::vector<std::string>{ light.device });
}
}

vtkStandardNewMacro(vtkPhotonReconstruction);

vtkPhotonReconstruction::vtkPhotonReconstruction()
{
  const tyndall::ReconstructionSettings defaults;
  this->Levels = defaults.levels;
  this->WeightStep = defaults.weightStep;
  this->Level = defaults.level;
  this->NearestPhotons = defaults.nearest;
  this->LeaveOut = defaults.leaveOut;
  // Replaces the default array of vtkImageAlgorithm, the active scalars, by `fluence`.
  this->SetInputArrayToProcess(Fluence, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "fluence");
}

vtkPhotonReconstruction::~vtkPhotonReconstruction() = default;

int vtkPhotonReconstruction::FillInputPortInformation(int, vtkInformation* information)
{
  tyndall::TakeImages(information);
  tyndall::ReadsVoxels(
    information, { "fluence", "mean_direction", "photon_count", "photon_weight", "fluence_batches" });
  return 1;
}

int vtkPhotonReconstruction::RequestInformation(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::TellVoxels(this, 0, inputs[0], outputs);
  return 1;
}

int vtkPhotonReconstruction::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::AskForAllBut(tyndall::EachAsksForItsPiece(request, outputs) ? 0 : -1, request, inputs, 1, outputs);
  return 1;
}

/// Smooths the fluence of this rank's block and writes the output. Collective.
void vtkPhotonReconstruction::Reconstruct(const tyndall::PieceBlocks& pieces, vtkImageData* image, vtkImageData* output)
{
  const tyndall::Domain& domain = pieces.GetDomain();
  vtkSmartPointer<vtkImageData> own;
  LightOfImage of;
  std::shared_ptr<tyndall::Device> device;
  domain.Collective([&] {
    own = pieces.OwnImage(image);
    if (own || domain.IsSerial())
    {
      of = Read(this, own);
    }
    device = tyndall::Device::Find(this->Device);
  });
  tyndall::ReconstructedLight light =
    tyndall::Reconstruct(*device, domain, of.light, SettingsOf(this), tyndall::MonitorOf(this));
  const std::vector<double> squares =
    domain.Comm().Sum({ SumOfSquares(light.fluence), SumOfSquares(light.fluenceError) });
  this->Note(light, squares[0], squares[1]);
  const int channels = static_cast<int>(domain.Max(of.fluence.Components()));
  pieces.SpreadToHeld(light.fluence, channels);
  pieces.SpreadToHeld(light.fluenceError, channels);
  pieces.SpreadToHeld(light.meanDirection, 3);
  pieces.SpreadToHeld(light.mipLevel, 1);
  tyndall::PassOn(image, output);
  pieces.KeepHeld(output);
  if (pieces.Held().VoxelCount() > 0)
  {
    ::Write(std::move(light), output);
  }
}

int vtkPhotonReconstruction::RequestData(
  vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->Note({}, 0.0, 0.0);
  tyndall::WorkOnSubdomains work;
  work.wantsPieces = [&](vtkInformationVector**) { return tyndall::EachAsksForItsPiece(request, outputs); };
  work.work = [&](const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs) {
    this->Reconstruct(pieces, vtkImageData::GetData(inputs[0]), vtkImageData::GetData(outputs));
    return true;
  };
  work.shareResults = [this](tyndall::Communicator& ranks) {
    tyndall::TakeFromFirstRank(ranks, this->Bias, this->MeanError, this->DeviceName);
  };
  return tyndall::Guarded(this, request, given, outputs, work);
}

/// Sets the read-only properties.
/// @param squares, ofErrors  sums of squares of fluence and of its error over the voxels of all ranks
void vtkPhotonReconstruction::Note(const tyndall::ReconstructedLight& light, double squares, double ofErrors)
{
  this->Bias = light.bias;
  this->MeanError = squares > 0.0 ? std::sqrt(ofErrors / squares) : 0.0;
  this->DeviceName = light.device;
  tyndall::NoteLeftOut(this, tyndall::Lines(light.leftOut));
}

void vtkPhotonReconstruction::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(PointData, Scheme, Levels, WeightStep, Level, NearestPhotons, ConserveFluence, LeaveOut, Device,
    Bias, MeanError, DeviceName);
  tyndall::PrintRun(os, indent, this);
}
