// The light of a lattice on several ranks is that of one rank.

#include "LatticeScene.h"
#include "MediumInBlocks.h"

#include "Device/Errors.h"
#include "LatticeBoltzmann/LatticeLight.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace tyndall;

namespace
{
/// All kinds of diffuse light and suns, thick voxels beside thin ones, reflecting faces, and an index that varies.
MediumToCut Everything(std::array<int, 3> size)
{
  MediumToCut medium(size);
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

void AddEnvironment(Scene& scene, int width, int height, std::size_t peak)
{
  Environment& environment = scene.light.environment;
  environment.width = width;
  environment.height = height;
  environment.radiance = RandomValues(3 * static_cast<std::size_t>(width * height), 0.1, 0.3, 2);
  environment.radiance[3 * peak] = 90.0f;
}

/// Of which a difference of 1e-7 of the light is left.
LatticeSettings Tight(std::array<bool, 3> periodic = {})
{
  LatticeSettings settings;
  settings.tolerance = 1e-7;
  settings.netFlux = true;
  settings.periodic = periodic;
  return settings;
}

/// Any places and directions, of one colour.
std::vector<Photon> AnyPhotons(std::size_t count)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0.5, 4.5);
  std::vector<Photon> photons(count);
  for (Photon& photon : photons)
  {
    photon.position = { place(random), place(random), place(random) };
    const glm::dvec3 along = glm::normalize(glm::dvec3(place(random) - 2.5, place(random) - 2.5, place(random) - 2.5));
    photon.direction = { static_cast<float>(along.x), static_cast<float>(along.y), static_cast<float>(along.z) };
    photon.power = { 0.01f, 0.02f, 0.03f };
  }
  return photons;
}

void RemoveReflection(MediumToCut& medium, const std::array<bool, 3>& periodic)
{
  for (std::size_t face = 0; face < 6; ++face)
  {
    medium.scene.light.faceAlbedo[face] = periodic[face / 2] ? Rgb{} : medium.scene.light.faceAlbedo[face];
  }
}
}

class LatticeOverRanks : public LatticeTest
{
protected:
  using Change = std::function<void(int rank, MediumToCut&, LatticeSettings&, Monitor&)>;

  LightField OnOneRank(MediumToCut& medium, const LatticeSettings& settings)
  {
    medium.Attach();
    return this->Solve(medium.scene, settings, medium.ior);
  }

  LightField OnRanks(const BlockPartition& partition, const MediumToCut& medium, const LatticeSettings& settings,
    const std::vector<Photon>* photons = nullptr)
  {
    return LightOfBlocks(partition, medium, [&](Communicator& communicator, MediumToCut& part) {
      const Domain domain(communicator, partition);
      if (!photons)
      {
        return SolveLatticeBoltzmann(
          this->GetDevice(), domain, part.scene.medium, part.Index(), part.scene.light, settings);
      }
      const auto from = [&](int rank) {
        return photons->begin() + static_cast<std::ptrdiff_t>(photons->size() * rank / partition.blocks.size());
      };
      return SolveLatticeBoltzmann(this->GetDevice(), domain, part.scene.medium, part.Index(),
        { from(domain.Rank()), from(domain.Rank() + 1) }, part.scene.light, settings);
    });
  }

  /// On one rank and on each of these partitions; without any on three ranks.
  void ExpectLightOfOneRank(MediumToCut& medium, const LatticeSettings& settings,
    std::vector<BlockPartition> partitions = {}, double tolerance = 2e-6)
  {
    const Grid& grid = medium.scene.medium.grid;
    const LightField expected = this->OnOneRank(medium, settings);
    partitions = partitions.empty() ? std::vector<BlockPartition>{ BlockPartition::Even(grid, 3) } : partitions;
    for (const BlockPartition& partition : partitions)
    {
      SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
      ExpectSame(this->OnRanks(partition, medium, settings), expected, tolerance);
    }
  }

