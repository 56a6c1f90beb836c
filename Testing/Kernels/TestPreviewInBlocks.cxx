// Previews of a medium that is spread over ranks, against those of the whole. Their solver tells what it is given: no
// device is needed.

#include "MediumInBlocks.h"

#include "LightPropagation/Accuracy/PreviewLight.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace tyndall;

namespace
{
/// All that a scene can have by voxel.
MediumToCut Everything(std::array<int, 3> size, int components)
{
  MediumToCut medium(size);
  Scene& scene = medium.scene;
  scene.medium.grid.spacing = { 1.0, 0.7, 1.2 };
  scene.Randomise(2.0, 2.0, 0.8, 11);
  scene.sigma_s = RandomValues(components * scene.sigma_a.size(), 0.1, 1.0, 9);
  scene.emission = RandomValues(scene.sigma_a.size(), 0.0, 0.2, 3);
  medium.g = RandomValues(scene.sigma_a.size(), -0.7, 0.7, 13);
  medium.ior = RandomValues(scene.sigma_a.size(), 1.0, 1.6, 5);
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
  light.halfRangeFlux = 0.25;
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

/// Even and uneven ones, thin ones, and ranks that have nothing, the first as well.
std::vector<BlockPartition> Partitions(const Grid& grid)
{
  std::vector<BlockPartition> partitions = { Slices(grid, { 0, 1, 2 }), Slices(grid, { 1, 1, 3 }) };
  for (const int ranks : { 1, 3, 8 })
  {
    partitions.push_back(BlockPartition::Even(grid, ranks));
  }
  return partitions;
}

Grid Halves(const Grid& grid)
{
  return Coarsening(Coarsening(grid).Coarse()).Coarse();
}

/// Of a quarter of the voxels an axis.
LightField OnFirst(Communicator& communicator, const BlockPartition& partition, const MediumToCut& part)
{
  return SolvePreview({ Domain(communicator, partition), part.scene.medium, part.scene.light, part.Index() }, {},
    Halves(partition.whole), ToldOfWhole);
}
}

TEST(PreviewInBlocks, IsThatOfTheWholeOnTheFirstRank)
{
  for (const int components : { 1, 3 })
  {
    SCOPED_TRACE(components);
    MediumToCut medium = Everything({ 13, 9, 6 }, components);
    medium.Attach();
    const Grid& grid = medium.scene.medium.grid;
    const LightField whole = SolvePreview(
      { Domain(grid), medium.scene.medium, medium.scene.light, medium.Index() }, {}, Halves(grid), ToldOfWhole);
    EXPECT_EQ(whole.leftOut.front(), "detail: a preview, of 3 x 2 x 1 of 13 x 9 x 6 voxels, few directions");
    for (const BlockPartition& partition : Partitions(grid))
    {
      SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
      ExpectSame(
        LightOfBlocks(partition, medium,
          [&](Communicator& communicator, MediumToCut& part) { return OnFirst(communicator, partition, part); }),
        whole);
    }
  }
}

TEST(PreviewInBlocks, IsThatOfTheWholeByBlocksOfTheCoarseGrid)
{
  MediumToCut medium = Everything({ 13, 9, 6 }, 3);
  medium.Attach();
  const Grid &grid = medium.scene.medium.grid, coarse = Coarsening(grid).Coarse();
  const LightField whole =
    SolvePreview({ Domain(grid), medium.scene.medium, medium.scene.light, medium.Index() }, {}, coarse, ToldOfWhole);
  for (const BlockPartition& partition : Partitions(grid))
  {
    SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
    ExpectSame(LightOfBlocks(partition, medium,
                 [&](Communicator& communicator, MediumToCut& part) {
                   const auto solve = [&](const SceneBlock& scene) {
                     const std::size_t voxels = scene.domain.Own().VoxelCount();
                     EXPECT_TRUE(voxels == 0 || voxels == scene.medium.grid.VoxelCount());
                     LightField light = voxels > 0 ? Told(scene) : LightField();
                     light.channels = 3;
                     light.balance.absorbed[1] = communicator.Sum({ light.balance.absorbed[1] })[0];
                     AddFigures(light, scene.illumination);
                     return light;
                   };
                   return SolvePreview(
                     { Domain(communicator, partition), part.scene.medium, part.scene.light, part.Index() }, {}, coarse,
                     solve, 0);
                 }),
      whole);
  }
}

TEST(PreviewInBlocks, FailsTogetherWithWords)
{
  const MediumToCut medium = Everything({ 7, 4, 3 }, 1);
  const BlockPartition partition = Slices(medium.scene.medium.grid, { 0, 3 });
  const auto expectErrors = [&](const std::string& words, const auto& solve) {
    RunInThreads(3, [&](Communicator& communicator) {
      MediumToCut part = medium.Part(partition.blocks[communicator.Rank()]);
      part.Attach();
      std::string said;
      try
      {
        solve(communicator, part);
      }
      catch (const std::exception& error)
      {
        said = error.what();
      }
      EXPECT_NE(said.find(words), std::string::npos) << said;
    });
  };
  expectErrors(
    "disagree about whether there is a refractive index", [&](Communicator& communicator, MediumToCut& part) {
      part.ior.resize(communicator.Rank() == 2 ? 0 : part.ior.size());
      OnFirst(communicator, partition, part);
    });
  expectErrors("no memory", [&](Communicator& communicator, MediumToCut& part) {
    SolvePreview({ Domain(communicator, partition), part.scene.medium, part.scene.light, part.Index() }, {},
      Halves(partition.whole), [](const SceneBlock&) -> LightField { throw DeviceError("no memory"); });
  });
}
