#include "vtkLitVolumeMapper.h"

#include "BlocksOfRanks.h"
#include "CasterProperties.h"
#include "Common/CellArrays.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Device/Clock.h"
#include "PictureOverlay.h"
#include "Pieces/ControllerCommunicator.h"
#include "RenderedCamera.h"
#include "Viewing/Blocks/ShownBlock.h"
#include "Viewing/Rays/Picture.h"
#include "Viewing/ToneMapping.h"
#include "VolumeLight.h"
#include "vtkMediumRayCaster.h"

#include "vtkAlgorithmOutput.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkLightPropagationMaps.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkParticipatingMedium.h"
#include "vtkRenderer.h"
#include "vtkTrivialProducer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <optional>
#include <utility>

namespace
{
constexpr double StillTime = 1.0;         ///< time allowed for a frame from which on the view counts as still, seconds
constexpr double CoarsestRays = 8.0;      ///< largest distance between neighbouring rays, pixels
constexpr double StepsOfCoarseness = 4.0; ///< the ray distance is a multiple of 1/4 pixel, so that it rarely changes
/// Distance by which the bounds of a piece that draws the background are extended, in diagonals of the piece.
constexpr double FarAway = 1e4;
constexpr int ExposedSize[2] = { 64, 48 };

/// Viewing directions for the automatic exposure: the corners of a tetrahedron.
constexpr double ExposedFrom[4][3] = { { 1, 1, 1 }, { -1, -1, 1 }, { -1, 1, -1 }, { 1, -1, -1 } };

/// Lets a filter read the scalars that a mapper is to show. If the mapper names none, the filter's choice stays.
void ChooseScalars(vtkAlgorithm* filter, vtkAbstractVolumeMapper* mapper)
{
  const int mode = mapper->GetScalarMode();
  const bool areOfCells = mode == VTK_SCALAR_MODE_USE_CELL_FIELD_DATA;
  if ((areOfCells || mode == VTK_SCALAR_MODE_USE_POINT_FIELD_DATA) && mapper->GetArrayName())
  {
    filter->SetInputArrayToProcess(0, 0, 0,
      areOfCells ? vtkDataObject::FIELD_ASSOCIATION_CELLS : vtkDataObject::FIELD_ASSOCIATION_POINTS,
      mapper->GetArrayName());
  }
}

/// Pixels to blend over the scene, red, green, blue, alpha: tone-mapped radiance and the medium's alpha.
/// @param ends  distances at which surfaces end the rays (RenderedCamera::EndsOf); empty: no ray ends
/// @param background  whether the background is visible: pixels whose rays meet no surface are then opaque
std::vector<std::uint8_t> PixelsOf(
  const tyndall::Picture& picture, const std::vector<float>& ends, bool background, const tyndall::ToneMapping& tones)
{
  std::vector<std::uint8_t> pixels = tyndall::ToneMap(picture.radiance, {}, tones);
  for (std::size_t i = 0; i < picture.alpha.size(); ++i)
  {
    const bool open = ends.empty() || ends[i] >= tyndall::Endless;
    pixels[4 * i + 3] = background && open ? 255 : static_cast<std::uint8_t>(255.0f * picture.alpha[i] + 0.5f);
  }
  return pixels;
}

/// Pixels to blend over objects that cover only a part of a pixel, such as a line thinner than a pixel, and that the
/// pixel's ray missed. The medium attenuates the object, and the object hides the background.
/// @param pixels  pixels of PixelsOf with background
std::vector<std::uint8_t> PixelsBeforeObjects(
  std::vector<std::uint8_t> pixels, const tyndall::Picture& picture, const std::vector<float>& ends)
{
  for (std::size_t i = 0; i < pixels.size(); ++i)
  {
    const bool open = ends.empty() || ends[i / 4] >= tyndall::Endless;
    pixels[i] = open ? static_cast<std::uint8_t>(pixels[i] * picture.alpha[i / 4] + 0.5f) : pixels[i];
  }
  return pixels;
}

/// Pixels of a piece that is rendered alone and composited with other pieces in depth order: radiance is divided by
/// alpha before tone mapping, and the pixel value multiplied by alpha (see SetPiece).
std::vector<std::uint8_t> PixelsOfPiece(
  tyndall::Picture picture, const std::vector<float>& ends, bool background, const tyndall::ToneMapping& tones)
{
  for (std::size_t i = 0; i < picture.radiance.size(); ++i)
  {
    const float alpha = picture.alpha[i / 3];
    const bool open = background && (ends.empty() || ends[i / 3] >= tyndall::Endless);
    picture.radiance[i] *= open ? 1.0f : alpha > 0.0f ? 1.0f / alpha : 0.0f;
  }
  std::vector<std::uint8_t> pixels = PixelsOf(picture, ends, background, tones);
  for (std::size_t i = 0; i < pixels.size(); ++i)
  {
    pixels[i] = i % 4 == 3 ? pixels[i] : static_cast<std::uint8_t>(pixels[i] * pixels[i | 3] / 255);
  }
  return pixels;
}

std::vector<double> Words(const tyndall::Camera& camera)
{
  std::vector<double> words = { camera.viewAngle, camera.parallelProjection ? 1.0 : 0.0, camera.parallelScale,
    camera.aspect, camera.shift[0], camera.shift[1] };
  for (const auto& place : { camera.position, camera.focalPoint, camera.viewUp })
  {
    words.insert(words.end(), place.begin(), place.end());
  }
  return words;
}

/// Camera of the renderer in the coordinates of the volume; none if camera or transformation are invalid, which Render
/// reports as an error.
std::optional<tyndall::Camera> CameraOf(vtkRenderer* renderer, vtkVolume* volume)
{
  try
  {
    return tyndall::RenderedCamera(renderer, volume->GetMatrix()).AsSeen();
  }
  catch (const std::exception&)
  {
    return std::nullopt;
  }
}

/// Distance between rays, pixels, for all ranks: the largest distance that any rank requests. Collective.
/// @param alike  numbers that must be the same on all ranks
/// @param apart  distance that this rank requests; 0 if it cannot render
/// @return nothing, on all ranks, if `alike` differs between ranks or a rank cannot render
std::optional<double> AgreedRaysApart(tyndall::Communicator& others, std::vector<double> alike, double apart)
{
  alike.push_back(apart);
  const std::vector<double> said = tyndall::SaidByAll(others, alike);
  double most = apart;
  for (auto other = said.begin(); other != said.end(); other += static_cast<std::ptrdiff_t>(alike.size()))
  {
    const double asked = other[alike.size() - 1];
    if (asked == 0.0 || !std::equal(alike.begin(), alike.end() - 1, other))
    {
      return std::nullopt;
    }
    most = std::max(most, asked);
  }
  return most;
}

/// Request for a small picture of the whole grid, for the automatic exposure.
/// @param from  direction from which the camera looks at the grid
tyndall::AskedView ExposedView(const tyndall::Grid& grid, const tyndall::OwnAxes& axes, const double from[3])
{
  tyndall::AskedView view;
  view.size = { ExposedSize[0], ExposedSize[1] };
  const double aspect = static_cast<double>(ExposedSize[0]) / ExposedSize[1];
  view.camera = tyndall::InScene(tyndall::FrameGrid(grid, aspect, 30.0, { from[0], from[1], from[2] }), axes);
  return view;
}
}

