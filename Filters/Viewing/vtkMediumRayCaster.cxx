#include "vtkMediumRayCaster.h"

#include "AskedView.h"
#include "BlocksOfRanks.h"
#include "CasterProperties.h"
#include "CasterScene.h"
#include "Common/AvailableMemory.h"
#include "Common/Failure.h"
#include "Common/InputsKey.h"
#include "Common/LightTransportData.h"
#include "Common/PhaseFunctionData.h"
#include "Common/PrintMembers.h"
#include "Device/Clock.h"
#include "Device/Device.h"
#include "PictureOfBlocks.h"
#include "PictureWriting.h"
#include "Pieces/ControllerCommunicator.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"
#include "Pieces/WholeInputs.h"
#include "ViewedInputs.h"
#include "Viewing/Blocks/PictureInBlocks.h"
#include "Viewing/MediumRayCaster.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/ToneMapping.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace
{
std::array<int, 6> WholePicture(vtkMediumRayCaster* filter)
{
  return { 0, filter->GetImageSize()[0] - 1, 0, filter->GetImageSize()[1] - 1, 0, 0 };
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
  information->Remove(vtkDataObject::DIRECTION()); // the medium's
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

/// Frees the device memory of an old scene before upstream filters run, which may need it. In a parallel pipeline each
/// rank asks for its piece of the medium.
int vtkMediumRayCaster::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->ForgetOldScene();
  const int done = this->Superclass::RequestUpdateExtent(request, inputs, outputs);
  tyndall::AskForPiece(request, inputs[MEDIUM], outputs);
  return done;
}

tyndall::InputsKey vtkMediumRayCaster::KeyOf(vtkInformationVector** inputs, Use use, const tyndall::GridBlock* block)
{
  tyndall::InputsKey key;
  key.device = tyndall::FindWithin(this->Within, this->Device, this->MemoryBudget);
  vtkImageData* const image = vtkImageData::GetData(inputs[MEDIUM]);
  key.Add(tyndall::GridOf(image));
  key.AddGhosts(image);
  key.Add({ static_cast<double>(use) });
  for (int axis = 0; block && axis < 3; ++axis)
  {
    key.Add(
      { 1.0 * block->first[axis], 1.0 * block->whole.size[axis], 1.0 * block->begin[axis], 1.0 * block->end[axis] });
  }
  tyndall::AddPhase(key, image);
  key.Add({ 1.0 * this->EnvironmentUp, this->EnvironmentAzimuth });
  const std::vector<double> axes = tyndall::OwnAxesOf(this).Words();
  key.numbers.insert(key.numbers.end(), axes.begin(), axes.end());
  for (int number = tyndall::SigmaA; number < tyndall::ViewedArrayCount; ++number)
  {
    key.Add(tyndall::ChosenArray(this, number, image, tyndall::ViewedNames[number]));
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

/// @return the cached scene of the last picture if it is still valid for the inputs, else null. The cache is then empty
///   until the next picture succeeds.
std::unique_ptr<tyndall::CasterScene> vtkMediumRayCaster::TakeKept(
  const tyndall::InputsKey& key, const tyndall::ViewSettings& settings)
{
  std::unique_ptr<tyndall::CasterScene> kept = std::move(this->Kept);
  bool stays = kept && kept->key == key;
  if (stays)
  {
    tyndall::ViewSettings asked = settings;
    asked.shadowRays |= kept->lightsAlone;
    stays = kept->caster->Adopt(asked);
  }
  return stays ? std::move(kept) : nullptr;
}

std::unique_ptr<tyndall::CasterScene> vtkMediumRayCaster::FindScene(
  vtkInformationVector** inputs, const tyndall::ViewSettings& settings, const tyndall::GridBlock* block)
{
  this->SceneKept = false;
  this->ForgetOldScene();
  const tyndall::InputsKey key = this->KeyOf(inputs, block ? Use::Piece : Use::Whole, block);
  if (std::unique_ptr<tyndall::CasterScene> kept = this->TakeKept(key, settings))
  {
    this->SceneKept = true;
    return kept;
  }
  vtkImageData* const image = vtkImageData::GetData(inputs[MEDIUM]);
  const tyndall::Grid grid = tyndall::GridOf(image);
  tyndall::ViewedInputs viewed = tyndall::ReadViewed(this, image, block ? block->whole : grid);
  if (block)
  {
    tyndall::KeepFacesOf(*block, grid.size, viewed);
  }
  return tyndall::MakeScene(viewed, viewed.ior, this->ReadIllumination(inputs), key, settings, nullptr);
}

bool vtkMediumRayCaster::SeesRadianceBehind()
{
  const double* const behind = this->BackgroundRadiance;
  return this->ShowBackground &&
    (this->GetNumberOfInputConnections(ENVIRONMENT) > 0 || behind[0] > 0.0 || behind[1] > 0.0 || behind[2] > 0.0);
}

/// Issues a scene's warnings, once.
void vtkMediumRayCaster::SayDoubts(tyndall::CasterScene& scene)
{
  for (const std::string& doubt : std::exchange(scene.doubts, {}))
  {
    vtkWarningMacro(<< doubt);
  }
}

/// Result of an update.
struct vtkMediumRayCaster::Shot
{
  std::unique_ptr<tyndall::CasterScene> scene; ///< null if ranks have one block each, and this rank has none
  tyndall::Picture picture;                    ///< the whole picture, or the part for this rank
  std::array<int, 2> first = {};               ///< column and row of its first pixel
  double exposure = 0.0;
  double seconds = 0.0;
  std::vector<std::string> leftOut;
};

/// Functions that render with the filter's own camera, serially or on several ranks together.
struct vtkMediumRayCaster::Taking
{
  std::function<tyndall::Picture()> take;
  std::function<double(const tyndall::Picture&)> exposureOf;
  std::function<bool(bool)> onAnyRank;
};

/// Renders the picture of a shot, and chooses its exposure if that is 0, from a picture without BackgroundColor.
/// @param shot  its exposure is that of the display; 0: automatic
void vtkMediumRayCaster::Expose(const Taking& taking, Shot& shot)
{
  const double start = tyndall::ClockSeconds();
  shot.picture = taking.take();
  if (shot.exposure == 0.0)
  {
    shot.exposure = taking.exposureOf(shot.picture);
    tyndall::ViewSettings settings = tyndall::SettingsOf(this, shot.exposure);
    const bool shows = shot.scene && shot.scene->caster->ShowsBackgroundColor() &&
      settings.backgroundColor != tyndall::BackgroundOf(this, 0.0);
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

/// Renders the whole medium on this rank.
/// @param exposure  0: automatic
vtkMediumRayCaster::Shot vtkMediumRayCaster::SeeWhole(vtkInformationVector** inputs, double exposure)
{
  Shot shot;
  shot.exposure = exposure;
  shot.scene = this->FindScene(inputs, tyndall::SettingsOf(this, exposure));
  this->SayDoubts(*shot.scene);
  const tyndall::Camera camera = tyndall::CameraOf(this, shot.scene->grid);
  Taking taking;
  taking.take = [&] { return shot.scene->caster->Render(camera, tyndall::MonitorOf(this)); };
  taking.exposureOf = [this](const tyndall::Picture& picture) {
    return tyndall::AutomaticExposure(
      picture.radiance, this->SeesRadianceBehind() ? std::vector<float>() : picture.alpha);
  };
  taking.onAnyRank = [](bool own) { return own; };
  this->Expose(taking, shot);
  shot.leftOut = shot.scene->caster->LeftOut();
  return shot;
}

/// Finds or prepares the scene of this rank's block. The cached scenes are reused on all ranks or on none. Collective.
std::unique_ptr<tyndall::CasterScene> vtkMediumRayCaster::FindSceneOfBlock(
  const tyndall::RankPieces& pieces, vtkInformationVector** inputs, std::vector<tyndall::VoxelBox>& held)
{
  this->SceneKept = false;
  this->ForgetOldScene();
  tyndall::InputsKey key;
  std::unique_ptr<tyndall::CasterScene> scene;
  pieces.communicator.Collective([&] {
    if (pieces.HasOwn())
    {
      key = this->KeyOf(inputs, Use::Block, &pieces.blocks.Own());
      // The width of the halo that a block needs depends on these settings.
      const bool reflects = pieces.settings.surfaceReflection != tyndall::SurfaceReflection::None;
      key.Add({ reflects ? pieces.settings.stepSize : 0.0 });
      scene = this->TakeKept(key, pieces.settings);
    }
  });
  if (tyndall::OnAnyRank(pieces.communicator, pieces.HasOwn() && !scene))
  {
    scene.reset(); // free its memory before the next one is prepared
    return tyndall::MakeSceneOfBlock(pieces, key, held);
  }
  this->SceneKept = true;
  held = scene ? scene->held : std::vector<tyndall::VoxelBox>(pieces.blocks.Given().size());
  return scene;
}

/// Renders with one piece of the medium per rank. Collective.
/// @param inputs  the medium's piece; the other inputs are whole
/// @param asked   extent of the picture that is requested from this rank
/// @return the part of the picture with that extent; nothing, on all ranks, if the pieces do not fit together:
///   rendering the whole then reports why
std::optional<vtkMediumRayCaster::Shot> vtkMediumRayCaster::SeeBlocks(
  vtkMultiProcessController* ranks, tyndall::WholeInputs& inputs, double exposure, const std::array<int, 6>& asked)
{
  vtkImageData* const image = vtkImageData::GetData(inputs.Vectors()[MEDIUM]);
  const std::unique_ptr<tyndall::Communicator> communicator =
    tyndall::CommunicatorOf(ranks, [this] { return tyndall::IsStoppedByOthers(this); });
  const tyndall::BlocksOfRanks blocks(*communicator, image);
  Shot shot;
  shot.exposure = exposure;
  tyndall::BlockToCast own;
  own.ofFilter = tyndall::PropertiesAsNumbers(this);
  own.ofFilter.push_back(this->FirstExposure);
  const bool has = blocks.MakeUpTheWhole() && blocks.HasOwn();
  own.able = tyndall::EndingOf([&] {
    if (has)
    {
      own.ofArrays = tyndall::ArraysInANumber(this, image);
    }
  }).kind == tyndall::Ending::Done;
  if (!tyndall::CanCast(*communicator, blocks, own))
  {
    return std::nullopt;
  }
  tyndall::Illumination illumination;
  communicator->Collective([&] { illumination = this->ReadIllumination(inputs.Vectors()); });
  const tyndall::RankPieces pieces = { this, *communicator, blocks, image, illumination,
    tyndall::SettingsOf(this, exposure) };
  std::vector<tyndall::VoxelBox> held;
  shot.scene = this->FindSceneOfBlock(pieces, inputs.Vectors(), held);
  tyndall::MediumRayCaster* const caster = shot.scene ? shot.scene->caster.get() : nullptr;
  own.ofBlocks = caster ? caster->SharedByBlocks() : own.ofBlocks;
  if (!tyndall::CanCast(*communicator, blocks, own))
  {
    return std::nullopt;
  }
  if (shot.scene)
  {
    this->SayDoubts(*shot.scene);
  }
  const tyndall::PixelRect counted = tyndall::OwnPixels(*communicator, WholePicture(this));
  const tyndall::PixelRect part = tyndall::Around(tyndall::RectOf(asked), counted);
  tyndall::PictureInBlocks ofBlock(*communicator, blocks.Partition(), held, caster);
  const tyndall::PictureOfBlocks picture({ *communicator, this, blocks, ofBlock, caster },
    tyndall::CameraOf(this, blocks.Whole()), { this->ImageSize[0], this->ImageSize[1] }, part, counted);
  Taking taking;
  taking.take = [&] { return picture.Take(); };
  taking.exposureOf = [&](
                        const tyndall::Picture& taken) { return picture.Exposure(taken, this->SeesRadianceBehind()); };
  taking.onAnyRank = [&](bool here) { return tyndall::OnAnyRank(*communicator, here); };
  this->Expose(taking, shot);
  shot.first = part.begin;
  shot.leftOut = tyndall::OnAllLists(
    *communicator, shot.scene ? shot.scene->caster->LeftOut() : std::vector<std::string>(), shot.scene != nullptr);
  return shot;
}

void vtkMediumRayCaster::CropToRequest(Shot&& shot, vtkInformationVector* outputs)
{
  tyndall::ToneMapping toneMapping;
  toneMapping.exposure = shot.exposure;
  toneMapping.curve = static_cast<tyndall::ToneCurve>(this->ToneCurve);
  const std::vector<float> opaque;
  auto color = tyndall::ToneMap(shot.picture.radiance, this->ShowBackground ? opaque : shot.picture.alpha, toneMapping);
  vtkImageData* const output = vtkImageData::GetData(outputs);
  if (shot.picture.width > 0) // else no pixels are requested from this rank
  {
    tyndall::WritePicture(std::move(shot.picture), shot.first, std::move(color), output);
  }
  const std::string device = tyndall::FindWithin(this->Within, this->Device, this->MemoryBudget)->Name();
  std::vector<std::string> settings = tyndall::Words(tyndall::SettingsOf(this, shot.exposure));
  tyndall::AddAveraged(this, settings);
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
    std::unique_ptr<tyndall::CasterScene> scene = this->FindScene(ports.data(), settings, block);
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
    CameraParallelProjection, CameraParallelScale, StepSize, SingleScatteringOnly, ShadowRays, RectangleSamples,
    ShowBackground, BackgroundColor, BackgroundRadiance, Exposure, AutoExposure);
  os << indent << "ToneCurve: " << (this->ToneCurve == LINEAR ? "linear" : "filmic") << "\n";
  tyndallPrintMacro(SurfaceReflection, SurfaceIndex, SurfaceReflectance, TableFace, TableColor, TableReflectance,
    LeaveOut, Seconds, UsedExposure, SceneKept, MemoryBudget, DeviceName, LeftOut, SettingsUsed);
}
