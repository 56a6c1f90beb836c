#pragma once

#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace tyndall
{
/// A rectangular light in the coordinates of its own edges and its normal.
struct RectangleSeen
{
  explicit RectangleSeen(const Light& light)
    : middle(Vector(light.position))
    , half(0.5 * light.size[0], 0.5 * light.size[1])
  {
    const auto edges = RectangleEdges(light);
    axes = { glm::normalize(Vector(edges[0])), glm::normalize(Vector(edges[1])),
      glm::normalize(Vector(light.direction)) };
  }

  /// Solid angle of it from a point before it.
  double From(const glm::dvec3& point) const
  {
    const glm::dvec3 d = point - middle;
    const double u = glm::dot(d, axes[0]), v = glm::dot(d, axes[1]), z = glm::dot(d, axes[2]);
    const auto corner = [z](double a, double b) { return std::atan2(a * b, z * std::sqrt(a * a + b * b + z * z)); };
    return z <= 0.0 ? 0.0
                    : corner(half.x - u, half.y - v) - corner(-half.x - u, half.y - v) -
        corner(half.x - u, -half.y - v) + corner(-half.x - u, -half.y - v);
  }

  /// Mean of it over a box: halved until that changes nothing.
  double Mean(const glm::dvec3& low, const glm::dvec3& edge, int levels) const
  {
    const double whole = this->ByPoints(low, edge);
    double parts = 0.0;
    for (int i = 0; i < 8; ++i)
    {
      parts += 0.125 * this->ByPoints(low + 0.5 * edge * glm::dvec3(i & 1, i >> 1 & 1, i >> 2), 0.5 * edge);
    }
    const glm::dvec3 across = 0.5 * glm::abs(axes[2]) * edge;
    const bool cut = std::abs(glm::dot(low + 0.5 * edge - middle, axes[2])) < across.x + across.y + across.z;
    if (levels <= (cut ? -2 : 0) || (std::abs(whole - parts) <= 2e-3 * parts && !cut))
    {
      return parts;
    }
    double sum = 0.0;
    for (int i = 0; i < 8; ++i)
    {
      sum += 0.125 * this->Mean(low + 0.5 * edge * glm::dvec3(i & 1, i >> 1 & 1, i >> 2), 0.5 * edge, levels - 1);
    }
    return sum;
  }

  double ByPoints(const glm::dvec3& low, const glm::dvec3& edge) const
  {
    double sum = 0.0;
    for (int i = 0; i < 8; ++i)
    {
      const glm::dvec3 part(i & 1, i >> 1 & 1, i >> 2);
      sum += 0.125 * this->From(low + edge * (0.211324865405187 + 0.577350269189626 * part));
    }
    return sum;
  }

  using Polygon = std::vector<glm::dvec3>;

  /// What of it is beyond a plane across an axis.
  static Polygon Beyond(const Polygon& polygon, int axis, double at, double sign)
  {
    Polygon beyond;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
      const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double from = sign * (a[axis] - at), to = sign * (b[axis] - at);
      if (from >= 0.0)
      {
        beyond.push_back(a);
      }
      if (from * to < 0.0)
      {
        beyond.push_back(a + (b - a) * (from / (from - to)));
      }
    }
    return beyond;
  }

  /// Half the sum of angle x normal over a polygon's edges seen from a point: irradiance under a radiance of 1.
  static glm::dvec3 VectorIrradiance(const Polygon& polygon, const glm::dvec3& point)
  {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
      const glm::dvec3 a = polygon[i] - point, b = polygon[(i + 1) % polygon.size()] - point, across = glm::cross(a, b);
      const double sine = glm::length(across);
      sum += sine > 0.0 ? 0.5 * std::atan2(sine, glm::dot(a, b)) / sine * across : glm::dvec3(0.0);
    }
    return sum;
  }

  /// All of it that is in the box, and through each face what shines there from beyond it.
  /// @param n  points along a face's edges
  double PartThatEnters(const tyndall::Grid& grid, int n = 100) const
  {
    const glm::dvec3 first = half.x * axes[0], second = half.y * axes[1];
    const Polygon all = { middle - first - second, middle + first - second, middle + first + second,
      middle - first + second };
    Polygon inside = all;
    double through = 0.0;
    for (int face = 0; face < 6; ++face)
    {
      const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
      const double at = grid.origin[axis] + (face % 2 ? grid.Length(axis) : 0.0), sign = face % 2 ? 1.0 : -1.0;
      inside = Beyond(inside, axis, at, -sign);
      const Polygon outside = Beyond(all, axis, at, sign);
      for (int i = 0; i < n * n && outside.size() > 2; ++i)
      {
        glm::dvec3 point;
        point[axis] = at;
        point[u] = grid.origin[u] + (i % n + 0.5) / n * grid.Length(u);
        point[v] = grid.origin[v] + (i / n + 0.5) / n * grid.Length(v);
        const bool before = glm::dot(point - middle, axes[2]) > 0.0;
        through += before ? std::abs(VectorIrradiance(outside, point)[axis]) * grid.Length(u) * grid.Length(v) : 0.0;
      }
      through /= face == 5 ? n * n : 1;
    }
    double size = 0.0;
    for (std::size_t i = 2; i < inside.size(); ++i)
    {
      size += 0.5 * glm::length(glm::cross(inside[i - 1] - inside[0], inside[i] - inside[0]));
    }
    return (size + through / Pi) / (4.0 * half.x * half.y);
  }

  glm::dvec3 middle;
  glm::dvec2 half;
  std::array<glm::dvec3, 3> axes;
};
}
