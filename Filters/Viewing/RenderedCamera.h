#pragma once

#include "Viewing/Scene/Camera.h"

#include <array>
#include <vector>

class vtkMatrix4x4;
class vtkRenderer;

namespace tyndall
{
constexpr float Endless = 1e30f; ///< end of a ray that meets no surface, see MediumRayCaster::Render

/// A renderer's camera, for the tile or eye that is being drawn, in the coordinates of the volume that it looks at.
class RenderedCamera
{
public:
  /// @param place  transformation from the volume's coordinates to the world's: rotation, translation and uniform
  ///   scaling
  /// @throws InvalidInput for any other transformation
  RenderedCamera(vtkRenderer* renderer, vtkMatrix4x4* place);

  const Camera& AsSeen() const { return this->Seen; }

  /// Lengths at which opaque surfaces end the rays (MediumRayCaster::Render); empty if there is no surface.
  /// @param depths    the renderer's depth buffer, in [0, 1], row by row from below
  /// @param buffer    columns and rows of the depth buffer
  /// @param size      columns and rows of the picture; each ray takes the depth at its pixel's centre
  std::vector<float> EndsOf(
    const std::vector<float>& depths, const std::array<int, 2>& buffer, const std::array<int, 2>& size) const;

private:
  Camera Seen;
  std::array<double, 4> Depth = {}; ///< elements of the projection matrix: rows 2 and 3, columns 2 and 3
  double Scale = 1.0;               ///< scale factor of the transformation: world length over the volume's
};
}
