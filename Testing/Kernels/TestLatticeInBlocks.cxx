// The steady light of a lattice in a medium that is spread over ranks, against that of one rank and of the whole.

#include "LatticeInBlocks.h"

#include "Device/Errors.h"
#include "LatticeBoltzmann/Distributed/LatticeSceneInBlocks.h"
#include "LatticeBoltzmann/LatticeLight.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

using namespace tyndall;
using namespace lattice_in_blocks;

TEST_F(LatticeBlocks, HaveTheLightOfTheWhole)
{
  MediumToCut medium = Everything({ 12, 9, 7 });
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
  const MediumToCut medium = Everything({ 12, 9, 7 });
  const LightField alone = this->OnRanks(1, medium, SettingsOf());
  for (const int ranks : { 3, 8 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    const LightField light = this->OnRanks(ranks, medium, SettingsOf());
    ExpectSame(light, alone, 1e-6);
    EXPECT_EQ(light.convergence.size(), alone.convergence.size());
  }
}

TEST_F(LatticeBlocks, MayBeUnevenEmptyOrSingleVoxels)
{
  const MediumToCut medium = Everything({ 9, 4, 5 });
  const Grid& grid = medium.scene.medium.grid;
  const LightField alone = this->OnRanks(1, medium, SettingsOf());
  ExpectSame(this->OfBlocks(Slices(grid, { 1, 1, 2, 8 }), medium, SettingsOf()), alone, 1e-6);
  ExpectSame(this->OfBlocks(Slices(grid, { 0, 9 }), medium, SettingsOf()), alone, 1e-6);
  // About a middle one, such that no plane cuts the grid through.
  const BlockPartition wheel = { Grid{ { 3, 3, 2 } },
    { { { 0, 0, 0 }, { 2, 1, 2 } }, { { 2, 0, 0 }, { 1, 2, 2 } }, { { 1, 2, 0 }, { 2, 1, 2 } },
      { { 0, 1, 0 }, { 1, 2, 2 } }, { { 1, 1, 0 }, { 1, 1, 2 } } } };
  const MediumToCut turning = Everything(wheel.whole.size);
  ExpectSame(this->OfBlocks(wheel, turning, SettingsOf()), this->OnRanks(1, turning, SettingsOf()), 1e-6);
  const MediumToCut small = Everything({ 3, 2, 2 });
  ExpectSame(this->OfBlocks(SingleVoxels(small.scene.medium.grid), small, SettingsOf()),
    this->OnRanks(1, small, SettingsOf()), 1e-6);
}

TEST_F(LatticeBlocks, HaveTheColoursAndTheAnisotropyOfTheWhole)
{
  MediumToCut medium = Everything({ 8, 7, 6 });
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
  MediumToCut medium({ 10, 9, 8 });
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

/// Each kind of light alone, and each beside each other one.
TEST_F(LatticeBlocks, CountEachLightOnce)
{
  const std::vector<std::pair<const char*, std::function<void(MediumToCut&)>>> kinds = {
    { "sky", [](MediumToCut& medium) { medium.scene.ShineFromEverywhere(0.2); } },
    { "environment",
      [](MediumToCut& medium) {
        Environment& environment = medium.scene.light.environment;
        environment.width = 8;
        environment.height = 4;
        environment.radiance = RandomValues(3 * 8 * 4, 0.5, 1.5, 6);
        environment.radiance[3 * 21] = 300.0f; // a peak
      } },
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
      const LightField whole = this->Whole(medium, SettingsOf(1e-7));
      for (const int ranks : { 1, 3 })
      {
        SCOPED_TRACE(std::to_string(ranks) + " ranks");
        ExpectSame(this->OnRanks(ranks, medium, SettingsOf(1e-7)), whole, 2e-6);
      }
    }
  }
}

/// Points, spots and rectangles, in thick voxels, too, and in units in which a float holds no area.
TEST_F(LatticeBlocks, HaveTheNearLampsOfTheWhole)
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
    const LightField whole = this->Whole(medium, SettingsOf(1e-7));
    const LightField slices = this->OfBlocks(Slices(scene.medium.grid, { 1, 1, 2 }), medium, SettingsOf(1e-7));
    ExpectSame(slices, whole, 2e-6);
    for (const int ranks : spacing > 1.0 ? std::vector<int>() : std::vector<int>{ 1, 3, 8 })
    {
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      ExpectSame(this->OnRanks(ranks, medium, SettingsOf(1e-7)), slices, 1e-6);
    }
  }
}

