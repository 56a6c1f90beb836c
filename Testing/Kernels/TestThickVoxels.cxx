// Orders added up one after the other where voxels are thick and absorb: light is scattered near the faces that it
// comes in through (numerics.md, section 6.5).

#include "DeviceTest.h"
#include "MediumScene.h"

#include "LightPropagation/PlaneParallel/PlaneParallelPropagation.h"
#include "Numerics/Constants.h"
#include "Reference/CubeReference.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

using namespace tyndall;

namespace
{
/// Equal layers along an axis, voxels of a length of 1, in columns; between clear ones. Solved along rays through
/// voxels, though nothing varies along two axes.
/// @param cosine  of a beam of power 1 through the lower face; 0: diffuse light
Scene Layers(int axis, int across, int layers, double perVoxel, double albedo, double cosine, int clear = 0)
{
  std::array<int, 3> size = { across, across, across };
  size[axis] = layers + 2 * clear;
  Scene scene(size);
  const std::size_t stride = scene.medium.grid.Strides()[axis];
  for (std::size_t i = 0; i < scene.sigma_a.size(); ++i)
  {
    const int layer = static_cast<int>(i / stride % static_cast<std::size_t>(size[axis])) - clear;
    const bool inside = layer >= 0 && layer < layers;
    scene.sigma_a[i] = inside ? static_cast<float>(perVoxel * (1.0 - albedo)) : 0.0f;
    scene.sigma_s[i] = inside ? static_cast<float>(perVoxel * albedo) : 0.0f;
  }
  scene.settings.adaptDirections = false;
  scene.settings.source = PropagationSource::Octants;
  scene.settings.acceleration = PropagationAcceleration::None;
  scene.settings.periodic = { true, true, true };
  scene.settings.periodic[axis] = false;
  if (cosine > 0.0)
  {
    std::array<double, 3> along = {};
    along[axis] = cosine;
    along[(axis + 1) % 3] = std::sqrt(1.0 - cosine * cosine);
    scene.ShineAlong(along);
  }
  else
  {
    scene.light.faces[2 * axis] = { 1.0, 1.0, 1.0 };
  }
  return scene;
}

double Reflected(const LightField& light, int axis)
{
  return light.facePowerOut[2 * axis][0] / light.balance.entered[0];
}

double ExactlyReflected(Scene scene, int axis)
{
  scene.settings.source = PropagationSource::Automatic;
  scene.Attach();
  return Reflected(SolvePlaneParallel(scene.medium, scene.light, scene.settings), axis);
}
}

class ThickVoxels : public DeviceTest
{
};

TEST_F(ThickVoxels, ReflectAsAbsorbingLayersDoHoweverThickTheyAre)
{
  int count = 0;
  for (double perVoxel : { 0.3, 1.0, 3.0, 12.0 })
  {
    for (double albedo : { 0.2, 0.5, 0.75 })
    {
      for (double cosine : { 0.0, 1.0, 0.55 })
      {
        const int axis = count++ / 2 % 3, layers = perVoxel < 1.0 ? 23 : 7;
        const LightField light = Layers(axis, 3, layers, perVoxel, albedo, cosine).Solve(this->GetDevice());
        const double exactly = ExactlyReflected(Layers(axis, 1, layers, perVoxel, albedo, cosine), axis);
        EXPECT_NEAR(Reflected(light, axis) / exactly, 1.0, 0.02)
          << "axis " << axis << ", " << perVoxel << " mean free paths a voxel, albedo " << albedo << ", cosine "
          << cosine;
        EXPECT_LT(light.balance.RelativeError(1), 1e-5);
      }
    }
  }
}

TEST_F(ThickVoxels, ReflectTheSameBehindClearOnes)
{
  for (double cosine : { 0.0, 0.8 })
  {
    const LightField light = Layers(1, 4, 9, 2.0, 0.6, cosine, 4).Solve(this->GetDevice());
    EXPECT_NEAR(Reflected(light, 1) / ExactlyReflected(Layers(1, 1, 9, 2.0, 0.6, cosine), 1), 1.0, 0.02) << cosine;
  }
}

TEST_F(ThickVoxels, SendBackWhatCubesDoThroughEachFace)
{
  const CubePowers cube = CubePowersOf(50.0, 0.5);
  for (int face = 0; face < 6; ++face)
  {
    Scene scene({ 20, 20, 20 }, 1.25f, 1.25f);
    scene.settings.source = PropagationSource::Octants;
    scene.light.faces[face] = { 1.0, 1.0, 1.0 };
    const LightField light = scene.Solve(this->GetDevice());
    EXPECT_NEAR(light.facePowerOut[face][0] / light.balance.entered[0] / cube.part[0], 1.0, 0.01) << face;
  }
}

