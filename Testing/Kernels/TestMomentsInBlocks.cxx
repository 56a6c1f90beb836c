// Light that is scattered in angular moments, in a medium that is spread over ranks, against that of the whole on one.

#include "BlocksOfLight.h"

#include "PhaseFunction/PhaseFunction.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

using namespace blocks_of_light;

namespace
{
PropagationSettings InFewMoments(int orders)
{
  PropagationSettings settings = SettingsOf(orders);
  settings.angularDegree = 2;
  return settings;
}

/// From -0.3 to 0.9, a value for each voxel and channel.
std::vector<float> Cosines(const RandomMedium& medium)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(-0.3f, 0.9f);
  std::vector<float> g(medium.scattering.size());
  for (float& value : g)
  {
    value = unit(random);
  }
  return g;
}
}

class MomentsInBlocks : public DeviceTest
{
};

TEST_F(MomentsInBlocks, AreThoseOfTheWholeWhereLightIsScatteredForwards)
{
  RandomMedium whole(Grid{ { 19, 8, 7 } }, 1, 0.8f, 31);
  whole.Emit(0.3f);
  whole.medium.phase = PhaseFunction::HenyeyGreenstein(0.85);
  ExpectTheLightOfTheWhole(GetDevice(), whole, LitFromOutside(), SettingsOf(3));
}

TEST_F(MomentsInBlocks, AreThoseOfTheWholeInColourWithACosineByVoxel)
{
  RandomMedium whole(Grid{ { 7, 6, 9 } }, 3, 0.6f, 32);
  whole.Emit(0.3f);
  const std::vector<float> g = Cosines(whole);
  whole.medium.phase = PhaseOfMedium(PhaseFunction::HenyeyGreenstein(0.5), { g.data(), 3 });
  Illumination shining = LitFromOutside();
  shining.lights[0].power = { 1.0, 0.5, 3.0 };
  ExpectTheLightOfTheWhole(GetDevice(), whole, shining, InFewMoments(4));
}

/// Channels share transmittance; four beams of seven are exact in angle.
TEST_F(MomentsInBlocks, AreThoseOfTheWholeUnderManyColouredLampsInAGreyMedium)
{
  RandomMedium whole(Grid{ { 6, 9, 8 } }, 1, 0.8f, 33);
  whole.Emit(0.0f);
  whole.medium.phase = PhaseFunction::DoubleHenyeyGreenstein(0.9, -0.4, 0.8);
  Illumination shining;
  for (int i = 0; i < 7; ++i)
  {
    Light lamp;
    lamp.direction = { std::sin(1.0 + i), std::cos(2.0 * i), -0.4 + 0.2 * i };
    lamp.power = { 1.0, 0.1 * i, 2.0 - 0.2 * i };
    shining.lights.push_back(lamp);
  }
  ExpectTheLightOfTheWhole(GetDevice(), whole, shining, InFewMoments(5));
}

/// Of the last block no voxel is thin enough for moments, the others have fewer than those of the first.
TEST_F(MomentsInBlocks, AreThoseOfTheWholeWhereSomeBlocksAreThick)
{
  RandomMedium whole(Grid{ { 12, 5, 5 } }, 1, 0.5f, 34);
  whole.Emit(0.3f);
  for (std::size_t i = 0; i < whole.scattering.size(); ++i)
  {
    const int x = whole.medium.grid.VoxelAt(i)[0];
    whole.scattering[i] *= x < 3 ? 1.0f : x < 6 ? 8.0f : 100.0f;
    whole.absorption[i] += x < 6 ? 0.0f : 1.0f;
  }
  whole.medium.phase = PhaseFunction::HenyeyGreenstein(0.7);
  ExpectTheLightOfTheWhole(GetDevice(), whole, LitFromOutside(), InFewMoments(6));
}

/// Moments are smoothed by the shape of the whole box, not by that of the blocks.
TEST_F(MomentsInBlocks, AreThoseOfTheWholeInAFlatBox)
{
  RandomMedium whole(Grid{ { 28, 20, 2 } }, 1, 0.4f, 35);
  whole.Emit(0.1f);
  whole.medium.phase = PhaseFunction::HenyeyGreenstein(0.85);
  PropagationSettings settings = InFewMoments(3);
  settings.directionsPerFace = 16;
  ExpectTheLightOfTheWhole(GetDevice(), whole, LitFromOutside(), settings);
}

TEST_F(MomentsInBlocks, AreThoseOfTheWholeVoxelByVoxel)
{
  RandomMedium whole(Grid{ { 3, 2, 3 } }, 1, 0.8f, 36);
  whole.Emit(0.3f);
  whole.medium.phase = PhaseFunction::Schlick(0.6);
  PropagationSettings settings = InFewMoments(3);
  settings.storeMoments = false;
  settings.netFlux = false;
  const LightField expected = SolveConservative(GetDevice(), whole.medium, LitFromOutside(), settings);
  ExpectSame(LightOfAll(GetDevice(), VoxelByVoxel(whole.medium.grid), whole, LitFromOutside(), settings), expected);
}

/// An emitting medium and a beam: each by itself, and both.
TEST_F(MomentsInBlocks, AreTheSumOfThoseOfEachSource)
{
  RandomMedium whole(Grid{ { 8, 7, 6 } }, 1, 0.8f, 37);
  whole.Emit(0.3f);
  whole.medium.phase = PhaseFunction::HenyeyGreenstein(0.85);
  Illumination beam, dark;
  beam.lights = LitFromOutside().lights;
  const PropagationSettings settings = InFewMoments(4);
  RandomMedium cold(whole.medium.grid, 1, 0.8f, 37);
  cold.Emit(0.0f);
  cold.medium.phase = whole.medium.phase;
  const BlockPartition partition = BlockPartition::Even(whole.medium.grid, 3);
  for (const bool inBlocks : { true, false })
  {
    SCOPED_TRACE(inBlocks ? "in blocks" : "the whole");
    const auto solve = [&](const RandomMedium& medium, const Illumination& shining) {
      return inBlocks ? LightOfAll(GetDevice(), partition, medium, shining, settings)
                      : SolveConservative(GetDevice(), medium.medium, shining, settings);
    };
    const LightField both = solve(whole, beam), emitted = solve(whole, dark), ofBeam = solve(cold, beam);
    std::vector<float> sum(both.fluence.size());
    std::transform(emitted.fluence.begin(), emitted.fluence.end(), ofBeam.fluence.begin(), sum.begin(), std::plus<>());
    EXPECT_LT(RelativeRmse(both.fluence, sum), 1e-6);
  }
}
