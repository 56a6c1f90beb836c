#pragma once

#include "Difference.h"
#include "MediumScene.h"

#include "Distribution/BlockPartition.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/RanksInThreads.h"
#include "Light/LightField.h"

#include <algorithm>
#include <array>
#include <functional>
#include <mutex>
#include <random>
#include <vector>

/// A scene with what else solvers read by voxel, of which ranks get parts.
struct MediumToCut
{
  explicit MediumToCut(std::array<int, 3> size)
    : scene(size)
  {
  }

  tyndall::VoxelBox All() const { return { { 0, 0, 0 }, this->scene.medium.grid.size }; }
  tyndall::Field Index() const { return { this->ior.empty() ? nullptr : this->ior.data(), 1 }; }
  void Attach()
  {
    if (this->scene.sigma_a.empty())
    {
      return; // the part of a rank that has none
    }
    this->scene.Attach();
    if (!this->given.empty())
    {
      this->scene.light.uncollided.fluence = { this->given.data(), this->scene.ComponentsOf(this->given) };
      this->scene.light.uncollided.meanDirection = { this->ways.data(), 3 };
    }
    if (!this->g.empty())
    {
      this->scene.medium.phase = tyndall::PhaseOfMedium(
        tyndall::PhaseFunction::HenyeyGreenstein(0.1), { this->g.data(), this->scene.ComponentsOf(this->g) });
    }
  }

  /// That of a box of it.
  MediumToCut Part(const tyndall::VoxelBox& box) const
  {
    MediumToCut part(box.size);
    const auto cut = [&](const std::vector<float>& values) {
      const int components = this->scene.ComponentsOf(values);
      return components > 0 ? tyndall::PartOf(values, this->All(), box, components) : values;
    };
    part.scene.light = this->scene.light;
    part.scene.sigma_a = cut(this->scene.sigma_a);
    part.scene.sigma_s = cut(this->scene.sigma_s);
    part.scene.emission = cut(this->scene.emission);
    part.scene.medium.phase = this->scene.medium.phase;
    part.ior = cut(this->ior);
    part.g = cut(this->g);
    part.given = cut(this->given);
    part.ways = cut(this->ways);
    return part;
  }

  Scene scene;
  std::vector<float> ior, g;
  std::vector<float> given, ways; ///< uncollided light and its mean directions; empty: none is given
};

inline std::vector<float> RandomValues(std::size_t count, double least, double most, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(least, most);
  std::vector<float> values(count);
  std::generate(values.begin(), values.end(), [&] { return static_cast<float>(value(random)); });
  return values;
}

/// A point, a spot that shines in from beside the box, and a rectangle.
inline void AddNearLamps(Scene& scene)
{
  const auto place = [&scene](double x, double y, double z) {
    const tyndall::Grid& grid = scene.medium.grid;
    return std::array<double, 3>{ x * grid.Length(0), y * grid.Length(1), z * grid.Length(2) };
  };
  tyndall::Light point;
  point.type = tyndall::LightType::Point;
  point.position = place(0.35, 0.6, 0.45);
  point.power = { 3.0, 3.0, 3.0 };
  tyndall::Light spot = point;
  spot.type = tyndall::LightType::Spot;
  spot.position = place(-0.5, 0.4, 1.2);
  spot.direction = { 0.9, 0.1, -0.6 };
  spot.angle = 40.0;
  tyndall::Light rectangle = point;
  rectangle.type = tyndall::LightType::Rectangle;
  rectangle.position = place(0.7, 1.1, 0.5);
  rectangle.direction = { -0.2, -0.9, 0.3 };
  rectangle.size = { 1.3, 0.7 };
  for (const tyndall::Light& lamp : { point, spot, rectangle })
  {
    scene.light.lights.push_back(lamp);
  }
}

/// Light of another solver instead of that of lamps.
inline void GiveLight(MediumToCut& medium, bool colour)
{
  const std::size_t voxels = medium.scene.medium.grid.VoxelCount();
  medium.given = RandomValues((colour ? 3 : 1) * voxels, 0.1, 2.0, 7);
  medium.ways = RandomValues(3 * voxels, -0.57, 0.57, 8);
  medium.scene.light.lights.clear();
  medium.scene.light.sky = {};
  medium.scene.light.faces = {};
  for (std::size_t face = 0; face < 6; ++face)
  {
    medium.scene.light.uncollided.escaped[face].fill(0.5 * static_cast<double>(face));
  }
}

