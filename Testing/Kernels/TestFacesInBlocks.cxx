// Light that faces of the box give back, and light that goes round periodic axes, in a medium that is spread over
// ranks, against that of the whole on one.

#include "BlocksOfLight.h"

#include "LightPropagation/Problem/ScatteringOrders.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

using namespace blocks_of_light;

namespace
{
Illumination BetweenBrightFaces()
{
  Illumination shining = LitFromOutside();
  shining.faceAlbedo[0] = { 0.5, 0.5, 0.5 };
  shining.faceAlbedo[3] = { 0.9, 0.9, 0.9 };
  shining.faceAlbedo[4] = { 1.0, 1.0, 1.0 };
  return shining;
}
}

class FacesInBlocks : public DeviceTest
{
};

TEST_F(FacesInBlocks, GiveBackTheLightThatTheyDoInTheWhole)
{
  RandomMedium whole(Grid{ { 11, 8, 7 } }, 1, 0.8f, 41);
  whole.Emit(0.3f);
  ExpectTheLightOfTheWhole(GetDevice(), whole, BetweenBrightFaces(), SettingsOf(0));
}

/// Some rays move both ways at once: past the edges of the grid, and of blocks.
TEST_F(FacesInBlocks, GiveBackLightThatGoesThroughEdges)
{
  RandomMedium whole(Grid{ { 8, 9, 10 } }, 1, 0.3f, 42);
  whole.Emit(0.1f);
  Illumination shining = LitFromOutside();
  shining.faceAlbedo.fill({ 0.8, 0.8, 0.8 });
  PropagationSettings settings = SettingsOf(5);
  settings.directionsPerFace = 16;
  ExpectTheLightOfTheWhole(GetDevice(), whole, shining, settings);
}

TEST_F(FacesInBlocks, GiveBackLightInColourAndInMoments)
{
  RandomMedium whole(Grid{ { 6, 7, 5 } }, 3, 0.6f, 43);
  whole.Emit(0.3f);
  whole.medium.phase = PhaseFunction::HenyeyGreenstein(0.85);
  Illumination shining = BetweenBrightFaces();
  shining.faceAlbedo[1] = { 0.9, 0.1, 0.5 };
  PropagationSettings settings = SettingsOf(4);
  settings.angularDegree = 1;
  ExpectTheLightOfTheWhole(GetDevice(), whole, shining, settings);
}

/// Of which nothing comes back, but what leaves through each cell is kept.
TEST_F(FacesInBlocks, KeepThePowerThatLeavesThroughCells)
{
  RandomMedium whole(Grid{ { 9, 8, 7 } }, 1, 0.5f, 44);
  whole.Emit(0.3f);
  PropagationSettings settings = SettingsOf(4);
  settings.directionsPerFace = 16;
  settings.facePower = true;
  ExpectTheLightOfTheWhole(GetDevice(), whole, LitFromOutside(), settings);
}

/// Only one block absorbs anything, and no light leaves.
TEST_F(FacesInBlocks, MayAllGiveBackAllLightWhereAnyBlockAbsorbs)
{
  RandomMedium whole(Grid{ { 6, 5, 4 } }, 1, 0.8f, 45);
  whole.Emit(0.3f);
  for (std::size_t i = 0; i < whole.absorption.size(); ++i)
  {
    whole.absorption[i] = i % 6 == 5 ? 0.5f : 0.0f;
  }
  Illumination shining;
  shining.faceAlbedo.fill({ 1.0, 1.0, 1.0 });
  const PropagationSettings settings = SettingsOf(6);
  const LightField expected = SolveConservative(GetDevice(), whole.medium, shining, settings);
  ExpectSame(LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, 3), whole, shining, settings), expected);
}

class PeriodicInBlocks : public DeviceTest
{
protected:
  void Expect(const std::array<bool, 3>& periodic, const Illumination& shining, int perFace, double g = 0.0)
  {
    SCOPED_TRACE(std::to_string(periodic[0]) + std::to_string(periodic[1]) + std::to_string(periodic[2]));
    RandomMedium whole(Grid{ { 7, 9, 6 } }, 1, 1.5f, 51); // a few laps
    whole.Emit(0.3f);
    whole.medium.phase = PhaseFunction::HenyeyGreenstein(g);
    PropagationSettings settings = SettingsOf(3);
    settings.directionsPerFace = perFace;
    settings.periodic = periodic;
    settings.angularDegree = g == 0.0 ? 0 : 1;
    const bool all = periodic[0] && periodic[1] && periodic[2];
    all ? ExpectInUnevenBlocks(whole, shining, settings)
        : ExpectTheLightOfTheWhole(GetDevice(), whole, shining, settings);
  }

