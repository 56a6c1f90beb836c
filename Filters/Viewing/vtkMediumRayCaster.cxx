#include "vtkMediumRayCaster.h"

#include "AskedView.h"
#include "BlocksOfRanks.h"
#include "Common/ContentKey.h"
#include "Common/DeviceBudget.h"
#include "Common/Failure.h"
#include "Common/FiniteValues.h"
#include "Common/InputsKey.h"
#include "Common/LightTransportData.h"
#include "Common/PhaseFunctionData.h"
#include "Common/VectorArray.h"
#include "Device/Clock.h"
#include "Device/Device.h"
#include "Medium/BoxFaces.h"
#include "PictureOfBlocks.h"
#include "Ranks/NeighbourLayer.h"
#include "Ranks/Ranks.h"
#include "Ranks/WholeImage.h"
#include "Viewing/Blocks/BlockFaces.h"
#include "Viewing/MediumRayCaster.h"
#include "Viewing/Scene/ViewQuality.h"
#include "Viewing/ToneMapping.h"
#include "Work/GuardedWork.h"
#include "Work/WholeInputs.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkMultiProcessStream.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTimeStamp.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace
{
enum LightArray
{
  Fluence = 3, ///< after tyndall::MediumArray
  FluenceDirect = 4,
  RefractiveIndex = 5,
  MeanDirection = 6,
};

/// The arrays it reads, by their number.
constexpr const char* ArrayNames[] = { "sigma_a", "sigma_s", "emission", "fluence", "fluence_direct", "ior",
  "mean_direction" };

/// What is behind the medium in a picture that is shown with this exposure, radiance.
/// @param exposure  0: it is not known yet
tyndall::Rgb BackgroundOf(vtkMediumRayCaster* filter, double exposure)
{
  tyndall::Rgb background = tyndall::Triple(filter->GetBackgroundRadiance());
  if (background == tyndall::Rgb{} && exposure > 0.0)
  {
    const auto curve = static_cast<tyndall::ToneCurve>(filter->GetToneCurve());
    std::transform(filter->GetBackgroundColor(), filter->GetBackgroundColor() + 3, background.begin(),
      [&](double shown) { return tyndall::ExposedAs(shown, curve) / exposure; });
  }
  return background;
}

tyndall::ViewSettings SettingsOf(vtkMediumRayCaster* filter, double exposure)
{
  tyndall::ViewSettings settings;
  std::copy_n(filter->GetImageSize(), 2, settings.imageSize.begin());
  settings.stepSize = filter->GetStepSize();
  settings.singleScatteringOnly = filter->GetSingleScatteringOnly();
  settings.shadowRays = filter->GetShadowRays();
  settings.rectangleSamples = filter->GetRectangleSamples();
  settings.showBackground = filter->GetShowBackground();
  settings.backgroundColor = BackgroundOf(filter, exposure);
  settings.surfaceReflection = static_cast<tyndall::SurfaceReflection>(filter->GetSurfaceReflection());
  settings.surfaceIndex = filter->GetSurfaceIndex();
  settings.surfaceReflectance = filter->GetSurfaceReflectance();
  settings.tableFace = filter->GetTableFace();
  settings.tableColor = tyndall::Triple(filter->GetTableColor());
  settings.tableReflectance = filter->GetTableReflectance();
  settings.leaveOut = filter->GetLeaveOut();
  return tyndall::AtQuality(static_cast<tyndall::Quality>(filter->GetQuality()), settings);
}

tyndall::Camera CameraOf(vtkMediumRayCaster* filter, const tyndall::Grid& grid)
{
  tyndall::Camera camera;
  camera.position = tyndall::Triple(filter->GetCameraPosition());
  camera.focalPoint = tyndall::Triple(filter->GetCameraFocalPoint());
  camera.viewUp = tyndall::Triple(filter->GetCameraViewUp());
  camera.viewAngle = filter->GetCameraViewAngle();
  camera.parallelScale = filter->GetCameraParallelScale();
  if (camera.position == camera.focalPoint)
  {
    const double aspect = static_cast<double>(filter->GetImageSize()[0]) / filter->GetImageSize()[1];
    camera =
      tyndall::FrameGrid(grid, aspect, camera.viewAngle, tyndall::ThreeQuarterView(camera.viewUp), camera.viewUp);
  }
  camera.parallelProjection = filter->GetCameraParallelProjection();
  return camera;
}

/// What the solver said of the light at the box's faces; empty where it did not, or what it said is not of these
/// voxels.
struct FaceValues
{
  std::vector<float> values;
  int components = 0;

  tyndall::Field Seen() const { return { this->values.empty() ? nullptr : this->values.data(), this->components }; }
};

/// @param parts  components of a channel
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

/// What light at the faces is seen: it belongs to the array that the solver wrote. Ranks that have a block each know
/// that of all faces.
struct LightAtFaces
{
  FaceValues surface, power, albedo;

  LightAtFaces() = default;
  LightAtFaces(vtkImageData* image, const tyndall::Grid& grid, const tyndall::GridBlock* block)
    : surface(ReadFaces(image, tyndall::SurfaceRadianceFact, tyndall::BoxFaceCellCount(block ? block->whole : grid),
        static_cast<int>(tyndall::SurfaceCosines.size())))
    , power(ReadFaces(image, tyndall::FacePowerFact, tyndall::BoxFaceCellCount(block ? block->whole : grid), 1))
    , albedo(ReadFaces(image, tyndall::FaceAlbedoFact, 6, 1))
  {
    for (FaceValues* const faces : { &this->surface, &this->power })
    {
      if (block && !faces->values.empty())
      {
        faces->values = tyndall::FacesOfBlock(faces->values, faces->components, *block, grid.size);
      }
    }
  }

  void AddTo(tyndall::SolvedLight& light) const
  {
    light.surface = this->surface.Seen();
    light.facePower = this->power.Seen();
    for (std::size_t i = 0; i < 18 && !this->albedo.values.empty(); ++i)
    {
      light.faceAlbedo[i / 3][i % 3] = this->albedo.Seen().At(i / 3, this->albedo.components == 3 ? i % 3 : 0);
    }
  }
};

std::array<int, 6> WholePicture(vtkMediumRayCaster* filter)
{
  return { 0, filter->GetImageSize()[0] - 1, 0, filter->GetImageSize()[1] - 1, 0, 0 };
}

/// The medium's pieces, with their neighbours' cells where those can be had.
tyndall::BlocksOfRanks SurroundedBlocks(vtkMultiProcessController* ranks, tyndall::WholeInputs& inputs)
{
  const auto given = [&] { return vtkImageData::GetData(inputs.Vectors()[vtkMediumRayCaster::MEDIUM]); };
  tyndall::BlocksOfRanks blocks(ranks, given());
  if (blocks.MakeUpTheWhole() && !blocks.HaveLayers())
  {
    if (const vtkSmartPointer<vtkImageData> surrounded = tyndall::WithNeighbourLayer(ranks, given()))
    {
      inputs.Replace(surrounded);
      return { ranks, surrounded };
    }
  }
  return blocks;
}

/// A number for which arrays a rank's block has, and for what is used of field data.
double ArraysInANumber(vtkMediumRayCaster* filter, vtkImageData* image)
{
  std::string words = tyndall::PhaseInWords(image);
  const auto add = [&](vtkDataArray* array) {
    words += array ? "," + std::to_string(array->GetNumberOfComponents()) : ",";
  };
  for (int number = tyndall::SigmaA; number <= MeanDirection; ++number)
  {
    add(tyndall::ChosenArray(filter, number, image, ArrayNames[number]));
  }
  for (const char* name : { "g", tyndall::MomentsArray, tyndall::StraightOnArray })
  {
    add(image->GetCellData()->GetArray(name));
  }
  vtkNew<vtkImageData> facts;
  for (const char* name : { tyndall::SurfaceRadianceFact, tyndall::FacePowerFact, tyndall::FaceAlbedoFact })
  {
    if (vtkDataArray* const fact = image->GetFieldData()->GetArray(name))
    {
      facts->GetFieldData()->AddArray(fact);
    }
  }
  const std::uint64_t number = tyndall::ContentKey(facts) ^ std::hash<std::string>()(words);
  return static_cast<double>(number >> 11); // a double's digits
}

/// @param first  column and row of the picture's first pixel
void WritePicture(
  tyndall::Picture&& picture, const std::array<int, 2>& first, std::vector<std::uint8_t>&& color, vtkImageData* output)
{
  output->SetExtent(first[0], first[0] + picture.width - 1, first[1], first[1] + picture.height - 1, 0, 0);
  output->SetOrigin(0.0, 0.0, 0.0);
  output->SetSpacing(1.0, 1.0, 1.0);
  vtkPointData* const pixels = output->GetPointData();
  const auto shown = tyndall::ArrayOf<vtkUnsignedCharArray>("color", std::move(color), 4);
  tyndall::LeaveRanges(shown);
  pixels->SetScalars(shown);
  const auto pixelName = [&first, width = static_cast<std::size_t>(picture.width)](std::size_t pixel) {
    return "pixel (" + std::to_string(first[0] + pixel % width) + ", " + std::to_string(first[1] + pixel / width) +
      ") from below";
  };
  for (const auto& [name, values, components] : { std::tuple("radiance", &picture.radiance, 3),
         std::tuple("alpha", &picture.alpha, 1), std::tuple("depth", &picture.depth, 1) })
  {
    const tyndall::ArrayRanges ranges =
      tyndall::RequireFinite(name, values->data(), values->size(), components, pixelName);
    const auto array = tyndall::ArrayOf<vtkFloatArray>(name, std::move(*values), components);
    tyndall::LeaveRanges(ranges, array);
    pixels->AddArray(array);
  }
}
}

