// Light propagation maps as published in a medium that is spread over ranks, against those of the whole.

#include "DeviceTest.h"
#include "MediumInBlocks.h"

#include "LightPropagation/Distributed/Published/PublishedInBlocks.h"
#include "LightPropagation/Distributed/Published/SlabsAcross.h"
#include "LightPropagation/Published/ParallelPropagation.h"
#include "LightPropagation/Published/SequentialPropagation.h"

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
/// With all that the scheme carries but faces that reflect, and scattering in directions, whose factors take a while on
/// each rank: lamps, sky, bright faces, emission.
MediumToCut Everything(std::array<int, 3> size)
{
  MediumToCut medium(size);
  Scene& scene = medium.scene;
  scene.medium.grid.spacing = { 1.0, 0.7, 1.2 };
  scene.Randomise(1.0, 2.0, 0.7, 11);
  scene.emission = RandomValues(scene.sigma_s.size(), 0.0, 0.2, 3);
  scene.ShineAlong({ 0.3, -0.5, -0.9 });
  scene.ShineFromEverywhere(0.1);
  for (std::size_t face = 0; face < 6; ++face)
  {
    scene.light.faces[face].fill(0.1 * static_cast<double>(face));
  }
  return medium;
}

PropagationSettings SettingsOf(int orders = 0, int directionsPerFace = 4)
{
  PropagationSettings settings;
  settings.directionsPerFace = directionsPerFace;
  settings.maximumOrders = orders;
  settings.netFlux = true;
  return settings;
}
}

class PublishedBlocks : public DeviceTest
{
protected:
  LightField Whole(MediumToCut& medium, const PropagationSettings& settings)
  {
    medium.Attach();
    return SolveParallel(this->GetDevice(), medium.scene.medium, medium.scene.light, settings);
  }

  LightField OfBlocks(const BlockPartition& partition, const MediumToCut& medium, const PropagationSettings& settings)
  {
    return LightOfBlocks(partition, medium, [&](Communicator& communicator, MediumToCut& part) {
      return SolvePublishedInBlocks(
        this->GetDevice(), communicator, partition, part.scene.medium, part.scene.light, settings);
    });
  }

  /// By the sequential algorithm.
  static LightField InTurn(const BlockPartition& partition, const MediumToCut& medium, const PropagationSettings& how)
  {
    return LightOfBlocks(partition, medium, [&](Communicator& communicator, MediumToCut& part) {
      return SolveSequentialInBlocks(communicator, partition, part.scene.medium, part.scene.light, how);
    });
  }

  static void ExpectSame(const LightField& found, const LightField& expected)
  {
    ExpectSameLight(found, expected, 1e-6);
    EXPECT_LT(RelativeDifference(found.scatteredRadiance, expected.scatteredRadiance), 1e-6);
    EXPECT_LT(RelativeDifference(found.facePower, expected.facePower), 1e-6);
    EXPECT_EQ(found.convergence.size(), expected.convergence.size());
    EXPECT_NEAR(
      found.balance.RelativeError(expected.channels), expected.balance.RelativeError(expected.channels), 1e-6);
    EXPECT_EQ(found.storedDirections, expected.storedDirections);
    EXPECT_EQ(found.leftOut, expected.leftOut);
    EXPECT_EQ(found.faceAlbedo, expected.faceAlbedo);
  }

  void ExpectTheWhole(MediumToCut& medium, const PropagationSettings& settings, const std::vector<int>& ranks)
  {
    const LightField whole = this->Whole(medium, settings);
    for (const int count : ranks)
    {
      SCOPED_TRACE(std::to_string(count) + " ranks");
      ExpectSame(this->OfBlocks(BlockPartition::Even(medium.scene.medium.grid, count), medium, settings), whole);
    }
  }
};

