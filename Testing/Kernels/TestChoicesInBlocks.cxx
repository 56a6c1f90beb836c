// What a solve of a medium that is spread over ranks chooses as it would of the whole, and light given by voxel.

#include "BlocksOfLight.h"

#include "Distribution/SharedMedium.h"
#include "LightPropagation/Emission/EmissionPeaks.h"
#include "LightPropagation/Problem/PropagationQuality.h"
#include "PhaseFunction/PhaseOfMedium.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

using namespace blocks_of_light;
using namespace tyndall;

class ChoicesInBlocks : public DeviceTest
{
};

/// One face shines: its light goes along as many directions as the whole would choose.
TEST_F(ChoicesInBlocks, TakeAsManyDirectionsOfUnscatteredLightAsTheWhole)
{
  RandomMedium whole(Grid{ { 12, 11, 13 } }, 1, 0.6f, 7);
  Illumination shining;
  shining.faces[2] = { 1.0, 1.0, 1.0 };
  PropagationSettings settings = SettingsOf(0);
  settings.uncollidedDirections = -1;
  settings.directionsPerFace = 25;
  const LightField expected = SolveConservative(GetDevice(), whole.medium, shining, settings);
  ASSERT_GT(expected.uncollidedDirections, 25);
  for (const int ranks : { 1, 3, 8 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    const LightField found =
      LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, ranks), whole, shining, settings);
    EXPECT_EQ(found.uncollidedDirections, expected.uncollidedDirections);
    ExpectSame(found, expected);
  }
}

/// g by voxel that is the same in all voxels of one block that scatter and varies in another, or is the same in all
/// blocks or all but one. In voxels that do not scatter it is any number.
TEST_F(ChoicesInBlocks, AgreeOnWhetherTheMeanCosineVaries)
{
  const auto inBlock = [](int x, float lower, float upper) { return x < 4 ? lower : x < 8 ? 0.5f : upper; };
  for (const std::array<float, 2>& g : { std::array<float, 2>{ 0.3f, -0.2f }, { 0.5f, 0.5f }, { 0.5f, 0.8f } })
  {
    SCOPED_TRACE(std::to_string(g[0]) + ", " + std::to_string(g[1]));
    RandomMedium whole(Grid{ { 12, 5, 4 } }, 1, 0.6f, 7);
    std::vector<float> cosines;
    for (std::size_t i = 0; i < whole.scattering.size(); ++i)
    {
      const int x = whole.medium.grid.VoxelAt(i)[0];
      whole.scattering[i] *= x == 5 || (x >= 8 && g[0] == g[1]) ? 0.0f : 1.0f; // the last block does not scatter
      cosines.push_back(whole.scattering[i] > 0.0f ? inBlock(x, g[0], g[1]) : 0.01f * static_cast<float>(x));
    }
    const PhaseFunction kind = PhaseFunction::Schlick(0.0);
    const Field ofWhole = { cosines.data(), 1 };
    whole.medium.phase = PhaseOfMedium(kind, ofWhole);
    SingleRank single;
    Medium alone = whole.medium;
    AgreeOnMeanCosine(single, true, ofWhole, alone);
    EXPECT_EQ(alone.phase.Varies(), g[1] != 0.5f || g[0] != 0.5f);
    EXPECT_EQ(
      alone.phase.OfChannel(0).MeanCosine(), alone.phase.Varies() ? 0.0 : PhaseFunction::Schlick(0.5).MeanCosine());
    const LightField expected = SolveConservative(GetDevice(), alone, LitFromOutside(), SettingsOf(6));
    for (const int ranks : { 1, 3 })
    {
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      const BlockPartition partition = BlockPartition::Even(whole.medium.grid, ranks);
      const LightField found = LightOfAll(partition, whole, LitFromOutside(),
        [&](Communicator& communicator, const Medium& given, const Illumination& light) {
          // As filters read their piece.
          const Field own = given.phase.G();
          Medium medium = given;
          medium.phase = PhaseByVoxel(kind, own, MeanCosineRange(own, given.sigma_s, given.grid.VoxelCount()));
          AgreeOnMeanCosine(communicator, true, own, medium);
          return SolveConservative(GetDevice(), Domain(communicator, partition), medium, light, SettingsOf(6));
        });
      ExpectSame(found, expected);
    }
  }
}