/// State of a mapper for one of several pieces (SetPiece), and the pixels that SeePieces prepared for the next frame.
struct vtkLitVolumeMapper::Pieces
{
  vtkMultiProcessController* ranks = nullptr;
  vtkNew<vtkTrivialProducer> surrounded;
  std::optional<tyndall::AskedView> view; ///< view of the next frame; none if each rank renders its piece alone
  std::array<int, 2> drawn = {};          ///< columns and rows of pixels of the frame
  bool together = false;                  ///< whether the last frame showed all pieces together
  tyndall::ShownBlock shown;
  double seconds = 0.0; ///< run time of SeePieces for this frame
};

vtkStandardNewMacro(vtkLitVolumeMapper);

vtkLitVolumeMapper::vtkLitVolumeMapper()
  : OwnLight(std::make_unique<tyndall::VolumeLight>())
  , Overlay(std::make_unique<tyndall::PictureOverlay>())
{
  this->RayCaster->ShowBackgroundOff();
}

vtkLitVolumeMapper::~vtkLitVolumeMapper() = default;

vtkMediumRayCaster* vtkLitVolumeMapper::GetRayCaster()
{
  return this->RayCaster;
}

vtkParticipatingMedium* vtkLitVolumeMapper::GetMedium()
{
  return this->OwnLight->GetMedium();
}

