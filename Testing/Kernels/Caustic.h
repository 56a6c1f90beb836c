#pragma once

#include "MeshShapes.h"
#include "PhotonScene.h"
#include "RefractionOptics.h"

#include "Photons/Emission/PhotonEmitter.h"

#include <numeric>

/// A ball of glass in air, voxelised from a mesh, and what it makes of parallel light. Places along the light's axis
/// are distances behind the ball's centre, and like all other lengths that go in or out here in radii of the ball.
namespace caustic
{
using Point = std::array<double, 3>;
constexpr double Radius = 0.5; ///< about the origin, in a cube from -1 to 1
constexpr double Index = 1.5;  ///< so that paraxial light meets at 1.5, in the cube
constexpr double Focus = 0.5 * Index / (Index - 1.0);

inline PhotonScene BallScene(tyndall::Device& device, int edge, int filterSize = 9, int samples = 4)
{
  PhotonScene scene(edge);
  scene.Voxelize(device, shapes::Sphere({ 0.0, 0.0, 0.0 }, Radius, 7), Index, filterSize, samples);
  return scene;
}

/// The direction of the light and two across.
struct Axis
{
  Point along, x, y;

  double Along(const Point& p) const { return Dot(p, this->along) / Radius; }
  double Beside(const Point& p) const { return std::hypot(Dot(p, this->x), Dot(p, this->y)) / Radius; }
  static double Dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
};

inline Axis AxisAlong(double x, double y, double z)
{
  const double length = std::sqrt(x * x + y * y + z * z), flat = std::hypot(y, z);
  const Point d = { x / length, y / length, z / length };
  const Point e = { 0.0, z / flat, -y / flat };
  return { d, e, { d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2], d[0] * e[1] - d[1] * e[0] } };
}

/// Askew to the voxels, as light usually is.
inline Axis Askew()
{
  return AxisAlong(0.23, 0.31, 1.0);
}

/// Of `count` photons of a directional light, 1 W / length^2, those that pass within `reach` of the axis.
inline std::vector<tyndall::Photon> Beam(const tyndall::Grid& grid, const Axis& axis, std::size_t count, double reach,
  tyndall::Sampler sampler = tyndall::Sampler::Hammersley, std::uint64_t seed = 0)
{
  tyndall::Illumination light;
  tyndall::Light sun;
  sun.direction = axis.along;
  light.lights = { sun };
  std::vector<tyndall::Photon> photons = tyndall::EmitPhotons(grid, light, { count, sampler, seed }).photons;
  photons.erase(std::remove_if(photons.begin(), photons.end(),
                  [&](const tyndall::Photon& photon) { return axis.Beside(photon.position) > reach; }),
    photons.end());
  return photons;
}

/// Photons all around the axis, `b` from it.
inline std::vector<tyndall::Photon> Ring(const Axis& axis, double b, int count)
{
  std::vector<tyndall::Photon> photons(count);
  for (int i = 0; i < count; ++i)
  {
    const double angle = 2.0 * optics::Pi * (i + 0.3) / count;
    for (int a = 0; a < 3; ++a)
    {
      const double across = std::cos(angle) * axis.x[a] + std::sin(angle) * axis.y[a];
      photons[i].position[a] = b * Radius * across - 3.0 * axis.along[a];
      photons[i].direction[a] = static_cast<float>(axis.along[a]);
    }
    photons[i].power = { 1.0f, 1.0f, 1.0f };
  }
  return photons;
}

/// Where the last stretches of the photons' paths are together nearest to the axis: the sum of the squares of their
/// distances from it is a parabola.
inline double FocusOfPaths(
  tyndall::PhotonMarcher& marcher, const Axis& axis, const std::vector<tyndall::Photon>& photons)
{
  std::vector<std::size_t> all(photons.size());
  std::iota(all.begin(), all.end(), 0);
  double linear = 0.0, square = 0.0;
  for (const tyndall::PhotonPath& path : marcher.Paths(photons, all))
  {
    const Point d = LastDirection(path);
    const Point& p = path.points.back();
    for (const Point& across : { axis.x, axis.y })
    {
      const double slope = Axis::Dot(d, across) / Axis::Dot(d, axis.along);
      linear += (axis.Along(p) * slope - Axis::Dot(p, across) / Radius) * slope;
      square += slope * slope;
    }
  }
  return linear / square;
}

