// Errors that are estimated on several ranks are those of a serial solve.

#include "SolvedOnRanks.h"

#include "DiscreteOrdinates/OrdinatesError.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/CoarseBlocks.h"
#include "LatticeBoltzmann/DiffusionError.h"
#include "LightPropagation/Accuracy/TargetError.h"
#include "LightPropagation/Problem/PropagationQuality.h"

using namespace tyndall;

namespace
{
std::vector<BlockPartition> CutsOf(const Grid& grid)
{
  return { BlockPartition::Even(grid, 1), BlockPartition::Even(grid, 3), Uneven(grid), SingleVoxels(grid) };
}
}

/// Each coarse voxel has one owner and the average of the whole, also where blocks end amid it.
TEST(CoarseBlocks, AverageAsTheWholeDoes)
{
  for (const int x : { 1, 2, 3, 5, 8 })
  {
    const Grid grid = { { x, 5, 4 } };
    const std::vector<float> values = RandomValues(2 * grid.VoxelCount(), -1.0, 1.0, 3);
    const Coarsening whole(grid);
    const std::vector<float> expected = whole.Average(values.data(), 2);
    const VoxelBox coarse = { {}, whole.Coarse().size };
    for (const BlockPartition& partition : CutsOf(grid))
    {
      RunInThreads(static_cast<int>(partition.blocks.size()), [&](Communicator& communicator) {
        const Domain domain(communicator, partition);
        const CoarseBlocks blocks(communicator, partition);
        EXPECT_NO_THROW(blocks.Coarse().Check()) << x;
        EXPECT_EQ(blocks.Coarse().whole.size, whole.Coarse().size);
        const std::vector<float> found = blocks.Average(BlockOf(domain, values), 2);
        EXPECT_EQ(found, PartOf(expected, coarse, blocks.Coarse().blocks[communicator.Rank()], 2));
        const std::vector<float> seen = blocks.SeenOf(found, 2);
        ForVoxels(domain, [&](std::size_t i, std::size_t there) {
          ASSERT_EQ(seen[2 * blocks.Seen().Parent(i)], expected[2 * whole.Parent(there)]);
        });
      });
    }
  }
}

class ErrorOnRanks : public SolvedOnRanks<ConservativeSolver>
{
protected:
  LightField Estimated(const BlockPartition& partition, const MediumToCut& medium, const PropagationSettings& settings)
  {
    return LightOnRanks(partition, medium, [&](const Domain& domain, MediumToCut& part) {
      return SolveWithErrorEstimate({ domain, part.scene.medium, part.scene.light }, settings, {}, this->Solver());
    });
  }

  PropagationSolver Solver()
  {
    return [this](const SceneBlock& scene, const PropagationSettings& settings, const Monitor& monitor) {
      return SolveConservative(this->GetDevice(), scene.domain, scene.medium, scene.illumination, settings, monitor);
    };
  }

  /// Errors are differences of light: they are compared as parts of that.
  static void ExpectSameErrors(const LightField& found, const LightField& expected, double tolerance)
  {
    EXPECT_LT(RelativeDifference(found.fluence, expected.fluence), tolerance);
    ASSERT_FALSE(expected.fluenceError.empty());
    const double brightest = *std::max_element(expected.fluence.begin(), expected.fluence.end());
    EXPECT_LT(LargestDifference(found.fluenceError, expected.fluenceError), tolerance * brightest);
    EXPECT_NEAR(found.relativeError, expected.relativeError, tolerance);
    EXPECT_NEAR(found.errorLength, expected.errorLength, 1e-3 * expected.errorLength);
    ASSERT_EQ(found.surfaceError.size(), expected.surfaceError.size());
    EXPECT_LT(LargestDifference(found.surfaceError, expected.surfaceError), tolerance * brightest);
  }
  void ExpectSerialErrors(MediumToCut& medium, const PropagationSettings& settings, const BlockPartition& partition)
  {
    medium.Attach();
    const LightField expected = SolveWithErrorEstimate(
      { Domain(medium.Grid()), medium.scene.medium, medium.scene.light }, settings, {}, this->Solver());
    EXPECT_GT(expected.relativeError, 1e-3);
    ExpectSameErrors(this->Estimated(partition, medium, settings), expected, 2e-6);
  }
};

TEST_F(ErrorOnRanks, IsThatOfASerialSolve)
{
  MediumToCut medium = Everything({ 9, 7, 8 });
  medium.scene.medium.grid.spacing = { 1.0, 0.7, 1.2 };
  medium.scene.sigma_s = RandomValues(3 * medium.scene.sigma_a.size(), 0.0, 0.6, 9);
  PropagationSettings settings = ConservativeSolver::Plain(3);
  settings.uncollidedDirections = 25;
  this->ExpectSerialErrors(medium, settings, Uneven(medium.Grid()));
}

/// Cosines by voxel, weighted by what is scattered, and light that another solver found.
TEST_F(ErrorOnRanks, IsThatOfASerialSolveWithCosinesAndLightByVoxel)
{
  MediumToCut medium = Everything({ 10, 7, 9 });
  medium.g = RandomValues(medium.scene.sigma_a.size(), 0.2, 0.8, 13);
  GiveLight(medium, false);
  this->ExpectSerialErrors(medium, ConservativeSolver::Plain(4), Uneven(medium.Grid()));
}

