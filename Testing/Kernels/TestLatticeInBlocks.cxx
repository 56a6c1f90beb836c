// The steady light of a lattice in a medium that is spread over ranks, against that of one rank and of the whole.

#include "Difference.h"
#include "LatticeScene.h"

#include "Distribution/BoxExchange.h"
#include "Distribution/RanksInThreads.h"
#include "LatticeBoltzmann/Distributed/LatticeInBlocks.h"

#include <algorithm>
#include <functional>
#include <mutex>
#include <random>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
/// A scene with what else a lattice reads by voxel.
struct LatticeMedium
{
  explicit LatticeMedium(std::array<int, 3> size)
    : scene(size)
  {
  }

  VoxelBox All() const { return { { 0, 0, 0 }, this->scene.medium.grid.size }; }
  Field Index() const { return { this->ior.empty() ? nullptr : this->ior.data(), 1 }; }
  void Attach()
  {
    this->scene.Attach();
    if (!this->g.empty())
    {
      this->scene.medium.phase =
        PhaseOfMedium(PhaseFunction::HenyeyGreenstein(0.1), { this->g.data(), this->scene.ComponentsOf(this->g) });
    }
  }

  /// That of a box of it.
  LatticeMedium Part(const VoxelBox& box) const
  {
    LatticeMedium part(box.size);
    const auto cut = [&](const std::vector<float>& values) {
      const int components = this->scene.ComponentsOf(values);
      return components > 0 ? PartOf(values, this->All(), box, components) : values;
    };
    part.scene.light = this->scene.light;
    part.scene.sigma_a = cut(this->scene.sigma_a);
    part.scene.sigma_s = cut(this->scene.sigma_s);
    part.scene.emission = cut(this->scene.emission);
    part.scene.medium.phase = this->scene.medium.phase;
    part.ior = cut(this->ior);
    part.g = cut(this->g);
    return part;
  }

  Scene scene;
  std::vector<float> ior, g;
};

std::vector<float> RandomValues(std::size_t count, double least, double most, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(least, most);
  std::vector<float> values(count);
  std::generate(values.begin(), values.end(), [&] { return static_cast<float>(value(random)); });
  return values;
}

/// With all that shines, thick voxels beside thin ones, faces that give back light, and an index that varies.
LatticeMedium Everything(std::array<int, 3> size)
{
  LatticeMedium medium(size);
  Scene& scene = medium.scene;
  scene.Randomise(4.0, 2.0, 0.9, 11);
  scene.emission = RandomValues(scene.sigma_s.size(), 0.0, 0.2, 3);
  scene.ShineAlong({ 0.3, -0.5, -0.9 });
  scene.ShineAlong({ -0.6, 0.2, 0.1 }, 0.4);
  scene.ShineFromEverywhere(0.1);
  for (std::size_t face = 0; face < 6; ++face)
  {
    const double of = 0.1 * static_cast<double>(face);
    scene.light.faces[face] = { of, of, of };
    scene.light.faceAlbedo[face] = { of, of, of };
  }
  medium.ior = RandomValues(scene.sigma_s.size(), 1.0, 1.6, 5);
  return medium;
}

LatticeSettings SettingsOf(double tolerance = 1e-4)
{
  LatticeSettings settings;
  settings.tolerance = tolerance;
  settings.netFlux = true;
  return settings;
}

/// Cut by planes across x at these voxels; 0 before and the end behind them.
BlockPartition Slices(const Grid& grid, std::vector<int> cuts)
{
  BlockPartition partition = { grid, {} };
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
BlockPartition SingleVoxels(const Grid& grid)
{
  BlockPartition partition = { grid, {} };
  for (std::size_t voxel = 0; voxel < grid.VoxelCount(); ++voxel)
  {
    partition.blocks.push_back({ grid.VoxelAt(voxel), { 1, 1, 1 } });
  }
  return partition;
}
}

class LatticeBlocks : public LatticeTest
{
protected:
  LightField Whole(LatticeMedium& medium, const LatticeSettings& settings)
  {
    medium.Attach();
    return this->Solve(medium.scene, settings, medium.ior);
  }