/// Medium, light and illumination as they are on the device, ready for pictures.
struct vtkMediumRayCaster::Scene
{
  tyndall::InputsKey key;
  vtkTimeStamp made;
  tyndall::Grid grid;
  bool lightsAlone = false;        ///< there is no fluence, so shadow rays are needed
  std::vector<std::string> doubts; ///< not said yet
  std::unique_ptr<tyndall::MediumRayCaster> caster;
};

vtkStandardNewMacro(vtkMediumRayCaster);

vtkMediumRayCaster::vtkMediumRayCaster()
{
  const tyndall::ViewSettings defaults;
  this->StepSize = defaults.stepSize;
  this->SingleScatteringOnly = defaults.singleScatteringOnly;
  this->ShadowRays = defaults.shadowRays;
  this->RectangleSamples = defaults.rectangleSamples;
  this->ShowBackground = defaults.showBackground;
  this->SurfaceIndex = defaults.surfaceIndex;
  this->SurfaceReflectance = defaults.surfaceReflectance;
  this->TableFace = defaults.tableFace;
  this->TableReflectance = defaults.tableReflectance;
  this->LeaveOut = defaults.leaveOut;
  std::copy(defaults.imageSize.begin(), defaults.imageSize.end(), this->ImageSize);
  std::copy(defaults.backgroundColor.begin(), defaults.backgroundColor.end(), this->BackgroundRadiance);
  std::copy(defaults.tableColor.begin(), defaults.tableColor.end(), this->TableColor);
}