/// Most ranks have no coarse voxel.
TEST_F(ErrorOnRanks, MayBeOfBlocksOfOneVoxel)
{
  MediumToCut medium = Everything({ 3, 3, 2 });
  this->ExpectSerialErrors(medium, ConservativeSolver::Plain(3), SingleVoxels(medium.Grid()));
}

/// Thick voxels, accelerated; with finer directions of light from outside, which the coarse ones cannot have.
TEST_F(ErrorOnRanks, IsThatOfASerialSolveOfThickVoxels)
{
  for (const double densest : { 8.0, 0.8 })
  {
    MediumToCut medium({ 12, 11, 13 });
    medium.scene.Randomise(densest, 1.0, 0.99, 4);
    medium.scene.light.faces[2] = { 1.0, 1.0, 1.0 };
    PropagationSettings settings = ConservativeSolver::Plain();
    settings.acceleration = PropagationAcceleration::Automatic;
    settings.source = PropagationSource::Automatic;
    settings.uncollidedDirections = -1;
    settings.tolerance = 1e-6;
    const LightField one = this->Estimated(BlockPartition::Even(medium.Grid(), 1), medium, settings);
    EXPECT_GT(one.errorLength, 0.0);
    EXPECT_EQ(one.surfaceError.empty(), densest < 1.0); // only thick voxels at faces have a surface radiance
    ExpectSameErrors(this->Estimated(Uneven(medium.Grid()), medium, settings), one, 1e-5);
  }
}

/// The same directions, tolerance and voxels are chosen, and the same light found, of all cells of faces on each rank.
TEST_F(ErrorOnRanks, IsBroughtToATargetAsThatOfASerialSolve)
{
  MediumToCut medium({ 8, 7, 9 });
  medium.scene.Randomise(0.5, 1.0, 0.5, 7);
  medium.scene.light.faces[2] = { 1.0, 1.0, 1.0 };
  medium.Attach();
  PropagationSettings settings;
  settings.acceleration = PropagationAcceleration::None;
  settings.source = PropagationSource::Constant;
  settings.emissionError = 0.0;
  settings.facePower = true;
  for (const double target : { 0.2, 0.008 })
  {
    const TargetLight expected = SolveToTargetError(
      { Domain(medium.Grid()), medium.scene.medium, medium.scene.light }, settings, target, {}, this->Solver());
    const BlockPartition partition = Uneven(medium.Grid());
    const LightField found = LightOnRanks(partition, medium, [&](const Domain& domain, MediumToCut& part) {
      TargetLight own =
        SolveToTargetError({ domain, part.scene.medium, part.scene.light }, settings, target, {}, this->Solver());
      EXPECT_EQ(own.divided, expected.divided);
      EXPECT_EQ(own.solves, expected.solves);
      EXPECT_EQ(Words(own.settings), Words(expected.settings));
      EXPECT_EQ(own.met, expected.met);
      EXPECT_LT(RelativeDifference(own.light.facePower, expected.light.facePower), 1e-5);
      return own.light;
    });
    ExpectSameErrors(found, expected.light, 2e-6);
    EXPECT_EQ(expected.divided, target < 0.1);
  }
}

/// Of discrete ordinates, with fewer directions and terms on the coarse grid.
TEST_F(ErrorOnRanks, OfOrdinatesIsThatOfASerialSolve)
{
  MediumToCut medium = Everything({ 9, 7, 8 });
  medium.scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  medium.Attach();
  OrdinatesSettings settings;
  settings.directionsPerFace = 9;
  settings.terms = 9;
  settings.maximumOrders = 4;
  const auto estimate = [&](const Domain& domain, const MediumToCut& part) {
    return EstimateOrdinates(this->GetDevice(), { domain, part.scene.medium, part.scene.light }, settings);
  };
  const LightField expected = estimate(Domain(medium.Grid()), medium);
  EXPECT_GT(expected.relativeError, 1e-3);
  ExpectSameErrors(LightOnRanks(Uneven(medium.Grid()), medium, estimate), expected, 2e-6);
}

/// Of the lattice, from solves on the coarse grid, whose voxels are cubes.
TEST_F(ErrorOnRanks, OfTheLatticeIsThatOfASerialSolve)
{
  MediumToCut medium = Everything({ 10, 8, 6 });
  AddNearLamps(medium.scene);
  medium.Attach();
  LatticeSettings settings;
  settings.tolerance = 1e-7;
  const auto estimate = [&](const Domain& domain, const MediumToCut& part) {
    const SceneBlock scene = { domain, part.scene.medium, part.scene.light, part.Index() };
    LightField light =
      SolveLatticeBoltzmann(this->GetDevice(), domain, scene.medium, scene.index, scene.illumination, settings);
    EstimateDiffusionError(this->GetDevice(), scene, settings, false, {}, light);
    return light;
  };
  const LightField expected = estimate(Domain(medium.Grid()), medium);
  EXPECT_GT(expected.relativeError, 1e-3);
  ExpectSameErrors(LightOnRanks(Uneven(medium.Grid()), medium, estimate), expected, 1e-5);
}
