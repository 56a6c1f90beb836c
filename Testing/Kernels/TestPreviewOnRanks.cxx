// Previews on several ranks are those of a serial solve. Their solver tells what it is given: no device is needed.

#include "SolvedOnRanks.h"

#include "LightPropagation/Accuracy/PreviewLight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace tyndall;

namespace
{
/// All that a scene can have by voxel.
MediumToCut ByVoxel(std::array<int, 3> size, int components)
{
  MediumToCut medium = Everything(size);
  Scene& scene = medium.scene;
  scene.medium.grid.spacing = { 1.0, 0.7, 1.2 };
  scene.sigma_s = RandomValues(components * scene.sigma_a.size(), 0.1, 1.0, 9);
  medium.g = RandomValues(scene.sigma_a.size(), -0.7, 0.7, 13);
  GiveLight(medium, components == 3);
  return medium;
}

/// Light that is made of all that a solver is given, by voxel.
LightField Told(const SceneBlock& scene)
{
  LightField light;
  light.channels = 3;
  const UncollidedImage& given = scene.illumination.uncollided;
  for (std::size_t i = 0; i < scene.medium.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      light.fluence.push_back(scene.medium.sigma_a.At(i, c) + 2.0f * scene.medium.emission.At(i, c) +
        3.0f * scene.medium.phase.G().At(i, c) + 5.0f * given.fluence.At(i, c) + 7.0f * given.meanDirection.At(i, c) +
        11.0f * scene.index.At(i, c));
      light.fluenceDirect.push_back(scene.medium.sigma_s.At(i, c));
    }
    light.balance.absorbed[1] += light.fluence.back();
  }
  return light;
}

void AddFigures(LightField& light, const Illumination& illumination)
{
  light.balance.escaped = { 1.0, 2.0, 3.0 };
  light.facePowerOut = illumination.uncollided.escaped;
  light.halfRangeFlux = { 0.25, 0.5, 0.75 };
  light.directionsPerFace = 36;
  light.uncollidedDirections = 100;
  light.polarNodes = 16;
  light.convergence = { { 0, 0.1, 0.5, 0.4, 1.0, 2.0, 3.0 }, { 4, 0.2, 0.25, 0.2, 1.5, 2.5, 3.5 } };
  light.sweepsSaved = { 0, 2 };
  light.device = "a device";
  light.leftOut = { "one thing", "another" };
}

LightField ToldOfWhole(const SceneBlock& scene)
{
  LightField light = Told(scene);
  AddFigures(light, scene.illumination);
  return light;
}

void ExpectSame(const LightField& found, const LightField& expected)
{
  EXPECT_LT(RelativeDifference(found.fluence, expected.fluence), 1e-6);
  EXPECT_LT(RelativeDifference(found.fluenceDirect, expected.fluenceDirect), 1e-6);
  EXPECT_NEAR(found.balance.absorbed[1], expected.balance.absorbed[1], 1e-6 * expected.balance.absorbed[1]);
  EXPECT_EQ(found.balance.escaped, expected.balance.escaped);
  EXPECT_EQ(found.facePowerOut, expected.facePowerOut);
  EXPECT_EQ(found.halfRangeFlux, expected.halfRangeFlux);
  EXPECT_EQ(found.directionsPerFace, expected.directionsPerFace);
  EXPECT_EQ(found.uncollidedDirections, expected.uncollidedDirections);
  EXPECT_EQ(found.polarNodes, expected.polarNodes);
  ASSERT_EQ(found.convergence.size(), expected.convergence.size());
  EXPECT_EQ(found.convergence.back().iteration, expected.convergence.back().iteration);
  EXPECT_EQ(found.convergence.back().leftOver, expected.convergence.back().leftOver);
  EXPECT_EQ(found.sweepsSaved, expected.sweepsSaved);
  EXPECT_EQ(found.device, expected.device);
  EXPECT_EQ(found.leftOut, expected.leftOut);
}

/// Even and uneven blocks, thin ones, and ranks that have nothing, the first as well.
std::vector<BlockPartition> Partitions(const Grid& grid)
{
  return { Slices(grid, { 0, 1, 2 }), Uneven(grid), BlockPartition::Even(grid, 1), BlockPartition::Even(grid, 8) };
}

/// Of a quarter of the voxels an axis.
Grid Quarters(const Grid& grid)
{
  return Coarsening(Coarsening(grid).Coarse()).Coarse();
}

LightField OnFirst(const Domain& domain, const MediumToCut& part)
{
  return SolvePreview(
    { domain, part.scene.medium, part.scene.light, part.Index() }, {}, Quarters(domain.Whole()), ToldOfWhole);
}

/// On ranks that each solve a block of the coarse grid.
LightField ByBlocks(const Domain& domain, const MediumToCut& part)
{
  const auto solve = [&](const SceneBlock& scene) {
    const std::size_t voxels = scene.domain.Own().VoxelCount();
    EXPECT_TRUE(voxels == 0 || voxels == scene.medium.grid.VoxelCount());
    LightField light = voxels > 0 ? Told(scene) : LightField();
    light.channels = 3;
    light.balance.absorbed[1] = domain.Sum(light.balance.absorbed[1]);
    AddFigures(light, scene.illumination);
    return light;
  };
  return SolvePreview(
    { domain, part.scene.medium, part.scene.light, part.Index() }, {}, Coarsening(domain.Whole()).Coarse(), solve, 0);
}
}

TEST(PreviewOnRanks, IsThatOfASerialSolve)
{
  for (const int components : { 1, 3 })
  {
    MediumToCut medium = ByVoxel({ 13, 9, 6 }, components);
    medium.Attach();
    const Grid& grid = medium.Grid();
    const SceneBlock scene = { Domain(grid), medium.scene.medium, medium.scene.light, medium.Index() };
    const LightField onFirst = SolvePreview(scene, {}, Quarters(grid), ToldOfWhole);
    const LightField byBlocks = SolvePreview(scene, {}, Coarsening(grid).Coarse(), ToldOfWhole);
    EXPECT_EQ(onFirst.leftOut.front(), "detail: a preview, of 3 x 2 x 1 of 13 x 9 x 6 voxels, few directions");
    for (const BlockPartition& partition : Partitions(grid))
    {
      SCOPED_TRACE(std::to_string(components) + ", " + std::to_string(partition.blocks.size()) + " ranks");
      ExpectSame(LightOnRanks(partition, medium, OnFirst), onFirst);
      ExpectSame(LightOnRanks(partition, medium, ByBlocks), byBlocks);
    }
  }
}

TEST(PreviewOnRanks, FailsTogetherWithWords)
{
  const MediumToCut medium = ByVoxel({ 7, 4, 3 }, 1);
  const BlockPartition partition = Slices(medium.Grid(), { 0, 3 });
  EXPECT_THAT(ErrorsOnRanks(partition,
                [&](const Domain& domain) {
                  MediumToCut part = medium.Part(domain);
                  part.ior.resize(domain.Rank() == 2 ? 0 : part.ior.size());
                  OnFirst(domain, part);
                }),
    testing::Each(testing::HasSubstr("disagree about whether there is a refractive index")));
  EXPECT_THAT(ErrorsOnRanks(partition,
                [&](const Domain& domain) {
                  const MediumToCut part = medium.Part(domain);
                  SolvePreview({ domain, part.scene.medium, part.scene.light, part.Index() }, {},
                    Quarters(partition.whole), [](const SceneBlock&) -> LightField { throw DeviceError("no memory"); });
                }),
    testing::Each(testing::HasSubstr("no memory")));
}