vtkMediumRayCaster::~vtkMediumRayCaster() = default;

int vtkMediumRayCaster::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkInformation* information = outputs->GetInformationObject(0);
  const int extent[6] = { 0, std::max(this->ImageSize[0], 1) - 1, 0, std::max(this->ImageSize[1], 1) - 1, 0, 0 };
  const double origin[3] = { 0.0, 0.0, 0.0 };
  const double spacing[3] = { 1.0, 1.0, 1.0 };
  information->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  information->Set(vtkDataObject::ORIGIN(), origin, 3);
  information->Set(vtkDataObject::SPACING(), spacing, 3);
  vtkDataObject::SetPointDataActiveScalarInfo(information, VTK_UNSIGNED_CHAR, 4);
  return 1;
}

void vtkMediumRayCaster::SetInputConnection(int port, vtkAlgorithmOutput* input)
{
  if (input != this->GetInputConnection(port, 0))
  {
    this->Kept.reset();
  }
  this->Superclass::SetInputConnection(port, input);
}

void vtkMediumRayCaster::ForgetOldScene()
{
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    if (this->Kept && tyndall::RanSince(this, port, this->Kept->made))
    {
      this->Kept.reset();
    }
  }
}

/// The memory of an old scene is given back before the filters before run, which may need it. Ranks together ask for
/// their pieces of the medium, unless they are known to need the whole.
int vtkMediumRayCaster::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->ForgetOldScene();
  const int done = this->Superclass::RequestUpdateExtent(request, inputs, outputs);
  if (!this->NeedsWhole && this->TableFace < 0)
  {
    tyndall::AskForPiece(request, inputs[MEDIUM], outputs);
  }
  return done;
}