  static void ExpectSame(const LightField& found, const LightField& expected, double tolerance)
  {
    ExpectSameLight(found, expected, tolerance);
    EXPECT_TRUE(found.converged);
    EXPECT_LT(found.balance.RelativeError(expected.channels), 1e-5);
    for (std::size_t c = 0; c < static_cast<std::size_t>(expected.channels); ++c)
    {
      const double all = expected.balance.entered[c] + expected.balance.emitted[c];
      EXPECT_LT(std::abs(found.balance.leftOver[c]), 1e-5 * all);
    }
  }

  /// Three ranks, of which some are given other things, all report this error.
  void ExpectErrors(const std::string& words, const Change& change)
  {
    const MediumToCut medium = Everything({ 6, 5, 4 });
    const BlockPartition partition = BlockPartition::Even(medium.scene.medium.grid, 3);
    std::vector<std::string> errors(3);
    RunInThreads(3, [&](Communicator& communicator) {
      const int rank = communicator.Rank();
      MediumToCut part = medium.Part(partition.blocks[rank]);
      part.Attach();
      LatticeSettings settings = Tight();
      Monitor monitor;
      change(rank, part, settings, monitor);
      try
      {
        SolveLatticeBoltzmann(this->GetDevice(), Domain(communicator, partition), part.scene.medium, part.Index(),
          part.scene.light, settings, monitor);
      }
      catch (const std::exception& error)
      {
        errors[rank] = error.what();
      }
    });
    for (const std::string& error : errors)
    {
      EXPECT_NE(error.find(words), std::string::npos) << error;
      EXPECT_EQ(error, errors.front());
    }
  }
};

TEST_F(LatticeOverRanks, IsThatOfOneRank)
{
  for (const int directions : { 18, 6 })
  {
    SCOPED_TRACE(std::to_string(directions) + " directions");
    MediumToCut medium = Everything({ 12, 9, 7 });
    LatticeSettings settings = Tight();
    settings.directions = directions;
    ExpectLightOfOneRank(medium, settings);
  }
}

TEST_F(LatticeOverRanks, MayHaveUnevenEmptyOrSingleVoxelBlocks)
{
  MediumToCut medium = Everything({ 9, 4, 5 });
  const Grid& grid = medium.scene.medium.grid;
  ExpectLightOfOneRank(medium, Tight(), { Slices(grid, { 1, 1, 2, 8 }), Slices(grid, { 0, 9 }) });
  // Four blocks about a fifth, so that no plane separates them.
  const BlockPartition wheel = { Grid{ { 3, 3, 2 } },
    { { { 0, 0, 0 }, { 2, 1, 2 } }, { { 2, 0, 0 }, { 1, 2, 2 } }, { { 1, 2, 0 }, { 2, 1, 2 } },
      { { 0, 1, 0 }, { 1, 2, 2 } }, { { 1, 1, 0 }, { 1, 1, 2 } } } };
  MediumToCut turning = Everything(wheel.whole.size);
  ExpectLightOfOneRank(turning, Tight(), { wheel });
  MediumToCut small = Everything({ 3, 2, 2 });
  ExpectLightOfOneRank(small, Tight(), { SingleVoxels(small.scene.medium.grid) });
}

TEST_F(LatticeOverRanks, HasColoursAndAnisotropy)
{
  MediumToCut medium = Everything({ 8, 7, 6 });
  Scene& scene = medium.scene;
  scene.sigma_s = RandomValues(3 * scene.sigma_a.size(), 0.0, 2.0, 9);
  scene.light.lights[0].power = { 1.0, 0.0, 3.0 };
  medium.g = RandomValues(scene.sigma_a.size(), -0.7, 0.7, 13);
  ASSERT_EQ(this->OnOneRank(medium, Tight()).channels, 3);
  ExpectLightOfOneRank(medium, Tight());
}

/// Thin voxels, whose first moments do not matter, under an environment with a peak.
TEST_F(LatticeOverRanks, HasAnEnvironment)
{
  MediumToCut medium({ 10, 9, 8 });
  medium.scene.Randomise(0.09, 1.0, 0.99, 4);
  AddEnvironment(medium.scene, 16, 8, 37);
  ExpectLightOfOneRank(medium, Tight());
}

