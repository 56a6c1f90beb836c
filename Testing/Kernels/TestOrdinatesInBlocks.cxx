// Discrete ordinates in a medium that is spread over ranks, against those of the whole.

#include "DeviceTest.h"
#include "MediumInBlocks.h"
#include "MemoryOfOneRank.h"

#include "Device/Errors.h"
#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"

#include <algorithm>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
/// With all that blocks carry.
MediumToCut Everything(std::array<int, 3> size)
{
  MediumToCut medium(size);
  Scene& scene = medium.scene;
  scene.Randomise(2.0, 2.0, 0.8, 11);
  scene.emission = RandomValues(scene.sigma_s.size(), 0.0, 0.2, 3);
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  scene.ShineAlong({ 0.3, -0.5, -0.9 });
  scene.ShineFromEverywhere(0.1);
  for (std::size_t face = 0; face < 6; ++face)
  {
    scene.light.faces[face].fill(0.1 * static_cast<double>(face));
  }
  return medium;
}

OrdinatesSettings SettingsOf(int orders = 0)
{
  OrdinatesSettings settings;
  settings.directionsPerFace = 9;
  settings.terms = 16;
  settings.netFlux = true;
  settings.maximumOrders = orders;
  return settings;
}
}

class OrdinatesBlocks : public DeviceTest
{
protected:
  LightField Whole(MediumToCut& medium, const OrdinatesSettings& settings)
  {
    medium.Attach();
    return SolveDiscreteOrdinates(
      this->GetDevice(), Domain(medium.scene.medium.grid), medium.scene.medium, medium.scene.light, settings);
  }

  LightField OfBlocks(const BlockPartition& partition, const MediumToCut& medium, const OrdinatesSettings& settings)
  {
    return LightOfBlocks(partition, medium, [&](Communicator& communicator, MediumToCut& part) {
      return SolveDiscreteOrdinates(
        this->GetDevice(), Domain(communicator, partition), part.scene.medium, part.scene.light, settings);
    });
  }

  static void ExpectSame(const LightField& found, const LightField& expected)
  {
    ExpectSameLight(found, expected, 1e-6);
    EXPECT_EQ(found.convergence.size(), expected.convergence.size());
    EXPECT_LT(found.balance.RelativeError(expected.channels), 1e-5);
  }
};

TEST_F(OrdinatesBlocks, HaveTheLightOfTheWholeOnOneToEightRanks)
{
  MediumToCut medium = Everything({ 11, 9, 7 });
  const LightField whole = this->Whole(medium, SettingsOf());
  for (const int ranks : { 1, 3, 8 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    ExpectSame(this->OfBlocks(BlockPartition::Even(medium.scene.medium.grid, ranks), medium, SettingsOf()), whole);
  }
}

TEST_F(OrdinatesBlocks, MayBeUnevenEmptyOrSingleVoxels)
{
  MediumToCut medium = Everything({ 9, 4, 5 });
  const LightField whole = this->Whole(medium, SettingsOf());
  ExpectSame(this->OfBlocks(Slices(medium.scene.medium.grid, { 1, 1, 2, 8 }), medium, SettingsOf()), whole);
  ExpectSame(this->OfBlocks(Slices(medium.scene.medium.grid, { 0, 9 }), medium, SettingsOf()), whole);
  MediumToCut small = Everything({ 3, 2, 2 });
  ExpectSame(
    this->OfBlocks(SingleVoxels(small.scene.medium.grid), small, SettingsOf()), this->Whole(small, SettingsOf()));
}

/// Points, spots and rectangles; in units in which a float holds no area, too, and of one colour.
TEST_F(OrdinatesBlocks, HaveTheNearLampsOfTheWhole)
{
  for (const double spacing : { 1.0, 1e8 })
  {
    SCOPED_TRACE(std::to_string(spacing));
    MediumToCut medium = Everything({ 5, 9, 7 });
    Scene& scene = medium.scene;
    scene.medium.grid.spacing = { spacing, 0.7 * spacing, 1.2 * spacing };
    scene.medium.grid.origin = { -2.0 * spacing, 3.0 * spacing, 0.5 * spacing };
    AddNearLamps(scene);
    for (std::vector<float>* perLength : { &scene.sigma_a, &scene.sigma_s, &scene.emission })
    {
      std::for_each(
        perLength->begin(), perLength->end(), [&](float& value) { value = static_cast<float>(value / spacing); });
    }
    for (Light& lamp : scene.light.lights)
    {
      lamp.power = spacing > 1.0 ? Rgb{ 0.0, 2.0, 0.0 } : lamp.power;
    }
    const LightField whole = this->Whole(medium, SettingsOf());
    for (const int ranks : { 1, 3, 8 })
    {
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      ExpectSame(this->OfBlocks(BlockPartition::Even(scene.medium.grid, ranks), medium, SettingsOf()), whole);
    }
    ExpectSame(this->OfBlocks(Slices(scene.medium.grid, { 1, 1, 2 }), medium, SettingsOf()), whole);
  }
  MediumToCut small = Everything({ 3, 2, 2 });
  AddNearLamps(small.scene);
  small.scene.light.lights[2].power = { 0.5, 2.0, 0.0 };
  ExpectSame(
    this->OfBlocks(SingleVoxels(small.scene.medium.grid), small, SettingsOf()), this->Whole(small, SettingsOf()));
}

/// What leaves through an end comes in on the other side in the next order; along a single voxel nothing changes.
TEST_F(OrdinatesBlocks, HaveTheLightThatGoesRoundPeriodicAxes)
{
  const std::array<bool, 3> some[] = { { true, false, false }, { false, true, true }, { true, true, true } };
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 5, 7, 3 }, { 1, 6, 1 }, { 2, 1, 1 } })
  {
    for (const std::array<bool, 3>& periodic : some)
    {
      SCOPED_TRACE(std::to_string(periodic[0]) + std::to_string(periodic[1]) + std::to_string(periodic[2]));
      MediumToCut medium = Everything(size);
      medium.scene.medium.grid.spacing = { 1.0, 0.7, 1.2 };
      OrdinatesSettings settings = SettingsOf(9);
      settings.periodic = periodic;
      const LightField whole = this->Whole(medium, settings);
      for (const int ranks : { 1, 2, 5 })
      {
        SCOPED_TRACE(std::to_string(ranks) + " ranks");
        ExpectSame(this->OfBlocks(BlockPartition::Even(medium.scene.medium.grid, ranks), medium, settings), whole);
      }
    }
  }
  MediumToCut small = Everything({ 3, 2, 2 });
  OrdinatesSettings settings = SettingsOf();
  settings.periodic = { false, true, true };
  ExpectSame(this->OfBlocks(SingleVoxels(small.scene.medium.grid), small, settings), this->Whole(small, settings));
}

