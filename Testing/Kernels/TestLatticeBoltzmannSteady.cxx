// The steady state of a lattice, solved for.

#include "Difference.h"
#include "ErrorWords.h"
#include "LatticeScene.h"

#include "Numerics/Constants.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace tyndall;

namespace
{
std::vector<float> RandomIndex(std::size_t count, double most, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> index(1.0, most);
  std::vector<float> ior(count);
  std::generate(ior.begin(), ior.end(), [&] { return static_cast<float>(index(random)); });
  return ior;
}
}

class SteadyLattices : public LatticeTest
{
};

/// Whatever links do, and along open and closed lines of every kind.
TEST_F(SteadyLattices, SolveWhatStepsSettleTo)
{
  for (const auto& [directions, bends] : { std::pair(18, false), std::pair(18, true), std::pair(6, true) })
  {
    for (const int periodic : { 0, 1, 5, 6, 7 })
    {
      Scene scene({ 6, 4, 5 });
      scene.Randomise(4.0, 1.5, 0.9, 11u + static_cast<unsigned>(periodic));
      scene.emission.assign(scene.sigma_s.size(), 0.0f);
      scene.emission[37] = 1.0f;
      LatticeSettings settings;
      settings.directions = directions;
      settings.periodic = { (periodic & 1) != 0, (periodic & 2) != 0, (periodic & 4) != 0 };
      for (std::size_t face = 0; face < 6; ++face)
      {
        if (!settings.periodic[face / 2])
        {
          scene.light.faces[face] = { 0.1 * face, 0.1 * face, 0.1 * face };
          scene.light.faceAlbedo[face] = { 0.15 * face, 0.15 * face, 0.15 * face };
        }
      }
      const std::vector<float> ior = bends ? RandomIndex(scene.sigma_s.size(), 1.8, 3) : std::vector<float>();
      settings.tolerance = 1e-6;
      settings.netFlux = true;
      const LightField solved = this->Solve(scene, settings, ior);
      settings.solvesSteady = false;
      settings.tolerance = 1e-7;
      const LightField stepped = this->Solve(scene, settings, ior);
      const std::string which =
        std::to_string(directions) + " directions, periodic " + std::to_string(periodic) + (bends ? ", bends" : "");
      EXPECT_LT(RelativeDifference(solved.fluence, stepped.fluence), 2e-5) << which;
      EXPECT_LT(RelativeDifference(solved.netFlux, stepped.netFlux), 1e-4) << which;
      EXPECT_TRUE(solved.converged) << which;
      const double all = solved.balance.entered[0] + solved.balance.emitted[0];
      EXPECT_LT(std::abs(solved.balance.leftOver[0]), 1e-5 * all) << which;
      for (std::size_t face = 0; face < 6; ++face)
      {
        EXPECT_NEAR(solved.facePowerOut[face][0], stepped.facePowerOut[face][0], 1e-4 * all) << which;
      }
    }
  }
}

/// From thin to opaque voxels side by side; power is kept where nothing absorbs, and nothing is negative.
TEST_F(SteadyLattices, KeepPowerWhateverTheirVoxelsAre)
{
  for (const double thickest : { 1e-2, 1.0, 1e2, 1e4 })
  {
    for (const double albedo : { 0.0, 0.5, 0.999, 1.0 })
    {
      Scene scene({ 9, 12, 7 });
      scene.Randomise(thickest, 8.0, albedo, 20261123);
      scene.ShineAlong({ 0.3, -0.2, -0.9 });
      scene.ShineFromEverywhere(0.3);
      const LightField light = this->Solve(scene);
      const std::string which = "thickness " + std::to_string(thickest) + ", albedo " + std::to_string(albedo);
      EXPECT_TRUE(light.converged) << which;
      EXPECT_LT(light.convergence.size(), 60u) << which;
      EXPECT_LT(std::abs(light.balance.leftOver[0]), 1e-5 * light.balance.entered[0]) << which;
      EXPECT_TRUE(std::all_of(light.fluence.begin(), light.fluence.end(),
        [](float fluence) { return std::isfinite(fluence) && fluence >= 0.0f; }))
        << which;
    }
  }
}

TEST_F(SteadyLattices, LeaveAFurnaceOfAnyIndexAsItsSquare)
{
  for (const int directions : { 6, 18 })
  {
    for (const double most : { 1.0, 1.3, 2.5 })
    {
      Scene scene({ 9, 6, 7 });
      scene.Randomise(30.0, 3.0, 1.0, 7);
      scene.ShineFromEverywhere(1.0);
      const std::vector<float> ior =
        most > 1.0 ? RandomIndex(scene.sigma_s.size(), most, 5) : std::vector<float>(scene.sigma_s.size(), 1.5f);
      LatticeSettings settings;
      settings.directions = directions;
      const LightField light = this->Solve(scene, settings, ior);
      for (std::size_t i = 0; i < ior.size(); ++i)
      {
        ASSERT_NEAR(light.fluence[i] / (4.0 * Pi * ior[i] * ior[i]), 1.0, 1e-4) << directions << ", " << most;
      }
      EXPECT_LT(std::abs(light.balance.leftOver[0]), 1e-5 * light.balance.entered[0]);
    }
  }
}