/// Each kind of light alone, and beside each other kind.
TEST_F(LatticeOverRanks, CountsEachLightOnce)
{
  const std::vector<std::pair<const char*, std::function<void(MediumToCut&)>>> kinds = {
    { "sky", [](MediumToCut& medium) { medium.scene.ShineFromEverywhere(0.2); } },
    { "environment", [](MediumToCut& medium) { AddEnvironment(medium.scene, 8, 4, 21); } },
    { "faces",
      [](MediumToCut& medium) {
        medium.scene.light.faces[1] = { 0.7, 0.7, 0.7 };
        medium.scene.light.faces[4] = { 0.3, 0.3, 0.3 };
      } },
    { "sun",
      [](MediumToCut& medium) {
        medium.scene.ShineAlong({ 0.3, -0.5, -0.9 });
      } },
    { "lamps", [](MediumToCut& medium) { AddNearLamps(medium.scene); } },
    { "emission",
      [](MediumToCut& medium) { medium.scene.emission = RandomValues(medium.scene.sigma_s.size(), 0.0, 0.2, 3); } },
    { "uncollided light",
      [](MediumToCut& medium) {
        medium.given = RandomValues(medium.scene.sigma_s.size(), 0.1, 2.0, 7);
        medium.ways = RandomValues(3 * medium.scene.sigma_s.size(), -0.57, 0.57, 8);
        medium.scene.light.uncollided.escaped[3].fill(5.0);
      } },
  };
  for (std::size_t first = 0; first < kinds.size(); ++first)
  {
    for (std::size_t second = first; second < kinds.size(); ++second)
    {
      SCOPED_TRACE(std::string(kinds[first].first) + " and " + kinds[second].first);
      MediumToCut medium({ 5, 4, 6 });
      medium.scene.Randomise(2.0, 2.0, 0.8, 17);
      kinds[first].second(medium);
      if (second != first)
      {
        kinds[second].second(medium);
      }
      ExpectLightOfOneRank(medium, Tight());
    }
  }
}

/// Points, spots and rectangles, in thick voxels, too, and in units in which a float holds no area.
TEST_F(LatticeOverRanks, HasNearLamps)
{
  for (const double spacing : { 1.0, 1e8 })
  {
    SCOPED_TRACE(std::to_string(spacing));
    MediumToCut medium = Everything({ 7, 11, 6 });
    Scene& scene = medium.scene;
    scene.medium.grid.spacing.fill(spacing);
    scene.medium.grid.origin = { -2.0 * spacing, 3.0 * spacing, 0.5 * spacing };
    AddNearLamps(scene);
    for (std::vector<float>* perLength : { &scene.sigma_a, &scene.sigma_s, &scene.emission })
    {
      std::for_each(
        perLength->begin(), perLength->end(), [&](float& value) { value = static_cast<float>(value / spacing); });
    }
    ExpectLightOfOneRank(medium, Tight(), { Slices(scene.medium.grid, { 1, 1, 2 }) });
  }
  MediumToCut coloured = Everything({ 2, 3, 3 });
  Scene& scene = coloured.scene;
  scene.sigma_s = RandomValues(3 * scene.sigma_a.size(), 0.0, 2.0, 9);
  scene.light.lights.clear();
  AddNearLamps(scene);
  scene.light.lights[0].power = { 1.0, 0.0, 3.0 };
  ExpectLightOfOneRank(coloured, Tight(), { SingleVoxels(scene.medium.grid) });
}

