#include "ViewedInputs.h"

#include "Common/ArrayRanges.h"
#include "Common/InputsKey.h"
#include "Common/PhaseFunctionData.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/SharedMedium.h"
#include "Medium/BoxFaces.h"
#include "Medium/VoxelBox.h"
#include "Viewing/Scene/GridBlock.h"
#include "vtkMediumRayCaster.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
/// Reads the solver's field data on light at the box's faces; empty if there are none, or they do not fit these voxels.
/// @param parts  components per channel
FaceValues ReadFaces(vtkImageData* image, const char* name, std::size_t tuples, int parts)
{
  FaceValues faces;
  vtkDataArray* const said = image->GetFieldData()->GetArray(name);
  if (!said || said->GetNumberOfTuples() != static_cast<vtkIdType>(tuples) ||
    (said->GetNumberOfComponents() != parts && said->GetNumberOfComponents() != 3 * parts))
  {
    return faces;
  }
  faces.components = said->GetNumberOfComponents();
  faces.values.resize(static_cast<std::size_t>(said->GetNumberOfValues()));
  for (vtkIdType i = 0; i < said->GetNumberOfValues(); ++i)
  {
    faces.values[i] = static_cast<float>(said->GetComponent(i / faces.components, i % faces.components));
  }
  return faces;
}

/// All fields with a value per voxel, in an order that is the same on all ranks.
std::vector<FloatField*> FieldsOf(ViewedInputs& inputs)
{
  return { &inputs.medium.sigma_a, &inputs.medium.sigma_s, &inputs.medium.emission, &inputs.medium.g, &inputs.fluence,
    &inputs.direct, &inputs.meanDirection, &inputs.moments.moments, &inputs.moments.straightOn };
}
}

SolvedLight ViewedInputs::Light() const
{
  SolvedLight light = { this->fluence, this->direct, this->meanDirection };
  light.surface = this->surface.Seen();
  light.facePower = this->power.Seen();
  for (std::size_t i = 0; i < 18 && !this->albedo.values.empty(); ++i)
  {
    light.faceAlbedo[i / 3][i % 3] = this->albedo.Seen().At(i / 3, this->albedo.components == 3 ? i % 3 : 0);
  }
  light.scatteredMoments = this->moments.moments;
  light.straightOn = this->moments.straightOn;
  light.lampsApart = this->moments.lampsApart;
  return light;
}

ViewedInputs ReadViewed(vtkMediumRayCaster* filter, vtkImageData* image, const Grid& whole)
{
  const auto read = [&](int number, Components components) {
    return ReadChosenCells(filter, number, image, ViewedNames[number], Need::Optional, components);
  };
  ViewedInputs inputs;
  inputs.medium = ReadMedium(filter, image);
  inputs.fluence = read(ViewedFluence, { 1, 3 });
  inputs.direct = read(ViewedFluenceDirect, { 1, 3 });
  inputs.ior = read(ViewedIndex, { 1 });
  inputs.meanDirection = read(ViewedMeanDirection, { 3 });
  // Moments and light at faces belong to the array `fluence` that the solver wrote.
  if (inputs.fluence.IsThere() &&
    ChosenArray(filter, ViewedFluence, image, ViewedNames[ViewedFluence]) == image->GetCellData()->GetArray("fluence"))
  {
    inputs.moments = ReadMoments(image);
    const std::size_t cells = BoxFaceCellCount(whole);
    inputs.surface = ReadFaces(image, SurfaceRadianceFact, cells, static_cast<int>(SurfaceCosines.size()));
    inputs.power = ReadFaces(image, FacePowerFact, cells, 1);
    inputs.albedo = ReadFaces(image, FaceAlbedoFact, 6, 1);
  }
  return inputs;
}

double ArraysInANumber(vtkMediumRayCaster* filter, vtkImageData* image)
{
  std::string words = PhaseInWords(image);
  const auto add = [&](vtkDataArray* array) {
    words += array ? "," + std::to_string(array->GetNumberOfComponents()) : ",";
  };
  for (int number = SigmaA; number < ViewedArrayCount; ++number)
  {
    add(ChosenArray(filter, number, image, ViewedNames[number]));
  }
  for (const char* name : { "g", MomentsArray, StraightOnArray })
  {
    add(image->GetCellData()->GetArray(name));
  }
  vtkNew<vtkImageData> facts;
  for (const char* name : { SurfaceRadianceFact, FacePowerFact, FaceAlbedoFact, LampsApartFact })
  {
    if (vtkDataArray* const fact = image->GetFieldData()->GetArray(name))
    {
      facts->GetFieldData()->AddArray(fact);
    }
  }
  const std::uint64_t number = ContentKey(facts) ^ std::hash<std::string>()(words);
  return static_cast<double>(number >> 11); // the 53 bits that a double represents exactly
}

void KeepFacesOf(const GridBlock& block, const std::array<int, 3>& size, ViewedInputs& inputs)
{
  for (FaceValues* const faces : { &inputs.surface, &inputs.power })
  {
    if (!faces->values.empty())
    {
      faces->values = FacesOfBlock(faces->values, faces->components, block, size);
    }
  }
}

std::vector<float> SpreadTo(const std::vector<VoxelBox>& wanted, const VoxelBox& given, Communicator& communicator,
  const BlockPartition& partition, const Field& field)
{
  const auto components = static_cast<int>(communicator.Largest({ field.values ? 1.0 * field.components : 0.0 })[0]);
  if (components == 0)
  {
    return {};
  }
  const VoxelBox& own = partition.blocks[static_cast<std::size_t>(communicator.Rank())];
  std::vector<float> values;
  communicator.Collective([&] {
    if (own.VoxelCount() > 0)
    {
      const std::size_t count = given.VoxelCount() * static_cast<std::size_t>(components);
      values = PartOf({ field.values, field.values + count }, given, own, components);
    }
  });
  return ValuesInBox(communicator, partition, wanted, values, components);
}

ViewedInputs SpreadTo(const std::vector<VoxelBox>& wanted, const VoxelBox& given, Communicator& communicator,
  const BlockPartition& partition, vtkImageData* image, const ViewedInputs& inputs)
{
  ViewedInputs spread = inputs;
  const VoxelBox& box = wanted[static_cast<std::size_t>(communicator.Rank())];
  for (FloatField* const field : FieldsOf(spread))
  {
    const int components = field->Components();
    std::vector<float> values = SpreadTo(wanted, given, communicator, partition, *field);
    if (box.VoxelCount() > 0 && !values.empty())
    {
      *field = FloatField(ArrayOf<vtkFloatArray>("", std::move(values), components));
    }
  }
  communicator.Collective([&] {
    if (box.VoxelCount() > 0)
    {
      MediumInput& medium = spread.medium;
      medium.medium.grid = GridOfBox(box, partition.whole);
      medium.medium.sigma_a = medium.sigma_a;
      medium.medium.sigma_s = medium.sigma_s;
      medium.medium.emission = medium.emission;
      vtkNew<vtkImageData> asLarge; // an image of these arrays' size
      asLarge->SetDimensions(box.size[0] + 1, box.size[1] + 1, box.size[2] + 1);
      asLarge->SetFieldData(image->GetFieldData());
      medium.medium.phase = ReadPhase(asLarge, medium.g, medium.sigma_s);
    }
  });
  AgreeOnMeanCosine(communicator, box.VoxelCount() > 0, spread.medium.g, spread.medium.medium);
  return spread;
}
}
