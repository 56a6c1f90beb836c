#include "vtkPhotonReconstruction.h"

#include "Common/ImageInput.h"
#include "Common/LightTransportData.h"
#include "Device/Device.h"
#include "Device/HostThreads.h"
#include "Ranks/WholeImage.h"
#include "Reconstruction/PhotonReconstruction.h"
#include "Work/GuardedWork.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace
{
using tyndall::FloatField;
using tyndall::Need;

/// Numbers of SetInputArrayToProcess.
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
  settings.conserve = filter->GetConserveFluence() == vtkPhotonReconstruction::ALWAYS ||
    (filter->GetConserveFluence() == vtkPhotonReconstruction::BY_SCHEME &&
      filter->GetScheme() == vtkPhotonReconstruction::CONSERVATIVE);
  return settings;
}

/// Light of no photons, which have no batches: as many as are needed are as dark as it is.
std::vector<float> DarkBatches(const FloatField& light, std::size_t voxels, int batches)
{
  const std::size_t count = voxels * static_cast<std::size_t>(light.Components());
  const bool dark = std::all_of(light.Values(), light.Values() + count, [](float value) { return value == 0.0f; });
  return std::vector<float>(dark ? count * static_cast<std::size_t>(batches) : 0, 0.0f);
}

/// How many batches an array has.
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

tyndall::ReconstructedLight Reconstruct(vtkPhotonReconstruction* filter, vtkImageData* image)
{
  tyndall::NoisyLight light;
  light.grid = tyndall::GridOf(image);
  const auto read = [&](int number, const char* name, tyndall::Components components) {
    const Need need = number == Fluence ? Need::Required : Need::Optional;
    return tyndall::ReadChosenCells(filter, number, image, name, need, components);
  };
  const FloatField fluence = read(Fluence, "fluence", { 1, 3 });
  const FloatField direction = read(MeanDirection, "mean_direction", { 3 });
  const FloatField count = read(PhotonCount, "photon_count", { 1 });
  const FloatField weight = read(PhotonWeight, "photon_weight", { 1 });
  const bool conservative = filter->GetScheme() == vtkPhotonReconstruction::CONSERVATIVE;
  const FloatField batches = conservative ? read(FluenceBatches, "fluence_batches", {}) : FloatField();
  light.channels = fluence.Components();
  std::vector<float> dark;
  if (batches.IsThere())
  {
    light.batches = BatchesOf(batches, light.channels);
    light.batchFluence = batches.Values();
  }
  else if (conservative)
  {
    light.batches = 2;
    dark = DarkBatches(fluence, light.grid.VoxelCount(), light.batches);
    light.batchFluence = dark.empty() ? nullptr : dark.data();
  }
  light.fluence = fluence.Values();
  light.meanDirection = direction.Values();
  light.photonCount = count.Values();
  light.photonWeight = weight.Values();
  return tyndall::Reconstruct(
    *tyndall::Device::Find(filter->GetDevice()), light, SettingsOf(filter), tyndall::MonitorOf(filter));
}

/// What was left out before, and here.
std::vector<std::string> Joined(vtkImageData* image, const std::vector<std::string>& more)
{
  std::vector<std::string> all;
  auto* const before = vtkArrayDownCast<vtkStringArray>(image->GetFieldData()->GetAbstractArray("left_out"));
  for (vtkIdType i = 0; before && i < before->GetNumberOfValues(); ++i)
  {
    all.push_back(before->GetValue(i));
  }
  const auto isNew = [&](const std::string& word) { return std::find(all.begin(), all.end(), word) == all.end(); };
  std::copy_if(more.begin(), more.end(), std::back_inserter(all), isNew);
  return all;
}

/// Several sums at a time: one alone waits for each of its additions.
double SumOfSquares(const float* values, std::size_t count)
{
  constexpr std::size_t Lanes = 16;
  double sums[Lanes] = {};
  std::size_t i = 0;
  for (; i + Lanes <= count; i += Lanes)
  {
    for (std::size_t lane = 0; lane < Lanes; ++lane)
    {
      sums[lane] += static_cast<double>(values[i + lane]) * values[i + lane];
    }
  }
  for (; i < count; ++i)
  {
    sums[0] += static_cast<double>(values[i]) * values[i];
  }
  return std::accumulate(sums, sums + Lanes, 0.0);
}

double SumOfSquares(const std::vector<float>& values)
{
  return tyndall::SumInThreads(values.size(), 32768,
    [&](std::size_t begin, std::size_t end) { return SumOfSquares(values.data() + begin, end - begin); });
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
  if (tyndall::ReadFact(output, tyndall::ScatteringsFact, 0.0) == 0.0) // else the marcher's own is there already
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
  // vtkImageAlgorithm chooses the active scalars.
  this->SetInputArrayToProcess(Fluence, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "fluence");
}

vtkPhotonReconstruction::~vtkPhotonReconstruction() = default;

int vtkPhotonReconstruction::FillInputPortInformation(int, vtkInformation* information)
{
  tyndall::TakeImages(information);
  return 1;
}

int vtkPhotonReconstruction::RequestInformation(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::TellSomeExtent(inputs[0], outputs);
  return 1;
}

int vtkPhotonReconstruction::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::AskForAll(request, inputs[0], outputs);
  return 1;
}

int vtkPhotonReconstruction::RequestData(
  vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->Note({});
  return tyndall::Guarded(this, request, given, outputs, [&](vtkInformationVector** inputs) {
    vtkImageData* const image = vtkImageData::GetData(inputs[0]);
    tyndall::ReconstructedLight light = Reconstruct(this, image);
    this->Note(light);
    vtkImageData* const output = vtkImageData::GetData(outputs);
    tyndall::PassOn(image, output);
    Write(std::move(light), output);
    tyndall::KeepWhatIsAskedFor(outputs->GetInformationObject(0), output);
  });
}

void vtkPhotonReconstruction::Note(const tyndall::ReconstructedLight& light)
{
  const double squares = SumOfSquares(light.fluence);
  this->Bias = light.bias;
  this->MeanError = squares > 0.0 ? std::sqrt(SumOfSquares(light.fluenceError) / squares) : 0.0;
  this->Seconds = light.seconds;
  this->DeviceName = light.device;
  this->LeftOut = tyndall::Lines(light.leftOut);
}

void vtkPhotonReconstruction::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Scheme: " << this->Scheme << "\n";
  os << indent << "Levels: " << this->Levels << "\n";
  os << indent << "WeightStep: " << this->WeightStep << "\n";
  os << indent << "Level: " << this->Level << "\n";
  os << indent << "NearestPhotons: " << this->NearestPhotons << "\n";
  os << indent << "ConserveFluence: " << this->ConserveFluence << "\n";
  os << indent << "Device: " << this->Device << "\n";
  os << indent << "Bias: " << this->Bias << "\n";
  os << indent << "MeanError: " << this->MeanError << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
  os << indent << "DeviceName: " << this->DeviceName << "\n";
  os << indent << "LeftOut: " << this->LeftOut << "\n";
}
