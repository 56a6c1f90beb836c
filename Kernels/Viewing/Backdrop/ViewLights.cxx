#include "Viewing/Backdrop/ViewLights.h"

#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tyndall
{
std::vector<SmallLight> SmallLights(const std::vector<Light>& lights, const Grid& grid, int rectangleSamples)
{
  std::vector<SmallLight> small;
  const auto add = [&](const glm::dvec3& place, bool point, const glm::dvec3& axis, double cone, const Rgb& power,
                     double scale, bool cosine) {
    small.push_back(
      { Float4(place, point ? 1.0 : 0.0), Float4(axis, cone), Float4(scale * Vector(power), cosine ? 1.0 : 0.0) });
  };
  for (const Light& light : lights)
  {
    const double length = glm::length(Vector(light.direction));
    const glm::dvec3 axis = length > 0.0 ? Vector(light.direction) / length : glm::dvec3(0.0, 0.0, -1.0);
    const glm::dvec3 place = Vector(light.position) - Vector(grid.origin);
    if (IsBlack(light.power))
    {
      continue;
    }
    if (light.type == LightType::Directional)
    {
      add({ 0.0, 0.0, 0.0 }, false, axis, -2.0, light.power, 1.0, false);
    }
    else if (light.type == LightType::Point)
    {
      add(place, true, axis, -2.0, light.power, 1.0 / (4.0 * Pi), false);
    }
    else if (light.type == LightType::Spot)
    {
      const double cone = std::cos(light.angle * Pi / 360.0);
      add(place, true, axis, cone, light.power, 1.0 / (2.0 * Pi * (1.0 - cone)), false);
    }
    else
    {
      // Lambertian: radiant intensity along the axis is power / pi.
      const auto edges = RectangleEdges(light);
      const int n = rectangleSamples;
      for (int sample = 0; sample < n * n; ++sample)
      {
        const glm::dvec3 offset =
          ((sample % n + 0.5) / n - 0.5) * Vector(edges[0]) + ((sample / n + 0.5) / n - 0.5) * Vector(edges[1]);
        add(place + offset, true, axis, -2.0, light.power, 1.0 / (Pi * n * n), true);
      }
    }
  }
  return small;
}

std::vector<cl_float4> ClosedEnvironment(const Environment& environment)
{
  const int width = environment.width;
  std::vector<cl_float4> pixels(static_cast<std::size_t>(width + 2) * environment.height);
  for (int j = 0; j < environment.height; ++j)
  {
    for (int i = 0; i < width + 2; ++i)
    {
      const std::size_t from = 3 * (static_cast<std::size_t>(j) * width + (i + width - 1) % width);
      pixels[static_cast<std::size_t>(j) * (width + 2) + i] = { { environment.radiance[from],
        environment.radiance[from + 1], environment.radiance[from + 2], 0.0f } };
    }
  }
  return pixels;
}

std::array<int, 2> FaceSize(const Grid& grid, int face)
{
  const PlaneAxes axes = AcrossAxis(face / 2);
  return { grid.size[axes.u], grid.size[axes.v] };
}

std::vector<cl_float4> WithBorders(const Grid& grid, const std::vector<cl_float4>& cells)
{
  std::vector<cl_float4> padded;
  std::size_t first = 0;
  for (int face = 0; face < 6; ++face)
  {
    const std::array<int, 2> size = FaceSize(grid, face);
    for (int j = -1; j <= size[1]; ++j)
    {
      for (int i = -1; i <= size[0]; ++i)
      {
        const std::size_t row = std::clamp(j, 0, size[1] - 1);
        padded.push_back(cells[first + row * size[0] + std::clamp(i, 0, size[0] - 1)]);
      }
    }
    first += static_cast<std::size_t>(size[0]) * size[1];
  }
  return padded;
}

std::vector<cl_float4> TableLight(
  const Grid& grid, const Field& fluence, const Field& meanDirection, const Field& ior, int face, bool fromBelow)
{
  const int axis = face / 2;
  const double outwards = face % 2 ? 1.0 : -1.0;
  const std::array<int, 2> size = FaceSize(grid, face);
  const std::array<std::size_t, 3> strides = grid.Strides();
  std::vector<cl_float4> lit;
  lit.reserve(static_cast<std::size_t>(size[0] + 2) * (size[1] + 2));
  for (int j = -1; j <= size[1]; ++j)
  {
    for (int i = -1; i <= size[0]; ++i)
    {
      const std::size_t voxel = std::clamp(i, 0, size[0] - 1) * strides[AcrossAxis(axis).u] +
        std::clamp(j, 0, size[1] - 1) * strides[AcrossAxis(axis).v] +
        (face % 2 ? grid.size[axis] - 1 : 0) * strides[axis];
      const double n = ior.values ? ior.values[voxel] : 1.0;
      glm::dvec3 mean(0.0);
      if (meanDirection.values)
      {
        const float* m = meanDirection.values + 3 * voxel;
        mean = glm::dvec3(m[0], m[1], m[2]) / std::max(1.0, glm::length(glm::dvec3(m[0], m[1], m[2])));
      }
      const double even = fromBelow || !meanDirection.values ? 0.25 * (1.0 - glm::length(mean)) : 0.0;
      const double part = even + std::max(outwards * mean[axis], 0.0);
      const glm::dvec3 all(fluence.At(voxel, 0), fluence.At(voxel, 1), fluence.At(voxel, 2));
      lit.push_back(Float4(all * (part / (Pi * n * n)), 0.0));
    }
  }
  return lit;
}
}
