#pragma once

#include "Medium/Grid.h"

#include <array>

namespace tyndall
{
/// Where the picture is taken from; named as vtkCamera names it, lengths in the dataset's own unit.
struct Camera
{
  std::array<double, 3> position = { 0.0, 0.0, 1.0 };
  std::array<double, 3> focalPoint = { 0.0, 0.0, 0.0 }; ///< seen in the picture's centre
  std::array<double, 3> viewUp = { 0.0, 0.0, 1.0 };     ///< upwards in the picture; not along the view
  double viewAngle = 30.0;         ///< between the picture's lower and upper edge, degrees, in (0, 180)
  bool parallelProjection = false; ///< parallel rays instead of rays from `position`
  double parallelScale = 1.0;      ///< then half the picture's height, length, > 0
  double aspect = 0.0;             ///< the picture's width over its height; 0: as pixels that are square have it
  /// From the focal point to the picture's middle, to the right and upwards, in halves of its width and height: of a
  /// part of a larger picture, or one for the left or right eye.
  std::array<double, 2> shift = { 0.0, 0.0 };
  bool mirrored = false; ///< the scene is: what is to the right in the picture is to the left of it
};

/// The direction of the default view: three quarters from the front and a little from above, with the axis nearest
/// to `viewUp` upwards; for z the sides -y and +x and the top are seen.
std::array<double, 3> ThreeQuarterView(const std::array<double, 3>& viewUp);

/// A camera that looks at the grid's centre and sees all of the box, with a margin of 5% of the picture.
/// @param aspect   width over height of the picture
/// @param towards  from the grid's centre to the camera, any length but 0
/// @param viewUp   replaced by y where it is along the view
Camera FrameGrid(const Grid& grid, double aspect, double viewAngle = 30.0,
  const std::array<double, 3>& towards = ThreeQuarterView({ 0.0, 0.0, 1.0 }),
  const std::array<double, 3>& viewUp = { 0.0, 0.0, 1.0 });

/// The camera's axes in the world, unit vectors: to the right, upwards in the picture, and forward.
/// @throws InvalidInput where position and focal point coincide, viewUp is along the view, or a number is not usable
std::array<std::array<double, 3>, 3> Axes(const Camera& camera);
}
