#pragma once

#include "Medium/Grid.h"

#include <array>

namespace tyndall
{
/// Camera parameters, named as in vtkCamera; lengths in the dataset's own unit.
struct Camera
{
  std::array<double, 3> position = { 0.0, 0.0, 1.0 };
  std::array<double, 3> focalPoint = { 0.0, 0.0, 0.0 }; ///< point that is projected to the picture's centre
  std::array<double, 3> viewUp = { 0.0, 0.0, 1.0 }; ///< up direction of the picture; not parallel to the view direction
  double viewAngle = 30.0;                          ///< full vertical angle of view, degrees, in (0, 180)
  bool parallelProjection = false;                  ///< whether rays are parallel instead of starting at `position`
  /// Half the height of the picture in a parallel projection, in units of length, > 0
  double parallelScale = 1.0;
  /// Width over height of the picture; 0: that of the image size, for square pixels.
  double aspect = 0.0;
  /// Offset of the picture's centre from the focal point, to the right and upwards, in units of half the picture's
  /// width and height: for a tile of a larger picture, or for one eye of a stereo pair.
  std::array<double, 2> shift = { 0.0, 0.0 };
  bool mirrored = false; ///< whether the picture is flipped left to right
};

/// The direction towards the camera in the default view, a three-quarter view from the front and slightly from above.
/// The axis nearest to `viewUp` points upwards; if it is z, the sides -y and +x and the top are visible.
std::array<double, 3> ThreeQuarterView(const std::array<double, 3>& viewUp);

/// A camera that looks at the grid's centre and shows the whole box with a margin of 5% of the picture.
/// @param aspect   width over height of the picture
/// @param towards  from the grid's centre to the camera, any length but 0
/// @param viewUp   replaced by y if it is parallel to the view direction
Camera FrameGrid(const Grid& grid, double aspect, double viewAngle = 30.0,
  const std::array<double, 3>& towards = ThreeQuarterView({ 0.0, 0.0, 1.0 }),
  const std::array<double, 3>& viewUp = { 0.0, 0.0, 1.0 });

/// The camera's axes in world coordinates, unit vectors: right and up in the picture, and forward.
/// @throws InvalidInput if position and focal point coincide, viewUp is parallel to the view direction, or a number is
///   invalid
std::array<std::array<double, 3>, 3> Axes(const Camera& camera);

/// Checks that ray coordinates do not overflow.
/// @throws InvalidInput if the camera is so far from the grid, or the picture so wide, that they do
void CheckDistance(const Camera& camera, const Grid& grid);
}