TEST_F(OrdinatesBlocks, HaveTheNearLampsThatShineRoundPeriodicAxes)
{
  MediumToCut medium = Everything({ 5, 3, 4 });
  AddNearLamps(medium.scene);
  OrdinatesSettings settings = SettingsOf(9);
  settings.periodic = { true, false, true };
  const LightField whole = this->Whole(medium, settings);
  for (const int ranks : { 1, 3 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    ExpectSame(this->OfBlocks(BlockPartition::Even(medium.scene.medium.grid, ranks), medium, settings), whole);
  }
}

/// Instead of that of lamps, by voxel, with its mean direction.
TEST_F(OrdinatesBlocks, HaveTheLightThatIsGivenToTheWhole)
{
  for (const bool colour : { false, true })
  {
    SCOPED_TRACE(colour);
    MediumToCut medium = Everything({ 7, 5, 6 });
    GiveLight(medium, colour);
    const LightField whole = this->Whole(medium, SettingsOf());
    for (const int ranks : { 1, 3, 8 })
    {
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      ExpectSame(this->OfBlocks(BlockPartition::Even(medium.scene.medium.grid, ranks), medium, SettingsOf()), whole);
    }
    ExpectSame(this->OfBlocks(Slices(medium.scene.medium.grid, { 0, 1, 1 }), medium, SettingsOf()), whole);
  }
}

/// So little that it is solved in another unit of power, which ranks without voxels have no light to turn into.
TEST_F(OrdinatesBlocks, HaveFaintLightThatIsGivenToTheWhole)
{
  MediumToCut medium({ 4, 3, 3 });
  medium.scene.Randomise(2.0, 1.0, 0.5);
  GiveLight(medium, false);
  for (float& value : medium.given)
  {
    value *= 1e-25f;
  }
  for (Rgb& face : medium.scene.light.uncollided.escaped)
  {
    face = { 1e-25, 1e-25, 1e-25 };
  }
  const LightField whole = this->Whole(medium, SettingsOf());
  ExpectSame(this->OfBlocks(Slices(medium.scene.medium.grid, { 0, 1 }), medium, SettingsOf()), whole);
}

/// A slab between faces that give back light, and in more directions than asked for.
TEST_F(OrdinatesBlocks, HaveTheSlabOfTheWhole)
{
  MediumToCut medium = Everything({ 1, 1, 9 });
  medium.scene.light.faceAlbedo[4] = { 0.3, 0.3, 0.3 };
  OrdinatesSettings settings = SettingsOf();
  settings.periodic = { true, true, false };
  const LightField whole = this->Whole(medium, settings);
  const LightField light = this->OfBlocks(BlockPartition::Even(medium.scene.medium.grid, 3), medium, settings);
  ExpectSame(light, whole);
  EXPECT_EQ(light.directionsPerFace, whole.directionsPerFace);
}

/// Of swept light, of beams and of near lamps, cell by cell.
TEST_F(OrdinatesBlocks, HaveTheLightThatFacesGiveBack)
{
  MediumToCut medium = Everything({ 6, 8, 5 });
  Scene& scene = medium.scene;
  AddNearLamps(scene);
  for (std::size_t face = 0; face < 6; ++face)
  {
    const double of = 0.15 * static_cast<double>(face);
    scene.light.faceAlbedo[face] = { of, 0.5 * of, of };
  }
  const LightField whole = this->Whole(medium, SettingsOf());
  for (const int ranks : { 1, 3, 8 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    const LightField light = this->OfBlocks(BlockPartition::Even(scene.medium.grid, ranks), medium, SettingsOf());
    ExpectSame(light, whole);
    EXPECT_LT(RelativeDifference(light.facePower, whole.facePower), 1e-6);
    EXPECT_EQ(light.faceAlbedo, whole.faceAlbedo);
  }
  ExpectSame(this->OfBlocks(Slices(scene.medium.grid, { 0, 1, 2 }), medium, SettingsOf()), whole);
}

/// By its mean over all ranks, weighted by what is scattered.
TEST_F(OrdinatesBlocks, HaveTheMeanOfAMeanCosineThatVaries)
{
  MediumToCut medium = Everything({ 4, 7, 5 });
  medium.scene.sigma_s = RandomValues(3 * medium.scene.sigma_a.size(), 0.0, 1.0, 9);
  medium.g = RandomValues(medium.scene.sigma_a.size(), -0.7, 0.7, 13);
  std::fill_n(medium.g.begin(), medium.g.size() / 2, 0.6f);
  const LightField whole = this->Whole(medium, SettingsOf());
  for (const int ranks : { 1, 3 })
  {
    const LightField light =
      this->OfBlocks(BlockPartition::Even(medium.scene.medium.grid, ranks), medium, SettingsOf());
    ExpectSame(light, whole);
    EXPECT_EQ(light.doubts, whole.doubts);
  }
  ExpectSame(this->OfBlocks(Slices(medium.scene.medium.grid, { 0, 1 }), medium, SettingsOf()), whole);
}

/// By every pair of directions, on a spiral, and in few orders; one colour alone shines on the last.
TEST_F(OrdinatesBlocks, HaveTheColoursAndTheScatteringOfTheWhole)
{
  MediumToCut medium = Everything({ 6, 7, 5 });
  medium.scene.sigma_s = RandomValues(3 * medium.scene.sigma_a.size(), 0.0, 1.0, 9);
  medium.scene.light.lights[0].power = { 1.0, 0.0, 3.0 };
  OrdinatesSettings settings = SettingsOf(3);
  settings.scattering = OrdinatesScattering::Matrix;
  settings.spiralDirections = 40;
  const BlockPartition partition = BlockPartition::Even(medium.scene.medium.grid, 3);
  ExpectSame(this->OfBlocks(partition, medium, settings), this->Whole(medium, settings));
  MediumToCut green({ 4, 1, 1 });
  green.scene.Randomise(1.0, 1.0, 0.9);
  green.scene.light.lights = medium.scene.light.lights;
  green.scene.light.lights[0].power = { 0.0, 2.0, 0.0 };
  green.scene.light.sky = { 0.0, 0.3, 0.0 };
  ExpectSame(this->OfBlocks(BlockPartition::Even(green.scene.medium.grid, 6), green, SettingsOf()),
    this->Whole(green, SettingsOf()));
}

/// As many directions as the whole has room for on the smallest device, and terms as far as any rank scatters unevenly.
TEST(QualityOfOrdinatesInBlocks, IsThatOfTheWhole)
{
  MediumToCut medium = Everything({ 7, 4, 6 });
  medium.Attach();
  const std::size_t bytes = 6 * 49 * 4 * medium.scene.medium.grid.VoxelCount(); // of 49 directions a face
  const DeviceMemory large, small = { 2 * bytes + 1, large.one };
  for (const Quality quality : { Quality::Draft, Quality::Default, Quality::Fine })
  {
    const OrdinatesSettings expected =
      AtQuality(Domain(medium.scene.medium.grid), quality, {}, medium.scene.medium, small);
    const BlockPartition partition = Slices(medium.scene.medium.grid, { 0, 5 });
    RunInThreads(3, [&](Communicator& communicator) {
      MediumToCut part = medium.Part(partition.blocks[communicator.Rank()]);
      part.Attach();
      part.scene.medium.phase = communicator.Rank() > 0 ? part.scene.medium.phase : PhaseFunction();
      const OrdinatesSettings found = AtQuality(
        Domain(communicator, partition), quality, {}, part.scene.medium, communicator.Rank() == 1 ? small : large);
      EXPECT_EQ(Words(found), Words(expected));
    });
    EXPECT_EQ(expected.directionsPerFace, quality == Quality::Draft ? 9 : quality == Quality::Fine ? 49 : 25);
  }
}

/// Thin enough for explicit steps.
MediumToCut Thin(std::array<int, 3> size)
{
  MediumToCut medium = Everything(size);
  for (std::vector<float>* values : { &medium.scene.sigma_a, &medium.scene.sigma_s })
  {
    std::for_each(values->begin(), values->end(), [](float& value) { value *= 0.3f; });
  }
  return medium;
}

TEST_F(OrdinatesBlocks, FailTogetherWhereMemoryEnds)
{
  MediumToCut medium = Thin({ 4, 3, 3 });
  AddNearLamps(medium.scene);
  const BlockPartition partition = BlockPartition::Even(medium.scene.medium.grid, 2);
  const auto expect = [&](const OrdinatesSettings& settings, std::size_t bytes) {
    ExpectToFailTogether(this->GetDevice(), 2, bytes, [&](Device& device, Communicator& communicator) {
      MediumToCut part = medium.Part(partition.blocks[communicator.Rank()]);
      part.Attach();
      SolveDiscreteOrdinates(device, Domain(communicator, partition), part.scene.medium, part.scene.light, settings);
    });
  };
  expect(SettingsOf(2), 140000); // that nobody says no to beforehand
}

TEST_F(OrdinatesBlocks, FailTogetherWithWordsOnWhatIsNotCarried)
{
  const MediumToCut medium = Everything({ 6, 5, 4 });
  const BlockPartition partition = BlockPartition::Even(medium.scene.medium.grid, 3);
  const auto expectErrors = [&](const std::string& words, const auto& change) {
    RunInThreads(3, [&](Communicator& communicator) {
      MediumToCut part = medium.Part(partition.blocks[communicator.Rank()]);
      part.Attach();
      OrdinatesSettings settings = SettingsOf();
      Monitor monitor;
      change(communicator.Rank(), part, settings, monitor);
      std::string said;
      try
      {
        SolveDiscreteOrdinates(
          this->GetDevice(), Domain(communicator, partition), part.scene.medium, part.scene.light, settings, monitor);
      }
      catch (const std::exception& error)
      {
        said = error.what();
      }
      EXPECT_NE(said.find(words), std::string::npos) << said;
    });
  };
  expectErrors("sigma_a", [](int rank, MediumToCut& part, OrdinatesSettings&, Monitor&) {
    part.scene.sigma_a[0] = rank == 1 ? -1.0f : part.scene.sigma_a[0];
  });
  expectErrors("disagree about settings",
    [](int rank, MediumToCut&, OrdinatesSettings& settings, Monitor&) { settings.terms = rank == 2 ? 9 : 16; });
  expectErrors("cannot be solved as published", [](int rank, MediumToCut&, OrdinatesSettings& settings, Monitor&) {
    settings.scheme = rank == 1 ? OrdinatesScheme::Published : OrdinatesScheme::Conservative;
  });
  expectErrors("aborted", [](int rank, MediumToCut&, OrdinatesSettings&, Monitor& monitor) {
    monitor = rank == 1 ? Monitor([](double done) { return done < 0.3; }) : Monitor();
  });
}

TEST(BalanceOfOrdinates, IsJudgedOnAnyNumberOfRanks)
{
  Scene scene({ 3, 1, 1 }, 0.2f, 0.3f);
  scene.Attach();
  LightField given;
  given.convergence = { ConvergenceRow() };
  given.balance.entered[0] = 4.0;
  given.balance.absorbed[0] = 3.0; // a quarter is lost
  const std::string words = "The light does not balance: 0.25 of the power is lost or made";
  OrdinatesSettings settings;
  for (const int count : { 1, 3 })
  {
    const BlockPartition partition = BlockPartition::Even(scene.medium.grid, count);
    RunInThreads(count, [&](Communicator& communicator) {
      LightField light = given;
      std::string said;
      try
      {
        Judge(settings, false, Domain(communicator, partition), scene.medium, light);
      }
      catch (const InvalidInput& error)
      {
        said = error.what();
      }
      EXPECT_EQ(said.find(words), 0u) << said;
    });
  }
  settings.scheme = OrdinatesScheme::Published; // loses power, as its paper has it
  Judge(settings, false, Domain(scene.medium.grid), scene.medium, given);
}