TEST_F(LatticeBlocks, HaveNearLampsOfColourInSingleVoxels)
{
  MediumToCut medium = Everything({ 2, 3, 3 });
  Scene& scene = medium.scene;
  scene.sigma_s = RandomValues(3 * scene.sigma_a.size(), 0.0, 2.0, 9);
  scene.light.lights.clear();
  AddNearLamps(scene);
  scene.light.lights[0].power = { 1.0, 0.0, 3.0 };
  ExpectSame(this->OfBlocks(SingleVoxels(scene.medium.grid), medium, SettingsOf(1e-7)),
    this->Whole(medium, SettingsOf(1e-7)), 2e-6);
}

/// Lines close, or come through blocks again and again; the more so where edges have a common divisor.
TEST_F(LatticeBlocks, HaveTheLightThatGoesRoundPeriodicAxes)
{
  const std::array<bool, 3> some[] = { { true, false, false }, { false, true, true }, { true, true, true } };
  for (const std::array<bool, 3>& periodic : some)
  {
    SCOPED_TRACE(std::to_string(periodic[0]) + std::to_string(periodic[1]) + std::to_string(periodic[2]));
    MediumToCut medium = Everything({ 6, 3, 4 });
    for (std::size_t face = 0; face < 6; ++face)
    {
      medium.scene.light.faceAlbedo[face].fill(periodic[face / 2] ? 0.0 : 0.1 * static_cast<double>(face));
    }
    LatticeSettings settings = SettingsOf(1e-7);
    settings.periodic = periodic;
    const LightField alone = this->OnRanks(1, medium, settings);
    ExpectSame(alone, this->Whole(medium, settings), 2e-6);
    for (const int ranks : { 3, 8 })
    {
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      ExpectSame(this->OnRanks(ranks, medium, settings), alone, 1e-6);
    }
    ExpectSame(this->OfBlocks(Slices(medium.scene.medium.grid, { 1, 1, 4 }), medium, settings), alone, 1e-6);
  }
}

