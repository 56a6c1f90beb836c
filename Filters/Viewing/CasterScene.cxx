#include "CasterScene.h"

#include "Common/ArrayRanges.h"
#include "Common/PhaseFunctionData.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/SharedMedium.h"
#include "Medium/BoxFaces.h"
#include "Medium/VoxelBox.h"
#include "Viewing/Blocks/PictureInBlocks.h"
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
#include <iterator>
#include <utility>

namespace tyndall
{
namespace
{
/// Reads a solver's field data about light at the faces of the box.
/// @param name  name of the array
/// @param tuples  required number of tuples
/// @param parts  required number of components per channel
/// @return the values; empty if there is no such array, or its shape differs
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

/// Arrays of the inputs that have a value per voxel, except `ior`, in the same order on all ranks.
std::vector<FloatField*> FieldsOf(ViewedInputs& inputs)
{
  return { &inputs.medium.sigma_a, &inputs.medium.sigma_s, &inputs.medium.emission, &inputs.medium.g, &inputs.fluence,
    &inputs.fluenceError, &inputs.direct, &inputs.meanDirection, &inputs.moments.moments, &inputs.moments.straightOn };
}
}

SolvedLight ViewedInputs::Light() const
{
  SolvedLight light = { this->fluence, this->direct, this->meanDirection };
  light.surface = this->surface.Seen();
  light.facePower = this->power.Seen();
  const auto ofFaces = [](const FaceValues& faces, std::array<Rgb, 6>& to) {
    for (std::size_t i = 0; i < 18 && !faces.values.empty(); ++i)
    {
      to[i / 3][i % 3] = faces.Seen().At(i / 3, faces.components == 3 ? i % 3 : 0);
    }
  };
  ofFaces(this->albedo, light.faceAlbedo);
  ofFaces(this->entering, light.faceRadiance);
  light.scatteredMoments = this->moments.moments;
  light.straightOn = this->moments.straightOn;
  light.lampsApart = this->moments.lampsApart;
  light.fluenceError = this->fluenceError;
  light.surfaceError = this->surfaceError.Seen();
  light.errorLength = this->errorLength;
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
  // The solver's error, angular moments and light at faces belong to its array `fluence`, and are not read if another
  // array is used as fluence.
  if (inputs.fluence.IsThere() &&
    ChosenArray(filter, ViewedFluence, image, ViewedNames[ViewedFluence]) == image->GetCellData()->GetArray("fluence"))
  {
    inputs.moments = ReadMoments(image);
    inputs.fluenceError =
      filter->GetEstimateError() ? ReadCells(image, FluenceErrorArray, Need::Optional) : FloatField();
    const std::size_t cells = BoxFaceCellCount(whole);
    const auto perCell = static_cast<int>(SurfaceCosines.size());
    inputs.surface = ReadFaces(image, SurfaceRadianceFact, cells, perCell);
    if (filter->GetEstimateError())
    {
      inputs.surfaceError = ReadFaces(image, SurfaceErrorFact, cells, perCell);
      const FaceValues length = ReadFaces(image, ErrorLengthFact, 1, 1);
      inputs.errorLength = length.values.empty() ? 0.0 : length.values[0];
    }
    inputs.power = ReadFaces(image, FacePowerFact, cells, 1);
    inputs.albedo = ReadFaces(image, FaceAlbedoFact, 6, 1);
    inputs.entering = ReadFaces(image, FaceRadianceFact, 6, 1);
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
  for (const char* name : { "g", MomentsArray, StraightOnArray, FluenceErrorArray })
  {
    add(image->GetCellData()->GetArray(name));
  }
  vtkNew<vtkImageData> facts;
  const auto addFact = [&](const char* name) {
    if (vtkDataArray* const fact = image->GetFieldData()->GetArray(name))
    {
      facts->GetFieldData()->AddArray(fact);
    }
  };
  std::for_each(std::begin(FaceFacts), std::end(FaceFacts), addFact);
  addFact(LampsApartFact);
  const std::uint64_t number = ContentKey(facts) ^ std::hash<std::string>()(words);
  return static_cast<double>(number >> 11); // 53 bits, which a double represents exactly
}

namespace
{
/// Selects, from values on the boundary faces of the whole grid, the values on the faces of a block.
/// @param size  number of voxels of the block's arrays along x, y and z
void KeepFacesOf(const GridBlock& block, const std::array<int, 3>& size, ViewedInputs& inputs)
{
  for (FaceValues* const faces : { &inputs.surface, &inputs.surfaceError, &inputs.power })
  {
    if (!faces->values.empty())
    {
      faces->values = FacesOfBlock(faces->values, faces->components, block, size);
    }
  }
}

/// Values of an array in the box of voxels that this rank needs for rendering, gathered from the blocks of all ranks.
/// Collective.
/// @param wanted  needed box of each rank, in voxels of the whole grid; empty if a rank has no block
/// @param field   the array on this rank's input image, ghost cells included
std::vector<float> SpreadTo(const std::vector<VoxelBox>& wanted, const BlocksOfRanks& blocks, const Field& field)
{
  const Domain& domain = blocks.Over();
  const auto components = static_cast<int>(domain.Max(field.values ? 1.0 * field.components : 0.0));
  if (components == 0)
  {
    return {};
  }
  const VoxelBox& given = blocks.Given()[static_cast<std::size_t>(domain.Rank())];
  std::vector<float> values;
  domain.Collective([&] {
    if (!domain.IsEmpty())
    {
      const std::size_t count = given.VoxelCount() * static_cast<std::size_t>(components);
      values = PartOf({ field.values, field.values + count }, given, domain.Own(), components);
    }
  });
  return ValuesInBox(domain.Comm(), domain.Partition(), wanted, values, components);
}

/// Inputs of the ray caster in the box of voxels that this rank needs for rendering, gathered from the blocks of all
/// ranks. Collective.
/// @param wanted  needed box of each rank, in voxels of the whole grid; empty if a rank has no block
/// @param image  this rank's input image, whose field data describe the phase function
ViewedInputs SpreadTo(
  const std::vector<VoxelBox>& wanted, const BlocksOfRanks& blocks, vtkImageData* image, const ViewedInputs& inputs)
{
  const Domain& domain = blocks.Over();
  ViewedInputs spread = inputs;
  const VoxelBox& box = wanted[static_cast<std::size_t>(domain.Rank())];
  for (FloatField* const field : FieldsOf(spread))
  {
    const int components = field->Components();
    std::vector<float> values = SpreadTo(wanted, blocks, *field);
    if (box.VoxelCount() > 0 && !values.empty())
    {
      *field = FloatField(ArrayOf<vtkFloatArray>("", std::move(values), components));
    }
  }
  domain.Collective([&] {
    if (box.VoxelCount() > 0)
    {
      MediumInput& medium = spread.medium;
      medium.medium.grid = GridOfBox(box, domain.Whole());
      medium.medium.sigma_a = medium.sigma_a;
      medium.medium.sigma_s = medium.sigma_s;
      medium.medium.emission = medium.emission;
      vtkNew<vtkImageData> asLarge; // image of the size of the gathered arrays, which ReadPhase requires
      asLarge->SetDimensions(box.size[0] + 1, box.size[1] + 1, box.size[2] + 1);
      asLarge->SetFieldData(image->GetFieldData());
      medium.medium.phase = ReadPhase(asLarge, medium.g, medium.sigma_s);
    }
  });
  AgreeOnMeanCosine(domain.Comm(), box.VoxelCount() > 0, spread.medium.g, spread.medium.medium);
  return spread;
}

/// Gathers the halo that this rank needs to render its block. Collective.
/// @param viewed  inputs in this rank's piece; set to the inputs in the voxels held[rank]
/// @param held  set to the voxels that the ray caster of each rank holds, by rank
/// @param ior   set to the refractive index in the voxels of the box BlockOfScene::known if it varies, else unchanged
/// @return this rank's block, and properties of the scene that all ranks share
BlockOfScene FetchHalo(
  const SceneSource& source, ViewedInputs& viewed, std::vector<VoxelBox>& held, std::vector<float>& ior)
{
  const Domain& domain = source.Over();
  const ViewSettings settings = source.filter->GetEstimateError() ? CoarserSettings(source.settings) : source.settings;
  AgreeOnMeanCosine(domain.Comm(), !domain.IsEmpty(), viewed.medium.g, viewed.medium.medium);
  SharedScene own;
  domain.Collective([&] {
    if (!domain.IsEmpty())
    {
      own = SharedSceneOf(viewed.medium.medium, viewed.Light(), viewed.ior, settings);
    }
  });
  BlockOfScene ofScene;
  ofScene.shared = PictureInBlocks::Shared(domain, domain.IsEmpty() ? nullptr : &own);
  held = source.blocks.HeldFor(
    settings, domain.Any(viewed.moments.moments.IsThere()), domain.Any(!viewed.surface.values.empty()));
  const auto rank = static_cast<std::size_t>(domain.Rank());
  if (ofScene.shared.index.Varies() || !settings.leaveOut)
  {
    std::vector<VoxelBox> known = held;
    for (std::size_t other = 0; other < known.size(); ++other)
    {
      const VoxelBox& block = domain.Partition().blocks[other];
      known[other] = block.VoxelCount() > 0 ? KnownBox(block, held[other], domain.Whole(), settings) : VoxelBox();
    }
    ior = SpreadTo(known, source.blocks, viewed.ior);
    ofScene.known = known[rank];
  }
  if (!source.blocks.AreGiven(held))
  {
    viewed = SpreadTo(held, source.blocks, source.image, viewed);
  }
  ofScene.block = BlockOfRank(domain.Partition(), domain.Rank(), held[rank]);
  return ofScene;
}
}

std::unique_ptr<CasterScene> MakeScene(
  const SceneSource& source, const InputsKey& key, const Illumination& illumination)
{
  const Domain& domain = source.Over();
  ViewedInputs viewed;
  domain.Collective([&] {
    if (!domain.IsEmpty())
    {
      viewed = ReadViewed(source.filter, source.image, source.Block() ? source.Block()->whole : domain.Whole());
    }
  });
  std::vector<VoxelBox> held;
  std::vector<float> known;
  BlockOfScene part;
  if (!domain.IsSerial())
  {
    part = FetchHalo(source, viewed, held, known);
  }
  std::unique_ptr<CasterScene> scene;
  domain.Collective([&] {
    if (domain.IsEmpty())
    {
      return;
    }
    const Grid& grid = viewed.medium.medium.grid;
    if (source.Block())
    {
      KeepFacesOf(domain.IsSerial() ? *source.Block() : part.block, grid.size, viewed);
    }
    scene = std::make_unique<CasterScene>();
    const bool sky = !illumination.environment.Empty() || illumination.sky != Rgb{};
    if (!viewed.fluence.IsThere() && illumination.lights.empty() && !viewed.medium.emission.IsThere() &&
      !(sky && viewed.ior.IsThere()))
    {
      scene->doubts.emplace_back("The medium is dark: it has no array fluence (a solver makes it, e.g. "
                                 "LightPropagationMaps), there are no Lights, and it does not emit.");
    }
    scene->key = key;
    scene->grid = grid;
    scene->held = held;
    scene->lightsAlone = !viewed.fluence.IsThere() && !illumination.lights.empty();
    ViewSettings settings = source.settings;
    settings.shadowRays |= scene->lightsAlone;
    const Field ior = domain.IsSerial() ? Field(viewed.ior) : Field{ known.empty() ? nullptr : known.data(), 1 };
    scene->caster = std::make_unique<MediumRayCaster>(*key.device, viewed.medium.medium, viewed.Light(), illumination,
      settings, ior, domain.IsSerial() ? nullptr : &part);
    if (source.filter->GetEstimateError())
    {
      scene->error = std::make_unique<PictureErrorCasters>(*key.device, viewed.medium.medium, viewed.Light(),
        illumination, settings, ior, domain.IsSerial() ? nullptr : &part);
    }
    const std::vector<std::string>& warnings = scene->caster->Warnings();
    scene->doubts.insert(scene->doubts.end(), warnings.begin(), warnings.end());
    scene->made.Modified();
  });
  return scene;
}
}
