// Thick voxels whose orders are added up one by one, in a medium that is spread over ranks: they shine by octant as in
// the whole (numerics.md, section 6.5), also where the voxels beside them are another rank's.

#include "BlocksOfLight.h"
#include "MemoryOfOneRank.h"

#include "Light/LeftOut.h"

#include <gmock/gmock.h>

using namespace blocks_of_light;
using namespace tyndall;

namespace
{
PropagationSettings ByOctant()
{
  PropagationSettings settings = SettingsOf(4);
  settings.directionsPerFace = 4;
  settings.source = PropagationSource::Octants;
  return settings;
}

/// A slanting beam, a lamp inside, a bright face and a sky.
Illumination Lit()
{
  Illumination shining = LitFromOutside();
  Light lamp;
  lamp.type = LightType::Point;
  lamp.position = { 2.6, 3.1, 2.2 };
  lamp.power = { 10.0, 4.0, 1.0 };
  shining.lights.push_back(lamp);
  return shining;
}
}

class OctantsInBlocks : public DeviceTest
{
protected:
  void ExpectTheLightOfTheWholeByOctant(
    const RandomMedium& whole, const Illumination& shining, const PropagationSettings& settings)
  {
    const Grid& grid = whole.medium.grid;
    const LightField byOctant = SolveConservative(GetDevice(), whole.medium, shining, settings);
    for (const BlockPartition& partition :
      { BlockPartition::Even(grid, 1), BlockPartition::Even(grid, 2), Uneven(grid) })
    {
      SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
      ExpectSame(LightOfAll(GetDevice(), partition, whole, shining, settings), byOctant, settings.periodic[0]);
    }
    PropagationSettings constant = settings;
    constant.source = PropagationSource::Constant;
    EXPECT_GT(
      RelativeRmse(SolveConservative(GetDevice(), whole.medium, shining, constant).fluence, byOctant.fluence), 1e-3);
  }
};

TEST_F(OctantsInBlocks, HaveTheLightOfTheWhole)
{
  RandomMedium whole(Grid{ { 5, 6, 4 }, { 1.0, 0.8, 1.3 } }, 3, 4.0f, 6);
  whole.Emit(0.3f);
  this->ExpectTheLightOfTheWholeByOctant(whole, Lit(), ByOctant());
}

/// Of which blocks have a part, or all. The beam goes across it: round it through few voxels it takes many laps.
TEST_F(OctantsInBlocks, HaveTheLightOfTheWholeRoundAnAxis)
{
  RandomMedium whole(Grid{ { 9, 3, 4 } }, 3, 4.0f, 7);
  Illumination shining = LitFromOutside();
  shining.lights[0].direction = { 0.0, -0.5, -0.9 };
  PropagationSettings settings = ByOctant();
  settings.maximumOrders = 2;
  settings.periodic[0] = true;
  this->ExpectTheLightOfTheWholeByOctant(whole, shining, settings);
}

TEST_F(OctantsInBlocks, HaveTheLightOfTheWholeFromFinerDirectionsAndWhiteFaces)
{
  RandomMedium whole(Grid{ { 3, 4, 5 } }, 3, 4.0f, 7);
  Illumination shining = LitFromOutside();
  shining.lights.clear();
  PropagationSettings settings = ByOctant();
  settings.uncollidedDirections = 9;
  this->ExpectTheLightOfTheWholeByOctant(whole, shining, settings);
  shining.faceAlbedo[2] = { 0.8, 0.6, 0.4 };
  settings.uncollidedDirections = 0;
  this->ExpectTheLightOfTheWholeByOctant(whole, shining, settings);
}

/// Of many thick voxels that absorb so much that acceleration does not pay.
TEST_F(OctantsInBlocks, ShineSoUnasked)
{
  RandomMedium whole(Grid{ { 5, 4, 3 } }, 3, 4.0f, 8);
  Share(whole, 0.8f, 0.2f);
  PropagationSettings settings = ByOctant();
  settings.source = PropagationSource::Automatic;
  settings.acceleration = PropagationAcceleration::Automatic;
  settings.maximumOrders = 0;
  this->ExpectTheLightOfTheWholeByOctant(whole, Lit(), settings);
}

