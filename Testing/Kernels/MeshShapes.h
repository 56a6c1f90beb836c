#pragma once

#include "Medium/Grid.h"
#include "Numerics/Constants.h"
#include "Refraction/Voxelization/TriangleMesh.h"

#include <array>
#include <cmath>
#include <functional>
#include <vector>

/// Closed meshes whose volume is known.
namespace shapes
{
using tyndall::TriangleMesh;
using Point = std::array<double, 3>;
using tyndall::Pi;

/// A cube of `size` voxels an edge between `low` and `high` along each axis.
inline tyndall::Grid CubeGrid(int size, double low = -1.0, double high = 1.0)
{
  const double spacing = (high - low) / size;
  return { { size, size, size }, { spacing, spacing, spacing }, { low, low, low } };
}

/// A closed surface over two angles in [0, 1), `across` times `along` quadrilaterals, each two triangles.
inline TriangleMesh Wrapped(int across, int along, const std::function<Point(double, double)>& at)
{
  TriangleMesh mesh;
  for (int j = 0; j < along; ++j)
  {
    for (int i = 0; i < across; ++i)
    {
      mesh.points.push_back(at(static_cast<double>(i) / across, static_cast<double>(j) / along));
      const auto number = [&](int k, int l) { return (j + l) % along * across + (i + k) % across; };
      mesh.triangles.push_back({ number(0, 0), number(1, 0), number(1, 1) });
      mesh.triangles.push_back({ number(0, 0), number(1, 1), number(0, 1) });
    }
  }
  return mesh;
}

inline TriangleMesh Torus(const Point& centre, double ring, double tube, int across = 256, int along = 128)
{
  return Wrapped(across, along, [=](double u, double v) {
    const double r = ring + tube * std::cos(2.0 * Pi * v);
    return Point{ centre[0] + r * std::cos(2.0 * Pi * u), centre[1] + r * std::sin(2.0 * Pi * u),
      centre[2] + tube * std::sin(2.0 * Pi * v) };
  });
}

/// An octahedron whose triangles were divided into four `divisions` times, its points pulled onto the sphere. The
/// points of each triangle are its own: none is shared.
inline TriangleMesh Sphere(const Point& centre, double radius, int divisions = 6)
{
  using Triangle = std::array<Point, 3>;
  std::vector<Triangle> triangles;
  for (double x : { -1.0, 1.0 })
  {
    for (double y : { -1.0, 1.0 })
    {
      for (double z : { -1.0, 1.0 })
      {
        const Point px = { x, 0, 0 }, py = { 0, y, 0 }, pz = { 0, 0, z };
        triangles.push_back(x * y * z > 0.0 ? Triangle{ px, py, pz } : Triangle{ px, pz, py });
      }
    }
  }
  const auto middle = [](const Point& a, const Point& b) {
    const Point sum = { a[0] + b[0], a[1] + b[1], a[2] + b[2] };
    const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    return Point{ sum[0] / length, sum[1] / length, sum[2] / length };
  };
  for (int d = 0; d < divisions; ++d)
  {
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : triangles)
    {
      const Point ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), { { a, ab, ca }, { ab, b, bc }, { ca, bc, c }, { ab, bc, ca } });
    }
    triangles = std::move(finer);
  }
  TriangleMesh mesh;
  for (const Triangle& triangle : triangles)
  {
    const int first = static_cast<int>(mesh.points.size());
    mesh.triangles.push_back({ first, first + 1, first + 2 });
    for (const Point& p : triangle)
    {
      mesh.points.push_back({ centre[0] + radius * p[0], centre[1] + radius * p[1], centre[2] + radius * p[2] });
    }
  }
  return mesh;
}

inline TriangleMesh Box(const Point& low, const Point& high)
{
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
  {
    mesh.points.push_back(
      { corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1], corner & 4 ? high[2] : low[2] });
  }
  mesh.triangles = { { 0, 2, 3 }, { 0, 3, 1 }, { 4, 5, 7 }, { 4, 7, 6 }, { 0, 1, 5 }, { 0, 5, 4 }, { 2, 6, 7 },
    { 2, 7, 3 }, { 0, 4, 6 }, { 0, 6, 2 }, { 1, 3, 7 }, { 1, 7, 5 } };
  return mesh;
}

/// An equilateral triangle about the origin, its first corner up along y, drawn out along z.
inline TriangleMesh Prism(double side, double length)
{
  TriangleMesh mesh;
  const double radius = side / std::sqrt(3.0);
  for (const double z : { -0.5 * length, 0.5 * length })
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      const double angle = Pi * (0.5 + corner * 2.0 / 3.0);
      mesh.points.push_back({ radius * std::cos(angle), radius * std::sin(angle), z });
    }
  }
  mesh.triangles = { { 0, 2, 1 }, { 3, 4, 5 }, { 0, 1, 4 }, { 0, 4, 3 }, { 1, 2, 5 }, { 1, 5, 4 }, { 2, 0, 3 },
    { 2, 3, 5 } };
  return mesh;
}

/// Turned about its middle by odd angles about z and then x.
inline TriangleMesh TurnedBox(const Point& low, const Point& high, double aboutZ = 0.7, double aboutX = 0.4)
{
  TriangleMesh mesh = Box(low, high);
  for (Point& p : mesh.points)
  {
    Point r;
    for (int axis = 0; axis < 3; ++axis)
    {
      r[axis] = p[axis] - 0.5 * (low[axis] + high[axis]);
    }
    r = { r[0] * std::cos(aboutZ) - r[1] * std::sin(aboutZ), r[0] * std::sin(aboutZ) + r[1] * std::cos(aboutZ), r[2] };
    r = { r[0], r[1] * std::cos(aboutX) - r[2] * std::sin(aboutX), r[1] * std::sin(aboutX) + r[2] * std::cos(aboutX) };
    for (int axis = 0; axis < 3; ++axis)
    {
      p[axis] = r[axis] + 0.5 * (low[axis] + high[axis]);
    }
  }
  return mesh;
}

/// Both meshes in one.
inline TriangleMesh Collective(TriangleMesh first, const TriangleMesh& second)
{
  const int offset = static_cast<int>(first.points.size());
  first.points.insert(first.points.end(), second.points.begin(), second.points.end());
  for (const std::array<int, 3>& triangle : second.triangles)
  {
    first.triangles.push_back({ triangle[0] + offset, triangle[1] + offset, triangle[2] + offset });
  }
  return first;
}

inline TriangleMesh Inverted(TriangleMesh mesh)
{
  for (std::array<int, 3>& triangle : mesh.triangles)
  {
    std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}
}
