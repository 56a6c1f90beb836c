#include "DeviceTest.h"
#include "Difference.h"
#include "PhotonScene.h"

#include "Medium/FilledBricks.h"
#include "Photons/Emission/PhotonEmitter.h"

#include <algorithm>
#include <limits>

using namespace tyndall;

namespace
{
/// Two cloudlets far apart in a box whose last bricks stand out of it.
PhotonScene Cloudlets(float red = 1.0f, int width = 77)
{
  PhotonScene scene({ width, 50, 61 }, 0.05, 1.0, 0.0f, 0.0f);
  if (red != 1.0f)
  {
    scene.sigma_s.resize(3 * scene.sigma_s.size());
  }
  const std::array<int, 3>& size = scene.medium.grid.size;
  const std::size_t each = red != 1.0f ? 3 : 1;
  for (std::size_t voxel = 0; voxel < scene.sigma_a.size(); ++voxel)
  {
    const std::array<int, 3> at = scene.medium.grid.VoxelAt(voxel);
    const double near = std::hypot(at[0] - 12, at[1] - 14, at[2] - 13);
    const double far = std::hypot(at[0] - size[0] + 9, at[1] - size[1] + 8, at[2] - size[2] + 7);
    const float density = static_cast<float>(std::max({ 0.0, 1.0 - near / 7.0, 1.0 - far / 8.0 }));
    scene.sigma_a[voxel] = 0.5f * density;
    for (std::size_t c = 0; c < each; ++c)
    {
      scene.sigma_s[voxel * each + c] = 9.0f * density * (c == 0 ? red : 1.0f);
    }
  }
  return scene;
}

std::vector<Photon> PhotonsOf(const Grid& grid, const Light& light, std::size_t count = 20000)
{
  Illumination illumination;
  illumination.lights = { light };
  return EmitPhotons(grid, illumination, { count, Sampler::Hammersley, 0 }).photons;
}

Light Sun(std::array<double, 3> direction, Rgb power = { 1.0, 1.0, 1.0 })
{
  Light sun;
  sun.direction = direction;
  sun.power = power;
  return sun;
}

/// A value of each voxel, in empty bricks its mean over the brick's voxels.
std::vector<float> MeansOfEmpty(const std::vector<float>& values, const FilledBricks& bricks, const Grid& grid)
{
  const std::size_t each = values.size() / grid.VoxelCount();
  const auto brickOf = [&](std::size_t voxel) {
    const std::array<int, 3> at = grid.VoxelAt(voxel);
    return static_cast<std::size_t>(
      (at[2] / BrickEdge * bricks.count[1] + at[1] / BrickEdge) * bricks.count[0] + at[0] / BrickEdge);
  };
  std::vector<double> sums(bricks.filled.size() * each, 0.0), counts(bricks.filled.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    sums[brickOf(i / each) * each + i % each] += values[i];
    counts[brickOf(i / each)] += 1.0 / static_cast<double>(each);
  }
  std::vector<float> means = values;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const std::size_t brick = brickOf(i / each);
    means[i] = bricks.filled[brick] ? values[i] : static_cast<float>(sums[brick * each + i % each] / counts[brick]);
  }
  return means;
}

}

class PhotonsByBricksTest : public DeviceTest
{
protected:
  /// The light by bricks and voxel by voxel, of which the former is the latter's mean where bricks are empty.
  PhotonLight ExpectSame(PhotonScene scene, const std::vector<Photon>& photons, const std::string& what)
  {
    const PhotonLight voxels = scene.March(this->GetDevice(), photons);
    scene.settings.byBricks = true;
    PhotonLight bricks = scene.March(this->GetDevice(), photons);
    const FilledBricks filled = FindFilledBricks(scene.Medium());
    const Grid& grid = scene.medium.grid;
    const double brightest = *std::max_element(voxels.light.fluence.begin(), voxels.light.fluence.end());
    // Rounding moves walls by some 1e-5 voxels, and a photon that passes an edge by to the voxel beside it.
    EXPECT_LT(
      LargestDifference(bricks.light.fluence, MeansOfEmpty(voxels.light.fluence, filled, grid)), 2e-4 * brightest)
      << what;
    EXPECT_LT(bricks.light.balance.RelativeError(bricks.light.channels), 1e-6) << what;
    EXPECT_EQ(bricks.missed, voxels.missed) << what;
    for (int face = 0; face < 6; ++face)
    {
      EXPECT_NEAR(
        bricks.light.facePowerOut[face][0], voxels.light.facePowerOut[face][0], 2e-6 * voxels.light.balance.entered[0])
        << what << ", face " << face;
    }
    for (int c = 0; c < voxels.light.channels; ++c)
    {
      EXPECT_NEAR(bricks.scattered[c], voxels.scattered[c], 1e-6 * voxels.light.balance.entered[c]) << what;
    }
    EXPECT_LT(2 * bricks.deposits, voxels.deposits) << what;
    return bricks;
  }
};