/// The same from rings at b and 2 b, without the part that grows with the square of b: spherical aberration.
inline double ParaxialFocus(tyndall::PhotonMarcher& marcher, const Axis& axis, double b = 0.15, int count = 64)
{
  const double inner = FocusOfPaths(marcher, axis, Ring(axis, b, count));
  const double outer = FocusOfPaths(marcher, axis, Ring(axis, 2.0 * b, count));
  return inner - (outer - inner) / 3.0;
}

/// Calls visit(along, beside, fluence) for every voxel's centre within 1 of the axis.
template <class Visit>
void ForVoxels(const tyndall::Grid& grid, const Axis& axis, const std::vector<float>& fluence, const Visit& visit)
{
  std::size_t voxel = 0;
  const auto middle = [&](int a, int i) { return grid.origin[a] + (i + 0.5) * grid.spacing[a]; };
  for (int k = 0; k < grid.size[2]; ++k)
  {
    for (int j = 0; j < grid.size[1]; ++j)
    {
      for (int i = 0; i < grid.size[0]; ++i, ++voxel)
      {
        const Point p = { middle(0, i), middle(1, j), middle(2, k) };
        const double beside = axis.Beside(p);
        if (beside < 1.0)
        {
          visit(axis.Along(p), beside, static_cast<double>(fluence[voxel]));
        }
      }
    }
  }
}

/// Where the light behind the ball is narrowest, by the mean square of its distance from the axis in slices as thick as
/// a voxel: a parabola, fitted from 1.15 to 1.85. What voxels add to that distance is the same everywhere.
inline double Waist(const tyndall::Grid& grid, const Axis& axis, const std::vector<float>& fluence)
{
  const double from = 1.15, to = 1.85, slice = grid.spacing[0] / Radius;
  const int count = static_cast<int>((to - from) / slice);
  std::vector<double> light(count), spread(count);
  ForVoxels(grid, axis, fluence, [&](double along, double beside, double value) {
    const int i = static_cast<int>(std::floor((along - from) / slice));
    if (i >= 0 && i < count)
    {
      light[i] += value;
      spread[i] += value * beside * beside;
    }
  });
  // Least squares with 1, u and u^2 - mean of u^2, which are orthogonal: u goes from -1 to 1.
  double linear = 0.0, square = 0.0, uu = 0.0, qq = 0.0;
  const auto u = [&](int i) { return (2.0 * i + 1.0) / count - 1.0; };
  for (int i = 0; i < count; ++i)
  {
    uu += u(i) * u(i);
  }
  for (int i = 0; i < count; ++i)
  {
    const double q = u(i) * u(i) - uu / count;
    linear += u(i) * spread[i] / light[i] / uu;
    square += q * spread[i] / light[i];
    qq += q * q;
  }
  return from + 0.5 * count * slice * (1.0 - 0.5 * linear / (square / qq));
}

/// The waist of a beam of radius `reach` by geometrical optics at a sharp border: 1.5, less spherical aberration.
inline double ExpectedWaist(double reach)
{
  double sum = 0.0, weights = 0.0;
  for (double b = 5e-4 * reach; b < reach; b += 1e-3 * reach)
  {
    const double slope = std::tan(optics::BallTurn(Index, b));
    const double weight = b * slope * slope / std::cos(optics::BallTurn(Index, b)); // fluence, of rings
    sum += weight * optics::BallFocus(Index, b);
    weights += weight;
  }
  return sum / weights;
}

/// The middle between the first and the last place at which brightness along the axis is half of its largest value; NaN
/// where the stretch goes on beyond the first or last slice.
inline double MiddleOfTheBright(const std::vector<double>& brightness, double from, double slice)
{
  const double half = 0.5 * *std::max_element(brightness.begin(), brightness.end());
  const int count = static_cast<int>(brightness.size());
  int first = 0, last = count - 1;
  for (; brightness[first] < half; ++first)
  {
  }
  for (; brightness[last] < half; --last)
  {
  }
  if (first == 0 || last == count - 1)
  {
    return std::nan("");
  }
  // Where straight lines between the slices' middles cross one half.
  const double low = first - (brightness[first] - half) / (brightness[first] - brightness[first - 1]);
  const double high = last + (brightness[last] - half) / (brightness[last] - brightness[last + 1]);
  return from + (0.5 * (low + high) + 0.5) * slice;
}