/// Blocks of which the first alone is thick, the last alone scatters: what matters is the whole.
TEST_F(ChoicesInBlocks, TakeTheSettingsThatAQualityHasForTheWhole)
{
  for (const float thick : { 0.5f, 3.0f })
  {
    RandomMedium whole(Grid{ { 16, 12, 12 } }, 1, 0.01f, 7);
    std::fill_n(whole.absorption.begin(), 16 * 12 * 6, thick);
    std::fill_n(whole.scattering.begin(), 16 * 12 * 11, 0.0f);
    const PropagationSettings expected =
      AtQuality(Domain(whole.medium.grid), Quality::Fine, {}, whole.medium, LitFromOutside());
    const BlockPartition partition = BlockPartition::Even(whole.medium.grid, 3);
    RunInThreads(3, [&](Communicator& communicator) {
      const PartOf part(whole, partition.blocks[communicator.Rank()]);
      const PropagationSettings found =
        AtQuality(Domain(communicator, partition), Quality::Fine, {}, part.medium, LitFromOutside());
      EXPECT_EQ(Words(found), Words(expected));
    });
    EXPECT_EQ(expected.directionsPerFace, thick > 1.0f ? 49 : 64);
  }
}

TEST_F(ChoicesInBlocks, LeaveInHostMemoryWhatDoesNotFitTheBudget)
{
  RandomMedium whole(Grid{ { 12, 11, 13 } }, 1, 0.6f, 7);
  const BlockPartition partition = BlockPartition::Even(whole.medium.grid, 3);
  PropagationSettings settings = SettingsOf(3);
  const LightField expected = LightOfAll(GetDevice(), partition, whole, LitFromOutside(), settings);
  settings.memoryBudget = 10000;
  const LightField found = LightOfAll(GetDevice(), partition, whole, LitFromOutside(), settings);
  EXPECT_EQ(found.fluence, expected.fluence);
  EXPECT_EQ(found.netFlux, expected.netFlux);
  EXPECT_NE(found.device.find("host memory"), std::string::npos) << found.device;
  EXPECT_EQ(expected.device.find("host memory"), std::string::npos) << expected.device;
}

/// On a GPU in slices of the blocks, with copies: light of all kinds, and what goes with it.
TEST_F(ChoicesInBlocks, HaveTheSameLightOfWhatIsInHostMemory)
{
  enum Kind
  {
    InColour,
    InMoments,
    RoundAnAxis,
    ByOctant,
    ByBalance
  };
  for (const Kind kind : { InColour, InMoments, RoundAnAxis, ByOctant, ByBalance })
  {
    SCOPED_TRACE("kind " + std::to_string(kind));
    RandomMedium whole(Grid{ { 21, 8, 9 } }, kind == InColour ? 3 : 1, kind >= ByOctant ? 6.0f : 0.6f, 27);
    whole.medium.phase = PhaseFunction::HenyeyGreenstein(kind == InMoments ? 0.6 : 0.0);
    const BlockPartition partition = BlockPartition::Even(whole.medium.grid, 4);
    PropagationSettings settings = SettingsOf(kind == ByBalance ? 0 : 3);
    settings.netFlux = true;
    settings.periodic = { kind == RoundAnAxis, false, false };
    settings.source = kind == ByOctant ? PropagationSource::Octants : PropagationSource::Automatic;
    const LightField expected = LightOfAll(GetDevice(), partition, whole, LitFromOutside(), settings);
    settings.memoryBudget = 10000;
    setenv("TYNDALL_WITHOUT", "host_memory", 1);
    const LightField found = LightOfAll(GetDevice(), partition, whole, LitFromOutside(), settings);
    unsetenv("TYNDALL_WITHOUT");
    EXPECT_EQ(found.fluence, expected.fluence);
    EXPECT_EQ(found.netFlux, expected.netFlux);
    EXPECT_EQ(found.facePowerOut, expected.facePowerOut);
    EXPECT_NE(found.device.find("host memory"), std::string::npos) << found.device;
  }
}