/// Lines close, or pass through blocks several times; the more so where edges have a common divisor.
TEST_F(LatticeOverRanks, WrapsAroundPeriodicAxes)
{
  const std::array<bool, 3> some[] = { { true, false, false }, { false, true, true }, { true, true, true } };
  for (const std::array<bool, 3>& periodic : some)
  {
    SCOPED_TRACE(std::to_string(periodic[0]) + std::to_string(periodic[1]) + std::to_string(periodic[2]));
    MediumToCut medium = Everything({ 6, 3, 4 });
    RemoveReflection(medium, periodic);
    const Grid& grid = medium.scene.medium.grid;
    ExpectLightOfOneRank(medium, Tight(periodic),
      { BlockPartition::Even(grid, 3), BlockPartition::Even(grid, 8), Slices(grid, { 1, 1, 4 }) });
  }
  MediumToCut lit = Everything({ 5, 3, 4 });
  AddNearLamps(lit.scene);
  lit.scene.light.faceAlbedo = {};
  ExpectLightOfOneRank(lit, Tight({ true, false, true }));
}

/// An axis of one voxel, which is its own neighbour, or of two, which touch at both faces.
TEST_F(LatticeOverRanks, WrapsAroundShortAxes)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 1, 1, 7 }, { 2, 3, 1 }, { 1, 1, 1 } })
  {
    SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]));
    MediumToCut medium = Everything(size);
    medium.scene.light.faceAlbedo = {};
    const Grid& grid = medium.scene.medium.grid;
    ExpectLightOfOneRank(medium, Tight({ true, true, false }), { BlockPartition::Even(grid, 2), SingleVoxels(grid) });
  }
}

/// Flat grids have long cells.
TEST_F(LatticeOverRanks, SolvesPlanesAndRows)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 12, 9, 1 }, { 1, 17, 1 }, { 1, 1, 1 } })
  {
    SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]));
    MediumToCut medium = Everything(size);
    ExpectLightOfOneRank(medium, Tight());
  }
}

/// With mean directions, from which it is estimated where in a voxel light is first scattered.
TEST_F(LatticeOverRanks, TakesUncollidedLight)
{
  for (const bool colour : { false, true })
  {
    SCOPED_TRACE(colour);
    MediumToCut medium = Everything({ 7, 5, 6 });
    GiveLight(medium, colour);
    RemoveReflection(medium, { false, true, false });
    const Grid& grid = medium.scene.medium.grid;
    ExpectLightOfOneRank(
      medium, Tight({ false, colour, false }), { BlockPartition::Even(grid, 3), Slices(grid, { 0, 1, 1 }) });
  }
}

/// Photons on bent paths, a share of them on each rank, beside emission.
TEST_F(LatticeOverRanks, TakesPhotons)
{
  MediumToCut medium = Everything({ 8, 7, 5 });
  medium.scene.light.lights.clear();
  medium.Attach();
  const Grid& grid = medium.scene.medium.grid;
  std::vector<Photon> photons = AnyPhotons(300);
  const LightField expected = SolveLatticeBoltzmann(
    this->GetDevice(), Domain(grid), medium.scene.medium, medium.Index(), photons, medium.scene.light, Tight());
  for (const BlockPartition& partition : { BlockPartition::Even(grid, 3), Slices(grid, { 0, 1 }) })
  {
    SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
    ExpectSame(this->OnRanks(partition, medium, Tight(), &photons), expected, 2e-6);
  }
  photons[1].position = photons[4].position = { -9.0, 0.0, 0.0 };
  photons[1].direction = photons[4].direction = { -1.0f, 0.0f, 0.0f };
  const LightField missed = this->OnRanks(BlockPartition::Even(grid, 3), medium, Tight(), &photons);
  EXPECT_TRUE(Says(missed.doubts, "2 of 300 photons do not meet the medium"));
}

/// Between perfect mirrors the medium absorbs all light in the end; if it absorbs none, that is an error.
TEST_F(LatticeOverRanks, MayBeBetweenPerfectMirrors)
{
  MediumToCut medium = Everything({ 5, 6, 4 });
  medium.scene.light.faceAlbedo.fill({ 1.0, 1.0, 1.0 });
  ExpectLightOfOneRank(medium, Tight());
  ExpectErrors("grow without end", [](int, MediumToCut& part, LatticeSettings&, Monitor&) {
    part.scene.light.faceAlbedo.fill({ 1.0, 1.0, 1.0 });
    std::fill(part.scene.sigma_a.begin(), part.scene.sigma_a.end(), 0.0f);
  });
}

