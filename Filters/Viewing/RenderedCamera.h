#pragma once

#include "Viewing/Scene/Camera.h"

#include <array>
#include <vector>

class vtkMatrix4x4;
class vtkRenderer;

namespace tyndall
{
constexpr float Endless = 1e30f; ///< of a ray that no surface ends, see MediumRayCaster::Render

/// A renderer's camera, its part for the tile or the eye that is being drawn, in the coordinates of what it looks at.
class RenderedCamera
{
public:
  /// @param place  of what it looks at in the world: turned, moved and scaled alike along all axes
  /// @throws InvalidInput for another place
  RenderedCamera(vtkRenderer* renderer, vtkMatrix4x4* place);

  const Camera& AsSeen() const { return this->Seen; }

  /// Where opaque surfaces end rays (MediumRayCaster::Render); empty where there is no surface.
  /// @param depths    of the renderer's depth buffer, in [0, 1], row by row from below
  /// @param buffer    its columns and rows
  /// @param size      of the picture: each ray takes the depth at its middle
  std::vector<float> EndsOf(
    const std::vector<float>& depths, const std::array<int, 2>& buffer, const std::array<int, 2>& size) const;

private:
  Camera Seen;
  std::array<double, 4> Depth = {}; ///< of the projection: rows 2 and 3, columns 2 and 3
  double Scale = 1.0;               ///< of the place: world lengths by its own
};
}
