#pragma once

#include "PhotonScene.h"

#include "Distribution/BoxExchange.h"
#include "Photons/Marching/PhotonMarcher.h"
#include "RanksInThreads.h"
#include "Refraction/Octree/RefractionOctree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <random>
#include <string>
#include <vector>

// Scenes in blocks, one a rank, whose ranks are threads.

/// The arrays of a box of a scene.
struct BlockOfScene
{
  BlockOfScene(const PhotonScene& scene, const tyndall::VoxelBox& box)
    : medium(scene.medium)
  {
    const tyndall::VoxelBox whole = { { 0, 0, 0 }, scene.medium.grid.size };
    const auto part = [&](const std::vector<float>& values) {
      return tyndall::PartOf(values, whole, box, scene.ComponentsOf(values));
    };
    this->sigma_a = part(scene.sigma_a);
    this->sigma_s = part(scene.sigma_s);
    this->ior = scene.ior.empty() ? scene.ior : part(scene.ior);
    if (scene.medium.phase.Varies())
    {
      const tyndall::Field& g = scene.medium.phase.G();
      this->g = part({ g.values, g.values + scene.medium.grid.VoxelCount() * static_cast<std::size_t>(g.components) });
      this->medium.phase = scene.medium.phase.WithG({ this->g.data(), g.components });
    }
    this->medium.grid.size = box.size;
    this->medium.sigma_a = { this->sigma_a.data(), scene.ComponentsOf(scene.sigma_a) };
    this->medium.sigma_s = { this->sigma_s.data(), scene.ComponentsOf(scene.sigma_s) };
    for (std::size_t i = 0; i < box.VoxelCount(); ++i)
    {
      std::array<int, 3> voxel = this->medium.grid.VoxelAt(i);
      for (int axis = 0; axis < 3; ++axis)
      {
        voxel[axis] += box.first[axis];
      }
      this->places.push_back(scene.medium.grid.IndexOf(voxel));
    }
    for (std::size_t i = 0; i < this->places.size() && !scene.levels.empty(); ++i)
    {
      this->levels.push_back(scene.levels[this->places[i]]);
    }
  }
  BlockOfScene(const BlockOfScene&) = delete;
  BlockOfScene& operator=(const BlockOfScene&) = delete;

  tyndall::Field Index() const { return { this->ior.empty() ? nullptr : this->ior.data(), 1 }; }
  const std::uint8_t* Levels() const { return this->levels.empty() ? nullptr : this->levels.data(); }
  /// Values of the box to those of the whole.
  void Put(const std::vector<float>& from, std::vector<float>& to, std::size_t voxels) const
  {
    const std::size_t width = this->places.empty() ? 0 : from.size() / this->places.size();
    to.resize(std::max(to.size(), voxels * width));
    for (std::size_t i = 0; i < from.size(); ++i)
    {
      to[this->places[i / width] * width + i % width] = from[i];
    }
  }

  tyndall::Medium medium;
  std::vector<float> sigma_a, sigma_s, ior, g;
  std::vector<std::uint8_t> levels;
  std::vector<std::size_t> places; ///< in the whole
};

inline std::vector<std::vector<float>*> ArraysOf(tyndall::PhotonLight& light)
{
  return { &light.light.fluence, &light.light.fluenceDirect, &light.light.fluenceError, &light.meanDirection,
    &light.photonCount, &light.photonWeight, &light.batchFluence };
}

/// What a rank has of photons: the more, the higher its number.
inline std::vector<tyndall::Photon> ShareOf(const std::vector<tyndall::Photon>& photons, int rank, int ranks)
{
  const auto cut = [&](int r) {
    return photons.begin() + static_cast<std::ptrdiff_t>(photons.size()) * r * r / (ranks * ranks);
  };
  return { cut(rank), cut(rank + 1) };
}

/// How a rank marches its share of the photons through its part of a scene.
using MarchOfRank = std::function<tyndall::PhotonLight(const tyndall::Domain& domain, const BlockOfScene& part,
  const std::vector<tyndall::Photon>& share, tyndall::RoundsTraffic& traffic)>;