TEST_F(PhotonsByBricksTest, BricksAreFilledWhereThereIsAnyMedium)
{
  PhotonScene scene({ 17, 8, 9 }, 1.0, 0.0, 0.0f, 0.0f);
  EXPECT_EQ(FindFilledBricks(scene.Medium()).filledCount, 0u);
  const Grid& grid = scene.medium.grid;
  scene.sigma_s[grid.IndexOf({ 16, 7, 8 })] = 1e-30f;
  scene.sigma_a[grid.IndexOf({ 7, 0, 0 })] = 1.0f;
  const FilledBricks bricks = FindFilledBricks(scene.Medium());
  EXPECT_EQ(bricks.count, (std::array<int, 3>{ 3, 1, 2 }));
  EXPECT_EQ(bricks.filled, (std::vector<unsigned char>{ 1, 0, 0, 0, 0, 1 }));
  EXPECT_EQ(bricks.filledCount, 2u);
  std::vector<float> emission(3 * grid.VoxelCount(), 0.0f);
  emission[3 * grid.IndexOf({ 8, 0, 7 }) + 2] = 1.0f;
  scene.medium.emission = { emission.data(), 3 };
  EXPECT_EQ(FindFilledBricks(scene.Medium()).filled, (std::vector<unsigned char>{ 1, 1, 0, 0, 0, 1 }));
}

TEST_F(PhotonsByBricksTest, BricksTellWhatValuesThereAre)
{
  PhotonScene scene({ 17, 8, 9 }, 1.0, 0.0, 0.5f, 0.0f);
  const auto scattering = [&](float value) {
    scene.sigma_s[scene.medium.grid.IndexOf({ 16, 3, 8 })] = value;
    return FindFilledBricks(scene.Medium()).scattering;
  };
  const float largest = std::numeric_limits<float>::max(), infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(scattering(0.25f).largest, 0.25f);
  EXPECT_EQ(FindFilledBricks(scene.Medium()).absorption.largest, 0.5f);
  EXPECT_TRUE(scattering(largest).sound);
  EXPECT_EQ(scattering(largest).largest, largest);
  for (const float wrong : { infinity, -infinity, -1e-40f, std::numeric_limits<float>::quiet_NaN() })
  {
    EXPECT_FALSE(scattering(wrong).sound) << wrong;
    EXPECT_THROW(CheckedBricks(scene.Medium()), InvalidInput) << wrong;
  }
  scattering(-0.0f);
  EXPECT_NO_THROW(CheckedBricks(scene.Medium()));
}

TEST_F(PhotonsByBricksTest, LightIsTheSameFromEverySide)
{
  const PhotonScene scene = Cloudlets();
  for (const std::array<double, 3>& direction : { std::array<double, 3>{ 0.3, 0.5, 0.8 }, { -0.9, 0.2, -0.1 },
         { 0.2, -0.7, 0.01 }, { 0.0, 0.0, 1.0 }, { 0.0, -1.0, 0.0 }, { -0.6, 0.0, 0.8 } })
  {
    this->ExpectSame(scene, PhotonsOf(scene.medium.grid, Sun(direction)),
      std::to_string(direction[0]) + ' ' + std::to_string(direction[1]) + ' ' + std::to_string(direction[2]));
  }
}

/// Of rows that are whole vectors, voxels of empty bricks are stored several at a time.
TEST_F(PhotonsByBricksTest, RowsOfWholeVectorsHaveTheSameLight)
{
  for (const float red : { 1.0f, 0.5f })
  {
    const PhotonScene scene = Cloudlets(red, 84);
    const std::vector<Photon> photons = PhotonsOf(scene.medium.grid, Sun({ 0.36, 0.48, 0.8 }));
    const PhotonLight light = this->ExpectSame(scene, photons, std::to_string(red));
    EXPECT_EQ(light.light.channels, red == 1.0f ? 1 : 3);
    for (std::size_t voxel = 0; voxel < light.meanDirection.size() / 3; ++voxel)
    {
      const bool lit = light.light.fluence[voxel * static_cast<std::size_t>(light.light.channels)] > 1e-3f;
      ASSERT_NEAR(light.meanDirection[3 * voxel + 2], 0.80, lit ? 1e-4 : 0.81) << voxel;
      ASSERT_NEAR(light.meanDirection[3 * voxel + 0], 0.36, lit ? 1e-4 : 0.37) << voxel;
    }
  }
}

TEST_F(PhotonsByBricksTest, LightOfALampInTheEmptySpaceIsTheSame)
{
  const PhotonScene scene = Cloudlets();
  Light lamp;
  lamp.type = LightType::Point;
  lamp.position = { 0.9, 0.3, 0.2 };
  lamp.power = { 5.0, 5.0, 5.0 };
  // Beside the lamp a few photons that rounding moves count for much: of them only sums are compared.
  PhotonScene voxelByVoxel = scene, byBricks = scene;
  byBricks.settings.byBricks = true;
  const std::vector<Photon> photons = PhotonsOf(scene.medium.grid, lamp);
  const PhotonLight expected = voxelByVoxel.March(this->GetDevice(), photons);
  const PhotonLight found = byBricks.March(this->GetDevice(), photons);
  EXPECT_NEAR(byBricks.TotalPathPower(found) / voxelByVoxel.TotalPathPower(expected), 1.0, 1e-5);
  EXPECT_NEAR(found.scattered[0] / expected.scattered[0], 1.0, 1e-5);
  EXPECT_LT(found.light.balance.RelativeError(1), 1e-6);
}

