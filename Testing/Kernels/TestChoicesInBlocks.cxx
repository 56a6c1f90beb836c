// What a solve of a medium that is spread over ranks chooses as it would of the whole, and light that is given by voxel.

#include "BlocksOfLight.h"

#include <cmath>
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
  for (std::size_t i = 0; i < whole.absorption.size(); ++i)
  {
    const float both = whole.absorption[i] + whole.scattering[i];
    whole.absorption[i] = 0.001f * both;
    whole.scattering[i] = 0.999f * both;
  }
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