TEST(SlabsAcrossAnAxis, AreWholePlanesOfRanksThatHaveVoxels)
{
  Grid grid;
  grid.size = { 7, 2, 5 };
  const BlockPartition blocks = Slices(grid, { 0, 3, 4 }); // none, 3, 1 and 3 voxels along x
  for (int axis = 0; axis < 3; ++axis)
  {
    const SlabsAcross slabs(blocks, axis);
    EXPECT_NO_THROW(slabs.boxes.Check());
    EXPECT_EQ(slabs.PlaceOf(0), -1);
    EXPECT_EQ(slabs.ranks.size(), axis == 1 ? 2u : 3u);
    for (std::size_t place = 0; place < slabs.ranks.size(); ++place)
    {
      EXPECT_EQ(slabs.PlaceOf(slabs.ranks[place]), static_cast<int>(place));
      const VoxelBox& box = slabs.boxes.blocks[slabs.ranks[place]];
      EXPECT_LE(box.size[axis], (grid.size[axis] + 2) / 3);
      EXPECT_EQ(box.VoxelCount() / box.size[axis], grid.VoxelCount() / grid.size[axis]);
    }
  }
}

TEST_F(PublishedBlocks, HaveTheLightOfTheWholeOnOneToEightRanks)
{
  MediumToCut medium = Everything({ 11, 9, 7 });
  this->ExpectTheWhole(medium, SettingsOf(0, 9), { 1, 3, 8 });
}

TEST_F(PublishedBlocks, MayBeUnevenEmptyOrSingleVoxels)
{
  MediumToCut medium = Everything({ 9, 4, 5 });
  const LightField whole = this->Whole(medium, SettingsOf());
  ExpectSame(this->OfBlocks(Slices(medium.scene.medium.grid, { 1, 1, 2, 8 }), medium, SettingsOf()), whole);
  ExpectSame(this->OfBlocks(Slices(medium.scene.medium.grid, { 0, 9 }), medium, SettingsOf()), whole);
  MediumToCut small = Everything({ 3, 2, 2 });
  ExpectSame(
    this->OfBlocks(SingleVoxels(small.scene.medium.grid), small, SettingsOf()), this->Whole(small, SettingsOf()));
}

/// Grey, and lit through one face alone, as the clouds of the paper are.
TEST_F(PublishedBlocks, HaveTheIsotropicLightOfTheWholeInCountedOrders)
{
  MediumToCut medium({ 8, 6, 5 });
  medium.scene.Randomise(2.0, 2.0, 0.9, 5);
  medium.scene.light.faces[0].fill(1.0);
  PropagationSettings settings = SettingsOf(3);
  settings.mapResolution = 2;
  settings.facePower = true;
  this->ExpectTheWhole(medium, settings, { 1, 3 });
  settings.maximumOrders = 1;
  this->ExpectTheWhole(medium, settings, { 2 });
}

TEST_F(PublishedBlocks, HaveTheColoursAndTheStoredDirectionsOfTheWhole)
{
  MediumToCut medium = Everything({ 6, 7, 5 });
  medium.scene.sigma_s = RandomValues(3 * medium.scene.sigma_a.size(), 0.0, 1.0, 9);
  medium.scene.light.lights[0].power = { 1.0, 0.0, 3.0 };
  medium.scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  for (const int stored : { 6, 10 })
  {
    PropagationSettings settings = SettingsOf(3);
    settings.storedDirections = stored;
    this->ExpectTheWhole(medium, settings, { 4 });
  }
  ExpectSame(this->OfBlocks(Slices(medium.scene.medium.grid, { 0, 4 }), medium, SettingsOf()),
    this->Whole(medium, SettingsOf()));
}

/// Which the whole has in one channel; more ranks than voxels.
TEST_F(PublishedBlocks, HaveTheLightOfOneColour)
{
  MediumToCut green({ 4, 1, 1 });
  green.scene.Randomise(1.0, 1.0, 0.9);
  green.scene.ShineAlong({ 0.3, -0.5, -0.9 });
  green.scene.light.lights[0].power = { 0.0, 2.0, 0.0 };
  green.scene.light.sky = { 0.0, 0.3, 0.0 };
  const LightField whole = this->Whole(green, SettingsOf());
  const LightField light = this->OfBlocks(BlockPartition::Even(green.scene.medium.grid, 6), green, SettingsOf());
  ExpectSameLight(light, whole, 1e-6);
  EXPECT_EQ(light.convergence.size(), whole.convergence.size());
}