/// Layers of albedo 1, the index other in the middle: resistances 3 tau / (4 n^2) in a row, Marshak's at the ends, and
/// those of two surfaces that reflect totally what comes too flat, |1 - 1 / n^2| / 2.
TEST_F(SteadyLattices, TransmitLayersOfOtherIndexAsDiffusionDoes)
{
  for (const double index : { 1.0, 1.5, 2.4 })
  {
    Scene scene({ 24, 1, 1 }, 0.0f, 5.0f);
    scene.light.faces[1] = { 1.0, 1.0, 1.0 };
    std::vector<float> ior(24, 1.0f);
    std::fill(ior.begin() + 6, ior.begin() + 18, static_cast<float>(index));
    LatticeSettings settings;
    settings.periodic = { false, true, true };
    settings.netFlux = true;
    settings.tolerance = 1e-6;
    const LightField light = this->Solve(scene, settings, ior);
    const double part = 1.0 / (index * index), resistance = 1.0 + 0.75 * 5.0 * (12.0 + 12.0 * part) + (1.0 - part);
    EXPECT_NEAR(light.facePowerOut[0][0] / light.balance.entered[0] * resistance, 1.0, 1e-3) << index;
    for (std::size_t i = 0; i < 24; ++i)
    {
      EXPECT_NEAR(light.netFlux[3 * i], -light.facePowerOut[0][0], 1e-4 * light.facePowerOut[0][0]) << index;
    }
  }
}

/// The steady state takes few iterations where steps would be millions.
TEST_F(SteadyLattices, NeedFewIterationsWhateverTheThickness)
{
  for (const float tau : { 10.0f, 1e3f, 1e5f })
  {
    Scene scene({ 20, 20, 20 }, 0.0f, tau / 20.0f);
    scene.light.faces[2] = { 1.0, 1.0, 1.0 };
    const LightField light = this->Solve(scene);
    EXPECT_TRUE(light.converged) << tau;
    EXPECT_LT(light.convergence.size(), 25u) << tau;
    EXPECT_LT(std::abs(light.balance.leftOver[0]), 1e-5 * light.balance.entered[0]) << tau;
  }
}

TEST_F(SteadyLattices, ReportProgressAndStopWhenTold)
{
  for (const bool solves : { true, false })
  {
    Scene scene({ 12, 9, 10 }, 0.0f, 2.0f);
    scene.ShineFromEverywhere(1.0);
    LatticeSettings settings;
    settings.solvesSteady = solves;
    double last = 0.0;
    int told = 0;
    this->Solve(scene, settings, {}, [&](double done) {
      EXPECT_GE(done, last);
      EXPECT_LE(done, 1.0);
      last = done;
      ++told;
      return true;
    });
    EXPECT_GT(told, 5);
    EXPECT_THROW(this->Solve(scene, settings, {}, [&](double) { return --told > 2; }), Aborted);
  }
}

/// What voxels emit is absorbed on its way out of them as what comes in is, whatever lies beside them.
TEST_F(SteadyLattices, KeepAFurnaceBesideVoxelsThatAbsorb)
{
  for (const int directions : { 18, 6 })
  {
    for (const bool solves : { true, false })
    {
      Scene scene({ 6, 4, 5 });
      scene.Randomise(1e4, 8.0, 0.3, 5);
      scene.emission = scene.sigma_a;
      scene.light.sky = { 1.0, 1.0, 1.0 };
      LatticeSettings settings;
      settings.directions = directions;
      settings.solvesSteady = solves;
      settings.tolerance = 1e-6;
      const LightField light = this->Solve(scene, settings);
      for (std::size_t i = 0; i < light.fluence.size(); ++i)
      {
        ASSERT_NEAR(light.fluence[i] / (4.0 * Pi), 1.0, 1e-3) << "voxel " << i << ", " << directions << ", " << solves;
      }
      EXPECT_LT(std::abs(light.balance.leftOver[0]), 1e-5 * (light.balance.entered[0] + light.balance.emitted[0]));
    }
  }
}

TEST_F(SteadyLattices, RefuseWhiteVoxelsThatTheyCannotHold)
{
  Scene scene({ 3, 2, 2 }, 0.0f, 1.0f);
  scene.sigma_s[4] = 1e12f;
  scene.light.sky = { 1.0, 1.0, 1.0 };
  const std::string words = ErrorWords([&] { this->Solve(scene); });
  EXPECT_THAT(words, testing::HasSubstr("Voxel (1, 1, 0) has optical thickness 1e+12"));
  scene.sigma_a[4] = 1.0f; // which ends light
  EXPECT_NO_THROW(this->Solve(scene));
}
