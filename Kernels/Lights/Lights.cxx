#include "Lights/Lights.h"

#include "Device/Errors.h"
#include "Medium/Grid.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"
#include "Numerics/Vectors.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
std::array<double, 3> Product(const Rotation& matrix, const std::array<double, 3>& v)
{
  std::array<double, 3> product;
  for (int row = 0; row < 3; ++row)
  {
    product[row] = matrix[row][0] * v[0] + matrix[row][1] * v[1] + matrix[row][2] * v[2];
  }
  return product;
}

Rotation Transposed(const Rotation& matrix)
{
  Rotation transposed;
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      transposed[row][column] = matrix[column][row];
    }
  }
  return transposed;
}
}

std::array<double, 3> Environment::ToPicture(const std::array<double, 3>& inScene) const
{
  return Product(this->toPicture, inScene);
}

std::array<double, 3> Environment::ToScene(const std::array<double, 3>& inPicture) const
{
  return Product(Transposed(this->toPicture), inPicture);
}

Rgb Lookup(const Environment& environment, const std::array<double, 3>& direction)
{
  const std::array<double, 3> seen = environment.ToPicture(direction);
  const double polar = std::atan2(std::hypot(seen[0], seen[1]), seen[2]);
  const double azimuth = std::atan2(seen[1], seen[0]);
  const double column = (azimuth < 0.0 ? azimuth / (2.0 * Pi) + 1.0 : azimuth / (2.0 * Pi)) * environment.width - 0.5;
  const double row = (1.0 - polar / Pi) * environment.height - 0.5;
  const double left = std::floor(column);
  const double below = std::floor(row);
  Rgb sum = {};
  for (int corner = 0; corner < 4; ++corner)
  {
    const int dx = corner % 2;
    const int dy = corner / 2;
    const double weight = (dx ? column - left : 1.0 - (column - left)) * (dy ? row - below : 1.0 - (row - below));
    const int i = (static_cast<int>(left) + dx + environment.width) % environment.width;
    const int j = std::min(std::max(static_cast<int>(below) + dy, 0), environment.height - 1);
    const std::size_t pixel = 3 * (static_cast<std::size_t>(j) * environment.width + i);
    for (int c = 0; c < 3; ++c)
    {
      sum[c] += weight * environment.radiance[pixel + c];
    }
  }
  return sum;
}

namespace
{
/// Smallest opening angle of a spot, degrees. The squared sine of a smaller angle underflows in floats.
constexpr double LeastSpotAngle = 1e-12;

/// Unit vector along a vector; 0 if the vector is 0. The vector is scaled first, so that squares neither underflow nor
/// overflow.
glm::dvec3 Unit(const std::array<double, 3>& vector)
{
  const double largest = std::max({ std::abs(vector[0]), std::abs(vector[1]), std::abs(vector[2]) });
  return largest > 0.0 ? glm::normalize(Vector(vector) / largest) : Vector(vector);
}
}

std::array<double, 3> DirectionOf(const Light& light)
{
  const glm::dvec3 unit = Unit(light.direction);
  return { unit.x, unit.y, unit.z };
}

double AngleFromAxis(const Light& light, const std::array<double, 3>& way)
{
  const glm::dvec3 axis = Unit(light.direction), along = Unit(way);
  return std::atan2(glm::length(glm::cross(along, axis)), glm::dot(along, axis));
}

double HalfAngle(const Light& spot)
{
  return 0.5 * spot.angle * Pi / 180.0;
}

void SetFineness(std::vector<Light>& lights, Quality quality)
{
  const double fineness[] = { 0.7, 1.0, 2.0, 3.0 };
  for (Light& light : lights)
  {
    light.fineness = fineness[static_cast<int>(quality)];
  }
}

double AxialIntensity(const Light& lamp)
{
  const double sine = std::sin(0.5 * HalfAngle(lamp));
  switch (lamp.type)
  {
    // 2 sin^2(angle / 2) equals 1 - cos(angle), which would be inaccurate for a narrow cone
    case LightType::Spot: return 1.0 / (4.0 * Pi * sine * sine);
    case LightType::Rectangle: return 1.0 / Pi;
    case LightType::Point: return 1.0 / (4.0 * Pi);
    case LightType::Directional: break;
  }
  return 0.0;
}

std::array<std::array<double, 3>, 2> RectangleEdges(const Light& light)
{
  const auto [x, y, z] = DirectionOf(light);
  const double across = std::hypot(x, y);
  const bool vertical = across < 1e-9;
  const double ex = vertical ? 1.0 : -y / across;
  const double ey = vertical ? 0.0 : x / across;
  const double s = light.size[1];
  if (light.angle != 0.0)
  {
    const glm::dvec3 level(ex, ey, 0.0), steep(-z * ey, z * ex, x * ey - y * ex);
    const double cosine = std::cos(light.angle * Pi / 180.0), sine = std::sin(light.angle * Pi / 180.0);
    const glm::dvec3 first = light.size[0] * (cosine * level + sine * steep);
    const glm::dvec3 second = s * (cosine * steep - sine * level);
    return { { { first.x, first.y, first.z }, { second.x, second.y, second.z } } };
  }
  return { { { light.size[0] * ex, light.size[0] * ey, 0.0 },
    { -s * z * ey, s * z * ex, s * (x * ey - y * ex) } } }; // second edge: direction x first edge
}