tyndall::InputsKey vtkMediumRayCaster::KeyOf(vtkInformationVector** inputs, const tyndall::GridBlock* block)
{
  tyndall::InputsKey key;
  key.device = tyndall::FindWithin(this->Within, this->Device, this->MemoryBudget);
  vtkImageData* const image = vtkImageData::GetData(inputs[MEDIUM]);
  key.Add(tyndall::GridOf(image));
  key.AddGhosts(image);
  for (int axis = 0; block && axis < 3; ++axis)
  {
    key.Add({ 1.0 * block->first[axis], 1.0 * block->whole.size[axis] });
  }
  tyndall::AddPhase(key, image);
  key.Add({ 1.0 * this->EnvironmentUp, this->EnvironmentAzimuth });
  for (int number = tyndall::SigmaA; number <= MeanDirection; ++number)
  {
    key.Add(tyndall::ChosenArray(this, number, image, ArrayNames[number]));
  }
  for (const char* fact : { tyndall::SurfaceRadianceFact, tyndall::FacePowerFact, tyndall::FaceAlbedoFact })
  {
    key.Add(image->GetFieldData()->GetArray(fact));
  }
  key.Add(image->GetCellData()->GetArray(tyndall::MomentsArray));
  key.Add(image->GetCellData()->GetArray(tyndall::StraightOnArray));
  key.Add(image->GetFieldData()->GetArray(tyndall::LampsApartFact));
  for (int port : { LIGHTS, ENVIRONMENT })
  {
    key.Add(vtkDataObject::GetData(inputs[port]));
  }
  if (vtkImageData* const environment = vtkImageData::GetData(inputs[ENVIRONMENT]))
  {
    const int* size = environment->GetDimensions();
    key.Add({ 1.0 * size[0], 1.0 * size[1], 1.0 * size[2] });
  }
  return key;
}

