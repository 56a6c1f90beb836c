#include "Viewing/Scene/ViewTraits.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <random>
#include <vector>

using namespace tyndall;

namespace
{
/// A medium of odd size that scatters forwards, its light, and how they are looked at.
class ViewTraitsTest : public testing::Test
{
protected:
  ViewTraitsTest()
  {
    this->medium.grid.size = { 7, 5, 11 };
    const std::size_t voxels = this->medium.grid.VoxelCount();
    std::mt19937 random(20261125);
    std::uniform_real_distribution<float> within(0.1f, 2.0f);
    const auto fill = [&](std::vector<float>& values, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i)
      {
        values.push_back(within(random));
      }
    };
    fill(this->absorption, voxels);
    fill(this->scattering, voxels);
    fill(this->coloured, 3 * voxels);
    fill(this->fluence, voxels);
    fill(this->direction, 3 * voxels);
    this->medium.sigma_a = { this->absorption.data(), 1 };
    this->medium.sigma_s = { this->scattering.data(), 1 };
    this->medium.phase = PhaseOfMedium(PhaseFunction::HenyeyGreenstein(0.6));
    this->light.fluence = this->light.fluenceDirect = { this->fluence.data(), 1 };
  }

  ViewTraits Found(const Field& ior = {}) const
  {
    return ViewTraitsOf(this->medium, FindFilledBricks(this->medium), this->light, ior, this->settings, 8);
  }

  std::vector<float> absorption, scattering, coloured, fluence, direction;
  Medium medium;
  SolvedLight light;
  ViewSettings settings;
};

TEST_F(ViewTraitsTest, GreyMediumInGreyLightIsSeenInOneChannel)
{
  EXPECT_TRUE(this->Found().grey);
  this->medium.sigma_s = { this->coloured.data(), 3 };
  EXPECT_FALSE(this->Found().grey);
  EXPECT_TRUE(this->Found().coloured);
}

TEST_F(ViewTraitsTest, OnlyArraysThatAreReadAreCounted)
{
  const std::array<int, 5> all = { 1, 1, 0, 1, 0 }, single = { 1, 1, 0, 0, 1 }, separated = { 1, 1, 0, 1, 1 };
  EXPECT_EQ(this->Found().components, all);
  this->settings.singleScatteringOnly = true;
  EXPECT_EQ(this->Found().components, single);
  this->settings.singleScatteringOnly = false;
  this->settings.shadowRays = true; // what they find is taken out of fluence, as far as it is unscattered
  EXPECT_EQ(this->Found().components, separated);
}

TEST_F(ViewTraitsTest, DirectionOfLightMattersOnlyWhereScatteringDependsOnIt)
{
  this->light.meanDirection = { this->direction.data(), 3 };
  EXPECT_TRUE(this->Found().knowsFlow);
  this->medium.phase = PhaseOfMedium(PhaseFunction::HenyeyGreenstein(0.0));
  EXPECT_FALSE(this->Found().knowsFlow);
}

TEST_F(ViewTraitsTest, SourcesDependOnTheCameraWhereLampsAreScatteredByAngle)
{
  EXPECT_FALSE(this->Found().sourcesDependOnCamera);
  this->settings.shadowRays = true;
  EXPECT_TRUE(this->Found().sourcesDependOnCamera);
  this->medium.phase = PhaseOfMedium(PhaseFunction::HenyeyGreenstein(0.0));
  EXPECT_FALSE(this->Found().sourcesDependOnCamera);
}

TEST_F(ViewTraitsTest, SurfaceReflectsWhereTheIndexRisesThroughItsOwn)
{
  std::vector<float> index(this->medium.grid.VoxelCount(), 1.0f);
  EXPECT_TRUE(this->Found({ index.data(), 1 }).OnlyStraight());
  index[this->medium.grid.VoxelCount() / 2] = 1.5f;
  const ViewTraits traits = this->Found({ index.data(), 1 });
  EXPECT_FALSE(traits.OnlyStraight());
  EXPECT_FALSE(traits.Reflects(this->settings)); // not asked for
  this->settings.surfaceReflection = SurfaceReflection::Fresnel;
  EXPECT_TRUE(traits.Reflects(this->settings));
  EXPECT_DOUBLE_EQ(traits.SurfaceIndex(this->settings), 1.25);
  this->settings.surfaceIndex = 1.6;
  EXPECT_FALSE(traits.Reflects(this->settings));
}

TEST_F(ViewTraitsTest, NoVoxelIsThickerThanTheBoundOfExtinction)
{
  const double bound = this->Found().largestSigmaT;
  for (std::size_t i = 0; i < this->medium.grid.VoxelCount(); ++i)
  {
    EXPECT_LE(this->absorption[i] + this->scattering[i], bound * (1.0 + 1e-7)) << i;
  }
}

TEST_F(ViewTraitsTest, AsManyRaysAreMarchedTogetherAsAskedForElseAsTheDeviceLikes)
{
  EXPECT_EQ(this->Found().packetWidth, 8);
  this->settings.packetWidth = 4;
  EXPECT_EQ(this->Found().packetWidth, 4);
}
}