TEST_F(LatticeBlocks, HaveTheNearLampsThatShineRoundPeriodicAxes)
{
  MediumToCut medium = Everything({ 5, 3, 4 });
  AddNearLamps(medium.scene);
  medium.scene.light.faceAlbedo = {};
  LatticeSettings settings = SettingsOf(1e-7);
  settings.periodic = { true, false, true };
  const LightField whole = this->Whole(medium, settings);
  for (const int ranks : { 1, 3 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    ExpectSame(this->OnRanks(ranks, medium, settings), whole, 2e-6);
  }
}

/// Instead of that of lamps, by voxel, with its mean direction, from which it is told where in voxels it is lost.
TEST_F(LatticeBlocks, HaveTheLightThatIsGivenToTheWhole)
{
  for (const bool colour : { false, true })
  {
    SCOPED_TRACE(colour);
    MediumToCut medium = Everything({ 7, 5, 6 });
    GiveLight(medium, colour);
    LatticeSettings settings = SettingsOf(1e-7);
    settings.periodic = { false, colour, false };
    medium.scene.light.faceAlbedo[2] = medium.scene.light.faceAlbedo[3] = {};
    const LightField whole = this->Whole(medium, settings);
    for (const int ranks : { 1, 3, 8 })
    {
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      ExpectSame(this->OnRanks(ranks, medium, settings), whole, 2e-6);
    }
    ExpectSame(this->OfBlocks(Slices(medium.scene.medium.grid, { 0, 1, 1 }), medium, settings), whole, 2e-6);
  }
}

/// Of photons that bend, of which each rank has some, and of what the medium emits.
TEST_F(LatticeBlocks, HaveThePhotonsOfTheWhole)
{
  MediumToCut medium = Everything({ 8, 7, 5 });
  medium.scene.light.lights.clear();
  const Grid& grid = medium.scene.medium.grid;
  const std::vector<Photon> photons = AnyPhotons(300);
  const LightField whole = this->Whole(medium, photons, SettingsOf(1e-7));
  for (const BlockPartition& partition :
    { BlockPartition::Even(grid, 1), BlockPartition::Even(grid, 3), Slices(grid, { 0, 1 }) })
  {
    SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
    ExpectSame(this->OfBlocks(partition, medium, photons, SettingsOf(1e-7)), whole, 2e-6);
  }
}

TEST_F(LatticeBlocks, SayThatPhotonsMissTheMedium)
{
  const MediumToCut medium = Everything({ 4, 3, 2 });
  std::vector<Photon> photons = AnyPhotons(5);
  photons[1].position = photons[4].position = { -9.0, 0.0, 0.0 };
  photons[1].direction = photons[4].direction = { -1.0f, 0.0f, 0.0f };
  const LightField light =
    this->OfBlocks(BlockPartition::Even(medium.scene.medium.grid, 3), medium, photons, SettingsOf());
  EXPECT_TRUE(Says(light.doubts, " photons do not meet the medium"));
}

/// The error names the setting.
TEST_F(LatticeBlocks, TakeNoSteps)
{
  const std::vector<std::pair<const char*, std::function<void(LatticeSettings&)>>> cases = {
    { "the scheme as published", [](LatticeSettings& settings) { settings.scheme = LatticeScheme::Published; } },
    { "BlockSize", [](LatticeSettings& settings) { settings.blockSize = 4; } },
    { "Interleaved", [](LatticeSettings& settings) { settings.interleaves = true; } },
    { "MaximumOrders", [](LatticeSettings& settings) { settings.maximumSteps = 20; } },
  };
  for (const auto& [name, choose] : cases)
  {
    SCOPED_TRACE(name);
    const std::function<void(LatticeSettings&)>& set = choose;
    ExpectErrors(std::string("not solved with ") + name,
      [&set](int, MediumToCut&, LatticeSettings& settings, Monitor&) { set(settings); });
  }
}

/// Between faces that all give back all light the medium takes it in the end; where none does that is an error.
TEST_F(LatticeBlocks, MayBeBetweenFacesThatGiveBackAllLight)
{
  MediumToCut medium = Everything({ 5, 6, 4 });
  medium.scene.light.faceAlbedo.fill({ 1.0, 1.0, 1.0 });
  const LightField whole = this->Whole(medium, SettingsOf(1e-7));
  for (const int ranks : { 1, 3, 8 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    ExpectSame(this->OnRanks(ranks, medium, SettingsOf(1e-7)), whole, 2e-6);
  }
  ExpectErrors("grow without end", [](int, MediumToCut& part, LatticeSettings&, Monitor&) {
    part.scene.light.faceAlbedo.fill({ 1.0, 1.0, 1.0 });
    std::fill(part.scene.sigma_a.begin(), part.scene.sigma_a.end(), 0.0f);
  });
}

/// Round three periodic axes likewise: where nothing absorbs, what is emitted never ends.
TEST_F(LatticeBlocks, RefuseLightThatGoesRoundWithoutEnd)
{
  ExpectErrors("without end", [](int, MediumToCut& part, LatticeSettings& settings, Monitor&) {
    settings.periodic = { true, true, true };
    part.scene.light.faceAlbedo = {};
    std::fill(part.scene.sigma_a.begin(), part.scene.sigma_a.end(), 0.0f);
  });
}

/// Rows of voxels along periodic axes are empty, as clear air above a cloud is, or a hole through it. Of what is first
/// scattered near a thick voxel's face a part begins in such a row, and some rows glow themselves.
TEST_F(LatticeBlocks, LightRowsThatAreEmptyAlongPeriodicAxes)
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
    LatticeSettings settings = SettingsOf(1e-7), steps = SettingsOf(1e-5);
    settings.periodic = steps.periodic = cases[i].first;
    const LightField whole = this->Whole(medium, settings);
    const double all = whole.balance.entered[0] + whole.balance.emitted[0];
    EXPECT_LT(std::abs(whole.balance.leftOver[0]), 2e-6 * all);
    for (const int ranks : { 1, 3 })
    {
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      ExpectSame(this->OnRanks(ranks, medium, settings), whole, 2e-6);
    }
    steps.solvesSteady = false;
    ExpectSameLight(this->Whole(medium, steps), whole, 3e-4);
    steps.blockSize = 3;
    ExpectSameLight(this->Whole(medium, steps), whole, 3e-4);
  }
}