/// What sources of thick voxels leave below 0 is taken from the voxels beside: sigma_a times fluence is what the ledger
/// counts. Where it is cut off, that is 2.0 and 2.6% more.
TEST_F(OctantsInBlocks, AbsorbWhatTheFluenceSays)
{
  const Grid grid = { { 7, 8, 6 }, { 1.0, 1.0, 1.0 } };
  for (const bool around : { false, true })
  {
    SCOPED_TRACE(around ? "round an axis" : "open");
    RandomMedium whole(grid, 1, 1.0f, 3);
    whole.SpreadOverDecades(1000.0, 2.0, 0.6, 3);
    Illumination shining;
    Light sun;
    sun.direction = { 0.3, -0.5, -0.9 };
    sun.power = { 1.0, 1.0, 1.0 };
    shining.lights.push_back(sun);
    shining.sky = { 0.1, 0.1, 0.1 };
    PropagationSettings settings;
    settings.tolerance = 1e-6;
    settings.periodic[1] = around;
    const LightField expected = SolveConservative(GetDevice(), whole.medium, shining, settings);
    double absorbed = 0.0;
    for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
    {
      EXPECT_GE(expected.fluence[i], 0.0f);
      absorbed += static_cast<double>(whole.absorption[i]) * expected.fluence[i];
    }
    EXPECT_NEAR(absorbed, expected.balance.absorbed[0], 1e-4 * expected.balance.absorbed[0]);
    EXPECT_LT(expected.balance.RelativeError(1), 1e-4);
    for (const BlockPartition& partition : { BlockPartition::Even(grid, 1), Uneven(grid) })
    {
      SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
      const LightField found = LightOfAll(GetDevice(), partition, whole, shining, settings);
      EXPECT_LT(RelativeRmse(found.fluence, expected.fluence), 1e-6);
    }
  }
}

TEST_F(OctantsInBlocks, SayWhereThereAreNone)
{
  const PropagationSettings settings = ByOctant();
  for (const float densest : { 0.1f, 3e4f })
  {
    RandomMedium whole(Grid{ { 3, 2, 2 } }, 3, densest, 6);
    Share(whole, 0.5f, 0.5f);
    const LightField light =
      LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, 2), whole, LitFromOutside(), settings);
    EXPECT_THAT(
      light.leftOut, testing::Contains(std::string(densest < 1.0f ? left_out::ThinVoxels : left_out::NotByOctant)));
  }
}

/// Where orders are added up by cells, as of the whole.
TEST_F(OctantsInBlocks, SayThatCellsHaveNone)
{
  RandomMedium whole(Grid{ { 22, 19, 18 } }, 1, 0.5f, 5);
  Share(whole, 0.02f, 0.98f);
  PropagationSettings settings = ByOctant();
  settings.maximumOrders = 0;
  settings.tolerance = 1e-6;
  settings.acceleration = PropagationAcceleration::Automatic;
  const LightField light =
    LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, 2), whole, LitFromOutside(), settings);
  EXPECT_THAT(light.leftOut, testing::Contains(std::string(left_out::NotByOctant)));
  EXPECT_THAT(light.leftOut, testing::Not(testing::Contains(std::string("acceleration: few scattering orders do"))));
}

TEST_F(OctantsInBlocks, FailTogetherWhereMemoryEnds)
{
  if (!GetDevice().SharesHostMemory())
  {
    GTEST_SKIP() << "what does not fit lies in host memory there";
  }
  const RandomMedium whole(Grid{ { 4, 3, 3 } }, 1, 4.0f, 6);
  const BlockPartition partition = BlockPartition::Even(whole.medium.grid, 2);
  PropagationSettings settings = ByOctant();
  settings.maximumOrders = 2;
  settings.directionsPerFace = 1;
  ExpectToFailTogether(GetDevice(), 2, 1000, [&](Device& device, Communicator& communicator) {
    PartOf part(whole, partition.blocks[communicator.Rank()]);
    SolveConservative(device, Domain(communicator, partition), part.medium, Lit(), settings);
  });
}
