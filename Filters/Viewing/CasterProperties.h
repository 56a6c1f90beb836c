#pragma once

#include "Common/ImageInput.h"
#include "Common/LightTransportData.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/ViewSettings.h"

#include <array>
#include <optional>
#include <vector>

class vtkMediumRayCaster;

/// Conversion of the properties of a vtkMediumRayCaster to settings of the kernels.
namespace tyndall
{
/// Radiance behind the medium, W/(length^2 sr): BackgroundRadiance or, if that is 0, the radiance that is displayed as
/// BackgroundColor with this exposure.
/// @param exposure  factor by which radiance is displayed; 0: not known yet, BackgroundColor counts as black
Rgb BackgroundOf(vtkMediumRayCaster* filter, double exposure);

ViewSettings SettingsOf(vtkMediumRayCaster* filter, double exposure);

/// InOwnAxes transforms a camera from the scene's coordinates to a medium's own axes; InScene is the inverse.
Camera InOwnAxes(const Camera& inScene, const OwnAxes& axes);
Camera InScene(const Camera& camera, const OwnAxes& axes);

/// Camera of a filter that has the properties of tyndallCameraMacro, in the scene's coordinates.
template <class Filter>
Camera CameraSetOn(Filter* filter)
{
  Camera camera;
  camera.position = Triple(filter->GetCameraPosition());
  camera.focalPoint = Triple(filter->GetCameraFocalPoint());
  camera.viewUp = Triple(filter->GetCameraViewUp());
  camera.viewAngle = filter->GetCameraViewAngle();
  return camera;
}

/// Camera of the filter, in the medium's own axes (OwnAxes).
/// @param grid  grid of the whole medium, which the camera frames if CameraPosition equals CameraFocalPoint
Camera CameraOf(vtkMediumRayCaster* filter, const Grid& grid);

/// Values of the properties that must be equal on all ranks that render a picture together.
std::vector<double> PropertiesAsNumbers(vtkMediumRayCaster* filter);

/// Request of vtkLitVolumeMapper to its vtkMediumRayCaster for one picture.
struct AskedView
{
  Camera camera;                ///< camera in the scene's coordinates; replaces the filter's camera
  std::array<int, 2> size = {}; ///< columns and rows of pixels; replaces ImageSize
  /// Distance along the view axis at which an opaque surface ends each pixel's ray, in units of length; empty: no ray
  /// ends.
  std::vector<float> ends;
  double exposure = 0.0; ///< exposure by which BackgroundColor is converted to radiance; 0: not known yet
  /// Position of the medium in the larger grid of which it is a block; no value: the medium is a whole grid.
  std::optional<GridBlock> block;
};
}