/// Who has light that others have not is told.
TEST_F(LatticeBlocks, AgreeOnTheLightThatIsGiven)
{
  static const std::vector<float> given(6 * 5 * 4, 1.0f);
  ExpectErrors("UncollidedLight", [](int rank, MediumToCut& part, LatticeSettings&, Monitor&) {
    part.scene.light.uncollided.fluence = { rank == 1 ? given.data() : nullptr, 1 };
  });
}

/// Of one voxel, which lies beside itself, or of two, which lie on both sides of each other.
TEST_F(LatticeBlocks, HaveTheLightThatGoesRoundShortAxes)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 1, 1, 7 }, { 2, 3, 1 }, { 1, 1, 1 } })
  {
    SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]));
    MediumToCut medium = Everything(size);
    medium.scene.light.faceAlbedo = {};
    LatticeSettings settings = SettingsOf(1e-7);
    settings.periodic = { true, true, false };
    const LightField whole = this->Whole(medium, settings);
    ExpectSame(this->OnRanks(2, medium, settings), whole, 2e-6);
    ExpectSame(this->OfBlocks(SingleVoxels(medium.scene.medium.grid), medium, settings), whole, 2e-6);
  }
}

/// Flat grids have long cells.
TEST_F(LatticeBlocks, SolvePlanesAndRows)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 12, 9, 1 }, { 1, 17, 1 }, { 1, 1, 1 } })
  {
    SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]));
    MediumToCut medium = Everything(size);
    ExpectSame(this->OnRanks(3, medium, SettingsOf(1e-7)), this->Whole(medium, SettingsOf(1e-7)), 2e-6);
  }
}

/// White, up to a hundred mean free paths a voxel: what diffusion on one rank's cells saves.
TEST_F(LatticeBlocks, NeedFewIterationsWhateverTheThickness)
{
  for (const double thickest : { 1e-2, 1.0, 1e2 })
  {
    SCOPED_TRACE(std::to_string(thickest));
    MediumToCut medium({ 24, 22, 20 });
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
  MediumToCut medium({ 4, 3, 2 });
  medium.scene.Randomise(1.0, 1.0, 0.9);
  const LightField light = this->OnRanks(3, medium, SettingsOf());
  EXPECT_EQ(*std::max_element(light.fluence.begin(), light.fluence.end()), 0.0f);
}

/// Whatever goes wrong on one rank is one error on each, and none waits for the others.
TEST_F(LatticeBlocks, FailTogether)
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
  ExpectErrors("aborted", [](int rank, MediumToCut&, LatticeSettings&, Monitor& monitor) {
    if (rank == 1)
    {
      monitor = [](double done) { return done < 0.2; };
    }
  });
}

/// What entered and went nowhere is in the balance, on whichever rank it was found.
TEST_F(LatticeBlocks, RefuseLightThatDoesNotBalance)
{
  const MediumToCut medium = Everything({ 6, 5, 4 });
  const auto judge = [&](int ranks, double lost) {
    const BlockPartition partition = BlockPartition::Even(medium.scene.medium.grid, ranks);
    std::vector<std::string> words(partition.blocks.size());
    RunInThreads(ranks, [&](Communicator& communicator) {
      const int rank = communicator.Rank();
      MediumToCut part = medium.Part(partition.blocks[rank]);
      part.Attach();
      const LatticeSettings settings = SettingsOf();
      const LatticeSceneInBlocks scene(
        this->GetDevice(), communicator, partition, part.scene.medium, part.Index(), part.scene.light, settings);
      LightField light = BeginLight(scene.Box().Count(), 1, settings);
      light.balance.entered[0] = light.balance.escaped[0] = 2.0;
      const Rgb lostHere = { rank == ranks - 1 ? lost * ranks : 0.0, 0.0, 0.0 };
      try
      {
        FinishLight(light, this->GetDevice(), communicator, scene, part.scene.light, settings, 1.0, lostHere);
        words[rank] = light.doubts.empty() ? "" : light.doubts.front();
      }
      catch (const InvalidInput& error)
      {
        words[rank] = error.what();
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