vtkLightPropagationMaps* vtkLitVolumeMapper::GetSolver()
{
  return this->OwnLight->GetSolver();
}

vtkMTimeType vtkLitVolumeMapper::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->RayCaster->GetMTime());
}

double* vtkLitVolumeMapper::GetBounds()
{
  double* const bounds = this->Superclass::GetBounds();
  if (this->IsPiece() && this->Spread->view && this->Spread->view->block->showsBackgroundBeside &&
    this->RayCaster->GetShowBackground())
  {
    const double far =
      FarAway * std::hypot(bounds[1] - bounds[0], std::hypot(bounds[3] - bounds[2], bounds[5] - bounds[4]));
    for (int side = 0; side < 6; ++side)
    {
      bounds[side] += side % 2 ? far : -far;
    }
  }
  return bounds;
}

int vtkLitVolumeMapper::FillInputPortInformation(int, vtkInformation* information)
{
  information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

bool vtkLitVolumeMapper::IsPiece() const
{
  return this->Spread && this->Spread->ranks;
}

/// Updates the inputs of the ray caster.
/// @param asked  connection of the medium
/// @return whether the medium has cells
bool vtkLitVolumeMapper::UpdateInputs(vtkAlgorithmOutput* asked)
{
  using Port = vtkMediumRayCaster::InputPorts;
  this->RayCaster->SetInputConnection(Port::MEDIUM, asked);
  for (int port : { Port::MEDIUM, Port::LIGHTS, Port::ENVIRONMENT })
  {
    if (vtkAlgorithmOutput* const connection = this->RayCaster->GetInputConnection(port, 0))
    {
      connection->GetProducer()->Update(connection->GetIndex());
    }
  }
  auto* const medium = vtkImageData::SafeDownCast(this->RayCaster->GetInputDataObject(Port::MEDIUM, 0));
  return medium && medium->GetNumberOfCells() > 0; // no cells if other ranks have the whole medium
}

/// Updates the inputs of the ray caster for this rank's piece with ghost cells (SetPiece).
/// @return the piece; null if this rank has none
vtkImageData* vtkLitVolumeMapper::UpdateSurrounded()
{
  vtkTrivialProducer* const surrounded = this->Spread->surrounded;
  auto* const image = vtkImageData::SafeDownCast(surrounded->GetOutputDataObject(0));
  return image && this->UpdateInputs(surrounded->GetOutputPort()) ? image : nullptr;
}

/// Whether the input is to be shown by transfer functions (LightScalars).
bool vtkLitVolumeMapper::HasScalarsToLight()
{
  vtkAlgorithmOutput* const input = this->GetInputConnection(0, 0);
  if (!this->LightScalars || this->IsPiece() || !input)
  {
    return false;
  }
  input->GetProducer()->Update(input->GetIndex());
  auto* const image = vtkImageData::SafeDownCast(this->GetDataObjectInput());
  return image && image->GetNumberOfPoints() > 0 && !tyndall::ChosenArray(this->RayCaster, 0, image, "sigma_a") &&
    !tyndall::ChosenArray(this->RayCaster, 1, image, "sigma_s");
}

/// Lights scalars by the lights and the environment of the ray caster, on its device. If it has no lights, those of the
/// renderer are used, and the ray caster has them as well.
void vtkLitVolumeMapper::ConnectLights()
{
  using Port = vtkMediumRayCaster::InputPorts;
  vtkLightPropagationMaps* const solver = this->GetSolver();
  if (!this->RayCaster->GetInputConnection(Port::LIGHTS, 0))
  {
    this->RayCaster->SetInputConnection(Port::LIGHTS, this->OwnLight->GetLights());
  }
  solver->SetLightsConnection(this->RayCaster->GetInputConnection(Port::LIGHTS, 0));
  solver->SetEnvironmentConnection(this->RayCaster->GetInputConnection(Port::ENVIRONMENT, 0));
  solver->SetEnvironmentUp(this->RayCaster->GetEnvironmentUp());
  solver->SetEnvironmentAzimuth(this->RayCaster->GetEnvironmentAzimuth());
  solver->SetDevice(this->RayCaster->GetDevice());
  solver->SetMemoryBudget(this->RayCaster->GetMemoryBudget());
}

/// Connection of the medium with its light: the input, or what is made of its scalars.
vtkAlgorithmOutput* vtkLitVolumeMapper::LitConnection(vtkRenderer* renderer, vtkVolume* volume)
{
  this->Shown = this->GetInputConnection(0, 0);
  if (this->HasScalarsToLight())
  {
    ChooseScalars(this->GetMedium(), this);
    this->ConnectLights();
    tyndall::RendererLights lights = { renderer, volume->GetMatrix(), {}, this->LightsFollowCamera };
    vtkImageData::SafeDownCast(this->GetDataObjectInput())->GetCenter(lights.centre);
    this->Shown =
      this->OwnLight->Update(this->Shown, volume->GetProperty(), lights, volume->GetAllocatedRenderTime() >= StillTime);
  }
  return this->Shown;
}

double vtkLitVolumeMapper::EstimateExposure()
{
  vtkAlgorithmOutput* const shown = this->LightScalars && this->Shown ? this->Shown : this->GetInputConnection(0, 0);
  if (this->GetNumberOfInputConnections(0) == 0 || !this->UpdateInputs(shown))
  {
    return 0.0;
  }
  std::vector<float> radiance, alpha;
  try
  {
    auto* const image = vtkImageData::SafeDownCast(this->RayCaster->GetInputDataObject(vtkMediumRayCaster::MEDIUM, 0));
    const vtkSmartPointer<vtkImageData> aligned = image ? tyndall::Aligned(image) : nullptr;
    const tyndall::OwnAxes axes = tyndall::OwnAxesOf(aligned.GetPointer());
    const tyndall::Grid grid =
      tyndall::GridOf(tyndall::InOwnAxes(aligned, axes, this->RayCaster, vtkMediumRayCaster::MEDIUM));
    for (const auto& from : ExposedFrom)
    {
      tyndall::Picture picture;
      if (!this->RayCaster->See(ExposedView(grid, axes, from), picture))
      {
        return 0.0;
      }
      this->AddSeen(picture, radiance, alpha);
    }
  }
  catch (const std::exception&) // the image is no valid medium: Render reports the error
  {
    return 0.0;
  }
  return tyndall::AutomaticExposure(radiance, alpha);
}

/// Appends a picture's pixels to the samples for the automatic exposure: radiance, and alpha if the background does not
/// count (SeesRadianceBehind).
void vtkLitVolumeMapper::AddSeen(
  const tyndall::Picture& picture, std::vector<float>& radiance, std::vector<float>& alpha)
{
  radiance.insert(radiance.end(), picture.radiance.begin(), picture.radiance.end());
  if (!this->RayCaster->SeesRadianceBehind())
  {
    alpha.insert(alpha.end(), picture.alpha.begin(), picture.alpha.end());
  }
}

/// Automatic exposure from small pictures of all pieces together. Collective.
/// @return the exposure; 0 if the pieces cannot be rendered together
double vtkLitVolumeMapper::ExposureOfPieces(tyndall::Communicator& others)
{
  const tyndall::BlocksOfRanks blocks(others, this->UpdateSurrounded());
  std::vector<float> radiance, alpha;
  for (const auto& from : ExposedFrom)
  {
    if (!blocks.MakeUpTheWhole())
    {
      return 0.0;
    }
    tyndall::AskedView view = ExposedView(blocks.Whole(), blocks.Axes(), from);
    tyndall::Picture picture;
    view.block = blocks.Own();
    const bool seen = !blocks.HasOwn() || this->RayCaster->See(view, picture);
    const tyndall::PixelRect all = { { 0, 0 }, view.size };
    const auto pieces = blocks.Exchange(tyndall::SeenPart(picture), all, !seen, view.camera);
    if (!pieces)
    {
      return 0.0;
    }
    this->AddSeen(tyndall::PictureOfAll(pieces->frontToBack, all, tyndall::BlockPixel::FarAway), radiance, alpha);
  }
  return tyndall::AutomaticExposure(radiance, alpha);
}

void vtkLitVolumeMapper::SetPiece(vtkMultiProcessController* ranks, vtkImageData* surrounded)
{
  this->Spread = std::make_unique<Pieces>();
  this->Spread->ranks = ranks;
  this->Spread->surrounded->SetOutput(surrounded);
}

/// Whether properties of rendering have changed on any rank since the automatic exposure was chosen. Collective.
bool vtkLitVolumeMapper::IsExposureOld(tyndall::Communicator& others)
{
  const bool old = this->RayCaster->GetExposure() == 0.0 && this->RayCaster->GetMTime() > this->ExposureTime;
  return tyndall::OnAnyRank(others, old);
}

/// Calls `act` with the communicator of the ranks of SetPiece. Exceptions, for example because a rank is lost, are
/// reported as an error of this mapper; each piece is then rendered alone.
void vtkLitVolumeMapper::WithOthers(const std::function<void(tyndall::Communicator&)>& act)
{
  try
  {
    act(*tyndall::CommunicatorOfFrame(this->Spread->ranks));
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

void vtkLitVolumeMapper::AgreeOnExposure()
{
  this->WithOthers([this](tyndall::Communicator& others) { this->AgreeOnExposure(others); });
}

void vtkLitVolumeMapper::AgreeOnExposure(tyndall::Communicator& others)
{
  this->CommonExposure = this->ExposureOfPieces(others);
  if (this->CommonExposure == 0.0) // if pieces are rendered alone: the geometric mean of their exposures
  {
    const double own = this->EstimateExposure();
    const std::vector<double> all = others.Sum({ own > 0.0 ? std::log(own) : 0.0, own > 0.0 ? 1.0 : 0.0 });
    this->CommonExposure = all[1] > 0.0 ? std::exp(all[0] / all[1]) : 0.0;
  }
  this->ExposureTime.Modified();
}

/// Sets UsedExposure: Exposure of the ray caster or, if that is 0, the automatic exposure, which is chosen once per
/// scene.
/// @return false if no exposure could be chosen
bool vtkLitVolumeMapper::FindExposure()
{
  const double given = this->RayCaster->GetExposure();
  this->UsedExposure = given > 0.0 ? given : this->CommonExposure;
  if (this->UsedExposure > 0.0)
  {
    return true;
  }
  const bool stays = this->RayCaster->GetSceneKept() && this->RayCaster->GetMTime() < this->ExposureTime;
  if (!stays || this->AutomaticExposure == 0.0)
  {
    this->AutomaticExposure = this->EstimateExposure();
    this->ExposureTime.Modified();
  }
  this->UsedExposure = this->AutomaticExposure;
  return this->UsedExposure > 0.0;
}

/// Distance between neighbouring rays, pixels, for which casting the rays takes at most FrameTime and the allowed time;
/// 1 if the view is still.
/// @param drawn  columns and rows of the viewport
/// @param allowed  seconds that the renderer has for the frame
double vtkLitVolumeMapper::RaysApart(const int drawn[2], double allowed) const
{
  if (allowed >= StillTime || this->SecondsOfRay == 0.0)
  {
    return 1.0;
  }
  const double asked = std::sqrt(this->SecondsOfRay * drawn[0] * drawn[1] / std::min(this->FrameTime, allowed));
  return std::clamp(std::ceil(asked * StepsOfCoarseness) / StepsOfCoarseness, 1.0, CoarsestRays);
}

void vtkLitVolumeMapper::ChooseCastSize(const int drawn[2], double apart)
{
  for (int axis = 0; axis < 2; ++axis)
  {
    this->CastSize[axis] = std::max(static_cast<int>(std::lround(drawn[axis] / apart)), 1);
  }
}

bool vtkLitVolumeMapper::Cast(const tyndall::AskedView& view, tyndall::Picture& picture)
{
  const double start = tyndall::ClockSeconds();
  if (!this->RayCaster->See(view, picture))
  {
    return false;
  }
  const double rays = static_cast<double>(view.size[0]) * view.size[1];
  this->SecondsOfRay = (tyndall::ClockSeconds() - start) / rays;
  return true;
}

tyndall::ToneMapping vtkLitVolumeMapper::Tones()
{
  tyndall::ToneMapping tones;
  tones.exposure = this->UsedExposure;
  tones.curve = static_cast<tyndall::ToneCurve>(this->RayCaster->GetToneCurve());
  return tones;
}

bool vtkLitVolumeMapper::ShowsBackgroundColor()
{
  const double* const color = this->RayCaster->GetBackgroundColor();
  return this->RayCaster->GetShowBackground() && std::any_of(color, color + 3, [](double c) { return c > 0.0; });
}

/// Renders this rank's piece and exchanges pixels with all ranks before a frame: the pixels of a piece depend on the
/// pieces in front of it, and in the frame itself some ranks may not draw. Collective.
void vtkLitVolumeMapper::SeePieces(vtkRenderer* renderer, vtkVolume* volume)
{
  if (this->IsPiece())
  {
    this->WithOthers([&](tyndall::Communicator& others) { this->SeePieces(others, renderer, volume); });
  }
}

void vtkLitVolumeMapper::SeePieces(tyndall::Communicator& others, vtkRenderer* renderer, vtkVolume* volume)
{
  const double start = tyndall::ClockSeconds();
  this->Spread->view.reset();
  // `together` is reset first, so that a frame that fails on one rank does not count as rendered together on other
  // ranks.
  const bool together = std::exchange(this->Spread->together, false);
  if (together && this->IsExposureOld(others))
  {
    this->AgreeOnExposure(others);
  }
  const bool exposed = this->FindExposure();
  const std::array<int, 2> drawn = tyndall::DrawnSize(renderer);
  const std::optional<tyndall::Camera> camera = CameraOf(renderer, volume);
  const tyndall::BlocksOfRanks blocks(others, this->UpdateSurrounded());
  std::vector<double> alike = Words(camera.value_or(tyndall::Camera()));
  alike.insert(alike.end(), { 1.0 * drawn[0], 1.0 * drawn[1], this->UsedExposure });
  const bool able = exposed && camera && drawn[0] > 0 && drawn[1] > 0;
  const auto apart = AgreedRaysApart(
    others, std::move(alike), able ? this->RaysApart(drawn.data(), renderer->GetAllocatedRenderTime()) : 0.0);
  if (!apart || !blocks.MakeUpTheWhole())
  {
    return;
  }
  this->ChooseCastSize(drawn.data(), *apart);
  tyndall::AskedView view;
  view.size = { this->CastSize[0], this->CastSize[1] };
  view.camera = *camera;
  view.exposure = this->UsedExposure;
  view.block = blocks.Own();
  tyndall::Picture picture;
  const bool seen = !blocks.HasOwn() || this->Cast(view, picture);
  const tyndall::BlockPixels own = tyndall::SeenPart(picture);
  auto pieces = blocks.Exchange(own, own.rect, !seen, view.camera);
  this->Spread->together = pieces.has_value();
  if (pieces && blocks.HasOwn())
  {
    this->Spread->shown = { std::move(pieces->frontToBack), pieces->own, view.size, this->Tones() };
    this->Spread->drawn = drawn;
    this->Spread->view = view;
  }
  this->Spread->seconds = tyndall::ClockSeconds() - start;
}

/// Draws the pixels that SeePieces prepared, with rays ended at the surfaces of the scene.
/// @return false if the pieces are not rendered together, so that the caller must render this piece alone
bool vtkLitVolumeMapper::DrawPiece(vtkRenderer* renderer, vtkVolume* volume)
{
  const auto camera = CameraOf(renderer, volume);
  if (!this->IsPiece() || !this->Spread->view || !camera || Words(*camera) != Words(this->Spread->view->camera) ||
    this->Spread->drawn != tyndall::DrawnSize(renderer))
  {
    return false;
  }
  tyndall::AskedView view = *this->Spread->view;
  view.ends = tyndall::RenderedCamera(renderer, volume->GetMatrix())
                .EndsOf(tyndall::DrawnDepths(renderer), this->Spread->drawn, view.size);
  std::vector<std::uint8_t> pixels;
  if (view.ends.empty())
  {
    pixels = this->Spread->shown.Pixels();
  }
  else
  {
    tyndall::Picture ended;
    if (!this->UpdateSurrounded() || !this->Cast(view, ended))
    {
      return true; // the ray caster has reported the error
    }
    std::vector<bool> isEnded(view.ends.size());
    std::transform(
      view.ends.begin(), view.ends.end(), isEnded.begin(), [](float end) { return end < tyndall::Endless; });
    pixels = this->Spread->shown.Pixels(ended, isEnded);
  }
  this->Overlay->Draw(renderer, pixels, view.size);
  return true;
}

void vtkLitVolumeMapper::Render(vtkRenderer* renderer, vtkVolume* volume)
{
  const double start = tyndall::ClockSeconds();
  const auto size = tyndall::DrawnSize(renderer);
  if (renderer->GetSelector() || size[0] <= 0 || size[1] <= 0)
  {
    return; // the medium cannot be picked: it fills its whole box
  }
  if (this->DrawPiece(renderer, volume))
  {
    this->Seconds = this->TimeToDraw = this->Spread->seconds + tyndall::ClockSeconds() - start;
    return;
  }
  if (!this->UpdateInputs(this->LitConnection(renderer, volume)))
  {
    return;
  }
  this->ChooseCastSize(size.data(), this->RaysApart(size.data(), volume->GetAllocatedRenderTime()));
  tyndall::AskedView view;
  view.size = { this->CastSize[0], this->CastSize[1] };
  view.exposure = this->UsedExposure;
  try
  {
    const tyndall::RenderedCamera camera(renderer, volume->GetMatrix());
    view.camera = camera.AsSeen();
    view.ends = camera.EndsOf(tyndall::DrawnDepths(renderer), size, view.size);
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
    return;
  }
  tyndall::Picture picture;
  if (!this->Cast(view, picture) || !this->FindExposure())
  {
    return; // the ray caster has reported the error
  }
  if (this->ShowsBackgroundColor() && view.exposure != this->UsedExposure)
  {
    // The radiance of BackgroundColor depends on the exposure, which was not known in the first pass.
    view.exposure = this->UsedExposure;
    this->Cast(view, picture);
  }
  const tyndall::ToneMapping tones = this->Tones();
  const bool background = this->RayCaster->GetShowBackground();
  const std::vector<std::uint8_t> pixels = this->IsPiece() ? PixelsOfPiece(picture, view.ends, background, tones)
                                                           : PixelsOf(picture, view.ends, background, tones);
  using Over = tyndall::PictureOverlay::Over;
  this->Overlay->Draw(renderer, pixels, view.size, background ? Over::Background : Over::All);
  if (background)
  {
    this->Overlay->Draw(renderer, PixelsBeforeObjects(pixels, picture, view.ends), view.size, Over::Objects);
  }
  this->Seconds = this->TimeToDraw = tyndall::ClockSeconds() - start;
}

void vtkLitVolumeMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Overlay->Release(window);
  this->Superclass::ReleaseGraphicsResources(window);
}

void vtkLitVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(LightScalars, LightsFollowCamera, FrameTime, CommonExposure);
  os << indent << "IsPiece: " << this->IsPiece() << "\n";
  tyndallPrintMacro(UsedExposure, CastSize, Seconds);
  os << indent << "RayCaster:\n";
  this->RayCaster->PrintSelf(os, indent.GetNextIndent());
}