/// Rows of voxels along periodic axes are empty, as clear air above a cloud is, or a hole through it. Of what is first
/// scattered near a thick voxel's face a part begins in such a row, and some rows emit.
TEST_F(LatticeOverRanks, LightsRowsThatAreEmptyAlongPeriodicAxes)
{
  const auto clearAir = [](const std::array<int, 3>& at) { return at[2] >= 5; };
  const auto hole = [](const std::array<int, 3>& at) { return at[0] == 1 && at[1] == 2; };
  const auto diagonal = [](const std::array<int, 3>& at) { return (at[0] + at[2]) % 2 == 0; };
  const std::vector<std::pair<std::array<bool, 3>, std::function<bool(const std::array<int, 3>&)>>> cases = {
    { { true, false, false }, clearAir }, { { true, true, false }, clearAir }, { { false, false, true }, hole },
    { { false, true, true }, hole }, { { true, false, true }, diagonal }
  };
  for (std::size_t i = 0; i < cases.size(); ++i)
  {
    SCOPED_TRACE(i);
    MediumToCut medium({ 4, 5, 6 });
    Scene& scene = medium.scene;
    scene.Randomise(4.0, 1.0, 0.9, 23);
    scene.emission = RandomValues(scene.sigma_a.size(), 0.0, 0.2, 3);
    scene.ShineAlong({ 0.3, -0.5, -0.9 });
    AddNearLamps(scene);
    for (std::size_t voxel = 0; voxel < scene.sigma_a.size(); ++voxel)
    {
      if (cases[i].second(scene.medium.grid.VoxelAt(voxel)))
      {
        scene.sigma_a[voxel] = scene.sigma_s[voxel] = 0.0f;
      }
    }
    ExpectLightOfOneRank(medium, Tight(cases[i].first));
    const LightField steady = this->OnOneRank(medium, Tight(cases[i].first));
    const double all = steady.balance.entered[0] + steady.balance.emitted[0];
    EXPECT_LT(std::abs(steady.balance.leftOver[0]), 2e-6 * all);
    LatticeSettings steps = Tight(cases[i].first);
    steps.tolerance = 1e-5;
    steps.solvesSteady = false;
    ExpectSameLight(this->OnOneRank(medium, steps), steady, 3e-4);
    steps.blockSize = 3;
    ExpectSameLight(this->OnOneRank(medium, steps), steady, 3e-4);
  }
}

/// White, up to a hundred mean free paths a voxel: diffusion on the first rank's cells preconditions it.
TEST_F(LatticeOverRanks, NeedsFewIterationsWhateverTheThickness)
{
  for (const double thickest : { 1e-2, 1.0, 1e2 })
  {
    SCOPED_TRACE(std::to_string(thickest));
    MediumToCut medium({ 24, 22, 20 });
    medium.scene.Randomise(thickest, 1.0, 1.0, 5);
    medium.scene.ShineFromEverywhere(0.3);
    medium.scene.ShineAlong({ 0.3, -0.2, -0.9 });
    LatticeSettings settings;
    settings.netFlux = true;
    const LightField expected = this->OnOneRank(medium, settings);
    const LightField light = this->OnRanks(BlockPartition::Even(medium.scene.medium.grid, 2), medium, settings);
    EXPECT_LE(light.convergence.size(), expected.convergence.size() + 4);
    ExpectSame(light, expected, 5e-4);
  }
}

TEST_F(LatticeOverRanks, IsDarkWithoutSources)
{
  MediumToCut medium({ 4, 3, 2 });
  medium.scene.Randomise(1.0, 1.0, 0.9);
  const LightField light = this->OnRanks(BlockPartition::Even(medium.scene.medium.grid, 3), medium, Tight());
  EXPECT_EQ(*std::max_element(light.fluence.begin(), light.fluence.end()), 0.0f);
}

