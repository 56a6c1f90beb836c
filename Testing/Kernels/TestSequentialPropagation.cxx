#include "Difference.h"
#include "LightPropagation/Published/SequentialPropagation.h"
#include "RandomMedium.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace tyndall;

namespace
{
Illumination WhiteSky()
{
  Illumination illumination;
  illumination.sky = { 1.0, 1.0, 1.0 };
  return illumination;
}
}

TEST(SequentialPropagation, VacuumLeavesRadianceUnchanged)
{
  for (const int resolution : { 1, 3 })
  {
    const Grid grid{ { 5, 3, 4 }, { 1.0, 0.3, 2.0 } };
    EvenMedium vacuum(grid, 0.0f, 0.0f);
    PropagationSettings settings;
    settings.mapResolution = resolution;
    const LightField light = SolveSequential(vacuum.medium, WhiteSky(), settings);
    for (const float fluence : light.fluence)
    {
      EXPECT_NEAR(fluence, 4.0 * Pi, 5e-4); // sums of float, as published
    }
    EXPECT_EQ(light.convergence.size(), 1u);
    EXPECT_LT(light.balance.RelativeError(1), 1e-6);
  }
}

TEST(SequentialPropagation, AbsorberFollowsTheExponentialAlongAnAxis)
{
  const Grid grid{ { 6, 2, 3 }, { 0.5, 1.0, 1.0 } };
  EvenMedium absorber(grid, 0.8f, 0.0f);
  Illumination left;
  left.faces[0] = { 2.0, 2.0, 2.0 };
  PropagationSettings settings;
  settings.directionsPerFace = 1; // along the axes alone
  const LightField light = SolveSequential(absorber.medium, left, settings);
  const double weight = 4.0 * Pi / 6.0;
  for (int x = 0; x < 6; ++x)
  {
    EXPECT_NEAR(light.fluence[x], weight * 2.0 * std::exp(-0.4 * (x + 1)), 1e-6); // the radiance that leaves the voxel
  }
  EXPECT_NEAR(light.facePowerOut[1][0], weight * 2.0 * 6.0 * std::exp(-0.4 * 6), 1e-5);
  EXPECT_EQ(light.facePowerOut[0][0], 0.0);
}

/// What the paper's Eq. (4) costs: a thick voxel scatters only the light that has crossed it.
TEST(SequentialPropagation, LosesLightInThickVoxels)
{
  PropagationSettings settings;
  const auto lost = [&](float sigma_s) {
    EvenMedium scatterer({ { 6, 6, 6 } }, 0.0f, sigma_s);
    return SolveSequential(scatterer.medium, WhiteSky(), settings).balance.RelativeError(1);
  };
  EXPECT_LT(lost(0.01f), 0.002);
  EXPECT_GT(lost(2.0f), 0.2);
}

TEST(SequentialPropagation, ThinEmitterShinesWhatItEmits)
{
  RandomMedium thin(std::array{ 4, 5, 3 }, 1, 1e-6f);
  thin.Emit(1.0f);
  const LightField light = SolveSequential(thin.medium, {}, {});
  EXPECT_NEAR(light.balance.escaped[0], light.balance.emitted[0], 1e-4 * light.balance.emitted[0]);
}

/// Without borders the radiance of an emitting absorber is emission / sigma_a everywhere.
TEST(SequentialPropagation, PeriodicBoxHasNoBorders)
{
  EvenMedium even({ { 2, 3, 1 }, { 1.0, 0.4, 2.0 } }, 0.3f, 0.0f);
  const std::vector<float> emission(6, 0.6f);
  even.medium.emission.values = emission.data();
  PropagationSettings settings;
  settings.periodic = { true, true, true };
  settings.tolerance = 1e-7;
  const LightField light = SolveSequential(even.medium, {}, settings);
  for (const float fluence : light.fluence)
  {
    EXPECT_NEAR(fluence / (4.0 * Pi * 2.0), 1.0, 0.005); // segments differ from round to round
  }
  EXPECT_LT(light.balance.RelativeError(1), 0.005);
}

TEST(SequentialPropagation, PeriodicSlabHardlyDependsOnItsWidth)
{
  PropagationSettings settings;
  settings.periodic = { true, true, false };
  settings.tolerance = 1e-7;
  Illumination below;
  below.faces[4] = { 1.0, 1.0, 1.0 };
  const auto reflectance = [&](int width) {
    EvenMedium slab({ { width, width, 4 } }, 0.05f, 0.2f);
    const LightField light = SolveSequential(slab.medium, below, settings);
    return light.facePowerOut[4][0] / light.balance.entered[0];
  };
  EXPECT_NEAR(reflectance(8), reflectance(12), 0.01);
}

TEST(SequentialPropagation, StopsAtTheOrdersOrTheTolerance)
{
  RandomMedium random({ 6, 6, 6 });
  PropagationSettings settings;
  settings.maximumOrders = 3;
  const LightField three = SolveSequential(random.medium, WhiteSky(), settings);
  EXPECT_EQ(three.convergence.size(), 3u);
  settings.maximumOrders = 0;
  settings.tolerance = 1e-3;
  const LightField rough = SolveSequential(random.medium, WhiteSky(), settings);
  settings.tolerance = 1e-7;
  const LightField fine = SolveSequential(random.medium, WhiteSky(), settings);
  EXPECT_LE(rough.convergence.back().residual, 1e-3);
  EXPECT_GT(rough.convergence[rough.convergence.size() - 2].residual, 1e-3);
  EXPECT_LT(RelativeRmse(rough.fluence, fine.fluence), 2e-3);
  EXPECT_GT(RelativeRmse(rough.fluence, fine.fluence), 1e-5);
}

TEST(SequentialPropagation, StopsWhenToldTo)
{
  RandomMedium random({ 4, 4, 4 });
  int calls = 0;
  EXPECT_THROW(SolveSequential(random.medium, WhiteSky(), {}, [&](double) { return ++calls < 5; }), Aborted);
  EXPECT_EQ(calls, 5);
}
