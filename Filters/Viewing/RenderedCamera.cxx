#include "RenderedCamera.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"

#include "vtkCamera.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkRenderer.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double AlikeScales = 1e-6; ///< relative tolerance for uniform scaling without shear
/// Minimum distance from the camera to its focal point, as a fraction of the distance from the origin to the camera.
constexpr double SmallestDistance = 1e-15;

using Vec = std::array<double, 3>;

Vec Column(vtkMatrix4x4* matrix, int column)
{
  return { matrix->GetElement(0, column), matrix->GetElement(1, column), matrix->GetElement(2, column) };
}

/// Scale factor of a transformation.
/// @throws InvalidInput if the transformation does not scale uniformly, shears or mirrors
double ScaleOf(vtkMatrix4x4* matrix)
{
  const Vec columns[3] = { Column(matrix, 0), Column(matrix, 1), Column(matrix, 2) };
  const double square = vtkMath::Dot(columns[0], columns[0]);
  double off = matrix->Determinant() > 0.0 ? 0.0 : 1.0;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      off = std::max(off, std::abs(vtkMath::Dot(columns[i], columns[j]) / square - (i == j ? 1.0 : 0.0)));
    }
  }
  if (!(off <= AlikeScales))
  {
    throw InvalidInput(
      "The volume is stretched, sheared or mirrored by its transformation, or the camera is; light has "
      "been solved for the medium as it stands. Only turn, move and scale it alike along all axes.");
  }
  return std::sqrt(square);
}
}

namespace
{
/// Checks the vectors of a camera.
/// @throws InvalidInput if position, focal point or view up are not finite, or position and focal point coincide
void CheckCamera(vtkCamera* camera)
{
  Vec position, focalPoint, viewUp;
  camera->GetPosition(position.data());
  camera->GetFocalPoint(focalPoint.data());
  camera->GetViewUp(viewUp.data());
  for (const Vec& place : { position, focalPoint, viewUp })
  {
    Require(std::isfinite(place[0]) && std::isfinite(place[1]) && std::isfinite(place[2]),
      "The camera's position, focal point or view up is not finite.");
  }
  // VTK moves coinciding points apart, but for large coordinates by a distance that is lost in rounding.
  const double distance = std::sqrt(vtkMath::Distance2BetweenPoints(position.data(), focalPoint.data()));
  Require(distance > SmallestDistance * vtkMath::Norm(position.data()) && distance > 1e-19,
    "The camera's position and focal point are the same; move one, so that it is clear where it looks.");
}
}

RenderedCamera::RenderedCamera(vtkRenderer* renderer, vtkMatrix4x4* place)
{
  vtkCamera* const camera = renderer->GetActiveCamera();
  CheckCamera(camera);
  vtkNew<vtkMatrix4x4> toEye;
  vtkMatrix4x4::Multiply4x4(camera->GetModelViewTransformMatrix(), place, toEye);
  this->Scale = ScaleOf(toEye);
  vtkNew<vtkMatrix4x4> fromEye;
  vtkMatrix4x4::Invert(toEye, fromEye);
  // the projection matrix that VTK passes to OpenGL
  vtkMatrix4x4* const projection = camera->GetProjectionTransformMatrix(renderer->GetTiledAspectRatio(), -1.0, 1.0);
  const auto element = [projection](int row, int column) { return projection->GetElement(row, column); };
  this->Depth = { element(2, 2), element(2, 3), element(3, 2), element(3, 3) };

  // Origin and direction of the central ray, in eye coordinates. Column i of fromEye is axis i of the eye, one unit of
  // world length long, in the volume's coordinates.
  Vec origin = { 0.0, 0.0, 0.0 }, forward = { 0.0, 0.0, -1.0 };
  this->Seen.parallelProjection = camera->GetParallelProjection() != 0;
  this->Seen.aspect = element(1, 1) / element(0, 0);
  if (this->Seen.parallelProjection)
  {
    this->Seen.parallelScale = 1.0 / (element(1, 1) * this->Scale);
    this->Seen.shift = { -element(0, 3), -element(1, 3) };
    // For stereo VTK shears the picture of each eye, so that parallel rays are oblique to the picture's plane. Here the
    // plane is rotated with the rays instead, by about a degree.
    forward[0] = element(0, 2) / element(0, 0);
    forward[1] = element(1, 2) / element(1, 1);
  }
  else
  {
    this->Seen.viewAngle = std::atan(1.0 / element(1, 1)) * 360.0 / Pi;
    this->Seen.shift = { element(0, 2), element(1, 2) };
    // For stereo each eye is shifted sideways from the camera; points at the focal distance coincide in both pictures.
    origin[0] = -element(0, 3) / element(0, 0);
    origin[1] = -element(1, 3) / element(1, 1);
  }
  this->Seen.viewUp = Column(fromEye, 1);
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Seen.position[axis] = fromEye->GetElement(axis, 3);
    this->Seen.focalPoint[axis] = this->Seen.position[axis];
    for (int i = 0; i < 3; ++i)
    {
      const double step = fromEye->GetElement(axis, i);
      this->Seen.position[axis] += origin[i] * step;
      this->Seen.focalPoint[axis] += (origin[i] + camera->GetDistance() * forward[i]) * step;
    }
  }
}

std::vector<float> RenderedCamera::EndsOf(
  const std::vector<float>& depths, const std::array<int, 2>& buffer, const std::array<int, 2>& size) const
{
  if (std::all_of(depths.begin(), depths.end(), [](float depth) { return depth >= 1.0f; }))
  {
    return {};
  }
  const auto& [zz, z1, wz, w1] = this->Depth;
  const auto end = [&, zz = zz, z1 = z1, wz = wz, w1 = w1](float depth) {
    const double n = 2.0 * depth - 1.0;
    return depth >= 1.0f ? Endless : static_cast<float>((n * w1 - z1) / (n * wz - zz) / this->Scale);
  };
  std::vector<float> ends(static_cast<std::size_t>(size[0]) * size[1]);
  for (int j = 0; j < size[1]; ++j)
  {
    const std::size_t row = (2 * j + 1) * static_cast<std::size_t>(buffer[1]) / (2 * size[1]);
    for (int i = 0; i < size[0]; ++i)
    {
      const std::size_t column = (2 * i + 1) * static_cast<std::size_t>(buffer[0]) / (2 * size[0]);
      ends[static_cast<std::size_t>(j) * size[0] + i] = end(depths[row * buffer[0] + column]);
    }
  }
  return ends;
}
}