std::unique_ptr<vtkMediumRayCaster::Scene> vtkMediumRayCaster::MakeScene(vtkInformationVector** inputs,
  const tyndall::InputsKey& key, tyndall::ViewSettings settings, const tyndall::GridBlock* block)
{
  using tyndall::Need;
  vtkImageData* const image = vtkImageData::GetData(inputs[MEDIUM]);
  const tyndall::MediumInput input = tyndall::ReadMedium(this, image);
  const auto read = [&](int number, tyndall::Components components) {
    return tyndall::ReadChosenCells(this, number, image, ArrayNames[number], Need::Optional, components);
  };
  const tyndall::FloatField fluence = read(Fluence, { 1, 3 });
  const tyndall::FloatField direct = read(FluenceDirect, { 1, 3 });
  const tyndall::FloatField ior = read(RefractiveIndex, { 1 });
  const tyndall::FloatField meanDirection = read(MeanDirection, { 3 });
  // It belongs to the array that the solver wrote.
  const bool asSolved = fluence.IsThere() &&
    tyndall::ChosenArray(this, Fluence, image, ArrayNames[Fluence]) == image->GetCellData()->GetArray("fluence");
  const tyndall::MomentsInput moments = asSolved ? tyndall::ReadMoments(image) : tyndall::MomentsInput();
  const LightAtFaces faces = asSolved ? LightAtFaces(image, input.medium.grid, block) : LightAtFaces();
  const tyndall::Illumination illumination = this->ReadIllumination(inputs);
  auto scene = std::make_unique<Scene>();
  const bool sky = !illumination.environment.Empty() || illumination.sky != tyndall::Rgb{};
  if (!fluence.IsThere() && illumination.lights.empty() && !input.emission.IsThere() && !(sky && ior.IsThere()))
  {
    scene->doubts.emplace_back("The medium is dark: it has no array fluence (a solver makes it, e.g. "
                               "LightPropagationMaps), there are no Lights, and it does not emit.");
  }
  scene->key = key;
  scene->grid = input.medium.grid;
  scene->lightsAlone = !fluence.IsThere() && !illumination.lights.empty();
  settings.shadowRays |= scene->lightsAlone;
  tyndall::SolvedLight light = { fluence, direct, meanDirection };
  faces.AddTo(light);
  light.scatteredMoments = moments.moments;
  light.straightOn = moments.straightOn;
  light.lampsApart = moments.lampsApart;
  scene->caster =
    std::make_unique<tyndall::MediumRayCaster>(*key.device, input.medium, light, illumination, settings, ior);
  const std::vector<std::string>& warnings = scene->caster->Warnings();
  scene->doubts.insert(scene->doubts.end(), warnings.begin(), warnings.end());
  scene->made.Modified();
  return scene;
}

std::unique_ptr<vtkMediumRayCaster::Scene> vtkMediumRayCaster::FindScene(
  vtkInformationVector** inputs, const tyndall::ViewSettings& settings, const tyndall::GridBlock* block)
{
  this->SceneKept = false;
  this->ForgetOldScene();
  std::unique_ptr<Scene> kept = std::move(this->Kept); // it comes back after a good picture
  const tyndall::InputsKey key = this->KeyOf(inputs, block);
  if (kept && kept->key == key)
  {
    tyndall::ViewSettings asked = settings;
    asked.shadowRays |= kept->lightsAlone;
    this->SceneKept = kept->caster->Adopt(asked);
  }
  if (this->SceneKept)
  {
    return kept;
  }
  kept.reset(); // before the next one needs the memory
  return this->MakeScene(inputs, key, settings, block);
}

/// Once for a scene.
void vtkMediumRayCaster::SayDoubts(Scene& scene)
{
  for (const std::string& doubt : std::exchange(scene.doubts, {}))
  {
    vtkWarningMacro(<< doubt);
  }
}

/// What comes of an update.
struct vtkMediumRayCaster::Shot
{
  std::unique_ptr<Scene> scene;  ///< null where ranks have a block each, and this one has none
  tyndall::Picture picture;      ///< or the part that is asked for
  std::array<int, 2> first = {}; ///< column and row of its first pixel
  double exposure = 0.0;
  double seconds = 0.0;
  std::vector<std::string> leftOut;
};

/// How pictures of the filter's own camera are made, on one rank or on several together.
struct vtkMediumRayCaster::Taking
{
  std::function<tyndall::Picture()> take;
  std::function<double(const tyndall::Picture&)> exposureOf;
  std::function<bool(bool)> onAnyRank;
};

