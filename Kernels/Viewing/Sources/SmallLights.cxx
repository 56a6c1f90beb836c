#include "Viewing/Sources/SmallLights.h"

#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
struct RectangleSample
{
  glm::dvec3 place; ///< relative to the grid's corner
  double share;     ///< fraction of the power
};

/// Appends samples of a rectangular light: `perEdge` along each edge, at the centres of equal parts. A rectangle larger
/// than the box and than its distance from the box is quartered recursively, so that nearer parts get more samples.
void AddSamples(const Grid& grid, const glm::dvec3& middle, const std::array<glm::dvec3, 2>& edges, int perEdge,
  double share, bool whole, std::vector<RectangleSample>& samples)
{
  const glm::dvec3 end(grid.Length(0), grid.Length(1), grid.Length(2));
  const double distance = glm::distance(middle, glm::clamp(middle, glm::dvec3(0.0), end));
  const double longer = std::max(glm::length(edges[0]), glm::length(edges[1]));
  const double box = std::max({ end.x, end.y, end.z });
  const bool quartered = longer > std::max(distance, whole ? box : 0.5 * box) * (1.0 + 1e-9);
  const int n = quartered ? 2 : whole ? perEdge : std::max(perEdge / 2, 1);
  for (int i = 0; i < n * n; ++i)
  {
    const glm::dvec3 place = middle + ((i % n + 0.5) / n - 0.5) * edges[0] + ((i / n + 0.5) / n - 0.5) * edges[1];
    if (quartered)
    {
      AddSamples(grid, place, { 0.5 * edges[0], 0.5 * edges[1] }, perEdge, 0.25 * share, false, samples);
    }
    else
    {
      samples.push_back({ place, share / (n * n) });
    }
  }
}
}

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
      std::vector<RectangleSample> samples;
      AddSamples(grid, place, { Vector(edges[0]), Vector(edges[1]) }, rectangleSamples, 1.0, true, samples);
      for (const RectangleSample& sample : samples)
      {
        add(sample.place, true, axis, 0.0, light.power, sample.share / Pi, true);
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