namespace
{
constexpr double FarAway = 1e5; ///< distance, relative to the box's longest edge, from which light is taken as parallel
/// Distance of a lamp, relative to the box's longest edge, at which doubles can no longer resolve which voxels its cone
/// illuminates.
constexpr double TooFarToAim = 1e10;
/// A rectangle is taken as a point if its largest edge, relative to its distance, is at most this.
constexpr double SmallFromFar = 1e-3;

/// Directional light that replaces a lamp that is further away than FarAway.
/// @param way  vector from the lamp to the box's centre
Light Parallel(const Light& lamp, const glm::dvec3& way, double distance)
{
  const double angle = AngleFromAxis(lamp, { way.x, way.y, way.z });
  const double part = lamp.type == LightType::Rectangle ? std::max(std::cos(angle), 0.0)
    : lamp.type == LightType::Spot                      ? (angle <= HalfAngle(lamp) ? 1.0 : 0.0)
                                                        : 1.0;
  Light beam = lamp;
  beam.type = LightType::Directional;
  const glm::dvec3 along = Unit({ way.x, way.y, way.z });
  beam.direction = { along.x, along.y, along.z };
  beam.power = Times(lamp.power, part * AxialIntensity(lamp) / distance / distance);
  return beam;
}

Light SeenFrom(const Grid& grid, const Light& lamp, std::size_t number)
{
  const std::array<double, 3> edges = { grid.Length(0), grid.Length(1), grid.Length(2) };
  const double longest = std::max({ edges[0], edges[1], edges[2] });
  const glm::dvec3 way = Vector(grid.origin) + 0.5 * Vector(edges) - Vector(lamp.position);
  const double distance = std::hypot(way.x, way.y, way.z);
  const double size = std::max(lamp.size[0], lamp.size[1]);
  if (lamp.type == LightType::Directional || distance < FarAway * longest ||
    (lamp.type == LightType::Rectangle && size > SmallFromFar * distance))
  {
    return lamp;
  }
  const double ofBox =
    std::hypot(edges[0], edges[1], edges[2]) / distance; // upper limit of half the box's angular size
  if (lamp.type == LightType::Spot && std::abs(AngleFromAxis(lamp, { way.x, way.y, way.z }) - HalfAngle(lamp)) < ofBox)
  {
    if (distance > TooFarToAim * longest)
    {
      throw InvalidInput("Light " + std::to_string(number) + " is a spot " + Text("%.3g", distance / longest) +
        " box lengths away, and the border of its cone crosses the box; where is not known from so far. Put it nearer, "
        "or take a directional light.");
    }
    return lamp;
  }
  return Parallel(lamp, way, distance);
}
}

std::vector<Light> SeenFrom(const Grid& grid, std::vector<Light> lights)
{
  for (std::size_t i = 0; i < lights.size(); ++i)
  {
    lights[i] = SeenFrom(grid, lights[i], i);
  }
  return lights;
}

namespace
{
/// Rotation about z, exact for quarter turns.
Rotation AboutZ(double degrees)
{
  const double quarters = degrees / 90.0;
  const int whole = static_cast<int>(std::lround(quarters - 4.0 * std::floor(quarters / 4.0))) % 4;
  const double exact[] = { 0.0, 1.0, 0.0, -1.0 };
  const bool isExact = quarters == std::round(quarters);
  const double sine = isExact ? exact[whole] : std::sin(degrees * Pi / 180.0);
  const double cosine = isExact ? exact[(whole + 1) % 4] : std::cos(degrees * Pi / 180.0);
  return { { { cosine, -sine, 0.0 }, { sine, cosine, 0.0 }, { 0.0, 0.0, 1.0 } } };
}
}

Environment Turned(const Environment& environment, const Rotation& rotation)
{
  for (int a = 0; a < 3; ++a)
  {
    for (int b = 0; b < 3; ++b)
    {
      const double product = Product(rotation, rotation[a])[b];
      Require(std::abs(product - (a == b ? 1.0 : 0.0)) < 1e-6,
        "An environment is turned by an orthogonal matrix: rows of length 1 that stand at right "
        "angles to each other.");
    }
  }
  Environment turned = environment;
  for (int row = 0; row < 3; ++row)
  {
    turned.toPicture[row] = Product(rotation, environment.toPicture[row]); // each row r of the matrix becomes R r
  }
  return turned;
}

Environment Turned(const Environment& environment, int up, double degrees)
{
  Require(up >= 0 && up <= 2 && std::isfinite(degrees),
    "An environment stands up along axis 0, 1 or 2 (x, y, z) and is turned by a finite angle.");
  Rotation stands = {}; // rotation that maps the picture's +z to axis `up` of the scene
  stands[up][2] = stands[(up + 1) % 3][0] = stands[(up + 2) % 3][1] = 1.0;
  return Turned(Turned(environment, AboutZ(degrees)), stands);
}