/// Arrays of the blocks put together; all else must be the same on all ranks.
inline tyndall::PhotonLight LightOfAll(const PhotonScene& scene, const tyndall::BlockPartition& partition,
  const std::vector<tyndall::Photon>& photons, const MarchOfRank& march,
  std::vector<tyndall::RoundsTraffic>* traffic = nullptr)
{
  const int ranks = static_cast<int>(partition.blocks.size());
  std::vector<tyndall::PhotonLight> found(ranks);
  std::vector<tyndall::RoundsTraffic> handed(ranks);
  tyndall::RunInThreads(ranks, [&](tyndall::Communicator& communicator) {
    const int rank = communicator.Rank();
    const BlockOfScene part(scene, partition.blocks[rank]);
    found[rank] = march(tyndall::Domain(communicator, partition), part, ShareOf(photons, rank, ranks), handed[rank]);
  });
  tyndall::PhotonLight all = found[0];
  const std::size_t voxels = scene.medium.grid.VoxelCount();
  for (std::vector<float>* array : ArraysOf(all))
  {
    array->clear();
  }
  for (int rank = 0; rank < ranks; ++rank)
  {
    const BlockOfScene part(scene, partition.blocks[rank]);
    for (std::size_t i = 0; i < ArraysOf(all).size(); ++i)
    {
      part.Put(*ArraysOf(found[rank])[i], *ArraysOf(all)[i], voxels);
    }
    EXPECT_EQ(found[rank].light.facePowerOut, all.light.facePowerOut);
    EXPECT_EQ(found[rank].light.balance.absorbed, all.light.balance.absorbed);
    EXPECT_EQ(found[rank].light.channels, all.light.channels);
    EXPECT_EQ(handed[rank].rounds, handed[0].rounds);
  }
  if (traffic)
  {
    *traffic = handed;
  }
  return all;
}

inline tyndall::PhotonLight LightOfAll(tyndall::Device& device, const PhotonScene& scene,
  const tyndall::BlockPartition& partition, const std::vector<tyndall::Photon>& photons,
  std::vector<tyndall::RoundsTraffic>* traffic = nullptr)
{
  const auto march = [&](const tyndall::Domain& domain, const BlockOfScene& part,
                       const std::vector<tyndall::Photon>& share, tyndall::RoundsTraffic& handed) {
    tyndall::PhotonMarcher marcher(device, domain, part.medium, part.Index(), scene.settings, part.Levels());
    tyndall::PhotonLight light = marcher.March(share);
    handed = marcher.Traffic();
    return light;
  };
  return LightOfAll(scene, partition, photons, march, traffic);
}

/// What each of some ranks says that it cannot do; empty: nothing.
inline std::vector<std::string> ErrorsOfRanks(int ranks, const std::function<void(tyndall::Communicator&)>& work)
{
  std::vector<std::string> errors(ranks);
  tyndall::RunInThreads(ranks, [&](tyndall::Communicator& communicator) {
    try
    {
      work(communicator);
    }
    catch (const std::exception& error)
    {
      errors[communicator.Rank()] = error.what();
    }
  });
  return errors;
}

/// Extinction from 0.01 to 1 a voxel's edge, `components` of it.
inline void Randomise(PhotonScene& scene, std::size_t components)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-2.0, 0.0);
  for (std::vector<float>* values : { &scene.sigma_a, &scene.sigma_s })
  {
    values->resize(scene.medium.grid.VoxelCount() * components);
    for (float& value : *values)
    {
      value = static_cast<float>(0.5 / scene.medium.grid.spacing[0] * std::pow(10.0, exponent(random)));
    }
  }
}

/// 12 x 9 x 7 voxels of some absorption and scattering.
inline PhotonScene SmallScene(std::size_t components = 1)
{
  PhotonScene scene({ 12, 9, 7 }, 0.2, 0.9, 0.0f, 0.0f);
  Randomise(scene, components);
  return scene;
}

/// Gives a scene the octree of its index.
inline void SetOctree(PhotonScene& scene, double tolerance)
{
  tyndall::OctreeSettings settings;
  settings.tolerance = tolerance;
  scene.levels =
    tyndall::BuildOctree(tyndall::Domain(scene.medium.grid), scene.Medium(), scene.Index(), settings).levels;
}

/// A scene whose octree has nodes as large as blocks: waves, or a ball of glass.
inline PhotonScene SceneOfNodes(bool glass, std::size_t components = 1)
{
  PhotonScene scene({ 21, 18, 17 }, 0.1, 0.9, 0.0f, 0.0f);
  Randomise(scene, components);
  if (glass)
  {
    scene.SetBall(0.6, 1.5, 1.0);
  }
  else
  {
    scene.SetIndex([](double x, double y, double z) {
      return 1.2 + 0.05 * std::sin(2.0 * x + 1.0) * std::cos(y) * std::cos(2.0 * z + 0.5);
    });
  }
  SetOctree(scene, glass ? 0.05 : 0.02);
  return scene;
}

/// Five blocks of that, of which one is empty and one a voxel.
inline tyndall::BlockPartition UnevenBlocks(const PhotonScene& scene)
{
  return { scene.medium.grid,
    { { { 1, 0, 0 }, { 11, 9, 7 } }, {}, { { 0, 1, 0 }, { 1, 8, 7 } }, { { 0, 0, 1 }, { 1, 1, 6 } },
      { { 0, 0, 0 }, { 1, 1, 1 } } } };
}
