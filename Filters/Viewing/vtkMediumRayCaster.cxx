#include "vtkMediumRayCaster.h"

#include "BlocksOfRanks.h"
#include "CasterProperties.h"
#include "CasterScene.h"
#include "Common/ArrayRanges.h"
#include "Common/AvailableMemory.h"
#include "Common/Failure.h"
#include "Common/InputsKey.h"
#include "Common/LightTransportData.h"
#include "Common/LightTransportWriting.h"
#include "Common/PhaseFunctionData.h"
#include "Common/PrintMembers.h"
#include "Device/Device.h"
#include "Pieces/ControllerCommunicator.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"
#include "Pieces/WholeInputs.h"
#include "Viewing/Blocks/PictureInBlocks.h"
#include "Viewing/PictureError.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/ToneMapping.h"

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
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace
{
std::array<int, 6> WholePicture(vtkMediumRayCaster* filter)
{
  return { 0, filter->GetImageSize()[0] - 1, 0, filter->GetImageSize()[1] - 1, 0, 0 };
}

/// Writes a picture as an image: point data `color` (red, green, blue, alpha), `radiance`, `alpha`, `depth`, and
/// `picture_error` if the picture has it.
/// @param first  column and row of the picture's first pixel in the whole picture
/// @throws InvalidInput if a pixel is not finite; the message names it
void WritePicture(
  tyndall::Picture&& picture, const std::array<int, 2>& first, std::vector<std::uint8_t>&& color, vtkImageData* output)
{
  output->SetExtent(first[0], first[0] + picture.width - 1, first[1], first[1] + picture.height - 1, 0, 0);
  output->SetOrigin(0.0, 0.0, 0.0);
  output->SetSpacing(1.0, 1.0, 1.0);
  output->SetDirectionMatrix(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
  vtkPointData* const pixels = output->GetPointData();
  const auto shown = tyndall::ArrayOf<vtkUnsignedCharArray>("color", std::move(color), 4);
  tyndall::LeaveRanges(shown);
  pixels->SetScalars(shown);
  const auto pixelName = [&first, width = static_cast<std::size_t>(picture.width)](std::size_t pixel) {
    return "pixel (" + std::to_string(first[0] + pixel % width) + ", " + std::to_string(first[1] + pixel / width) +
      ") from below";
  };
  for (const auto& [name, values, components] :
    { std::tuple("radiance", &picture.radiance, 3), std::tuple("alpha", &picture.alpha, 1),
      std::tuple("depth", &picture.depth, 1), std::tuple("picture_error", &picture.error, 3) })
  {
    if (values->empty())
    {
      continue;
    }
    const tyndall::ArrayRanges ranges =
      tyndall::RequireFinite(name, values->data(), values->size(), components, pixelName);
    const auto array = tyndall::ArrayOf<vtkFloatArray>(name, std::move(*values), components);
    tyndall::LeaveRanges(ranges, array);
    pixels->AddArray(array);
  }
}
}

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

int vtkMediumRayCaster::FillInputPortInformation(int port, vtkInformation* information)
{
  const int done = this->Superclass::FillInputPortInformation(port, information);
  if (port == MEDIUM)
  {
    const auto& names = tyndall::ViewedNames;
    tyndall::ReadsVoxels(
      information, { names[0], names[1], names[2], names[3], names[4], names[5], names[6] }, { "g" });
  }
  return done;
}

int vtkMediumRayCaster::FillOutputPortInformation(int port, vtkInformation* information)
{
  tyndall::TakePictures(information);
  return this->Superclass::FillOutputPortInformation(port, information);
}

int vtkMediumRayCaster::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkInformation* information = outputs->GetInformationObject(0);
  const int extent[6] = { 0, std::max(this->ImageSize[0], 1) - 1, 0, std::max(this->ImageSize[1], 1) - 1, 0, 0 };
  const double origin[3] = { 0.0, 0.0, 0.0 };
  const double spacing[3] = { 1.0, 1.0, 1.0 };
  information->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  information->Set(vtkDataObject::ORIGIN(), origin, 3);
  information->Set(vtkDataObject::SPACING(), spacing, 3);
  // The picture has no direction matrix; the one that is removed was copied from the medium.
  information->Remove(vtkDataObject::DIRECTION());
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

/// Frees the device memory of a cached scene that is out of date before upstream filters run. In a parallel pipeline
/// each rank requests its piece of the medium with one layer of ghost cells.
int vtkMediumRayCaster::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->ForgetOldScene();
  const int done = this->Superclass::RequestUpdateExtent(request, inputs, outputs);
  tyndall::AskForPiece(request, inputs[MEDIUM], outputs);
  return done;
}