namespace
{
/// End of the error message for a number that cannot be a power or radiance: "1e+39; it must be ...".
std::string Refusal(double value)
{
  return Text("%.6g", value) + "; it must be finite and not negative, at most 3.40282e+38, as floats are.";
}

void CheckLight(const Light& light, std::size_t number)
{
  const std::string name = "Light " + std::to_string(number);
  for (int axis = 0; axis < 3; ++axis)
  {
    Require(std::isfinite(light.position[axis]) && std::isfinite(light.direction[axis]),
      name + " has a position or direction that is not finite.");
    Require(IsUsable(light.power[axis]), name + " has power " + Refusal(light.power[axis]));
  }
  if (light.type != LightType::Point && Unit(light.direction) == glm::dvec3(0.0))
  {
    throw InvalidInput(name + " has direction (0, 0, 0); say where it shines.");
  }
  if (light.type == LightType::Spot && !(light.angle >= LeastSpotAngle && light.angle <= 180.0))
  {
    throw InvalidInput(
      name + " is a spot with opening angle " + Text("%.6g", light.angle) + "; it must be from 1e-12 to 180 degrees.");
  }
  if (light.type == LightType::Rectangle &&
    !(light.size[0] > 0.0 && light.size[1] > 0.0 && std::isfinite(light.size[0] * light.size[1])))
  {
    throw InvalidInput(name + " is a rectangle without a size; give both edges a positive length.");
  }
}
}

namespace
{
std::string FaceName(std::size_t face)
{
  return std::to_string(face) + " (-x, +x, -y, +y, -z, +z)";
}

bool AnyShines(const std::array<Rgb, 6>& faces)
{
  return std::any_of(faces.begin(), faces.end(), [](const Rgb& face) { return Sum(face) > 0.0; });
}
}

bool Shines(const Illumination& illumination)
{
  const std::vector<float>& pixels = illumination.environment.radiance;
  return Sum(illumination.sky) > 0.0 ||
    std::any_of(illumination.lights.begin(), illumination.lights.end(),
      [](const Light& light) { return Sum(light.power) > 0.0; }) ||
    AnyShines(illumination.faces) ||
    std::any_of(pixels.begin(), pixels.end(), [](float pixel) { return pixel > 0.0f; }) ||
    illumination.uncollided.IsThere();
}

bool AnyHasPosition(const std::vector<Light>& lights)
{
  return std::any_of(
    lights.begin(), lights.end(), [](const Light& light) { return light.type != LightType::Directional; });
}

bool ShinesThroughFaces(const Illumination& illumination)
{
  return Sum(illumination.sky) > 0.0 || !illumination.environment.Empty() || AnyShines(illumination.faces);
}

bool Reflects(const Illumination& illumination)
{
  return std::any_of(
    illumination.faceAlbedo.begin(), illumination.faceAlbedo.end(), [](const Rgb& face) { return Sum(face) > 0.0; });
}

void CheckFaceAlbedo(const Illumination& illumination, const std::array<bool, 3>& periodic)
{
  for (std::size_t face = 0; face < 6; ++face)
  {
    const Rgb& albedo = illumination.faceAlbedo[face];
    Require(!periodic[face / 2] || IsBlack(albedo),
      "FaceAlbedo of face " + FaceName(face) + " is (" + Text("%g", albedo[0]) + ", " + Text("%g", albedo[1]) + ", " +
        Text("%g", albedo[2]) +
        "), but its axis is periodic: what leaves there comes in on the other side. Give that face albedo 0, or switch "
        "off Periodic of the axis.");
  }
}

void Check(const Illumination& illumination)
{
  for (std::size_t i = 0; i < illumination.lights.size(); ++i)
  {
    CheckLight(illumination.lights[i], i);
  }
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t face = 0; face < 6; ++face)
    {
      Require(IsUsable(illumination.faces[face][c]),
        "FaceRadiance of face " + FaceName(face) + " is " + Refusal(illumination.faces[face][c]));
      if (!(illumination.faceAlbedo[face][c] >= 0.0 && illumination.faceAlbedo[face][c] <= 1.0))
      {
        throw InvalidInput("FaceAlbedo of face " + FaceName(face) + " is " +
          Text("%.6g", illumination.faceAlbedo[face][c]) +
          "; it must be from 0 to 1: the part of what leaves through the face that comes back.");
      }
    }
    Require(IsUsable(illumination.sky[c]), "The sky's radiance (SkyColor) is " + Refusal(illumination.sky[c]));
  }
  const Environment& environment = illumination.environment;
  for (std::size_t i = 0; i < environment.radiance.size(); ++i)
  {
    if (!IsUsable(environment.radiance[i]))
    {
      throw InvalidInput("The environment's radiance is " + Text("%g", environment.radiance[i]) + " in pixel (" +
        std::to_string(i / 3 % environment.width) + ", " + std::to_string(i / 3 / environment.width) +
        ") (the first such pixel); it must be finite and not negative.");
    }
  }
}
}