/// @param shot  its exposure is what the picture will be shown with; where that is 0 it is chosen, from a picture
///   without BackgroundColor
void vtkMediumRayCaster::Expose(const Taking& taking, Shot& shot)
{
  const double start = tyndall::ClockSeconds();
  shot.picture = taking.take();
  if (shot.exposure == 0.0)
  {
    shot.exposure = taking.exposureOf(shot.picture);
    tyndall::ViewSettings settings = SettingsOf(this, shot.exposure);
    const bool shows =
      shot.scene && shot.scene->caster->ShowsBackgroundColor() && settings.backgroundColor != BackgroundOf(this, 0.0);
    if (taking.onAnyRank(shows))
    {
      if (shot.scene)
      {
        settings.shadowRays |= shot.scene->lightsAlone;
        shot.scene->caster->Adopt(settings);
      }
      shot.picture = taking.take();
    }
  }
  shot.seconds = tyndall::ClockSeconds() - start;
}

/// @param exposure  0: automatic
vtkMediumRayCaster::Shot vtkMediumRayCaster::SeeWhole(vtkInformationVector** inputs, double exposure)
{
  Shot shot;
  shot.exposure = exposure;
  shot.scene = this->FindScene(inputs, SettingsOf(this, exposure));
  this->SayDoubts(*shot.scene);
  const tyndall::Camera camera = CameraOf(this, shot.scene->grid);
  Taking taking;
  taking.take = [&] { return shot.scene->caster->Render(camera, tyndall::MonitorOf(this)); };
  taking.exposureOf = [](const tyndall::Picture& picture) { return tyndall::AutomaticExposure(picture.radiance); };
  taking.onAnyRank = [](bool own) { return own; };
  this->Expose(taking, shot);
  shot.leftOut = shot.scene->caster->LeftOut();
  this->NeedsWhole = !shot.scene->caster->CastsBlocksExactly();
  return shot;
}

/// What has to be the same on all ranks that make a picture together.
std::vector<double> vtkMediumRayCaster::PropertiesAsNumbers()
{
  std::vector<double> numbers = { this->CameraViewAngle, this->CameraParallelProjection ? 1.0 : 0.0,
    this->CameraParallelScale, this->StepSize, this->SingleScatteringOnly ? 1.0 : 0.0, this->ShadowRays ? 1.0 : 0.0,
    this->ShowBackground ? 1.0 : 0.0, this->Exposure, this->FirstExposure, this->SurfaceIndex, this->SurfaceReflectance,
    this->TableReflectance, this->LeaveOut ? 1.0 : 0.0, this->EnvironmentAzimuth };
  for (int number : { this->ImageSize[0], this->ImageSize[1], this->Quality, this->RectangleSamples, this->AutoExposure,
         this->ToneCurve, this->SurfaceReflection, this->TableFace, this->EnvironmentUp })
  {
    numbers.push_back(number);
  }
  for (const double* triple : { this->CameraPosition, this->CameraFocalPoint, this->CameraViewUp, this->BackgroundColor,
         this->BackgroundRadiance, this->TableColor })
  {
    numbers.insert(numbers.end(), triple, triple + 3);
  }
  return numbers;
}