/// Cell by cell, also of a part of a plane's sides.
TEST_F(PublishedBlocks, HaveTheLightThatFacesGiveBack)
{
  MediumToCut medium = Everything({ 6, 8, 5 });
  for (std::size_t face = 0; face < 6; ++face)
  {
    const double of = 0.15 * static_cast<double>(face);
    medium.scene.light.faceAlbedo[face] = { of, 0.5 * of, of };
  }
  this->ExpectTheWhole(medium, SettingsOf(5), { 1, 3, 8 });
}

/// What leaves through an end comes in on the other side in the next order, where it was in its voxel.
TEST_F(PublishedBlocks, HaveTheLightThatGoesRoundPeriodicAxes)
{
  const std::array<bool, 3> some[] = { { true, false, false }, { false, true, true }, { true, true, true } };
  for (const std::array<bool, 3>& periodic : some)
  {
    SCOPED_TRACE(std::to_string(periodic[0]) + std::to_string(periodic[1]) + std::to_string(periodic[2]));
    MediumToCut medium = Everything({ 5, 7, 3 });
    medium.scene.light.faceAlbedo[4].fill(periodic[2] ? 0.0 : 0.4);
    PropagationSettings settings = SettingsOf(4);
    settings.periodic = periodic;
    settings.mapResolution = periodic[0] ? 1 : 2;
    this->ExpectTheWhole(medium, settings, { 1, 2, 5 });
  }
}

/// Instead of that of lamps, by voxel, with its mean direction.
TEST_F(PublishedBlocks, HaveTheLightThatIsGivenToTheWhole)
{
  for (const bool colour : { false, true })
  {
    SCOPED_TRACE(colour);
    MediumToCut medium = Everything({ 7, 5, 6 });
    GiveLight(medium, colour);
    const LightField whole = this->Whole(medium, SettingsOf(4));
    ExpectSame(this->OfBlocks(BlockPartition::Even(medium.scene.medium.grid, 3), medium, SettingsOf(4)), whole);
    ExpectSame(this->OfBlocks(Slices(medium.scene.medium.grid, { 0, 1, 1 }), medium, SettingsOf(4)), whole);
  }
}

/// Of all that the scheme carries; on ranks of uneven parts, single planes and none.
TEST_F(PublishedBlocks, HaveTheLightOfTheSequentialAlgorithm)
{
  for (const bool around : { false, true })
  {
    SCOPED_TRACE(around ? "round two axes" : "open");
    MediumToCut medium = Everything({ 5, 7, 3 });
    medium.scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
    medium.scene.light.faceAlbedo[0].fill(0.6);
    medium.scene.light.faceAlbedo[3].fill(around ? 0.0 : 0.3);
    GiveLight(medium, around);
    medium.Attach();
    PropagationSettings settings = SettingsOf(around ? 4 : 0);
    settings.periodic = { false, around, around };
    settings.mapResolution = around ? 2 : 1;
    settings.storedDirections = 6;
    const LightField whole = SolveSequential(medium.scene.medium, medium.scene.light, settings);
    const Grid& grid = medium.scene.medium.grid;
    for (const BlockPartition& partition :
      { BlockPartition::Even(grid, 1), BlockPartition::Even(grid, 5), Slices(grid, { 0, 1, 1, 3 }) })
    {
      SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
      const LightField light = InTurn(partition, medium, settings);
      ExpectSame(light, whole);
      EXPECT_EQ(light.device, whole.device);
    }
  }
}

