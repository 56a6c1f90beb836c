#include "vtkLPMCollect.h"

#include "Common/ImageInput.h"
#include "Common/LightTransportData.h"
#include "Common/LightTransportWriting.h"
#include "Common/PrintMembers.h"
#include "Device/Device.h"
#include "LightPropagation/Published/ParallelPropagation.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/WholeInputs.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace
{
using Buffers = std::array<tyndall::FloatField, 6>;

Buffers ReadBuffers(vtkImageData* image)
{
  Buffers buffers;
  for (int face = 0; face < 6; ++face)
  {
    buffers[face] = tyndall::ReadCells(image, tyndall::NamesOfT[face], tyndall::Need::Required, {});
    if (buffers[face].Components() != buffers[0].Components())
    {
      throw tyndall::InvalidInput(std::string("Array '") + tyndall::NamesOfT[face] + "' has " +
        std::to_string(buffers[face].Components()) + " components, '" + tyndall::NamesOfT[0] + "' has " +
        std::to_string(buffers[0].Components()) + "; they must be those that LPMPropagate made.");
    }
  }
  return buffers;
}

int ReadCount(vtkImageData* image, const char* name)
{
  const double value = tyndall::ReadFact(image, name, 0.0);
  if (!(value >= 1.0 && value <= 1e6))
  {
    throw tyndall::InvalidInput(std::string("The field data '") + name +
      "' is missing or is no number of directions or rays; it must be what LPMPropagate made.");
  }
  return static_cast<int>(value);
}

/// Settings with which vtkLPMPropagate made an image (read from the image's field data), and the number of channels of
/// the image's arrays T (`T_xmin` to `T_zmax`, the deposits of the rays).
struct Told
{
  tyndall::PropagationSettings settings;
  int channels = 1;
};

Told ReadTold(vtkImageData* image, const Buffers& buffers)
{
  Told told;
  told.settings.mapResolution = ReadCount(image, tyndall::MapResolutionFact);
  told.settings.storedDirections = ReadCount(image, tyndall::StoredDirectionsFact);
  told.settings.maximumOrders = 1;
  vtkDataArray* listed = image->GetFieldData()->GetArray("directions");
  const vtkIdType perFace = listed ? listed->GetNumberOfTuples() / 6 : 0;
  const int components = buffers[0].Components();
  if (perFace < 1 || (components != perFace && components != 3 * perFace))
  {
    throw tyndall::InvalidInput("The arrays T have " + std::to_string(components) + " components for " +
      std::to_string(perFace) +
      " directions per face in the field data 'directions'; they must be what LPMPropagate made.");
  }
  told.settings.directionsPerFace = static_cast<int>(perFace);
  told.channels = static_cast<int>(components / perFace);
  return told;
}

void CollectAll(tyndall::ParallelPropagation& propagation, const Buffers& buffers, std::size_t voxels)
{
  const std::size_t channels = static_cast<std::size_t>(propagation.Model().Channels());
  const std::size_t components = static_cast<std::size_t>(buffers[0].Components());
  const int perFace = propagation.Model().Directions().PerFace();
  for (int batch = 0; batch < propagation.BatchCount(); ++batch)
  {
    std::vector<std::vector<float>> deposits;
    for (int direction = propagation.FirstDirection(batch); direction < propagation.FirstDirection(batch + 1);
         ++direction)
    {
      const float* source = buffers[direction / perFace].Values() + direction % perFace * channels;
      deposits.emplace_back(voxels * channels);
      for (std::size_t i = 0; i < voxels * channels; ++i)
      {
        deposits.back()[i] = source[i / channels * components + i % channels];
      }
    }
    propagation.SetContributions(batch, deposits);
    propagation.Collect(batch);
  }
  propagation.FinishOrder();
}

/// Adds the light of the previous scattering orders, cell array `name` of the image, to `values`, the light of this
/// order; does nothing if the image does not have that array.
void AddBefore(std::vector<float>& values, vtkImageData* image, const char* name, std::size_t voxels)
{
  const int components = static_cast<int>(values.size() / voxels);
  const tyndall::FloatField before = tyndall::ReadCells(image, name, tyndall::Need::Optional, { components });
  for (std::size_t i = 0; before.IsThere() && i < values.size(); ++i)
  {
    values[i] = before.Values()[i] + values[i];
  }
}
}

vtkStandardNewMacro(vtkLPMCollect);

vtkLPMCollect::vtkLPMCollect() = default;
vtkLPMCollect::~vtkLPMCollect() = default;

int vtkLPMCollect::FillInputPortInformation(int, vtkInformation* information)
{
  tyndall::TakeImages(information);
  tyndall::ReadsVoxels(information, { "sigma_a", "sigma_s", "emission" }, { "g" });
  return 1;
}

int vtkLPMCollect::RequestInformation(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::TellVoxels(this, 0, inputs[0], outputs);
  return 1;
}

int vtkLPMCollect::RequestData(vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  const auto work = [&](vtkMultiProcessController*, tyndall::WholeInputs& inputs) {
    vtkImageData* image = vtkImageData::GetData(inputs.Vectors()[0]);
    const tyndall::MediumInput input = tyndall::ReadMedium(this, image);
    const std::size_t voxels = input.medium.grid.VoxelCount();
    const Buffers buffers = ReadBuffers(image);
    const Told told = ReadTold(image, buffers);
    const bool first = tyndall::ReadFact(image, tyndall::OrderFact, 0.0) == 0.0;

    const std::shared_ptr<tyndall::Device> device = tyndall::Device::Find(this->Device);
    tyndall::ParallelPropagation propagation(*device, input.medium, {}, told.settings, 0, told.channels);
    CollectAll(propagation, buffers, voxels);
    tyndall::LightField light = propagation.Result();

    vtkImageData* output = vtkImageData::GetData(outputs, 0);
    tyndall::PassOn(image, output);
    for (const char* name : tyndall::NamesOfT)
    {
      output->GetCellData()->RemoveArray(name);
    }
    std::vector<float> unscattered = propagation.Source();
    const int sources = static_cast<int>(unscattered.size() / voxels);
    const int stored = static_cast<int>(light.storedDirections.size()) * light.channels;
    if (first)
    {
      tyndall::AddCells(output, "fluence_direct", std::vector<float>(light.fluence), light.channels);
    }
    else
    {
      AddBefore(light.fluence, image, "fluence", voxels);
      AddBefore(light.scatteredRadiance, image, "scattered_radiance", voxels);
    }
    tyndall::AddCells(output, "unscattered", std::move(unscattered), sources);
    tyndall::AddCells(output, "scattered_radiance", std::move(light.scatteredRadiance), stored);
    tyndall::AddCells(output, "fluence", std::move(light.fluence), light.channels);
    output->GetCellData()->SetActiveScalars("fluence");
    tyndall::TellLeftOut(this, output, propagation.LeftOut());
    const tyndall::Rgb& left = light.balance.leftOver;
    tyndall::AddFact(
      output, "left_over", std::vector<double>(left.begin(), left.begin() + light.channels), light.channels);
  };
  return tyndall::GuardedInPieces(this, request, given, outputs, 0, work);
}

void vtkLPMCollect::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(Device);
  tyndall::PrintRun(os, indent, this);
}