  /// Arrays of the blocks put together; all else of the first rank that comes, which must be that of all.
  LightField OfBlocks(const BlockPartition& partition, const LatticeMedium& medium, const LatticeSettings& settings)
  {
    LightField all;
    std::mutex guard;
    RunInThreads(static_cast<int>(partition.blocks.size()), [&](Communicator& communicator) {
      const VoxelBox& block = partition.blocks[communicator.Rank()];
      LatticeMedium part = medium.Part(block);
      part.Attach();
      const LightField light = SolveLatticeInBlocks(
        this->GetDevice(), communicator, partition, part.scene.medium, part.Index(), part.scene.light, settings);
      const std::lock_guard<std::mutex> lock(guard);
      const std::size_t channels = static_cast<std::size_t>(light.channels);
      if (all.convergence.empty())
      {
        all = light;
        all.fluence.assign(channels * partition.whole.VoxelCount(), 0.0f);
        all.fluenceDirect = all.fluence;
        all.netFlux.assign(3 * all.fluence.size(), 0.0f);
      }
      EXPECT_EQ(light.facePowerOut, all.facePowerOut);
      EXPECT_EQ(light.balance.absorbed, all.balance.absorbed);
      EXPECT_EQ(light.convergence.size(), all.convergence.size());
      Grid own;
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
      put(light.netFlux, all.netFlux, 3 * channels);
    });
    return all;
  }

  LightField OnRanks(int ranks, const LatticeMedium& medium, const LatticeSettings& settings)
  {
    return this->OfBlocks(BlockPartition::Even(medium.scene.medium.grid, ranks), medium, settings);
  }

  static void ExpectSame(const LightField& found, const LightField& expected, double tolerance)
  {
    EXPECT_LT(RelativeDifference(found.fluence, expected.fluence), tolerance);
    EXPECT_LT(RelativeDifference(found.fluenceDirect, expected.fluenceDirect), 1e-6);
    EXPECT_LT(RelativeDifference(found.netFlux, expected.netFlux), 2.0 * tolerance);
    EXPECT_TRUE(found.converged);
    for (std::size_t c = 0; c < static_cast<std::size_t>(expected.channels); ++c)
    {
      const double all = expected.balance.entered[c] + expected.balance.emitted[c];
      EXPECT_NEAR(found.balance.entered[c], expected.balance.entered[c], 1e-6 * all);
      EXPECT_NEAR(found.balance.emitted[c], expected.balance.emitted[c], 1e-6 * all);
      EXPECT_NEAR(found.balance.absorbed[c], expected.balance.absorbed[c], tolerance * all);
      EXPECT_LT(std::abs(found.balance.leftOver[c]), 1e-5 * all);
      for (std::size_t face = 0; face < 6; ++face)
      {
        EXPECT_NEAR(found.facePowerOut[face][c], expected.facePowerOut[face][c], tolerance * all);
      }
    }
  }

  /// The errors of three ranks, of which one is given something else than the others.
  std::vector<std::string> Errors(
    const std::function<void(int rank, LatticeMedium&, LatticeSettings&, Monitor&)>& change,
    const BlockPartition* blocks = nullptr)
  {
    const LatticeMedium medium = Everything({ 6, 5, 4 });
    const BlockPartition partition = blocks ? *blocks : BlockPartition::Even(medium.scene.medium.grid, 3);
    std::vector<std::string> errors(partition.blocks.size());
    RunInThreads(static_cast<int>(errors.size()), [&](Communicator& communicator) {
      const int rank = communicator.Rank();
      LatticeMedium part = medium.Part(partition.blocks[rank]);
      part.Attach();
      LatticeSettings settings = SettingsOf();
      Monitor monitor;
      change(rank, part, settings, monitor);
      try
      {
        SolveLatticeInBlocks(this->GetDevice(), communicator, partition, part.scene.medium, part.Index(),
          part.scene.light, settings, monitor);
      }
      catch (const std::exception& error)
      {
        errors[rank] = error.what();
      }
    });
    return errors;
  }