/// Cut by planes across x at these voxels; 0 before and the end behind them.
inline tyndall::BlockPartition Slices(const tyndall::Grid& grid, std::vector<int> cuts)
{
  tyndall::BlockPartition partition = { grid, {} };
  cuts.push_back(grid.size[0]);
  int first = 0;
  for (const int cut : cuts)
  {
    partition.blocks.push_back({ { first, 0, 0 }, { cut - first, grid.size[1], grid.size[2] } });
    first = cut;
  }
  return partition;
}

/// A block for each voxel.
inline tyndall::BlockPartition SingleVoxels(const tyndall::Grid& grid)
{
  tyndall::BlockPartition partition = { grid, {} };
  for (std::size_t voxel = 0; voxel < grid.VoxelCount(); ++voxel)
  {
    partition.blocks.push_back({ grid.VoxelAt(voxel), { 1, 1, 1 } });
  }
  return partition;
}
/// Arrays of the blocks put together; all else of the first rank that comes, which must be that of all.
/// @param solve  of a rank's part
inline tyndall::LightField LightOfBlocks(const tyndall::BlockPartition& partition, const MediumToCut& medium,
  const std::function<tyndall::LightField(tyndall::Communicator&, MediumToCut& part)>& solve)
{
  tyndall::LightField all;
  std::mutex guard;
  tyndall::RunInThreads(static_cast<int>(partition.blocks.size()), [&](tyndall::Communicator& communicator) {
    const tyndall::VoxelBox& block = partition.blocks[communicator.Rank()];
    MediumToCut part = medium.Part(block);
    part.Attach();
    const tyndall::LightField light = solve(communicator, part);
    const std::lock_guard<std::mutex> lock(guard);
    const std::size_t channels = static_cast<std::size_t>(light.channels);
    if (all.convergence.empty())
    {
      all = light;
      all.fluence.assign(channels * partition.whole.VoxelCount(), 0.0f);
      all.fluenceDirect = all.fluence;
      all.netFlux.assign(3 * all.fluence.size(), 0.0f);
      all.scatteredRadiance.clear();
    }
    EXPECT_EQ(light.facePowerOut, all.facePowerOut);
    EXPECT_EQ(light.balance.absorbed, all.balance.absorbed);
    EXPECT_EQ(light.convergence.size(), all.convergence.size());
    tyndall::Grid own;
    own.size = block.size;
    const auto put = [&](const std::vector<float>& from, std::vector<float>& to, std::size_t width) {
      for (std::size_t i = 0; i < block.VoxelCount(); ++i)
      {
        std::array<int, 3> at = own.VoxelAt(i);
        for (int axis = 0; axis < 3; ++axis)
        {
          at[axis] += block.first[axis];
        }
        std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(i * width), width,
          to.begin() + static_cast<std::ptrdiff_t>(partition.whole.IndexOf(at) * width));
      }
    };
    put(light.fluence, all.fluence, channels);
    put(light.fluenceDirect, all.fluenceDirect, channels);
    put(light.netFlux, all.netFlux, light.netFlux.empty() ? 0 : 3 * channels);
    const std::size_t scattered = channels * light.storedDirections.size();
    all.scatteredRadiance.resize(scattered * partition.whole.VoxelCount());
    put(light.scatteredRadiance, all.scatteredRadiance, light.scatteredRadiance.empty() ? 0 : scattered);
  });
  return all;
}

/// That two solves came to the same.
/// @param tolerance  of fluence and powers, relative to the largest; of uncollided light 1e-6
inline void ExpectSameLight(const tyndall::LightField& found, const tyndall::LightField& expected, double tolerance)
{
  EXPECT_LT(RelativeDifference(found.fluence, expected.fluence), tolerance);
  EXPECT_LT(RelativeDifference(found.fluenceDirect, expected.fluenceDirect), 1e-6);
  EXPECT_LT(RelativeDifference(found.netFlux, expected.netFlux), 2.0 * tolerance);
  EXPECT_EQ(found.converged, expected.converged);
  for (std::size_t c = 0; c < static_cast<std::size_t>(expected.channels); ++c)
  {
    const double all = expected.balance.entered[c] + expected.balance.emitted[c];
    EXPECT_NEAR(found.balance.entered[c], expected.balance.entered[c], 1e-6 * all);
    EXPECT_NEAR(found.balance.emitted[c], expected.balance.emitted[c], 1e-6 * all);
    EXPECT_NEAR(found.balance.absorbed[c], expected.balance.absorbed[c], tolerance * all);
    for (std::size_t face = 0; face < 6; ++face)
    {
      EXPECT_NEAR(found.facePowerOut[face][c], expected.facePowerOut[face][c], tolerance * all);
    }
  }
}
