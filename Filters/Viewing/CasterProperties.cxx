#include "CasterProperties.h"

#include "Viewing/ToneMapping.h"
#include "vtkMediumRayCaster.h"

#include <algorithm>

namespace tyndall
{
Rgb BackgroundOf(vtkMediumRayCaster* filter, double exposure)
{
  Rgb background = Triple(filter->GetBackgroundRadiance());
  if (background == Rgb{} && exposure > 0.0)
  {
    const auto curve = static_cast<ToneCurve>(filter->GetToneCurve());
    std::transform(filter->GetBackgroundColor(), filter->GetBackgroundColor() + 3, background.begin(),
      [&](double shown) { return ExposedAs(shown, curve) / exposure; });
  }
  return background;
}

ViewSettings SettingsOf(vtkMediumRayCaster* filter, double exposure)
{
  ViewSettings settings;
  std::copy_n(filter->GetImageSize(), 2, settings.imageSize.begin());
  settings.stepSize = filter->GetStepSize();
  settings.singleScatteringOnly = filter->GetSingleScatteringOnly();
  settings.shadowRays = filter->GetShadowRays();
  settings.rectangleSamples = filter->GetRectangleSamples();
  settings.showBackground = filter->GetShowBackground();
  settings.backgroundColor = BackgroundOf(filter, exposure);
  settings.surfaceReflection = static_cast<SurfaceReflection>(filter->GetSurfaceReflection());
  settings.surfaceIndex = filter->GetSurfaceIndex();
  settings.surfaceReflectance = filter->GetSurfaceReflectance();
  settings.tableFace = filter->GetTableFace();
  settings.tableColor = Triple(filter->GetTableColor());
  settings.tableReflectance = filter->GetTableReflectance();
  settings.leaveOut = filter->GetLeaveOut();
  return AtQuality(static_cast<Quality>(filter->GetQuality()), settings);
}

namespace
{
template <typename Place, typename Way>
Camera Turned(Camera camera, const OwnAxes& axes, const Place& place, const Way& way)
{
  if (!axes.AreThoseOfScene())
  {
    camera.position = place(camera.position);
    camera.focalPoint = place(camera.focalPoint);
    camera.viewUp = way(camera.viewUp);
    camera.mirrored = camera.mirrored != axes.AreMirrored();
  }
  return camera;
}
}

Camera InOwnAxes(const Camera& inScene, const OwnAxes& axes)
{
  return Turned(
    inScene, axes, [&](const auto& at) { return axes.Place(at); }, [&](const auto& to) { return axes.Way(to); });
}

Camera InScene(const Camera& camera, const OwnAxes& axes)
{
  return Turned(
    camera, axes, [&](const auto& at) { return axes.PlaceInScene(at); },
    [&](const auto& to) { return axes.WayInScene(to); });
}

Camera CameraOf(vtkMediumRayCaster* filter, const Grid& grid)
{
  const OwnAxes axes = OwnAxesOf(filter);
  Camera camera = CameraSetOn(filter);
  camera.parallelScale = filter->GetCameraParallelScale();
  if (camera.position == camera.focalPoint)
  {
    const double aspect = static_cast<double>(filter->GetImageSize()[0]) / filter->GetImageSize()[1];
    const bool turned = !axes.AreThoseOfScene();
    const auto towards = ThreeQuarterView(camera.viewUp);
    camera = turned ? FrameGrid(grid, aspect, camera.viewAngle, axes.Way(towards), axes.Way(camera.viewUp))
                    : FrameGrid(grid, aspect, camera.viewAngle, towards, camera.viewUp);
    camera.mirrored = axes.AreMirrored();
  }
  else
  {
    camera = InOwnAxes(camera, axes);
  }
  camera.parallelProjection = filter->GetCameraParallelProjection();
  return camera;
}

std::vector<double> PropertiesAsNumbers(vtkMediumRayCaster* filter)
{
  std::vector<double> numbers = { filter->GetCameraViewAngle(), filter->GetCameraParallelProjection() ? 1.0 : 0.0,
    filter->GetCameraParallelScale(), filter->GetStepSize(), filter->GetSingleScatteringOnly() ? 1.0 : 0.0,
    filter->GetShadowRays() ? 1.0 : 0.0, filter->GetShowBackground() ? 1.0 : 0.0, filter->GetExposure(),
    filter->GetSurfaceIndex(), filter->GetSurfaceReflectance(), filter->GetTableReflectance(),
    filter->GetLeaveOut() ? 1.0 : 0.0, filter->GetEstimateError() ? 1.0 : 0.0, filter->GetEnvironmentAzimuth() };
  for (int number : { filter->GetImageSize()[0], filter->GetImageSize()[1], filter->GetQuality(),
         filter->GetRectangleSamples(), filter->GetAutoExposure(), filter->GetToneCurve(),
         filter->GetSurfaceReflection(), filter->GetTableFace(), filter->GetEnvironmentUp() })
  {
    numbers.push_back(number);
  }
  for (const double* triple : { filter->GetCameraPosition(), filter->GetCameraFocalPoint(), filter->GetCameraViewUp(),
         filter->GetBackgroundColor(), filter->GetBackgroundRadiance(), filter->GetTableColor() })
  {
    numbers.insert(numbers.end(), triple, triple + 3);
  }
  return numbers;
}
}