/// The picture of ranks that have a piece of the medium each, with a layer of their neighbours' cells, where pictures
/// of pieces make up that of the whole.
/// @param inputs  the others are whole
/// @param asked   pixels of the picture that are asked for of this rank
/// @return the part with them; none, on all ranks, where the whole is needed
std::optional<vtkMediumRayCaster::Shot> vtkMediumRayCaster::SeeBlocks(
  vtkMultiProcessController* ranks, tyndall::WholeInputs& inputs, double exposure, const std::array<int, 6>& asked)
{
  const tyndall::BlocksOfRanks blocks = SurroundedBlocks(ranks, inputs);
  vtkImageData* const image = vtkImageData::GetData(inputs.Vectors()[MEDIUM]);
  Shot shot;
  shot.exposure = exposure;
  tyndall::BlockToCast own;
  own.ofFilter = this->PropertiesAsNumbers();
  own.able = true;
  if (blocks.HasOwn() && blocks.MakeUpTheWhole() && blocks.HaveLayers())
  {
    // What is wrong with it will be said of the whole.
    const tyndall::Ending found = tyndall::EndingOf([&] {
      own.ofArrays = ArraysInANumber(this, image);
      shot.scene = this->FindScene(inputs.Vectors(), SettingsOf(this, exposure), &blocks.Own());
      own.ofBlocks = shot.scene->caster->SharedByBlocks();
    });
    own.able = found.kind == tyndall::Ending::Done && shot.scene->caster->CastsBlocksExactly();
  }
  if (!tyndall::CanCast(ranks, blocks, own))
  {
    return std::nullopt;
  }
  if (shot.scene)
  {
    this->SayDoubts(*shot.scene);
  }
  const tyndall::PixelRect counted = tyndall::OwnPixels(ranks, WholePicture(this));
  const tyndall::PixelRect part = tyndall::Around(tyndall::RectOf(asked), counted);
  const tyndall::PictureOfBlocks picture(
    ranks, this, blocks, CameraOf(this, blocks.Whole()), { this->ImageSize[0], this->ImageSize[1] }, part, counted);
  Taking taking;
  taking.take = [&] { return picture.Take(shot.scene ? shot.scene->caster.get() : nullptr); };
  taking.exposureOf = [&](const tyndall::Picture& taken) { return picture.Exposure(taken); };
  taking.onAnyRank = [&](bool here) { return tyndall::OnAnyRank(ranks, here); };
  this->Expose(taking, shot);
  shot.first = part.begin;
  shot.leftOut = tyndall::OnAllLists(
    ranks, shot.scene ? shot.scene->caster->LeftOut() : std::vector<std::string>(), shot.scene != nullptr);
  this->NeedsWhole = false;
  return shot;
}

void vtkMediumRayCaster::HandOn(Shot&& shot, vtkInformationVector* outputs)
{
  tyndall::ToneMapping toneMapping;
  toneMapping.exposure = shot.exposure;
  toneMapping.curve = static_cast<tyndall::ToneCurve>(this->ToneCurve);
  const std::vector<float> opaque;
  auto color = tyndall::ToneMap(shot.picture.radiance, this->ShowBackground ? opaque : shot.picture.alpha, toneMapping);
  vtkImageData* const output = vtkImageData::GetData(outputs);
  if (shot.picture.width > 0) // else nothing is asked for of this rank
  {
    WritePicture(std::move(shot.picture), shot.first, std::move(color), output);
  }
  const std::string device = tyndall::FindWithin(this->Within, this->Device, this->MemoryBudget)->Name();
  const std::vector<std::string> settings = tyndall::Words(SettingsOf(this, shot.exposure));
  tyndall::AddFact(output, "exposure", std::vector<double>{ shot.exposure });
  tyndall::AddFact(output, "left_out", shot.leftOut);
  tyndall::AddFact(output, "settings_used", settings);
  tyndall::AddFact(output, "device", std::vector<std::string>{ device });
  tyndall::KeepWhatIsAskedFor(outputs->GetInformationObject(0), output);

  this->UsedExposure = shot.exposure;
  this->DeviceName = device;
  this->LeftOut = tyndall::Lines(shot.leftOut);
  this->SettingsUsed = tyndall::Lines(settings);
  this->Kept = std::move(shot.scene);
  this->Seconds = shot.seconds;
}

int vtkMediumRayCaster::RequestData(
  vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->Seconds = this->UsedExposure = 0.0;
  this->SceneKept = false;
  this->DeviceName.clear();
  this->LeftOut.clear();
  this->SettingsUsed.clear();
  const auto work = [&](vtkMultiProcessController* ranks, tyndall::WholeInputs& inputs) {
    const bool automatic = this->Exposure == 0.0;
    const double exposure = automatic && this->AutoExposure == FIRST_PICTURE ? this->FirstExposure : this->Exposure;
    const std::array<int, 6> asked = tyndall::ExtentAskedFor(outputs->GetInformationObject(0), WholePicture(this));
    std::optional<Shot> shot;
    if (ranks)
    {
      shot = this->SeeBlocks(ranks, inputs, exposure, asked);
    }
    if (!shot)
    {
      inputs.MakeWhole();
      shot = this->SeeWhole(inputs.Vectors(), exposure);
    }
    if (automatic || this->AutoExposure == EACH_PICTURE)
    {
      this->FirstExposure = this->AutoExposure == FIRST_PICTURE ? shot->exposure : 0.0;
    }
    this->HandOn(std::move(*shot), outputs);
  };
  return tyndall::GuardedInPieces(this, request, given, outputs, MEDIUM, work);
}