/// That of the mean of the voxels within a voxel of the axis.
inline double BrightStretch(const tyndall::Grid& grid, const Axis& axis, const std::vector<float>& fluence)
{
  const double from = 1.0, slice = grid.spacing[0] / Radius;
  std::vector<double> sums(static_cast<std::size_t>(1.2 / slice)), counts(sums.size());
  ForVoxels(grid, axis, fluence, [&](double along, double beside, double value) {
    const double i = std::floor((along - from) / slice);
    if (beside < slice && i >= 0.0 && i < static_cast<double>(sums.size()))
    {
      sums[static_cast<std::size_t>(i)] += value;
      counts[static_cast<std::size_t>(i)] += 1.0;
    }
  });
  for (std::size_t i = 0; i < sums.size(); ++i)
  {
    sums[i] /= std::max(counts[i], 1.0);
  }
  return MiddleOfTheBright(sums, from, slice);
}

/// The same by geometrical optics: rays are on the axis where they are within `width` of it.
inline double ExpectedBrightStretch(double reach, double width)
{
  const double from = 1.0, slice = 1e-3;
  std::vector<double> sums(1200);
  for (double b = 5e-4 * reach; b < reach; b += 1e-3 * reach)
  {
    const double turn = optics::BallTurn(Index, b), focus = optics::BallFocus(Index, b);
    for (std::size_t i = 0; i < sums.size(); ++i)
    {
      const bool near = std::abs((focus - from - (i + 0.5) * slice) * std::tan(turn)) < width;
      sums[i] += near ? b / std::cos(turn) : 0.0;
    }
  }
  return MiddleOfTheBright(sums, from, slice);
}

/// Mean fluence of rings an eighth wide in the plane through the focus, a voxel thick.
constexpr int Rings = 8;
inline std::vector<double> Profile(const tyndall::Grid& grid, const Axis& axis, const std::vector<float>& fluence)
{
  std::vector<double> sums(Rings), counts(Rings);
  ForVoxels(grid, axis, fluence, [&](double along, double beside, double value) {
    if (std::abs(along - Focus) < 0.501 * grid.spacing[0] / Radius)
    {
      sums[static_cast<int>(beside * Rings)] += value;
      counts[static_cast<int>(beside * Rings)] += 1.0;
    }
  });
  for (int ring = 0; ring < Rings; ++ring)
  {
    sums[ring] /= counts[ring];
  }
  return sums;
}

/// The same by geometrical optics, of light of 1 W / length^2 that covers the ball: each ray adds the inverse of its
/// cosine to the ring in which it meets the plane. The ball keeps other light away.
inline std::vector<double> ExpectedProfile()
{
  std::vector<double> sums(Rings);
  const int rays = 400000;
  for (int i = 0; i < rays; ++i)
  {
    const double b = std::sqrt((i + 0.5) / rays); // of equal areas
    const double turn = optics::BallTurn(Index, b);
    const double r = std::abs((optics::BallFocus(Index, b) - Focus) * std::tan(turn));
    if (turn < 0.5 * optics::Pi && r < 1.0)
    {
      const int ring = static_cast<int>(r * Rings);
      sums[ring] += Rings * Rings / (rays * std::cos(turn) * (2.0 * ring + 1.0));
    }
  }
  return sums;
}

/// Light that is in another place than in the reference, as a part of all.
inline double Difference(const std::vector<double>& profile, const std::vector<double>& reference)
{
  double different = 0.0, all = 0.0;
  for (int ring = 0; ring < Rings; ++ring)
  {
    different += (2.0 * ring + 1.0) * std::abs(profile[ring] - reference[ring]);
    all += (2.0 * ring + 1.0) * reference[ring];
  }
  return different / all;
}
}