  void ExpectErrors(
    const std::string& words, const std::function<void(int rank, LatticeMedium&, LatticeSettings&, Monitor&)>& change)
  {
    const std::vector<std::string> errors = this->Errors(change);
    for (const std::string& error : errors)
    {
      EXPECT_NE(error.find(words), std::string::npos) << error;
      EXPECT_EQ(error, errors.front());
    }
  }
};

TEST_F(LatticeBlocks, HaveTheLightOfTheWhole)
{
  LatticeMedium medium = Everything({ 12, 9, 7 });
  for (const int directions : { 18, 6 })
  {
    SCOPED_TRACE(std::to_string(directions) + " directions");
    LatticeSettings settings = SettingsOf(1e-7);
    settings.directions = directions;
    ExpectSame(this->OnRanks(3, medium, settings), this->Whole(medium, settings), 2e-6);
  }
}

/// Whatever the tolerance: all ranks do the same steps.
TEST_F(LatticeBlocks, HaveTheLightOfOneRankOnAnyNumber)
{
  const LatticeMedium medium = Everything({ 12, 9, 7 });
  const LightField alone = this->OnRanks(1, medium, SettingsOf());
  for (const int ranks : { 2, 3, 4, 8 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    const LightField light = this->OnRanks(ranks, medium, SettingsOf());
    ExpectSame(light, alone, 1e-6);
    EXPECT_EQ(light.convergence.size(), alone.convergence.size());
  }
}

TEST_F(LatticeBlocks, MayBeUnevenEmptyOrSingleVoxels)
{
  const LatticeMedium medium = Everything({ 9, 4, 5 });
  const Grid& grid = medium.scene.medium.grid;
  const LightField alone = this->OnRanks(1, medium, SettingsOf());
  ExpectSame(this->OfBlocks(Slices(grid, { 1, 1, 2, 8 }), medium, SettingsOf()), alone, 1e-6);
  ExpectSame(this->OfBlocks(Slices(grid, { 0, 9 }), medium, SettingsOf()), alone, 1e-6);
  // About a middle one, such that no plane cuts the grid through.
  const BlockPartition wheel = { Grid{ { 3, 3, 2 } },
    { { { 0, 0, 0 }, { 2, 1, 2 } }, { { 2, 0, 0 }, { 1, 2, 2 } }, { { 1, 2, 0 }, { 2, 1, 2 } },
      { { 0, 1, 0 }, { 1, 2, 2 } }, { { 1, 1, 0 }, { 1, 1, 2 } } } };
  const LatticeMedium turning = Everything(wheel.whole.size);
  ExpectSame(this->OfBlocks(wheel, turning, SettingsOf()), this->OnRanks(1, turning, SettingsOf()), 1e-6);
  const LatticeMedium small = Everything({ 3, 2, 2 });
  ExpectSame(this->OfBlocks(SingleVoxels(small.scene.medium.grid), small, SettingsOf()),
    this->OnRanks(1, small, SettingsOf()), 1e-6);
}

TEST_F(LatticeBlocks, HaveTheColoursAndTheAnisotropyOfTheWhole)
{
  LatticeMedium medium = Everything({ 8, 7, 6 });
  Scene& scene = medium.scene;
  scene.sigma_s = RandomValues(3 * scene.sigma_a.size(), 0.0, 2.0, 9);
  scene.light.lights[0].power = { 1.0, 0.0, 3.0 };
  medium.g = RandomValues(scene.sigma_a.size(), -0.7, 0.7, 13);
  const LatticeSettings settings = SettingsOf(1e-7);
  const LightField whole = this->Whole(medium, settings);
  ASSERT_EQ(whole.channels, 3);
  ExpectSame(this->OnRanks(4, medium, settings), whole, 2e-6);
}

/// Thin voxels, of which first moments do not matter, under an environment with a peak.
TEST_F(LatticeBlocks, HaveTheEnvironmentOfTheWhole)
{
  LatticeMedium medium({ 10, 9, 8 });
  Scene& scene = medium.scene;
  scene.Randomise(0.09, 1.0, 0.99, 4);
  Environment& environment = scene.light.environment;
  environment.width = 16;
  environment.height = 8;
  environment.radiance = RandomValues(3 * 16 * 8, 0.1, 0.3, 2);
  environment.radiance[3 * 37] = 90.0f;
  const LatticeSettings settings = SettingsOf(1e-7);
  ExpectSame(this->OnRanks(4, medium, settings), this->Whole(medium, settings), 2e-6);
}

/// Flat grids have long cells.
TEST_F(LatticeBlocks, SolvePlanesAndRows)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 12, 9, 1 }, { 1, 17, 1 }, { 1, 1, 1 } })
  {
    SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]));
    LatticeMedium medium = Everything(size);
    ExpectSame(this->OnRanks(3, medium, SettingsOf(1e-7)), this->Whole(medium, SettingsOf(1e-7)), 2e-6);
  }
}

