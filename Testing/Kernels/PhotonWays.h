#pragma once

#include "Numerics/ChooseEvenly.h"
#include "Photons/Marching/PhotonMarcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

/// Photons anywhere in the box, that go anywhere.
inline std::vector<tyndall::Photon> AnyPhotons(const tyndall::Grid& grid, std::size_t count, unsigned seed = 1)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<float> normal;
  std::vector<tyndall::Photon> photons(count);
  for (tyndall::Photon& photon : photons)
  {
    for (int a = 0; a < 3; ++a)
    {
      photon.position[a] = grid.origin[a] + uniform(random) * grid.Length(a);
      photon.direction[a] = normal(random);
    }
    const float length = std::hypot(photon.direction[0], photon.direction[1], photon.direction[2]);
    for (float& component : photon.direction)
    {
      component /= length;
    }
    photon.power.fill(static_cast<float>(0.5 + uniform(random)));
    photon.weight = static_cast<float>(4.0 * uniform(random));
  }
  return photons;
}

inline tyndall::Photon PhotonFrom(std::array<double, 3> position, std::array<float, 3> direction)
{
  tyndall::Photon photon;
  photon.position = position;
  photon.direction = direction;
  photon.power = { 1.0f, 1.0f, 1.0f };
  return photon;
}

/// Along faces, edges and corners of voxels of 1, in a cube from -4 to 4.
inline std::vector<tyndall::Photon> PhotonsAlongFaces()
{
  std::vector<tyndall::Photon> photons;
  const float s = std::sqrt(0.5f), t = std::sqrt(1.0f / 3.0f);
  for (const double y : { -4.0, -1.0, 0.0, 1e-9, -1e-9, 2.0, 4.0 })
  {
    for (const double z : { -4.0, 0.0, 1.0, 4.0 })
    {
      photons.push_back(PhotonFrom({ -4.0, y, z }, { 1.0f, 0.0f, 0.0f }));
      photons.push_back(PhotonFrom({ 4.0, y, z }, { -1.0f, 0.0f, 0.0f }));
      photons.push_back(PhotonFrom({ y, -4.0, z }, { 0.0f, 1.0f, 0.0f }));
      photons.push_back(PhotonFrom({ z, y, 4.0 }, { 0.0f, 0.0f, -1.0f }));
      photons.push_back(PhotonFrom({ -4.0, -4.0, z }, { s, s, 0.0f })); // through edges
      photons.push_back(PhotonFrom({ z, 4.0, -4.0 }, { 0.0f, -s, s }));
    }
  }
  for (const float x : { -t, t })
  {
    for (const float y : { -t, t })
    {
      photons.push_back(PhotonFrom({ 0.0, 0.0, 0.0 }, { x, y, t })); // from a corner, and through it
      photons.push_back(PhotonFrom({ -4.0 * std::copysign(1.0, x), -4.0 * std::copysign(1.0, y), -4.0 }, { x, y, t }));
    }
  }
  return photons;
}

/// Bit for bit, and the same ways.
inline void ExpectSameLight(const tyndall::PhotonLight& light, const tyndall::PhotonLight& other)
{
  EXPECT_EQ(light.light.fluence, other.light.fluence);
  EXPECT_EQ(light.meanDirection, other.meanDirection);
  EXPECT_EQ(light.light.balance.entered, other.light.balance.entered);
  EXPECT_EQ(light.light.balance.absorbed, other.light.balance.absorbed);
  EXPECT_EQ(light.light.balance.escaped, other.light.balance.escaped);
  EXPECT_EQ(light.light.balance.leftOver, other.light.balance.leftOver);
  EXPECT_EQ(light.light.facePowerOut, other.light.facePowerOut);
  EXPECT_EQ(light.scattered, other.scattered);
  EXPECT_EQ(light.deposits, other.deposits);
  EXPECT_EQ(light.steps, other.steps);
}

/// The voxels that a path crosses, one after the other: each stretch is cut at the planes between voxels.
inline std::vector<std::size_t> VoxelsCrossed(const tyndall::PhotonPath& path, const tyndall::Grid& grid)
{
  std::vector<std::size_t> crossed;
  for (std::size_t i = 1; i < path.points.size(); ++i)
  {
    double from[3], to[3];
    std::vector<double> cuts = { 0.0, 1.0 };
    for (int a = 0; a < 3; ++a)
    {
      from[a] = (path.points[i - 1][a] - grid.origin[a]) / grid.spacing[a];
      to[a] = (path.points[i][a] - grid.origin[a]) / grid.spacing[a];
      for (int plane = 0; plane <= grid.size[a]; ++plane)
      {
        const double t = (plane - from[a]) / (to[a] - from[a]);
        if (t > 0.0 && t < 1.0)
        {
          cuts.push_back(t);
        }
      }
    }
    std::sort(cuts.begin(), cuts.end());
    const double length = std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
    for (std::size_t c = 1; c < cuts.size(); ++c)
    {
      if ((cuts[c] - cuts[c - 1]) * length < 3e-6) // rounding of the path's corners, which are floats
      {
        continue;
      }
      std::size_t voxel = 0;
      for (int a = 2; a >= 0; --a)
      {
        const double middle = from[a] + 0.5 * (cuts[c] + cuts[c - 1]) * (to[a] - from[a]);
        const int at = std::min(std::max(static_cast<int>(std::floor(middle)), 0), grid.size[a] - 1);
        voxel = voxel * static_cast<std::size_t>(grid.size[a]) + static_cast<std::size_t>(at);
      }
      if (crossed.empty() || crossed.back() != voxel)
      {
        crossed.push_back(voxel);
      }
    }
  }
  return crossed;
}

/// The ways of all photons.
inline std::vector<tyndall::PhotonPath> AllPaths(
  tyndall::PhotonMarcher& marcher, const std::vector<tyndall::Photon>& photons)
{
  return marcher.Paths(photons, tyndall::ChooseEvenly(photons.size(), photons.size()));
}

/// Sum of differences over the sum of the second.
template <class Numbers, class Others>
double DifferenceOf(const Numbers& numbers, const Others& others)
{
  double difference = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < others.size(); ++i)
  {
    difference += std::abs(static_cast<double>(numbers[i]) - static_cast<double>(others[i]));
    sum += std::abs(static_cast<double>(others[i]));
  }
  return difference / sum;
}
