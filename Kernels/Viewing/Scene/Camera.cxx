#include "Viewing/Scene/Camera.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"
#include "Numerics/Vectors.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
/// Largest distance of the camera, in units of length or in voxels; its square does not overflow a float.
constexpr double FarthestCamera = 1e15;

std::array<double, 3> Array(const glm::dvec3& v)
{
  return { v.x, v.y, v.z };
}

bool Finite(const std::array<double, 3>& v)
{
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

/// The vector, scaled so that its largest component is 1: the square of its length cannot overflow. 0 for 0.
glm::dvec3 Scaled(const glm::dvec3& v)
{
  const double largest = std::max({ std::abs(v.x), std::abs(v.y), std::abs(v.z) });
  return largest > 0.0 ? v / largest : v;
}

double TangentOfHalf(double degrees)
{
  return std::tan(degrees * std::acos(-1.0) / 360.0);
}
}

std::array<std::array<double, 3>, 3> Axes(const Camera& camera)
{
  Require(Finite(camera.position) && Finite(camera.focalPoint) && Finite(camera.viewUp),
    "The camera's position, focal point or view up is not finite.");
  Require(camera.parallelProjection || (camera.viewAngle > 0.0 && camera.viewAngle < 180.0),
    "The camera's view angle is " + Text("%g", camera.viewAngle) + " degrees; it must be between 0 and 180.");
  Require(!camera.parallelProjection || (camera.parallelScale > 0.0 && std::isfinite(camera.parallelScale)),
    "The camera's parallel scale is " + Text("%g", camera.parallelScale) +
      "; it is half the picture's height and must be positive.");
  // Halving both positions avoids overflow of their difference.
  const glm::dvec3 view = Scaled(0.5 * Vector(camera.focalPoint) - 0.5 * Vector(camera.position));
  Require(view != glm::dvec3(0.0),
    "The camera's position and focal point are the same; move one, so that it is clear where it looks.");
  const glm::dvec3 forward = glm::normalize(view);
  const glm::dvec3 up = Scaled(Vector(camera.viewUp));
  Require(up != glm::dvec3(0.0), "The camera's view up is zero; say what is upwards in the picture.");
  const glm::dvec3 right = glm::cross(forward, up);
  Require(glm::length(right) > 1e-9 * glm::length(up), "The camera's view up is along its view; choose one across it.");
  const glm::dvec3 unitRight = glm::normalize(right);
  const glm::dvec3 upwards = glm::cross(unitRight, forward);
  return { Array(camera.mirrored ? -unitRight : unitRight), Array(upwards), Array(forward) };
}

std::array<double, 3> ThreeQuarterView(const std::array<double, 3>& viewUp)
{
  int up = 2;
  for (int axis : { 1, 0 })
  {
    up = std::abs(viewUp[axis]) > std::abs(viewUp[up]) ? axis : up;
  }
  std::array<double, 3> towards;
  towards[up] = std::copysign(0.5, viewUp[up]);
  towards[(up + 1) % 3] = 0.55;
  towards[(up + 2) % 3] = -1.0;
  return towards;
}

Camera FrameGrid(const Grid& grid, double aspect, double viewAngle, const std::array<double, 3>& towards,
  const std::array<double, 3>& viewUp)
{
  Camera camera;
  camera.viewAngle = viewAngle;
  camera.viewUp = viewUp;
  const glm::dvec3 out = glm::normalize(Vector(towards));
  if (glm::length(glm::cross(out, Vector(viewUp))) < 1e-6 * glm::length(Vector(viewUp)))
  {
    camera.viewUp = { 0.0, 1.0, 0.0 };
  }
  const glm::dvec3 half(0.5 * grid.Length(0), 0.5 * grid.Length(1), 0.5 * grid.Length(2));
  const glm::dvec3 centre = Vector(grid.origin) + half;
  camera.focalPoint = Array(centre);
  camera.position = Array(centre + glm::length(half) * out);
  const auto axes = Axes(camera);

  // Smallest distance of the camera at which every corner of the box is inside the picture. The margin is applied
  // afterwards.
  const double margin = 1.05;
  const double upperEdge = TangentOfHalf(viewAngle);
  double distance = 0.0;
  double highest = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec3 at(corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z);
    const double x = std::abs(glm::dot(at, Vector(axes[0]))) / aspect;
    const double y = std::abs(glm::dot(at, Vector(axes[1])));
    const double z = glm::dot(at, Vector(axes[2]));
    highest = std::max({ highest, x, y });
    distance = std::max(distance, margin * std::max(x, y) / upperEdge - z);
  }
  camera.position = Array(centre + distance * out);
  camera.parallelScale = margin * highest;
  return camera;
}

void CheckDistance(const Camera& camera, const Grid& grid)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double away = std::abs(camera.position[axis] - grid.origin[axis]);
    Require(away <= FarthestCamera && away / grid.spacing[axis] <= FarthestCamera,
      "The camera is too far away: " + Text("%g", away) + " from the medium's corner along " + "xyz"[axis] + ", " +
        Text("%g", away / grid.spacing[axis]) + " voxels; come closer than " + Text("%g", FarthestCamera) +
        " of both.");
    Require(!camera.parallelProjection || camera.parallelScale / grid.spacing[axis] <= FarthestCamera,
      "The camera's parallel scale is " + Text("%g", camera.parallelScale) + ", " +
        Text("%g", camera.parallelScale / grid.spacing[axis]) + " voxels along " + "xyz"[axis] +
        "; it may be at most " + Text("%g", FarthestCamera) + " voxels.");
  }
}
}
