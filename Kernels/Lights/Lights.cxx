#include "Lights/Lights.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace tyndall
{
Rgb Lookup(const Environment& environment, const std::array<double, 3>& direction)
{
  const double polar = std::atan2(std::hypot(direction[0], direction[1]), direction[2]);
  const double azimuth = std::atan2(direction[1], direction[0]);
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

double AxialIntensity(const Light& lamp)
{
  switch (lamp.type)
  {
    case LightType::Spot: return 1.0 / (2.0 * Pi * (1.0 - std::cos(0.5 * lamp.angle * Pi / 180.0)));
    case LightType::Rectangle: return 1.0 / Pi;
    case LightType::Point: return 1.0 / (4.0 * Pi);
    case LightType::Directional: break;
  }
  return 0.0;
}

std::array<std::array<double, 3>, 2> RectangleEdges(const Light& light)
{
  const auto [x, y, z] = light.direction;
  const double length = std::hypot(x, y, z);
  const double across = std::hypot(x, y);
  const bool vertical = across < 1e-9 * length;
  const double ex = vertical ? 1.0 : -y / across;
  const double ey = vertical ? 0.0 : x / across;
  const double s = light.size[1] / length;
  return { { { light.size[0] * ex, light.size[0] * ey, 0.0 },
    { -s * z * ey, s * z * ex, s * (x * ey - y * ex) } } }; // direction x first edge
}

namespace
{
Environment Shifted(const Environment& environment, int columns)
{
  Environment shifted = environment;
  const std::size_t row = 3 * static_cast<std::size_t>(environment.width);
  for (auto begin = shifted.radiance.begin(); begin != shifted.radiance.end(); begin += row)
  {
    std::rotate(begin, begin + 3 * (environment.width - columns), begin + row);
  }
  return shifted;
}

/// Mean of what is seen through pixel (i, j), which looks along `axes` of the environment's own frame.
Rgb SeenThrough(const Environment& environment, int i, int j, int up)
{
  constexpr int Parts = 2;
  const double pi = std::acos(-1.0);
  Rgb sum = {};
  double total = 0.0;
  for (int part = 0; part < Parts * Parts; ++part)
  {
    const int column = part % Parts;
    const int row = part / Parts;
    const double azimuth = 2.0 * pi * (i + (column + 0.5) / Parts) / environment.width;
    const double polar = pi * (1.0 - (j + (row + 0.5) / Parts) / environment.height);
    const std::array<double, 3> scene = { std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
      std::cos(polar) };
    const Rgb seen = Lookup(environment, { scene[(up + 1) % 3], scene[(up + 2) % 3], scene[up] });
    for (int c = 0; c < 3; ++c)
    {
      sum[c] += std::sin(polar) * seen[c];
    }
    total += std::sin(polar);
  }
  return { sum[0] / total, sum[1] / total, sum[2] / total };
}

Environment StoodUp(const Environment& environment, int up)
{
  Environment stood = environment;
  for (int j = 0; j < environment.height; ++j)
  {
    for (int i = 0; i < environment.width; ++i)
    {
      const Rgb seen = SeenThrough(environment, i, j, up);
      std::copy(
        seen.begin(), seen.end(), stood.radiance.begin() + 3 * (static_cast<std::size_t>(j) * environment.width + i));
    }
  }
  return stood;
}
}

Environment Turned(const Environment& environment, int up, double degrees)
{
  if (up < 0 || up > 2 || !std::isfinite(degrees))
  {
    throw InvalidInput("An environment stands up along axis 0, 1 or 2 (x, y, z) and is turned by a finite angle.");
  }
  if (environment.Empty())
  {
    return environment;
  }
  const double turn = degrees / 360.0 - std::floor(degrees / 360.0);
  const int columns = static_cast<int>(std::lround(turn * environment.width)) % environment.width;
  const Environment turned = columns == 0 ? environment : Shifted(environment, columns);
  return up == 2 ? turned : StoodUp(turned, up);
}

namespace
{
/// Light is worked with as floats.
bool Usable(double value)
{
  return value >= 0.0 && value <= std::numeric_limits<float>::max();
}

/// "1e+39; it must be ..."
std::string Refusal(double value)
{
  return Text("%.6g", value) + "; it must be finite and not negative, at most 3.40282e+38, as floats are.";
}

void CheckLight(const Light& light, std::size_t number)
{
  const std::string name = "Light " + std::to_string(number);
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!std::isfinite(light.position[axis]) || !std::isfinite(light.direction[axis]))
    {
      throw InvalidInput(name + " has a position or direction that is not finite.");
    }
    if (!Usable(light.power[axis]))
    {
      throw InvalidInput(name + " has power " + Refusal(light.power[axis]));
    }
  }
  if (light.type != LightType::Point && std::hypot(light.direction[0], light.direction[1], light.direction[2]) == 0.0)
  {
    throw InvalidInput(name + " has direction (0, 0, 0); say where it shines.");
  }
  if (light.type == LightType::Spot && !(light.angle > 0.0 && light.angle <= 180.0))
  {
    throw InvalidInput(name + " is a spot with opening angle " + Text("%g", light.angle) + "; it must be in (0, 180].");
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
    if (periodic[face / 2] && !IsBlack(albedo))
    {
      throw InvalidInput("FaceAlbedo of face " + FaceName(face) + " is (" + Text("%g", albedo[0]) + ", " +
        Text("%g", albedo[1]) + ", " + Text("%g", albedo[2]) +
        "), but its axis is periodic: what leaves there comes in on the other side. Give that face albedo 0, or switch "
        "off Periodic of the axis.");
    }
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
      if (!Usable(illumination.faces[face][c]))
      {
        throw InvalidInput("FaceRadiance of face " + FaceName(face) + " is " + Refusal(illumination.faces[face][c]));
      }
      if (!(illumination.faceAlbedo[face][c] >= 0.0 && illumination.faceAlbedo[face][c] <= 1.0))
      {
        throw InvalidInput("FaceAlbedo of face " + FaceName(face) + " is " +
          Text("%.6g", illumination.faceAlbedo[face][c]) +
          "; it must be from 0 to 1: the part of what leaves through the face that comes back.");
      }
    }
    if (!Usable(illumination.sky[c]))
    {
      throw InvalidInput("The sky's radiance (SkyColor) is " + Refusal(illumination.sky[c]));
    }
  }
  const Environment& environment = illumination.environment;
  for (std::size_t i = 0; i < environment.radiance.size(); ++i)
  {
    if (!Usable(environment.radiance[i]))
    {
      throw InvalidInput("The environment's radiance is " + Text("%g", environment.radiance[i]) + " in pixel (" +
        std::to_string(i / 3 % environment.width) + ", " + std::to_string(i / 3 / environment.width) +
        ") (the first such pixel); it must be finite and not negative.");
    }
  }
}
}
