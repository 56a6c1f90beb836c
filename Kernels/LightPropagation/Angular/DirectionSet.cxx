#include "LightPropagation/Angular/DirectionSet.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{

int CellsPerEdge(int perFace, const std::string& name)
{
  const int n = static_cast<int>(std::lround(std::sqrt(static_cast<double>(std::max(perFace, 0)))));
  if (n < 1 || n * n != perFace || n > 64)
  {
    throw InvalidInput(name + " is " + std::to_string(perFace) +
      "; directions fill a square grid on each face: choose 1, 4, 9, 16, 25, 36, ... at most 4096.");
  }
  return n;
}

/// Tangent at position `i + offset` of n along a face's edge, from integers, exactly odd about the middle.
double Tangent(bool equiangular, int n, double twicePosition)
{
  const double fromMiddle = (twicePosition - n) / n; // in [-1, 1]
  const double magnitude = std::abs(fromMiddle);
  const double tangent = magnitude == 1.0 ? 1.0 : equiangular ? std::tan(magnitude * (Pi / 4.0)) : magnitude;
  return std::copysign(tangent, fromMiddle);
}

std::array<double, 3> ThroughFace(int face, double s, double t)
{
  const int axis = face / 2;
  const double scale = 1.0 / std::sqrt(1.0 + (s * s + t * t));
  std::array<double, 3> omega;
  omega[axis] = (face % 2 == 0 ? -1.0 : 1.0) * scale;
  omega[(axis + 1) % 3] = s * scale;
  omega[(axis + 2) % 3] = t * scale;
  return omega;
}

/// Solid angle of the rectangle [0, s] x [0, t] at distance 1.
double CornerSolidAngle(double s, double t)
{
  return std::atan2(s * t, std::sqrt(1.0 + s * s + t * t));
}

double SolidAngle(double s0, double s1, double t0, double t1)
{
  return CornerSolidAngle(s1, t1) - CornerSolidAngle(s0, t1) - CornerSolidAngle(s1, t0) + CornerSolidAngle(s0, t0);
}

DirectionSet CubeDirections(int perFace, bool equiangular, const std::string& name)
{
  DirectionSet set;
  const int n = set.cellsPerEdge = CellsPerEdge(perFace, name);
  set.equiangular = equiangular;
  for (int face = 0; face < 6; ++face)
  {
    for (int j = 0; j < n; ++j)
    {
      for (int i = 0; i < n; ++i)
      {
        set.directions.push_back(
          { ThroughFace(face, Tangent(equiangular, n, 2 * i + 1), Tangent(equiangular, n, 2 * j + 1)),
            4.0 * Pi / (6.0 * n * n) });
      }
    }
  }
  return set;
}
}

DirectionSet PublishedDirections(int perFace)
{
  return CubeDirections(perFace, false, "DirectionsPerFace");
}

DirectionSet EquiangularDirections(int perFace, const std::string& name)
{
  DirectionSet set = CubeDirections(perFace, true, name);
  const int n = set.cellsPerEdge;
  for (std::size_t d = 0; d < set.directions.size(); ++d)
  {
    // By the cell's mirror image in the first octant of the face, sorted, so that equals are equal to the last bit.
    const int i = static_cast<int>(d) % n;
    const int j = static_cast<int>(d) / n % n;
    const int u = std::min(std::max(i, n - 1 - i), std::max(j, n - 1 - j));
    const int v = std::max(std::max(i, n - 1 - i), std::max(j, n - 1 - j));
    set.directions[d].weight = SolidAngle(
      Tangent(true, n, 2 * u), Tangent(true, n, 2 * u + 2), Tangent(true, n, 2 * v), Tangent(true, n, 2 * v + 2));
  }
  return set;
}

double HalfRangeFlux(const DirectionSet& set)
{
  double flux = 0.0;
  for (const Direction& direction : set.directions)
  {
    flux += direction.weight * std::max(direction.omega[2], 0.0) / Pi;
  }
  return flux;
}

int Nearest(const DirectionSet& set, const std::array<double, 3>& omega)
{
  int axis = 0;
  for (int other = 1; other < 3; ++other)
  {
    axis = std::abs(omega[other]) > std::abs(omega[axis]) ? other : axis;
  }
  const int n = set.cellsPerEdge;
  const auto cell = [&](double tangent) {
    const double position = set.equiangular ? std::atan(tangent) * (4.0 / Pi) : tangent;
    return std::clamp(static_cast<int>((position + 1.0) * 0.5 * n), 0, n - 1);
  };
  const double depth = std::abs(omega[axis]);
  const int face = 2 * axis + (omega[axis] > 0.0 ? 1 : 0);
  return (face * n + cell(omega[(axis + 2) % 3] / depth)) * n + cell(omega[(axis + 1) % 3] / depth);
}

std::vector<Rgb> BoundaryRadiance(const DirectionSet& set, const Environment& environment, const Rgb& sky)
{
  std::vector<Rgb> radiance(set.directions.size(), sky);
  if (environment.Empty())
  {
    return radiance;
  }
  // Each cell in parts of about half a pixel: a pixel spans pi / height, a cell about pi / (2 n). An even number of
  // them, so that none is a pole, where the azimuth is not defined.
  const int n = set.cellsPerEdge;
  const int parts = 2 * std::clamp((environment.height / n + 1) / 2, 1, 128);
  for (std::size_t d = 0; d < set.directions.size(); ++d)
  {
    const int i = static_cast<int>(d) % n;
    const int j = static_cast<int>(d) / n % n;
    const int face = static_cast<int>(d) / (n * n);
    const auto tangent = [&](int cell, double part) {
      return Tangent(set.equiangular, n * parts, 2.0 * (cell * parts + part));
    };
    Rgb sum = {};
    double total = 0.0;
    for (int b = 0; b < parts; ++b)
    {
      for (int a = 0; a < parts; ++a)
      {
        const double weight = SolidAngle(tangent(i, a), tangent(i, a + 1), tangent(j, b), tangent(j, b + 1));
        const std::array<double, 3> omega = ThroughFace(face, tangent(i, a + 0.5), tangent(j, b + 0.5));
        const Rgb seen = Lookup(environment, { -omega[0], -omega[1], -omega[2] });
        for (int c = 0; c < 3; ++c)
        {
          sum[c] += weight * seen[c];
        }
        total += weight;
      }
    }
    for (int c = 0; c < 3; ++c)
    {
      radiance[d][c] += sum[c] / total;
    }
  }
  return radiance;
}
}
