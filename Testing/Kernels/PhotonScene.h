#pragma once

#include "Medium/Grid.h"

#include "Photons/Marching/PhotonMarcher.h"
#include "Refraction/Index/RefractiveMedium.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

/// A refractive medium that owns its arrays, over a cube from -half to half.
struct PhotonScene
{
  tyndall::Medium medium;
  std::vector<float> sigma_a, sigma_s, ior;
  std::vector<std::uint8_t> levels;
  tyndall::MarchSettings settings;

  explicit PhotonScene(int edge, double half = 1.0, float absorption = 0.0f, float scattering = 0.0f)
    : PhotonScene({ edge, edge, edge }, 2.0 * half / edge, half, absorption, scattering)
  {
  }

  PhotonScene(std::array<int, 3> size, double spacing, double half, float absorption, float scattering)
  {
    this->medium.grid.size = size;
    this->medium.grid.spacing = { spacing, spacing, spacing };
    this->medium.grid.origin = { -half, -half, -half };
    this->sigma_a.assign(this->medium.grid.VoxelCount(), absorption);
    this->sigma_s.assign(this->medium.grid.VoxelCount(), scattering);
  }

  void SetIndex(const std::function<double(double, double, double)>& n)
  {
    this->ior.clear();
    const tyndall::Grid& grid = this->medium.grid;
    const auto middle = [&](int a, int i) { return grid.origin[a] + (i + 0.5) * grid.spacing[a]; };
    tyndall::ForGridVoxels(grid.size, [&](std::size_t, int i, int j, int k) {
      this->ior.push_back(static_cast<float>(n(middle(0, i), middle(1, j), middle(2, k))));
    });
  }

  /// A ball of glass, its border smoothed over `width` voxels (standard deviation).
  void SetBall(double radius, double index, double width = 1.5)
  {
    const double scale = width * this->medium.grid.spacing[0] * std::sqrt(2.0);
    this->SetIndex([=](double x, double y, double z) {
      return 1.0 + (index - 1.0) * 0.5 * std::erfc((std::hypot(x, y, z) - radius) / scale);
    });
  }

  /// Glass in air where the closed mesh is, as the voxeliser makes it: its border smoothed over filterSize / 6 voxels.
  void Voxelize(
    tyndall::Device& device, const tyndall::TriangleMesh& mesh, double index, int filterSize = 9, int samples = 4)
  {
    tyndall::RefractiveMediumSettings settings;
    settings.grid = this->medium.grid;
    settings.filterSize = filterSize;
    settings.voxelization.samples = samples;
    this->ior = tyndall::Voxelize(device, { { "glass", mesh, { index, {}, {}, 0.0 } } }, settings).ior;
  }

  int ComponentsOf(const std::vector<float>& values) const
  {
    return static_cast<int>(values.size() / this->medium.grid.VoxelCount());
  }

  tyndall::Field Index() const { return { this->ior.empty() ? nullptr : this->ior.data(), 1 }; }

  const tyndall::Medium& Medium()
  {
    this->medium.sigma_a = { this->sigma_a.data(), this->ComponentsOf(this->sigma_a) };
    this->medium.sigma_s = { this->sigma_s.data(), this->ComponentsOf(this->sigma_s) };
    return this->medium;
  }

  tyndall::PhotonMarcher Marcher(tyndall::Device& device)
  {
    return tyndall::PhotonMarcher(device, tyndall::Domain(this->Medium().grid), this->Medium(), this->Index(),
      this->settings, this->levels.empty() ? nullptr : this->levels.data());
  }

  tyndall::PhotonLight March(tyndall::Device& device, const std::vector<tyndall::Photon>& photons)
  {
    return this->Marcher(device).March(photons);
  }

  tyndall::PhotonPath Path(tyndall::Device& device, std::array<double, 3> from, std::array<double, 3> direction)
  {
    tyndall::Photon photon;
    photon.position = from;
    for (int a = 0; a < 3; ++a)
    {
      photon.direction[a] = static_cast<float>(direction[a]);
    }
    photon.power = { 1.0f, 1.0f, 1.0f };
    return this->Marcher(device).Paths({ photon }, { 0 }).at(0);
  }

  double TotalPathPower(const tyndall::PhotonLight& light) const
  {
    double sum = 0.0;
    for (const float fluence : light.light.fluence)
    {
      sum += fluence;
    }
    const std::array<double, 3>& h = this->medium.grid.spacing;
    return sum * h[0] * h[1] * h[2] / light.light.channels;
  }
};