/// On the device of each, of what one rank takes; and sent, of rays' radiance and of voxels.
TEST_F(PublishedBlocks, TakeAnEighthOfTheMemoryOnEachOfEightRanks)
{
  MediumToCut medium({ 24, 24, 24 });
  medium.scene.Randomise(1.0, 1.0, 0.5, 5);
  medium.scene.light.faces[0].fill(1.0);
  const auto most = [&](int ranks) {
    const BlockPartition partition = BlockPartition::Even(medium.scene.medium.grid, ranks);
    std::mutex guard;
    std::size_t bytes = 0, sent = 0;
    LightOfBlocks(partition, medium, [&](Communicator& communicator, MediumToCut& part) {
      Device own(this->GetDevice(), MemoryBudget());
      LightField light =
        SolvePublishedInBlocks(own, communicator, partition, part.scene.medium, part.scene.light, SettingsOf(2, 25));
      const std::lock_guard<std::mutex> lock(guard);
      bytes = std::max(bytes, own.PeakBytes());
      sent = std::max(sent, communicator.Sent().bytes);
      return light;
    });
    std::printf("%d ranks: %.2f MB on the device, %.2f MB sent in two orders\n", ranks, 1e-6 * bytes, 1e-6 * sent);
    return static_cast<double>(bytes);
  };
  const double one = most(1);
  EXPECT_LT(most(2), 0.6 * one);
  EXPECT_LT(most(8), 0.15 * one);
}

TEST_F(PublishedBlocks, FailTogetherWhereTheyDoNotFitTheMemoryOfOneRank)
{
  const MediumToCut medium = Everything({ 6, 5, 4 });
  const BlockPartition partition = BlockPartition::Even(medium.scene.medium.grid, 3);
  RunInThreads(3, [&](Communicator& communicator) {
    MediumToCut part = medium.Part(partition.blocks[communicator.Rank()]);
    part.Attach();
    MemoryBudget budget;
    budget.bytes = communicator.Rank() == 1 ? 5000 : budget.bytes;
    Device own(this->GetDevice(), budget);
    EXPECT_THROW(
      SolvePublishedInBlocks(own, communicator, partition, part.scene.medium, part.scene.light, SettingsOf()),
      DeviceError);
  });
}

TEST_F(PublishedBlocks, FailTogetherWithWords)
{
  const MediumToCut medium = Everything({ 6, 5, 4 });
  const BlockPartition partition = BlockPartition::Even(medium.scene.medium.grid, 3);
  const auto expectErrors = [&](const std::string& words, const auto& change) {
    RunInThreads(3, [&](Communicator& communicator) {
      MediumToCut part = medium.Part(partition.blocks[communicator.Rank()]);
      part.Attach();
      PropagationSettings settings = SettingsOf();
      settings.periodic = { true, false, false };
      Monitor monitor;
      change(communicator.Rank(), part, settings, monitor);
      std::string said;
      try
      {
        SolvePublishedInBlocks(
          this->GetDevice(), communicator, partition, part.scene.medium, part.scene.light, settings, monitor);
      }
      catch (const std::exception& error)
      {
        said = error.what();
      }
      EXPECT_NE(said.find(words), std::string::npos) << said;
    });
  };
  expectErrors("sigma_a", [](int rank, MediumToCut& part, PropagationSettings&, Monitor&) {
    part.scene.sigma_a[0] = rank == 1 ? -1.0f : part.scene.sigma_a[0];
  });
  expectErrors("disagree about settings", [](int rank, MediumToCut&, PropagationSettings& settings, Monitor&) {
    settings.directionsPerFace = rank == 2 ? 16 : 4;
  });
  expectErrors("disagree about StoredDirections", [](int rank, MediumToCut&, PropagationSettings& settings, Monitor&) {
    settings.storedDirections = rank == 2 ? 6 : 1;
  });
  expectErrors("disagree about g", [](int rank, MediumToCut& part, PropagationSettings&, Monitor&) {
    part.scene.medium.phase = PhaseFunction::HenyeyGreenstein(rank == 0 ? 0.5 : 0.6);
  });
  expectErrors("has one phase function", [](int rank, MediumToCut& part, PropagationSettings&, Monitor&) {
    part.g = rank == 1 ? RandomValues(part.scene.sigma_a.size(), -0.7, 0.7, 13) : part.g;
    part.Attach();
  });
  expectErrors("DirectionsPerFace is 10",
    [](int, MediumToCut&, PropagationSettings& settings, Monitor&) { settings.directionsPerFace = 10; });
  expectErrors("aborted", [](int rank, MediumToCut&, PropagationSettings&, Monitor& monitor) {
    if (rank == 1)
    {
      monitor = [](double done) { return done < 0.3; };
    }
  });
}