/// Without a budget of the user's: of a device with memory of its own, nine tenths of what is left, as of the whole.
TEST_F(ChoicesInBlocks, LeaveInHostMemoryWhatDoesNotFitTheDevice)
{
  RandomMedium whole(Grid{ { 12, 11, 13 } }, 1, 0.6f, 7);
  const BlockPartition partition = BlockPartition::Even(whole.medium.grid, 1);
  const PropagationSettings settings = SettingsOf(3);
  const LightField expected = LightOfAll(GetDevice(), partition, whole, LitFromOutside(), settings);
  setenv("TYNDALL_WITHOUT", "host_memory", 1);
  Device small(GetDevice(), { 100000, false, MemoryBudget::NoLimit });
  const LightField found = LightOfAll(small, partition, whole, LitFromOutside(), settings);
  unsetenv("TYNDALL_WITHOUT");
  EXPECT_EQ(found.fluence, expected.fluence);
  EXPECT_NE(found.device.find("from host memory"), std::string::npos) << found.device;
}

/// Light that is given by voxel, as that of photons.
class LightGivenInBlocks : public DeviceTest
{
protected:
  /// Of some brightness and direction in each voxel, brightest at x = 0.
  void Give(const Grid& grid, int components)
  {
    for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
    {
      const std::array<int, 3> at = grid.VoxelAt(i);
      for (int c = 0; c < components; ++c)
      {
        this->Fluence.push_back(static_cast<float>(std::exp(-0.3 * at[0]) * (1.0 + 0.3 * std::sin(i + c))));
      }
      this->Directions.insert(this->Directions.end(), { 0.7f, 0.1f, static_cast<float>(0.2 * std::cos(1.0 * i)) });
    }
    this->Shining.uncollided.fluence = { this->Fluence.data(), components };
    this->Shining.uncollided.meanDirection = { this->Directions.data(), 3 };
    this->Shining.uncollided.escaped[1] = { 2.0, 2.0, 2.0 };
    this->Shining.uncollided.escaped[4] = { 0.5, 0.5, 0.5 };
  }

  std::vector<float> Fluence, Directions;
  Illumination Shining;
};

TEST_F(LightGivenInBlocks, IsScatteredAsInTheWhole)
{
  RandomMedium whole(Grid{ { 9, 7, 8 } }, 1, 0.6f, 7);
  whole.Emit(0.1f);
  this->Give(whole.medium.grid, 1);
  ExpectTheLightOfTheWhole(GetDevice(), whole, this->Shining, SettingsOf(4));
  whole.medium.phase = PhaseFunction::HenyeyGreenstein(0.7); // in moments, and what goes straight on
  ExpectTheLightOfTheWhole(GetDevice(), whole, this->Shining, SettingsOf(4));
  PropagationSettings settings = SettingsOf(4);
  settings.angularDegree = 0; // what goes straight on by similarity
  ExpectTheLightOfTheWhole(GetDevice(), whole, this->Shining, settings);
}

TEST_F(LightGivenInBlocks, MayHaveColour)
{
  RandomMedium whole(Grid{ { 5, 6, 7 }, { 1.0, 0.7, 1.2 } }, 3, 0.6f, 8);
  this->Give(whole.medium.grid, 3);
  this->Shining.faceAlbedo[3] = { 0.5, 0.7, 0.9 };
  ExpectTheLightOfTheWhole(GetDevice(), whole, this->Shining, SettingsOf(4));
}

TEST_F(LightGivenInBlocks, GoesWithTheBalanceOfThickVoxels)
{
  RandomMedium whole(Grid{ { 8, 7, 9 } }, 1, 8.0f, 4);
  Share(whole, 0.001f, 0.999f);
  this->Give(whole.medium.grid, 1);
  PropagationSettings settings = SettingsOf(0);
  settings.acceleration = PropagationAcceleration::Automatic;
  settings.source = PropagationSource::Automatic;
  const LightField expected = SolveConservative(GetDevice(), whole.medium, this->Shining, settings);
  for (const int ranks : { 1, 3, 8 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    const LightField found =
      LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, ranks), whole, this->Shining, settings);
    ASSERT_EQ(found.surfaceRadiance.size(), expected.surfaceRadiance.size());
    EXPECT_LT(RelativeRmse(found.surfaceRadiance, expected.surfaceRadiance), 1e-4);
    EXPECT_LT(RelativeRmse(found.fluence, expected.fluence), 1e-4);
    EXPECT_NEAR(found.balance.entered[0], expected.balance.entered[0], 1e-6 * expected.balance.entered[0]);
    EXPECT_LT(found.balance.RelativeError(1), 1e-5);
  }
}