/// Unit vector of the last stretch of a path.
inline std::array<double, 3> LastDirection(const tyndall::PhotonPath& path)
{
  const std::array<double, 3>& b = path.points.back();
  std::size_t i = path.points.size() - 1;
  double length = 0.0;
  while (length < 1e-3 && i > 0) // a turn on the border leaves a stretch without a length
  {
    --i;
    const std::array<double, 3>& a = path.points[i];
    length = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  }
  const std::array<double, 3>& a = path.points[i];
  return { (b[0] - a[0]) / length, (b[1] - a[1]) / length, (b[2] - a[2]) / length };
}

/// Distance from `target` at which a path passes, taken as straight between its corners.
inline double Miss(const tyndall::PhotonPath& path, const std::array<double, 3>& target)
{
  double least = 1e9;
  for (std::size_t i = 1; i < path.points.size(); ++i)
  {
    const std::array<double, 3>&a = path.points[i - 1], &b = path.points[i];
    double along = 0.0, length = 0.0;
    for (int c = 0; c < 3; ++c)
    {
      along += (target[c] - a[c]) * (b[c] - a[c]);
      length += (b[c] - a[c]) * (b[c] - a[c]);
    }
    const double t = length > 0.0 ? std::min(std::max(along / length, 0.0), 1.0) : 0.0;
    const auto off = [&](int c) { return target[c] - a[c] - t * (b[c] - a[c]); };
    least = std::min(least, std::hypot(off(0), off(1), off(2)));
  }
  return least;
}

/// Maxwell's fish-eye: from (1, 0, 0) light goes round circles through (-1, 0, 0).
namespace fisheye
{
inline double Index(double x, double y, double z)
{
  return 2.0 / (1.0 + x * x + y * y + z * z);
}

/// Largest distance of a path's first `corners` from the circle through these points with centre (0, c).
inline double WorstCorner(const tyndall::PhotonPath& path, double c, std::size_t corners)
{
  double worst = 0.0;
  for (std::size_t i = 0; i < std::min(corners, path.points.size()); ++i)
  {
    const std::array<double, 3>& p = path.points[i];
    worst = std::max(worst, std::hypot(std::hypot(p[0], p[1] - c) - std::hypot(1.0, c), p[2]));
  }
  return worst;
}
}

/// The Luneburg lens of radius 1 about the origin: parallel light along +x meets at (1, 0, 0), on ellipses
/// r0 cos t + v0 sin t, 0 <= t <= pi / 2, from r0 = (-sqrt(1 - b^2), b, 0) with v0 = (1, 0, 0).
namespace luneburg
{
inline double Index(double x, double y, double z)
{
  return std::sqrt(std::max(2.0 - x * x - y * y - z * z, 1.0));
}

/// The same beyond its surface, as far as voxels reach: only the integrator errs.
inline double Endless(double x, double y, double z)
{
  return std::sqrt(std::max(2.0 - x * x - y * y - z * z, 0.1));
}

/// Largest distance of the path's corners from that ellipse.
inline double WorstCorner(const tyndall::PhotonPath& path, double b)
{
  const double x0 = -std::sqrt(1.0 - b * b);
  double worst = 0.0;
  for (const std::array<double, 3>& p : path.points)
  {
    double nearest = 1e9;
    double step = 1e-2, middle = 0.785, half = 0.785;
    for (int level = 0; level < 5; ++level, half = 2.0 * step, step *= 0.02)
    {
      double best = middle;
      for (double t = middle - half; t <= middle + half; t += step)
      {
        const double distance = std::hypot(p[0] - x0 * std::cos(t) - std::sin(t), p[1] - b * std::cos(t), p[2]);
        if (distance < nearest)
        {
          nearest = distance;
          best = t;
        }
      }
      middle = best;
    }
    if (p[0] < 0.95)
    {
      worst = std::max(worst, nearest);
    }
  }
  return worst;
}

/// How far from the far pole light passes that comes to the lens through air: at worst, of many rays.
inline double MissInAir(tyndall::Device& device, PhotonScene& scene)
{
  tyndall::PhotonMarcher marcher = scene.Marcher(device);
  std::vector<tyndall::Photon> photons;
  std::vector<std::size_t> all;
  for (double b = 0.05; b < 0.9; b += 0.05)
  {
    tyndall::Photon photon;
    photon.position = { -1.1, b, 0.0 };
    photon.direction = { 1.0f, 0.0f, 0.0f };
    photon.power = { 1.0f, 1.0f, 1.0f };
    all.push_back(photons.size());
    photons.push_back(photon);
  }
  double worst = 0.0;
  for (const tyndall::PhotonPath& path : marcher.Paths(photons, all))
  {
    worst = std::max(worst, Miss(path, { 1.0, 0.0, 0.0 }));
  }
  return worst;
}
}
