#pragma once

#include "Common/ImageInput.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/ViewSettings.h"

#include <vector>

class vtkMediumRayCaster;

/// What the properties of a ray caster mean to the kernels.
namespace tyndall
{
/// What is behind the medium in a picture that is shown with this exposure, radiance.
/// @param exposure  0: it is not known yet
Rgb BackgroundOf(vtkMediumRayCaster* filter, double exposure);

ViewSettings SettingsOf(vtkMediumRayCaster* filter, double exposure);

/// The same view of a medium that lies in axes of its own, and the other way round.
Camera InOwnAxes(const Camera& inScene, const OwnAxes& axes);
Camera InScene(const Camera& camera, const OwnAxes& axes);

/// In the axes in which the filter works.
/// @param grid  of the whole medium, which is looked at where the filter has no camera of its own
Camera CameraOf(vtkMediumRayCaster* filter, const Grid& grid);

/// What has to be the same on all ranks that make a picture together.
std::vector<double> PropertiesAsNumbers(vtkMediumRayCaster* filter);
}
