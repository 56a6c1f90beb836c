#include "vtkLitVolumeMapper.h"

#include "AskedView.h"
#include "Common/LightTransportData.h"
#include "Device/Clock.h"
#include "PictureOverlay.h"
#include "RenderedCamera.h"
#include "Viewing/Rays/Picture.h"
#include "Viewing/ToneMapping.h"
#include "vtkMediumRayCaster.h"

#include "vtkAlgorithmOutput.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <utility>
#include <vector>

namespace
{
constexpr double StillTime = 1.0;         ///< seconds that a renderer has for a frame where nothing moves
constexpr double CoarsestRays = 8.0;      ///< pixels from ray to ray
constexpr double StepsOfCoarseness = 4.0; ///< in a pixel, so that a picture's size does not change with every frame
constexpr int ExposedSize[2] = { 64, 48 };

/// The corners of a tetrahedron: from these sides the scene is looked at for its exposure.
constexpr double ExposedFrom[4][3] = { { 1, 1, 1 }, { -1, -1, 1 }, { -1, 1, -1 }, { 1, -1, -1 } };

/// What lies over the scene: radiance as the screen shows it, and how much of the scene it hides. Where a background is
/// seen that is all.
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

/// The same of a part, which is laid over others or under them: see IsPart.
std::vector<std::uint8_t> PixelsOfPart(
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
}

vtkStandardNewMacro(vtkLitVolumeMapper);

vtkLitVolumeMapper::vtkLitVolumeMapper()
  : Overlay(std::make_unique<tyndall::PictureOverlay>())
{
  this->RayCaster->ShowBackgroundOff();
}

vtkLitVolumeMapper::~vtkLitVolumeMapper() = default;

vtkMediumRayCaster* vtkLitVolumeMapper::GetRayCaster()
{
  return this->RayCaster;
}

vtkMTimeType vtkLitVolumeMapper::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->RayCaster->GetMTime());
}

int vtkLitVolumeMapper::FillInputPortInformation(int, vtkInformation* information)
{
  information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

/// @return whether there is a medium
bool vtkLitVolumeMapper::UpdateInputs()
{
  using Port = vtkMediumRayCaster::InputPorts;
  this->RayCaster->SetInputConnection(Port::MEDIUM, this->GetInputConnection(0, 0));
  for (int port : { Port::MEDIUM, Port::LIGHTS, Port::ENVIRONMENT })
  {
    if (vtkAlgorithmOutput* const connection = this->RayCaster->GetInputConnection(port, 0))
    {
      connection->GetProducer()->Update(connection->GetIndex());
    }
  }
  auto* const medium = vtkImageData::SafeDownCast(this->RayCaster->GetInputDataObject(Port::MEDIUM, 0));
  return medium && medium->GetNumberOfCells() > 0; // other ranks may have all of it
}

double vtkLitVolumeMapper::EstimateExposure()
{
  if (!this->UpdateInputs())
  {
    return 0.0;
  }
  std::vector<float> radiance;
  try
  {
    const tyndall::Grid grid = tyndall::GridOf(vtkImageData::SafeDownCast(this->GetDataObjectInput()));
    const double aspect = static_cast<double>(ExposedSize[0]) / ExposedSize[1];
    for (const auto& from : ExposedFrom)
    {
      tyndall::AskedView view;
      view.size = { ExposedSize[0], ExposedSize[1] };
      view.camera = tyndall::FrameGrid(grid, aspect, 30.0, { from[0], from[1], from[2] });
      tyndall::Picture picture;
      if (!this->RayCaster->See(view, picture))
      {
        return 0.0;
      }
      radiance.insert(radiance.end(), picture.radiance.begin(), picture.radiance.end());
    }
  }
  catch (const std::exception&) // an image that is no medium: the ray caster says so when it is drawn
  {
    return 0.0;
  }
  return tyndall::AutomaticExposure(radiance);
}

/// Once for a scene, where it is to be chosen.
/// @return false where that failed
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

/// @param allowed  seconds that the renderer has for it
void vtkLitVolumeMapper::ChooseCastSize(const int drawn[2], double allowed)
{
  double apart = 1.0; // pixels from ray to ray
  if (allowed<StillTime&& this->SecondsOfRay> 0.0)
  {
    const double asked = std::sqrt(this->SecondsOfRay * drawn[0] * drawn[1] / std::min(this->FrameTime, allowed));
    apart = std::clamp(std::ceil(asked * StepsOfCoarseness) / StepsOfCoarseness, 1.0, CoarsestRays);
  }
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

bool vtkLitVolumeMapper::ShowsBackgroundColor()
{
  const double* const color = this->RayCaster->GetBackgroundColor();
  return this->RayCaster->GetShowBackground() && std::any_of(color, color + 3, [](double c) { return c > 0.0; });
}

void vtkLitVolumeMapper::Render(vtkRenderer* renderer, vtkVolume* volume)
{
  const double start = tyndall::ClockSeconds();
  const auto size = tyndall::DrawnSize(renderer);
  if (renderer->GetSelector() || size[0] <= 0 || size[1] <= 0 || !this->UpdateInputs())
  {
    return; // a medium is not picked: it is everywhere
  }
  this->ChooseCastSize(size.data(), volume->GetAllocatedRenderTime());
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
    return; // the ray caster has said why
  }
  if (this->ShowsBackgroundColor() && view.exposure != this->UsedExposure)
  {
    // The radiance of what is behind follows from the exposure, which was not known before.
    view.exposure = this->UsedExposure;
    this->Cast(view, picture);
  }
  tyndall::ToneMapping tones;
  tones.exposure = this->UsedExposure;
  tones.curve = static_cast<tyndall::ToneCurve>(this->RayCaster->GetToneCurve());
  const bool background = this->RayCaster->GetShowBackground();
  this->Overlay->Draw(renderer,
    this->IsPart ? PixelsOfPart(std::move(picture), view.ends, background, tones)
                 : PixelsOf(picture, view.ends, background, tones),
    view.size);
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
  os << indent << "FrameTime: " << this->FrameTime << "\n";
  os << indent << "CommonExposure: " << this->CommonExposure << "\n";
  os << indent << "IsPart: " << this->IsPart << "\n";
  os << indent << "UsedExposure: " << this->UsedExposure << "\n";
  os << indent << "CastSize: " << this->CastSize[0] << " " << this->CastSize[1] << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
  os << indent << "RayCaster:\n";
  this->RayCaster->PrintSelf(os, indent.GetNextIndent());
}