bool vtkMediumRayCaster::See(const tyndall::AskedView& view, tyndall::Picture& picture)
{
  bool seen = false;
  const vtkNew<vtkInformationVector> noOutputs;
  tyndall::Guarded(this, noOutputs, [&] {
    tyndall::ViewSettings settings = SettingsOf(this, view.exposure);
    settings.imageSize = view.size;
    const tyndall::GridBlock* const block = view.block ? &*view.block : nullptr;
    std::unique_ptr<Scene> scene = this->FindScene(this->GetExecutive()->GetInputInformation(), settings, block);
    this->SayDoubts(*scene);
    seen = !block || scene->caster->CastsBlocks();
    if (seen)
    {
      picture = scene->caster->Render(view.camera, {}, view.ends, block);
    }
    this->Kept = std::move(scene);
  });
  return seen;
}

void vtkMediumRayCaster::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Quality: " << this->Quality << "\n";
  os << indent << "ImageSize: " << this->ImageSize[0] << " " << this->ImageSize[1] << "\n";
  PrintNumbers(os, indent, "CameraPosition", this->CameraPosition, 3);
  PrintNumbers(os, indent, "CameraFocalPoint", this->CameraFocalPoint, 3);
  PrintNumbers(os, indent, "CameraViewUp", this->CameraViewUp, 3);
  os << indent << "CameraViewAngle: " << this->CameraViewAngle << "\n";
  os << indent << "CameraParallelProjection: " << this->CameraParallelProjection << "\n";
  os << indent << "CameraParallelScale: " << this->CameraParallelScale << "\n";
  os << indent << "StepSize: " << this->StepSize << "\n";
  os << indent << "SingleScatteringOnly: " << this->SingleScatteringOnly << "\n";
  os << indent << "ShadowRays: " << this->ShadowRays << "\n";
  os << indent << "RectangleSamples: " << this->RectangleSamples << "\n";
  os << indent << "ShowBackground: " << this->ShowBackground << "\n";
  PrintNumbers(os, indent, "BackgroundColor", this->BackgroundColor, 3);
  PrintNumbers(os, indent, "BackgroundRadiance", this->BackgroundRadiance, 3);
  os << indent << "Exposure: " << this->Exposure << "\n";
  os << indent << "AutoExposure: " << this->AutoExposure << "\n";
  os << indent << "ToneCurve: " << (this->ToneCurve == LINEAR ? "linear" : "filmic") << "\n";
  os << indent << "SurfaceReflection: " << this->SurfaceReflection << "\n";
  os << indent << "SurfaceIndex: " << this->SurfaceIndex << "\n";
  os << indent << "SurfaceReflectance: " << this->SurfaceReflectance << "\n";
  os << indent << "TableFace: " << this->TableFace << "\n";
  PrintNumbers(os, indent, "TableColor", this->TableColor, 3);
  os << indent << "TableReflectance: " << this->TableReflectance << "\n";
  os << indent << "LeaveOut: " << this->LeaveOut << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
  os << indent << "UsedExposure: " << this->UsedExposure << "\n";
  os << indent << "SceneKept: " << this->SceneKept << "\n";
  os << indent << "MemoryBudget: " << this->MemoryBudget << "\n";
  os << indent << "DeviceName: " << this->DeviceName << "\n";
  os << indent << "LeftOut: " << this->LeftOut << "\n";
  os << indent << "SettingsUsed: " << this->SettingsUsed << "\n";
}