// Light crosses the edges of a cube within a mean free path, less than a voxel: one ray in the middle of each voxel
// lets 11% too little through the sides.
TEST_F(ThickVoxels, LetThroughTheSidesOfACubeWhatMonteCarloDoes)
{
  const CubePowers cube = CubePowersOf(50.0, 0.5);
  Scene scene({ 40, 40, 40 }, 0.625f, 0.625f);
  scene.light.faces[2] = { 1.0, 1.0, 1.0 };
  const LightField light = scene.Solve(this->GetDevice());
  double sides = 0.0;
  for (int face : { 0, 1, 4, 5 })
  {
    sides += light.facePowerOut[face][0] / light.balance.entered[0];
  }
  EXPECT_NEAR(sides / cube.part[2], 1.0, 0.02);
}

TEST_F(ThickVoxels, KeepEvenLightEven)
{
  // All that is absorbed is emitted, in voxels of 0.03 to 30 mean free paths.
  Scene scene({ 9, 7, 8 });
  scene.Randomise(30.0, 3.0, 0.6, 11);
  scene.settings.source = PropagationSource::Octants;
  scene.emission = scene.sigma_a;
  scene.settings.emissionError = 0.0;
  scene.settings.tolerance = 1e-6;
  scene.ShineFromEverywhere(1.0);
  const LightField light = scene.Solve(this->GetDevice());
  const auto [least, most] = std::minmax_element(light.fluence.begin(), light.fluence.end());
  EXPECT_NEAR(*least / (4.0 * Pi), 1.0, 1e-3);
  EXPECT_NEAR(*most / (4.0 * Pi), 1.0, 1e-3);
}

// A lamp in the corner of voxels of 30 mean free paths: with sources by octant, orders of albedo 0.67 grow like a
// checkerboard of voxels, and three times the power of the lamp was absorbed.
TEST_F(ThickVoxels, AbsorbTheLightOfALampAmongThem)
{
  for (float perVoxel : { 8.0f, 30.0f, 300.0f })
  {
    for (float albedo : { 0.52f, 0.6f, 0.67f, 0.72f })
    {
      Scene scene({ 9, 9, 9 }, perVoxel * (1.0f - albedo), perVoxel * albedo);
      Light lamp;
      lamp.type = LightType::Spot;
      lamp.angle = 40.0;
      lamp.position = { 3.0, 4.0, 6.0 };
      lamp.power = { 1.0, 1.0, 1.0 };
      scene.light.lights = { lamp };
      const LightField light = scene.Solve(this->GetDevice());
      double absorbed = 0.0;
      for (float fluence : light.fluence)
      {
        absorbed += scene.sigma_a[0] * fluence;
      }
      EXPECT_NEAR(absorbed, 1.0, 2e-3) << perVoxel << " mean free paths, albedo " << albedo;
    }
  }
}

TEST_F(ThickVoxels, AddUpTheLightOfBothLamps)
{
  const auto solve = [&](bool first, bool second) {
    Scene scene({ 7, 9, 6 });
    scene.Randomise(8.0, 2.0, 0.5, 3);
    scene.settings.source = PropagationSource::Octants;
    scene.settings.tolerance = 1e-6;
    if (first)
    {
      scene.ShineAlong({ 0.3, 0.1, 1.0 });
    }
    if (second)
    {
      scene.ShineAlong({ -0.8, 0.5, -0.2 }, 2.0);
    }
    const LightField light = scene.Solve(this->GetDevice());
    EXPECT_LT(light.balance.RelativeError(1), 1e-5);
    return light.fluence;
  };
  const std::vector<float> one = solve(true, false), other = solve(false, true), both = solve(true, true);
  const float most = *std::max_element(both.begin(), both.end());
  for (std::size_t i = 0; i < both.size(); ++i)
  {
    EXPECT_NEAR(one[i] + other[i], both[i], 2e-5f * most) << i;
  }
}

TEST_F(ThickVoxels, AreLookedForAndLeftOutWhereThereAreNone)
{
  const auto leftOut = [&](float sigma) {
    Scene scene({ 5, 6, 7 }, sigma, sigma);
    scene.settings.source = PropagationSource::Octants;
    scene.light.faces[2] = { 1.0, 1.0, 1.0 };
    return scene.Solve(this->GetDevice()).leftOut;
  };
  const auto word = testing::HasSubstr("thick voxels");
  EXPECT_THAT(leftOut(0.05f), testing::Contains(word));
  EXPECT_THAT(leftOut(0.5f), testing::Not(testing::Contains(word)));
}
