#pragma once

#include "Medium/Grid.h"
#include "MediumScene.h"

#include <algorithm>
#include <cmath>

/// Kobayashi's problem 1, in cm: a source of 20 cm in a void of 100 cm in a shield of 200 cm; the problem's reflecting
/// planes run through the middle.
/// @param voxels  along each edge, a multiple of 20 so that the regions end on voxels
/// @param scattering  part of the extinction: 0 (case i), 0.5 (case ii)
inline Scene KobayashiScene(int voxels, double scattering)
{
  Scene scene({ voxels, voxels, voxels });
  const double h = 200.0 / voxels;
  scene.medium.grid.spacing = { h, h, h };
  scene.medium.grid.origin = { -100.0, -100.0, -100.0 };
  scene.emission.assign(scene.sigma_a.size(), 0.0f);
  tyndall::ForGridVoxels({ voxels, voxels, voxels }, [&](std::size_t i, int x, int y, int z) {
    double from = 0.0; // the middle, largest distance along an axis
    for (int at : { x, y, z })
    {
      from = std::max(from, std::abs((at + 0.5) * h - 100.0));
    }
    const double sigma_t = from > 10.0 && from < 50.0 ? 1e-4 : 0.1;
    scene.sigma_s[i] = static_cast<float>(scattering * sigma_t);
    scene.sigma_a[i] = static_cast<float>((1.0 - scattering) * sigma_t);
    scene.emission[i] = from < 10.0 ? static_cast<float>(1.0 / (4.0 * 3.14159265358979323846)) : 0.0f;
  });
  return scene;
}

/// Fluence at a point in the middle of a voxel, seen as through 8 mirrored octants. A parabola through the means of the
/// voxel and its neighbours along each axis takes from the voxel's mean what its size adds: order 4 in the size.
/// @param asPoint  false: the voxel's mean itself
inline double KobayashiFluence(
  const Scene& scene, const std::vector<float>& fluence, const std::array<double, 3>& point, bool asPoint)
{
  const int n = scene.medium.grid.size[0];
  const auto at = [&](const std::array<int, 3>& v) {
    return static_cast<double>(fluence[(static_cast<std::size_t>(v[2]) * n + v[1]) * n + v[0]]);
  };
  double sum = 0.0;
  for (int octant = 0; octant < 8; ++octant)
  {
    std::array<int, 3> voxel;
    for (int a = 0; a < 3; ++a)
    {
      const double x = octant >> a & 1 ? -point[a] : point[a];
      voxel[a] = static_cast<int>(std::floor((x + 100.0) / scene.medium.grid.spacing[a]));
    }
    double value = at(voxel);
    for (int a = 0; asPoint && a < 3; ++a)
    {
      std::array<int, 3> lower = voxel, upper = voxel;
      --lower[a];
      ++upper[a];
      value -= (at(lower) - 2.0 * at(voxel) + at(upper)) / 24.0;
    }
    sum += value;
  }
  return sum / 8.0;
}