tyndall::InputsKey vtkMediumRayCaster::KeyOf(vtkInformationVector** inputs, const tyndall::SceneSource& source)
{
  const tyndall::GridBlock* const block = source.Block();
  tyndall::InputsKey key;
  key.device = tyndall::FindWithin(this->Within, this->Device, this->MemoryBudget);
  vtkImageData* const image = vtkImageData::GetData(inputs[MEDIUM]);
  key.Add(tyndall::GridOf(image));
  key.AddGhosts(image);
  key.Add({ source.alone ? 1.0 : 0.0, block ? 1.0 : 0.0 });
  for (int axis = 0; block && axis < 3; ++axis)
  {
    key.Add(
      { 1.0 * block->first[axis], 1.0 * block->whole.size[axis], 1.0 * block->begin[axis], 1.0 * block->end[axis] });
  }
  if (!source.Over().IsSerial())
  {
    // If surfaces reflect, the halo of a block depends on the step size, which is then part of the cache key.
    const bool reflects = source.settings.surfaceReflection != tyndall::SurfaceReflection::None;
    key.Add({ reflects ? source.settings.stepSize : 0.0 });
  }
  tyndall::AddPhase(key, image);
  key.Add({ 1.0 * this->EnvironmentUp, this->EnvironmentAzimuth });
  const std::vector<double> axes = tyndall::OwnAxesOf(this).Words();
  key.numbers.insert(key.numbers.end(), axes.begin(), axes.end());
  for (int number = tyndall::SigmaA; number < tyndall::ViewedArrayCount; ++number)
  {
    key.Add(tyndall::ChosenArray(this, number, image, tyndall::ViewedNames[number]));
  }
  for (const char* fact : tyndall::FaceFacts)
  {
    key.Add(image->GetFieldData()->GetArray(fact));
  }
  key.Add(image->GetCellData()->GetArray(tyndall::MomentsArray));
  key.Add(image->GetCellData()->GetArray(tyndall::StraightOnArray));
  key.Add(image->GetFieldData()->GetArray(tyndall::LampsApartFact));
  key.Add({ this->EstimateError ? 1.0 : 0.0 });
  key.Add(this->EstimateError ? image->GetCellData()->GetArray(tyndall::FluenceErrorArray) : nullptr);
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

/// Takes the scene of the last picture out of the cache, which stays empty until the next picture succeeds.
/// @return the scene if it is valid for the inputs and settings, else null
std::unique_ptr<tyndall::CasterScene> vtkMediumRayCaster::TakeKept(
  const tyndall::InputsKey& key, const tyndall::ViewSettings& settings)
{
  std::unique_ptr<tyndall::CasterScene> kept = std::move(this->Kept);
  bool stays = kept && kept->key == key;
  if (stays)
  {
    tyndall::ViewSettings asked = settings;
    asked.shadowRays |= kept->lightsAlone;
    stays = kept->Adopt(asked);
  }
  return stays ? std::move(kept) : nullptr;
}

/// Returns the cached scene, if it is valid on all ranks with a block, or prepares a new one. Collective.
/// @return null if this rank has no block
std::unique_ptr<tyndall::CasterScene> vtkMediumRayCaster::FindScene(
  vtkInformationVector** inputs, const tyndall::SceneSource& source)
{
  this->SceneKept = false;
  this->ForgetOldScene();
  const tyndall::Domain& domain = source.Over();
  tyndall::InputsKey key;
  std::unique_ptr<tyndall::CasterScene> scene;
  domain.Collective([&] {
    if (!domain.IsEmpty())
    {
      key = this->KeyOf(inputs, source);
      scene = this->TakeKept(key, source.settings);
    }
  });
  if (!domain.Any(!domain.IsEmpty() && !scene))
  {
    this->SceneKept = true;
    return scene;
  }
  scene.reset(); // frees device memory before the new scene is prepared
  tyndall::Illumination illumination;
  domain.Collective([&] { illumination = this->ReadIllumination(inputs); });
  return tyndall::MakeScene(source, key, illumination);
}

bool vtkMediumRayCaster::SeesRadianceBehind()
{
  const double* const behind = this->BackgroundRadiance;
  return this->ShowBackground &&
    (this->GetNumberOfInputConnections(ENVIRONMENT) > 0 || behind[0] > 0.0 || behind[1] > 0.0 || behind[2] > 0.0);
}

/// Issues the warnings of a scene and removes them, so that each is issued once.
void vtkMediumRayCaster::SayDoubts(tyndall::CasterScene& scene)
{
  for (const std::string& doubt : std::exchange(scene.doubts, {}))
  {
    vtkWarningMacro(<< doubt);
  }
}

/// Result of rendering one picture.
struct vtkMediumRayCaster::Shot
{
  std::unique_ptr<tyndall::CasterScene> scene; ///< null if the medium is distributed and this rank has no block
  tyndall::Picture picture;                    ///< the whole picture, or the part that this rank needs
  std::array<int, 2> first = {};               ///< column and row of the first pixel of `picture`
  double exposure = 0.0;
  std::vector<std::string> leftOut;
};

/// Whether the ranks can render their pieces together (FitTogether). Collective.
bool vtkMediumRayCaster::PiecesFit(const tyndall::BlocksOfRanks& blocks, vtkImageData* image)
{
  double arrays = 0.0;
  const tyndall::Ending ending = tyndall::EndingOf([&] {
    if (blocks.MakeUpTheWhole() && blocks.HasOwn())
    {
      arrays = tyndall::ArraysInANumber(this, image);
    }
  });
  std::vector<double> properties = tyndall::PropertiesAsNumbers(this);
  properties.push_back(this->FirstExposure);
  return tyndall::FitTogether(blocks, ending.kind == tyndall::Ending::Done, std::move(properties), arrays);
}

/// Renders the medium, distributed over ranks or complete on one rank. Chooses the exposure if `exposure` is 0, from a
/// picture without BackgroundColor. Collective.
/// @param inputs  inputs of the filter: this rank's piece of the medium, and the complete other inputs
/// @param exposure  factor by which radiance is multiplied; 0: automatic
/// @param asked   extent of the picture that is requested from this rank
/// @return a part of the picture that contains that extent; nothing, on all ranks, if the pieces cannot be rendered
///   together: the caller then renders the whole medium, which reports errors
std::optional<vtkMediumRayCaster::Shot> vtkMediumRayCaster::See(
  const tyndall::BlocksOfRanks& blocks, vtkInformationVector** inputs, double exposure, const std::array<int, 6>& asked)
{
  vtkImageData* const image = vtkImageData::GetData(inputs[MEDIUM]);
  if (!blocks.Over().IsSerial() && !this->PiecesFit(blocks, image))
  {
    return std::nullopt;
  }
  const tyndall::Domain& domain = blocks.Over();
  Shot shot;
  shot.exposure = exposure;
  shot.scene = this->FindScene(inputs, { this, image, tyndall::SettingsOf(this, exposure), blocks });
  tyndall::MediumRayCaster* const caster = shot.scene ? shot.scene->caster.get() : nullptr;
  if (shot.scene)
  {
    this->SayDoubts(*shot.scene);
  }
  const tyndall::PixelRect counted = tyndall::OwnPixels(domain.Comm(), WholePicture(this));
  const tyndall::PixelRect part =
    tyndall::Around(tyndall::RectOf(this->EstimateError ? WholePicture(this) : asked), counted);
  const std::vector<tyndall::VoxelBox> held =
    shot.scene ? shot.scene->held : std::vector<tyndall::VoxelBox>(domain.Partition().blocks.size());
  tyndall::PictureInBlocks picture(domain, held, caster);
  const tyndall::Camera camera = tyndall::CameraOf(this, blocks.Whole());
  const auto take = [&] {
    shot.picture = picture.Take(camera, { this->ImageSize[0], this->ImageSize[1] }, part, tyndall::MonitorOf(this));
  };
  take();
  if (shot.exposure == 0.0)
  {
    const tyndall::PixelRect ofPart = { { counted.begin[0] - part.begin[0], counted.begin[1] - part.begin[1] },
      { counted.end[0] - part.begin[0], counted.end[1] - part.begin[1] } };
    shot.exposure = tyndall::ExposureOfParts(domain, shot.picture, ofPart, this->SeesRadianceBehind());
    tyndall::ViewSettings settings = tyndall::SettingsOf(this, shot.exposure);
    if (domain.Any(
          caster && caster->ShowsBackgroundColor() && settings.backgroundColor != tyndall::BackgroundOf(this, 0.0)))
    {
      if (caster)
      {
        settings.shadowRays |= shot.scene->lightsAlone;
        shot.scene->Adopt(settings);
      }
      take();
    }
  }
  shot.first = part.begin;
  shot.leftOut = caster ? caster->LeftOut() : std::vector<std::string>();
  if (this->EstimateError)
  {
    this->Estimate(domain, camera, shot);
  }
  shot.leftOut = tyndall::OnAllLists(domain.Comm(), shot.leftOut, caster != nullptr);
  return shot;
}

/// Estimates the error of the whole picture. Collective; all ranks compute the same.
void vtkMediumRayCaster::Estimate(const tyndall::Domain& domain, const tyndall::Camera& camera, Shot& shot)
{
  const tyndall::PictureErrorCasters* const error = shot.scene ? shot.scene->error.get() : nullptr;
  const std::vector<tyndall::VoxelBox> held =
    shot.scene ? shot.scene->held : std::vector<tyndall::VoxelBox>(domain.Partition().blocks.size());
  const auto render = [&](auto which, const tyndall::Camera& seenBy, const std::array<int, 2>& size) {
    tyndall::MediumRayCaster* const own = error ? (error->*which).get() : nullptr;
    return domain.Any(own != nullptr)
      ? tyndall::PictureInBlocks(domain, held, own).Take(seenBy, size, { { 0, 0 }, size }, tyndall::MonitorOf(this))
      : tyndall::Picture();
  };
  tyndall::EstimatePictureError(shot.picture, camera, render);
  if (error && !error->lightLeftOut.empty())
  {
    shot.leftOut.push_back(error->lightLeftOut);
  }
}

void vtkMediumRayCaster::CropToRequest(Shot&& shot, vtkInformationVector* outputs)
{
  tyndall::ToneMapping toneMapping;
  toneMapping.exposure = shot.exposure;
  toneMapping.curve = static_cast<tyndall::ToneCurve>(this->ToneCurve);
  const std::vector<float> opaque;
  auto color = tyndall::ToneMap(shot.picture.radiance, this->ShowBackground ? opaque : shot.picture.alpha, toneMapping);
  vtkImageData* const output = vtkImageData::GetData(outputs);
  this->EstimatedError = shot.picture.relativeError;
  if (shot.picture.width > 0) // false if no pixels are requested from this rank
  {
    WritePicture(std::move(shot.picture), shot.first, std::move(color), output);
  }
  const std::string device = tyndall::FindWithin(this->Within, this->Device, this->MemoryBudget)->Name();
  std::vector<std::string> settings = tyndall::Words(tyndall::SettingsOf(this, shot.exposure));
  tyndall::AddAveraged(this, settings);
  tyndall::AddFact(output, "exposure", std::vector<double>{ shot.exposure });
  tyndall::TellLeftOut(this, output, shot.leftOut);
  tyndall::AddFact(output, "settings_used", settings);
  tyndall::AddFact(output, "device", std::vector<std::string>{ device });
  tyndall::KeepWhatIsAskedFor(outputs->GetInformationObject(0), output);

  this->UsedExposure = shot.exposure;
  this->DeviceName = device;
  this->SettingsUsed = tyndall::Lines(settings);
  this->Kept = std::move(shot.scene);
}

int vtkMediumRayCaster::RequestData(
  vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->UsedExposure = 0.0;
  this->EstimatedError = 0.0;
  this->SceneKept = false;
  this->DeviceName.clear();
  this->SettingsUsed.clear();
  const auto work = [&](vtkMultiProcessController* ranks, tyndall::WholeInputs& inputs) {
    const bool automatic = this->Exposure == 0.0;
    const double exposure = automatic && this->AutoExposure == FIRST_PICTURE ? this->FirstExposure : this->Exposure;
    const std::array<int, 6> asked = tyndall::ExtentAskedFor(outputs->GetInformationObject(0), WholePicture(this));
    const auto medium = [&] { return vtkImageData::GetData(inputs.Vectors()[MEDIUM]); };
    std::optional<Shot> shot;
    if (ranks)
    {
      const std::unique_ptr<tyndall::Communicator> communicator =
        tyndall::CommunicatorOf(ranks, [this] { return tyndall::IsStoppedByOthers(this); });
      shot = this->See(tyndall::BlocksOfRanks(*communicator, medium()), inputs.Vectors(), exposure, asked);
    }
    if (!shot)
    {
      inputs.MakeWhole();
      shot = this->See(tyndall::BlocksOfRanks(medium()), inputs.Vectors(), exposure, WholePicture(this));
    }
    if (automatic || this->AutoExposure == EACH_PICTURE)
    {
      this->FirstExposure = this->AutoExposure == FIRST_PICTURE ? shot->exposure : 0.0;
    }
    this->CropToRequest(std::move(*shot), outputs);
  };
  return tyndall::GuardedInPieces(this, request, given, outputs, MEDIUM, work);
}

bool vtkMediumRayCaster::See(const tyndall::AskedView& view, tyndall::Picture& picture)
{
  bool seen = false;
  const vtkNew<vtkInformationVector> noOutputs;
  tyndall::Guarded(this, noOutputs, [&] {
    tyndall::ViewSettings settings = tyndall::SettingsOf(this, view.exposure);
    settings.imageSize = view.size;
    const tyndall::GridBlock* const block = view.block ? &*view.block : nullptr;
    vtkInformationVector** const given = this->GetExecutive()->GetInputInformation();
    std::vector<vtkInformationVector*> ports(given, given + this->GetNumberOfInputPorts());
    const vtkNew<vtkInformationVector> medium;
    vtkImageData* const image = vtkImageData::GetData(given[MEDIUM]);
    tyndall::OwnAxes axes;
    if (image)
    {
      vtkSmartPointer<vtkImageData> voxels = block ? vtkSmartPointer<vtkImageData>(image) : tyndall::Aligned(image);
      axes = tyndall::OwnAxesOf(voxels.GetPointer());
      voxels = tyndall::InOwnAxes(voxels, axes, this, MEDIUM);
      voxels = !block && tyndall::AreAroundPoints(this, MEDIUM, voxels) ? tyndall::PointsAsVoxels(voxels) : voxels;
      const vtkNew<vtkInformation> asVoxels;
      asVoxels->Set(vtkDataObject::DATA_OBJECT(), voxels);
      medium->Append(asVoxels);
      ports[MEDIUM] = medium;
    }
    tyndall::NoteOwnAxes(this, axes);
    const tyndall::BlocksOfRanks alone(vtkImageData::GetData(ports[MEDIUM]));
    std::unique_ptr<tyndall::CasterScene> scene =
      this->FindScene(ports.data(), { this, vtkImageData::GetData(ports[MEDIUM]), settings, alone, block });
    this->SayDoubts(*scene);
    seen = !block || scene->caster->CastsBlocks();
    if (seen)
    {
      picture = scene->caster->Render(tyndall::InOwnAxes(view.camera, axes), {}, view.ends, block);
    }
    this->Kept = std::move(scene);
  });
  return seen;
}

void vtkMediumRayCaster::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(Device, Quality, ImageSize, CameraPosition, CameraFocalPoint, CameraViewUp, CameraViewAngle,
    CameraParallelProjection, CameraParallelScale, StepSize, EstimateError, SingleScatteringOnly, ShadowRays,
    RectangleSamples, ShowBackground, BackgroundColor, BackgroundRadiance, Exposure, AutoExposure);
  os << indent << "ToneCurve: " << (this->ToneCurve == LINEAR ? "linear" : "filmic") << "\n";
  tyndallPrintMacro(SurfaceReflection, SurfaceIndex, SurfaceReflectance, TableFace, TableColor, TableReflectance,
    LeaveOut, UsedExposure, EstimatedError, SceneKept, MemoryBudget, DeviceName, SettingsUsed);
  tyndall::PrintRun(os, indent, this);
}
