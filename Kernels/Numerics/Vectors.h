#pragma once

#include "Device/OpenCL.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
inline glm::dvec3 Vector(const std::array<double, 3>& v)
{
  return { v[0], v[1], v[2] };
}

/// Clips a convex polygon to the half-space depth(point) >= 0; `depth` is linear in the point.
template <class Point, class Depth>
std::vector<Point> Clipped(const std::vector<Point>& polygon, const Depth& depth)
{
  std::vector<Point> clipped;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double from = depth(a), to = depth(b);
    if (from >= 0.0)
    {
      clipped.push_back(a);
    }
    if (from * to < 0.0)
    {
      clipped.push_back(a + (b - a) * (from / (from - to)));
    }
  }
  return clipped;
}

/// Conversion of vectors to kernel arguments.
inline cl_float4 Float4(const glm::dvec3& v, double w = 0.0)
{
  return { { static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w) } };
}
inline cl_int4 Int4(const std::array<int, 3>& v)
{
  return { { v[0], v[1], v[2], 0 } };
}
}
