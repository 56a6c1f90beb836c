#include "Viewing/Sources/SmallLights.h"

#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"

#include <algorithm>
#include <cmath>

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
  for (const Light& light : SeenFrom(grid, lights))
  {
    const glm::dvec3 axis = Vector(DirectionOf(light));
    const glm::dvec3 place = Vector(light.position) - Vector(grid.origin);
    if (IsBlack(light.power))
    {
      continue;
    }
    if (light.type == LightType::Directional)
    {
      add({ 0.0, 0.0, 0.0 }, false, axis, 0.0, light.power, 1.0, false);
    }
    else if (light.type == LightType::Point)
    {
      add(place, true, axis, 0.0, light.power, 1.0 / (4.0 * Pi), false);
    }
    else if (light.type == LightType::Spot)
    {
      add(place, true, axis, std::tan(0.5 * HalfAngle(light)), light.power, AxialIntensity(light), false);
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
        add(place + offset, true, axis, 0.0, light.power, 1.0 / (Pi * n * n), true);
      }
    }
  }
  return small;
}

bool MayLeadThrough(const SmallLight& light, const Grid& grid, const VoxelBox& from, const VoxelBox& block)
{
  bool may = from.VoxelCount() > 0 && block.VoxelCount() > 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    double low = from.first[axis], high = low + from.size[axis];
    if (light.place.s[3] > 0.0f)
    {
      const double place = light.place.s[axis] / grid.spacing[axis];
      low = std::min(low, place - 1.0); // rounding
      high = std::max(high, place + 1.0);
    }
    else
    {
      low = light.axis.s[axis] > 0.0f ? 0.0 : low;
      high = light.axis.s[axis] < 0.0f ? grid.size[axis] : high;
    }
    may = may && low < block.first[axis] + block.size[axis] && high > block.first[axis];
  }
  return may;
}
}
