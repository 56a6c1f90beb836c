#pragma once

#include "Common/ImageInput.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/ViewSettings.h"

#include <array>
#include <optional>
#include <vector>

class vtkMediumRayCaster;

/// Conversion of a ray caster's properties to the kernels' settings.
namespace tyndall
{
/// Radiance behind the medium in a picture that is displayed with this exposure.
/// @param exposure  0 if not known yet
Rgb BackgroundOf(vtkMediumRayCaster* filter, double exposure);

ViewSettings SettingsOf(vtkMediumRayCaster* filter, double exposure);

/// Transforms a camera from the scene's coordinates to a medium's own axes, and back.
Camera InOwnAxes(const Camera& inScene, const OwnAxes& axes);
Camera InScene(const Camera& camera, const OwnAxes& axes);

/// The filter's camera, in the axes in which the filter works.
/// @param grid  the whole medium's grid, which the camera frames if none is set
Camera CameraOf(vtkMediumRayCaster* filter, const Grid& grid);

/// The properties that must be equal on all ranks that render a picture together.
std::vector<double> PropertiesAsNumbers(vtkMediumRayCaster* filter);

/// Request of vtkLitVolumeMapper to its ray caster for one picture.
struct AskedView
{
  Camera camera;                  ///< replaces the filter's own camera
  std::array<int, 2> size = {};   ///< pixels, replaces ImageSize
  std::vector<float> ends;        ///< length at which each ray ends, see MediumRayCaster::Render
  double exposure = 0.0;          ///< of the display, to convert BackgroundColor to radiance; 0: not known yet
  std::optional<GridBlock> block; ///< the block of a larger grid that the medium is, see MediumRayCaster::Render
};
}
