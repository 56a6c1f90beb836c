#include "LightPropagation/Convergence.h"

#include <gtest/gtest.h>

using namespace tyndall;

namespace
{
LightField LightWith(double residual, double leftOver)
{
  LightField light;
  light.convergence.resize(7);
  light.convergence.back().residual = residual;
  light.balance.entered = { 3.0, 0.0, 0.0 };
  light.balance.emitted = { 1.0, 0.0, 0.0 };
  light.balance.leftOver = { 4.0 * leftOver, 0.0, 0.0 };
  return light;
}
}

TEST(Convergence, IsAResidualNotAboveTheTolerance)
{
  PropagationSettings settings;
  settings.tolerance = 1e-3;
  LightField light = LightWith(1e-3, 0.0);
  JudgeConvergence(settings, light);
  EXPECT_TRUE(light.converged);
  EXPECT_TRUE(light.doubts.empty());

  light = LightWith(1.1e-3, 0.0);
  JudgeConvergence(settings, light);
  EXPECT_FALSE(light.converged);
  ASSERT_EQ(light.doubts.size(), 1u);
  EXPECT_NE(light.doubts[0].find("after 7 sweeps its estimated relative error is 0.0011, Tolerance is 0.001"),
    std::string::npos)
    << light.doubts[0];
}

TEST(Convergence, IsNotAskedForWhereOrdersAreCounted)
{
  PropagationSettings settings;
  settings.maximumOrders = 7;
  LightField light = LightWith(0.5, 0.5);
  JudgeConvergence(settings, light);
  EXPECT_TRUE(light.converged);
  EXPECT_TRUE(light.doubts.empty());
}

TEST(Convergence, DoubtsLightOfWhichAHundredthIsLeftOver)
{
  LightField light = LightWith(0.0, 0.0099);
  JudgeConvergence({}, light);
  EXPECT_TRUE(light.doubts.empty());

  light = LightWith(0.0, 0.0101);
  JudgeConvergence({}, light);
  EXPECT_TRUE(light.converged);
  ASSERT_EQ(light.doubts.size(), 1u);
  EXPECT_NE(light.doubts[0].find("1.01% is left over"), std::string::npos) << light.doubts[0];
}