/// What the whole has beyond blocks is told, the same on all ranks, whatever the blocks.
class BetterAsWholeInBlocks : public DeviceTest
{
protected:
  std::string Told(
    const RandomMedium& whole, const Illumination& shining, const PropagationSettings& settings, int ranks)
  {
    const BlockPartition partition = BlockPartition::Even(whole.medium.grid, ranks);
    std::vector<std::string> told(ranks);
    RunInThreads(ranks, [&](Communicator& communicator) {
      const int rank = communicator.Rank();
      PartOf part(whole, partition.blocks[rank]);
      told[rank] =
        ReasonNotToDecompose(GetDevice(), Domain(communicator, partition), part.medium, part.Of(shining), settings);
    });
    EXPECT_EQ(std::count(told.begin(), told.end(), told[0]), ranks);
    return told[0];
  }
  void ExpectTold(const RandomMedium& whole, const Illumination& shining, const PropagationSettings& settings,
    const std::string& words)
  {
    for (const int ranks : { 3, 8 })
    {
      const std::string told = this->Told(whole, shining, settings, ranks);
      EXPECT_EQ(told.substr(0, words.size()), words) << ranks;
      EXPECT_EQ(told.empty(), words.empty()) << ranks;
    }
  }
  /// As users have it.
  static PropagationSettings Untouched() { return {}; }
};

TEST_F(BetterAsWholeInBlocks, IsNotAThinMediumOrAThickOneThatHardlyAbsorbs)
{
  RandomMedium thin(Grid{ { 12, 9, 7 } }, 1, 0.1f, 5);
  ExpectTold(thin, LitFromOutside(), Untouched(), "");
  RandomMedium white(Grid{ { 12, 11, 13 } }, 1, 1.0f);
  std::fill(white.absorption.begin(), white.absorption.end(), 0.001f);
  std::fill(white.scattering.begin(), white.scattering.end(), 4.0f);
  Illumination shining;
  shining.sky = { 1.0, 1.0, 1.0 };
  ExpectTold(white, shining, Untouched(), "");
  shining.faceAlbedo[0] = { 0.5, 0.5, 0.5 };
  ExpectTold(white, shining, Untouched(), "");
}

/// They shine by octant in blocks as well.
TEST_F(BetterAsWholeInBlocks, AreNotThickVoxelsThatAbsorbMuch)
{
  RandomMedium whole(Grid{ { 12, 9, 7 } }, 1, 3.0f, 5);
  for (std::size_t i = 0; i < whole.absorption.size(); ++i)
  {
    std::swap(whole.absorption[i], whole.scattering[i]);
    whole.absorption[i] += 2.0f;
  }
  ExpectTold(whole, LitFromOutside(), Untouched(), "");
}

TEST_F(BetterAsWholeInBlocks, AreNotManyOrdersAlsoAlongPeriodicAxes)
{
  RandomMedium whole(Grid{ { 12, 11, 13 } }, 1, 1.0f);
  std::fill(whole.absorption.begin(), whole.absorption.end(), 0.001f);
  std::fill(whole.scattering.begin(), whole.scattering.end(), 0.4f);
  Illumination shining;
  shining.sky = { 1.0, 1.0, 1.0 };
  PropagationSettings settings = Untouched();
  ExpectTold(whole, shining, settings, "");
  settings.periodic = { true, true, false };
  whole.absorption[7] = 0.002f; // no layers
  ExpectTold(whole, shining, settings, "");
}

TEST_F(BetterAsWholeInBlocks, AreLayers)
{
  RandomMedium whole(Grid{ { 4, 5, 6 } }, 1, 1.0f);
  std::fill(whole.absorption.begin(), whole.absorption.end(), 0.1f);
  std::fill(whole.scattering.begin(), whole.scattering.end(), 0.1f);
  PropagationSettings settings = Untouched();
  settings.periodic = { true, false, true };
  Illumination shining;
  shining.sky = { 1.0, 1.0, 1.0 };
  ExpectTold(whole, shining, settings, "layers");
  whole.absorption[7] = 0.2f;
  EXPECT_EQ(this->Told(whole, shining, settings, 3), "");
}

TEST_F(BetterAsWholeInBlocks, IsASmallBrightEmitter)
{
  RandomMedium whole(Grid{ { 12, 11, 13 } }, 1, 0.1f);
  whole.Emit(0.01f);
  ExpectTold(whole, {}, Untouched(), "");
  whole.emission[whole.medium.grid.IndexOf({ 6, 5, 6 })] = 100.0f;
  ASSERT_FALSE(Split(whole.medium).peaks.empty());
  ExpectTold(whole, {}, Untouched(), "small bright emission");
}