/// The error names the setting.
TEST_F(LatticeOverRanks, TakesNoSteps)
{
  const std::vector<std::pair<std::string, std::function<void(LatticeSettings&)>>> cases = {
    { "the scheme as published", [](LatticeSettings& settings) { settings.scheme = LatticeScheme::Published; } },
    { "BlockSize", [](LatticeSettings& settings) { settings.blockSize = 4; } },
    { "Interleaved", [](LatticeSettings& settings) { settings.interleaves = true; } },
    { "MaximumOrders", [](LatticeSettings& settings) { settings.maximumSteps = 20; } },
  };
  for (const auto& of : cases)
  {
    ExpectErrors("not solved with " + of.first,
      [&](int, MediumToCut&, LatticeSettings& settings, Monitor&) { of.second(settings); });
  }
}

/// Whatever fails on one rank is one error on each, and no rank waits for another.
TEST_F(LatticeOverRanks, FailsTogether)
{
  ExpectErrors("sigma_a", [](int rank, MediumToCut& part, LatticeSettings&, Monitor&) {
    part.scene.sigma_a[0] = rank == 1 ? -1.0f : part.scene.sigma_a[0];
  });
  ExpectErrors("disagree about settings",
    [](int rank, MediumToCut&, LatticeSettings& settings, Monitor&) { settings.directions = rank == 2 ? 6 : 18; });
  ExpectErrors(
    "disagree about whether there is a refractive index", [](int rank, MediumToCut& part, LatticeSettings&, Monitor&) {
      if (rank == 1)
      {
        part.ior.clear();
      }
    });
  static const std::vector<float> given(6 * 5 * 4, 1.0f);
  ExpectErrors("UncollidedLight", [](int rank, MediumToCut& part, LatticeSettings&, Monitor&) {
    part.scene.light.uncollided.fluence = { rank == 1 ? given.data() : nullptr, 1 };
  });
  ExpectErrors("aborted", [](int rank, MediumToCut&, LatticeSettings&, Monitor& monitor) {
    if (rank == 1)
    {
      monitor = [](double done) { return done < 0.2; };
    }
  });
  ExpectErrors("without end", [](int, MediumToCut& part, LatticeSettings& settings, Monitor&) {
    settings.periodic = { true, true, true };
    part.scene.light.faceAlbedo = {};
    std::fill(part.scene.sigma_a.begin(), part.scene.sigma_a.end(), 0.0f);
  });
}

/// Power that was deposited nowhere is in the balance, whichever rank lost it.
TEST_F(LatticeOverRanks, RefusesLightThatDoesNotBalance)
{
  const MediumToCut medium = Everything({ 6, 5, 4 });
  const auto judge = [&](int ranks, double lost) {
    const BlockPartition partition = BlockPartition::Even(medium.scene.medium.grid, ranks);
    std::vector<std::string> words(partition.blocks.size());
    RunInThreads(ranks, [&](Communicator& communicator) {
      const Domain domain(communicator, partition);
      MediumToCut part = medium.Part(domain.Own());
      part.Attach();
      const LatticeSettings settings = Tight();
      const LatticeProblem problem(domain, part.scene.medium, part.Index(), part.scene.light, settings);
      LightField light = BeginLight(problem, settings);
      light.balance.entered[0] = light.balance.escaped[0] = 2.0;
      const Rgb lostHere = { domain.Rank() == ranks - 1 ? lost * ranks : 0.0, 0.0, 0.0 };
      try
      {
        FinishLight(light, this->GetDevice(), problem, part.scene.light, settings, 1.0, lostHere);
        words[domain.Rank()] = light.doubts.empty() ? "" : light.doubts.front();
      }
      catch (const InvalidInput& error)
      {
        words[domain.Rank()] = error.what();
      }
    });
    return words;
  };
  for (const int ranks : { 1, 3 })
  {
    for (const std::string& word : judge(ranks, 0.5))
    {
      EXPECT_EQ(word.find("The light does not balance: 0.2 of the power is lost or made"), 0u) << word;
    }
    for (const std::string& word : judge(ranks, 0.002))
    {
      EXPECT_EQ(word.find("The energy balance is off: 0.001 of the power is lost or made"), 0u) << word;
    }
  }
}