/// White, up to a hundred mean free paths a voxel: what diffusion on one rank's cells saves.
TEST_F(LatticeBlocks, NeedFewIterationsWhateverTheThickness)
{
  for (const double thickest : { 1e-2, 1.0, 1e2 })
  {
    SCOPED_TRACE(std::to_string(thickest));
    LatticeMedium medium({ 24, 22, 20 });
    medium.scene.Randomise(thickest, 1.0, 1.0, 5);
    medium.scene.ShineFromEverywhere(0.3);
    medium.scene.ShineAlong({ 0.3, -0.2, -0.9 });
    const LightField whole = this->Whole(medium, SettingsOf());
    const LightField light = this->OnRanks(2, medium, SettingsOf());
    std::printf("thickness %g: %zu iterations by blocks, %zu of the whole\n", thickest, light.convergence.size(),
      whole.convergence.size());
    EXPECT_LE(light.convergence.size(), whole.convergence.size() + 4);
    ExpectSame(light, whole, 5e-4);
  }
}

TEST_F(LatticeBlocks, AreDarkWhereNothingShines)
{
  LatticeMedium medium({ 4, 3, 2 });
  medium.scene.Randomise(1.0, 1.0, 0.9);
  const LightField light = this->OnRanks(3, medium, SettingsOf());
  EXPECT_EQ(*std::max_element(light.fluence.begin(), light.fluence.end()), 0.0f);
}

/// Whatever goes wrong on one rank is one error on each, and none waits for the others.
TEST_F(LatticeBlocks, FailTogether)
{
  ExpectErrors("sigma_a", [](int rank, LatticeMedium& part, LatticeSettings&, Monitor&) {
    part.scene.sigma_a[0] = rank == 1 ? -1.0f : part.scene.sigma_a[0];
  });
  ExpectErrors("disagree about settings",
    [](int rank, LatticeMedium&, LatticeSettings& settings, Monitor&) { settings.directions = rank == 2 ? 6 : 18; });
  ExpectErrors("disagree about whether there is a refractive index",
    [](int rank, LatticeMedium& part, LatticeSettings&, Monitor&) {
      if (rank == 1)
      {
        part.ior.clear();
      }
    });
  ExpectErrors("aborted", [](int rank, LatticeMedium&, LatticeSettings&, Monitor& monitor) {
    if (rank == 1)
    {
      monitor = [](double done) { return done < 0.2; };
    }
  });
}

TEST_F(LatticeBlocks, SayWhatIsNotCarriedFromRankToRank)
{
  ExpectErrors(
    "periodic", [](int, LatticeMedium&, LatticeSettings& settings, Monitor&) { settings.periodic[1] = true; });
  ExpectErrors("point, spot or rectangle",
    [](int, LatticeMedium& part, LatticeSettings&, Monitor&) { part.scene.light.lights[0].type = LightType::Point; });
  ExpectErrors(
    "MaximumOrders", [](int, LatticeMedium&, LatticeSettings& settings, Monitor&) { settings.maximumSteps = 3; });
  ExpectErrors("BlockSize", [](int, LatticeMedium&, LatticeSettings& settings, Monitor&) { settings.blockSize = 4; });
  ExpectErrors("published Scheme",
    [](int, LatticeMedium&, LatticeSettings& settings, Monitor&) { settings.scheme = LatticeScheme::Published; });
  ExpectErrors("all give back all", [](int, LatticeMedium& part, LatticeSettings&, Monitor&) {
    part.scene.light.faceAlbedo.fill({ 1.0, 1.0, 1.0 });
  });
}