TEST_F(PhotonsByBricksTest, ColourIsKept)
{
  const PhotonScene scene = Cloudlets(0.3f);
  const PhotonLight light =
    this->ExpectSame(scene, PhotonsOf(scene.medium.grid, Sun({ 0.5, 0.5, 0.6 }, { 3.0, 2.0, 1.0 })), "coloured medium");
  EXPECT_EQ(light.light.channels, 3);
  const PhotonScene grey = Cloudlets();
  this->ExpectSame(grey, PhotonsOf(grey.medium.grid, Sun({ 0.5, 0.5, 0.6 }, { 3.0, 2.0, 1.0 })), "coloured light");
}

TEST_F(PhotonsByBricksTest, DirectionsAreThoseOfTheLight)
{
  PhotonScene scene = Cloudlets();
  scene.settings.byBricks = true;
  const PhotonLight light = scene.March(this->GetDevice(), PhotonsOf(scene.medium.grid, Sun({ 0.36, 0.48, 0.8 })));
  std::size_t lit = 0;
  for (std::size_t voxel = 0; voxel < light.light.fluence.size(); ++voxel)
  {
    if (light.light.fluence[voxel] > 1e-3f)
    {
      ++lit;
      ASSERT_NEAR(light.meanDirection[3 * voxel + 0], 0.36, 1e-4) << voxel;
      ASSERT_NEAR(light.meanDirection[3 * voxel + 1], 0.48, 1e-4) << voxel;
      ASSERT_NEAR(light.meanDirection[3 * voxel + 2], 0.80, 1e-4) << voxel;
    }
  }
  EXPECT_GT(lit, light.light.fluence.size() / 2);
}

TEST_F(PhotonsByBricksTest, WhateverTheSumsTheBitsAreTheSame)
{
  PhotonScene scene = Cloudlets();
  scene.settings.byBricks = true;
  const std::vector<Photon> photons = PhotonsOf(scene.medium.grid, Sun({ 0.3, 0.5, 0.8 }));
  scene.settings.sums = MarchSettings::Sums::Private;
  const PhotonLight mine = scene.March(this->GetDevice(), photons);
  scene.settings.sums = MarchSettings::Sums::Shared;
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  for (int time = 0; time < 2; ++time) // sums are zero again after a run
  {
    const PhotonLight shared = marcher.March(photons);
    EXPECT_EQ(mine.light.fluence, shared.light.fluence) << time;
    EXPECT_EQ(mine.meanDirection, shared.meanDirection) << time;
  }
}

TEST_F(PhotonsByBricksTest, PathsGoFromWallToWall)
{
  PhotonScene scene = Cloudlets();
  scene.settings.byBricks = true;
  const PhotonPath path = scene.Path(this->GetDevice(), { -1.0, 0.0, 0.2 }, { 1.0, 0.0, 0.0 });
  EXPECT_NEAR(path.points.back()[0], -1.0 + 77 * 0.05, 1e-4);
  EXPECT_NEAR(path.points.back()[1], 0.0, 1e-4);
}

TEST_F(PhotonsByBricksTest, WhereItSavesNothingLightIsKeptVoxelByVoxel)
{
  const auto bits = [&](PhotonScene scene, bool byBricks) {
    scene.settings.byBricks = byBricks;
    return scene.March(this->GetDevice(), PhotonsOf(scene.medium.grid, Sun({ 0.3, 0.5, 0.8 }), 2000)).light.fluence;
  };
  const PhotonScene full({ 24, 24, 24 }, 0.1, 1.0, 0.1f, 0.2f);
  EXPECT_EQ(bits(full, true), bits(full, false));
  PhotonScene bent = Cloudlets();
  bent.SetBall(0.5, 1.3);
  EXPECT_EQ(bits(bent, true), bits(bent, false));
  PhotonScene counting = Cloudlets();
  counting.settings.counts = true;
  EXPECT_EQ(bits(counting, true), bits(counting, false));
}

TEST_F(PhotonsByBricksTest, WhatNeedsVoxelsSaysSo)
{
  PhotonScene scene = Cloudlets();
  scene.settings.byBricks = true;
  const std::vector<Photon> photons = PhotonsOf(scene.medium.grid, Sun({ 0.3, 0.5, 0.8 }), 100);
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  EXPECT_THROW(marcher.Gather(photons, std::vector<std::array<int, 2>>(photons.size()), { 4, 4, 4 }), InvalidInput);
}
