#pragma once

#include "Viewing/Scene/Camera.h"

#include <array>
#include <vector>

class vtkMatrix4x4;
class vtkRenderer;

namespace tyndall
{
constexpr float Endless = 1e30f; ///< value of EndsOf for a ray that meets no opaque surface

/// Camera of a renderer, for the tile or eye that is being drawn, in the coordinates of a volume of the scene.
class RenderedCamera
{
public:
  /// Transforms the camera of a renderer to the coordinates of a volume.
  /// @param place  transformation from the volume's coordinates to the world's: rotation, translation, uniform scaling
  /// @throws InvalidInput for any other transformation, or an invalid camera
  RenderedCamera(vtkRenderer* renderer, vtkMatrix4x4* place);

  const Camera& AsSeen() const { return this->Seen; }

  /// Distances along the view axis, in the volume's unit of length, at which opaque surfaces end the rays, one per
  /// pixel: argument `ends` of MediumRayCaster::Render. Empty if no ray meets a surface.
  /// @param depths    depth buffer of the renderer, values in [0, 1], rows from bottom to top
  /// @param buffer    columns and rows of the depth buffer
  /// @param size      columns and rows of the picture; the depth of a ray is that at the centre of its pixel
  std::vector<float> EndsOf(
    const std::vector<float>& depths, const std::array<int, 2>& buffer, const std::array<int, 2>& size) const;

private:
  Camera Seen;
  std::array<double, 4> Depth = {}; ///< elements (2, 2), (2, 3), (3, 2), (3, 3) of the projection matrix
  double Scale = 1.0; ///< scale factor from the volume's to eye coordinates: world length per volume length
};
}