  /// Where rays go round so often that blocks of all kinds would take a minute.
  void ExpectInUnevenBlocks(const RandomMedium& whole, const Illumination& shining, const PropagationSettings& settings)
  {
    const LightField expected = SolveConservative(GetDevice(), whole.medium, shining, settings);
    ExpectSame(LightOfAll(GetDevice(), Uneven(whole.medium.grid), whole, shining, settings), expected, true);
  }
};

TEST_F(PeriodicInBlocks, AreTheWholeAlongOneAxis)
{
  Expect({ true, false, false }, LitFromOutside(), 9);
}

TEST_F(PeriodicInBlocks, AreTheWholeAlongTwoAxes)
{
  Expect({ false, true, true }, LitFromOutside(), 16);
}

TEST_F(PeriodicInBlocks, AreTheWholeAlongAllAxesLitByTheMediumAlone)
{
  Expect({ true, true, true }, Illumination(), 4);
}

TEST_F(PeriodicInBlocks, AreTheWholeBetweenFacesThatGiveBackLightInMoments)
{
  Illumination shining = LitFromOutside();
  shining.faceAlbedo[4] = { 0.7, 0.7, 0.7 };
  shining.faceAlbedo[5] = { 0.2, 0.2, 0.2 };
  Expect({ true, true, false }, shining, 9, 0.8);
}

/// Until the light is there, in colour, with rays that wait from one sweep to the next for each channel.
TEST_F(PeriodicInBlocks, ConvergeAsTheWholeInColour)
{
  RandomMedium whole(Grid{ { 5, 6, 7 } }, 3, 2.5f, 52);
  whole.Emit(0.3f);
  PropagationSettings settings = SettingsOf(0);
  settings.directionsPerFace = 9;
  settings.periodic = { false, true, false };
  ExpectInUnevenBlocks(whole, LitFromOutside(), settings);
}

/// With coarse-mesh DSA, whose cells wrap around too.
TEST_F(PeriodicInBlocks, ConvergeAsTheWholeOnCells)
{
  for (const std::array<bool, 3>& periodic :
    std::vector<std::array<bool, 3>>{ { true, false, true }, { true, true, true } })
  {
    RandomMedium whole(Grid{ { 12, 11, 13 } }, 1, 1.0f, 54);
    std::fill(whole.absorption.begin(), whole.absorption.end(), 0.01f);
    std::fill(whole.scattering.begin(), whole.scattering.end(), 0.2f);
    whole.absorption[7] = 0.3f;
    whole.Emit(0.3f);
    PropagationSettings settings;
    settings.directionsPerFace = 4;
    settings.periodic = periodic;
    settings.emissionError = 0.0;
    ASSERT_EQ(
      ChooseIterationScheme(PropagationProblem(whole.medium, {}, settings, {})), IterationScheme::CoarseMeshDsa);
    const LightField expected = SolveConservative(GetDevice(), whole.medium, {}, settings);
    const LightField found = LightOfAll(GetDevice(), Uneven(whole.medium.grid), whole, {}, settings);
    EXPECT_LT(RelativeRmse(found.fluence, expected.fluence), settings.tolerance);
    EXPECT_NEAR(found.convergence.size(), expected.convergence.size(), 1);
    EXPECT_LT(found.balance.RelativeError(1), 1e-5);
  }
}

TEST_F(PeriodicInBlocks, AreTheWholeVoxelByVoxel)
{
  RandomMedium whole(Grid{ { 2, 1, 2 } }, 1, 2.5f, 53);
  whole.Emit(0.3f);
  PropagationSettings settings = SettingsOf(3);
  settings.directionsPerFace = 9;
  settings.periodic = { true, true, false };
  const LightField expected = SolveConservative(GetDevice(), whole.medium, LitFromOutside(), settings);
  ExpectSame(
    LightOfAll(GetDevice(), VoxelByVoxel(whole.medium.grid), whole, LitFromOutside(), settings), expected, true);
}
