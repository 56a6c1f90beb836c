// The last light as a first guess: fewer sweeps to the same light (numerics.md, section 6.4).

#include "DeviceTest.h"
#include "Difference.h"
#include "Medium/Grid.h"
#include "OrdinatesScene.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

using namespace tyndall;

namespace
{
Light SunAt(double elevation, double azimuth)
{
  const double degree = 3.14159265358979323846 / 180.0;
  Light sun;
  sun.direction = { std::cos(elevation * degree) * std::cos(azimuth * degree),
    std::cos(elevation * degree) * std::sin(azimuth * degree), -std::sin(elevation * degree) };
  sun.power = { 2.0, 2.0, 2.0 };
  return sun;
}

/// A ragged cloud with clear air around it, under sun and sky; along another axis for another `seed`.
Scene Cloud(std::array<int, 3> size, double thickness, double albedo, unsigned seed = 1)
{
  Scene scene(size);
  const std::array<int, 3>& n = size;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> even(0.5, 1.5);
  ForGridVoxels(n, [&](std::size_t i, int x, int y, int z) {
    const double u = (x + 0.5) / n[0] - 0.45, v = (y + 0.5) / n[1] - 0.5, w = (z + 0.5) / n[2] - 0.55;
    const double inside = std::max(0.0, 0.14 - u * u - v * v - w * w) / 0.14;
    const double sigma_t = thickness / n[0] * inside * even(random);
    scene.sigma_s[i] = static_cast<float>(sigma_t * albedo);
    scene.sigma_a[i] = static_cast<float>(sigma_t * (1.0 - albedo));
  });
  scene.light.lights = { SunAt(50.0, 20.0 + 90.0 * seed) };
  scene.ShineFromEverywhere(0.2);
  return scene;
}

void Scatter(Scene& scene, double factor)
{
  std::transform(scene.sigma_s.begin(), scene.sigma_s.end(), scene.sigma_s.begin(),
    [factor](float value) { return static_cast<float>(factor * value); });
}

/// Moves the medium on by one voxel along x; what leaves comes in on the other side.
void Advect(Scene& scene)
{
  const int n = scene.medium.grid.size[0];
  for (std::vector<float>* field : { &scene.sigma_a, &scene.sigma_s })
  {
    for (std::size_t row = 0; row < field->size(); row += n)
    {
      const auto begin = field->begin() + static_cast<std::ptrdiff_t>(row);
      std::rotate(begin, begin + n - 1, begin + n);
    }
  }
}

void ScatterForwards(Scene& scene, double g, int degree)
{
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
  scene.settings.angularDegree = degree;
}
}

class WarmStarts : public DeviceTest
{
protected:
  /// Solves `before`, and `after` from its light: the same as from darkness, within the tolerance.
  struct Outcome
  {
    std::size_t cold, warm;
    double error, coldError;
  };
  Outcome Follow(Scene before, Scene after, const char* name)
  {
    KeptLight kept;
    before.Solve(this->GetDevice(), {}, &kept);
    const LightField cold = after.Solve(this->GetDevice());
    const LightField warm = after.Solve(this->GetDevice(), {}, &kept);
    Scene exactly = after;
    exactly.settings.tolerance = 1e-7;
    const LightField exact = exactly.Solve(this->GetDevice());
    const Outcome found = { cold.convergence.size(), warm.convergence.size(), RelativeRmse(warm.fluence, exact.fluence),
      RelativeRmse(cold.fluence, exact.fluence) };
    std::printf("%-44s %3zu -> %3zu sweeps, error %.2g (cold %.2g), residual %.2g\n", name, found.cold, found.warm,
      found.error, found.coldError, warm.convergence.back().residual);
    EXPECT_TRUE(warm.converged) << name;
    EXPECT_LT(found.error, after.settings.tolerance) << name;
    EXPECT_LT(warm.balance.RelativeError(warm.channels), 1e-5) << name;
    EXPECT_EQ(warm.fluenceDirect, cold.fluenceDirect) << name;
    EXPECT_GE(*std::min_element(warm.fluence.begin(), warm.fluence.end()), 0.0f) << name;
    for (int face = 0; face < 6; ++face)
    {
      EXPECT_NEAR(warm.facePowerOut[face][0], exact.facePowerOut[face][0],
        3.0 * after.settings.tolerance * (warm.balance.entered[0] + warm.balance.emitted[0]))
        << name << ", face " << face;
    }
    EXPECT_EQ(warm.sweepsSaved.size(), warm.convergence.size()) << name;
    return found;
  }

  /// Of a scene: a slider, the sun, the medium on its way, and nothing.
  void ExpectFewerSweeps(const Scene& scene, const std::string& name)
  {
    Scene after = scene;
    Outcome found = this->Follow(scene, after, (name + ", nothing changed").c_str());
    // Unscattered light and a sweep, with acceleration of moments two.
    EXPECT_LE(found.warm, scene.settings.angularDegree > 0 ? 3u : 2u);

    Scatter(after, 1.05);
    found = this->Follow(scene, after, (name + ", sigma_s 5% more").c_str());
    EXPECT_LT(found.warm, found.cold);

    after = scene;
    after.light.lights = { SunAt(55.0, 25.0) };
    Scene low = scene;
    low.light.lights = { SunAt(50.0, 25.0) };
    found = this->Follow(low, after, (name + ", sun 5 degrees on").c_str());
    EXPECT_LT(found.warm, found.cold);

    after = scene;
    Advect(after);
    found = this->Follow(scene, after, (name + ", a voxel on").c_str());
    EXPECT_LE(found.warm, found.cold);

    after = scene;
    after.light.lights[0].power = { 0.5, 0.5, 0.5 };
    after.light.sky = { 0.05, 0.05, 0.05 };
    found = this->Follow(scene, after, (name + ", a quarter of the light").c_str());
    EXPECT_LE(found.warm, scene.settings.angularDegree > 0 ? 3u : 2u);
  }
};

TEST_F(WarmStarts, TakeFewerOrdersOneAfterTheOther)
{
  Scene scene = Cloud({ 23, 17, 20 }, 6.0, 0.98);
  this->ExpectFewerSweeps(scene, "orders");
  scene.settings.leaveOut = false;
  this->ExpectFewerSweeps(scene, "orders, all computed");
}

TEST_F(WarmStarts, TakeFewerOrdersInAngularMoments)
{
  Scene scene = Cloud({ 18, 15, 21 }, 10.0, 0.98, 2);
  scene.settings.acceleration = PropagationAcceleration::None;
  ScatterForwards(scene, 0.7, 3);
  this->ExpectFewerSweeps(scene, "orders, g 0.7");
}

TEST_F(WarmStarts, TakeFewerAcceleratedSweeps)
{
  this->ExpectFewerSweeps(Cloud({ 23, 17, 20 }, 100.0, 1.0), "accelerated");
}

TEST_F(WarmStarts, TakeFewerAcceleratedSweepsInAngularMoments)
{
  Scene scene = Cloud({ 18, 15, 21 }, 200.0, 0.9999, 3);
  ScatterForwards(scene, 0.85, 3);
  this->ExpectFewerSweeps(scene, "accelerated, g 0.85");
}

TEST_F(WarmStarts, TakeFewerSweepsWhereASmoothMediumMovesOn)
{
  for (double thickness : { 6.0, 100.0 })
  {
    Scene scene({ 30, 22, 26 });
    for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
    {
      const double x = 0.21 * (i % 30), y = 0.25 * (i / 30 % 22), z = 0.2 * (i / 660);
      const double density = 1.0 + 0.9 * std::sin(x) * std::cos(y) * std::cos(z + 0.5);
      scene.sigma_s[i] = static_cast<float>(thickness / 30 * density);
      scene.sigma_a[i] = 0.01f * scene.sigma_s[i];
    }
    scene.light.lights = { SunAt(40.0, 200.0) };
    Scene after = scene;
    Advect(after);
    const Outcome found = this->Follow(scene, after, thickness < 10.0 ? "smooth, a voxel on" : "smooth, thick, on");
    EXPECT_LT(found.warm, found.cold);
  }
}

TEST_F(WarmStarts, TakeFewerSweepsInAThickWhiteSlab)
{
  for (double tau : { 100.0, 1e4 })
  {
    Scene scene({ 1, 40, 1 }, 0.0f, static_cast<float>(tau / 40));
    scene.settings.periodic = { true, false, true };
    scene.settings.source = PropagationSource::Linear; // along rays
    scene.light.faces[2] = { 1.0, 1.0, 1.0 };
    scene.ShineAlong({ 0.3, 0.9, 0.1 });
    Scene after = scene;
    Scatter(after, 1.05);
    const Outcome found = this->Follow(scene, after, "white slab, sigma_s 5% more");
    // At 2.5 mean free paths a voxel the solve from darkness takes 3 sweeps already, the least.
    EXPECT_LT(found.warm, std::max<std::size_t>(found.cold, 4));
    EXPECT_LE(this->Follow(scene, scene, "white slab, nothing changed").warm, 2u);
  }
}

TEST_F(WarmStarts, AreRightWhereAllHasChanged)
{
  for (double thickness : { 4.0, 60.0 })
  {
    Scene before = Cloud({ 17, 19, 15 }, thickness, 0.97, 2);
    before.light = {};
    before.ShineAlong({ 0.2, 0.1, -1.0 }, 1e9);
    Scene after = Cloud({ 17, 19, 15 }, 2.0 * thickness, 0.99, 5);
    after.light = {};
    after.ShineFromEverywhere(1e-3);
    this->Follow(before, after, "a bright sun gone, sky on, another cloud");

    Light lamp;
    lamp.type = LightType::Point;
    lamp.position = { 3.2, 4.1, 12.7 };
    lamp.power = { 100.0, 100.0, 100.0 };
    Scene lit = before;
    lit.light.lights = { lamp };
    Scene dark = before;
    dark.light = {};
    KeptLight kept;
    dark.Solve(this->GetDevice(), {}, &kept);
    const LightField first = lit.Solve(this->GetDevice(), {}, &kept);
    EXPECT_EQ(first.fluence, lit.Solve(this->GetDevice()).fluence) << "nothing was known";
    const LightField none = dark.Solve(this->GetDevice(), {}, &kept);
    EXPECT_EQ(*std::max_element(none.fluence.begin(), none.fluence.end()), 0.0f);
    Scene glowing = before;
    glowing.light = {};
    glowing.emission.assign(glowing.sigma_a.size(), 0.0f);
    glowing.emission[700] = 30.0f;
    glowing.emission[2000] = 1.0f;
    this->Follow(lit, glowing, "a lamp out, the medium glows");
  }
}

TEST_F(WarmStarts, KnowEachChannelByItself)
{
  for (double thickness : { 5.0, 80.0 })
  {
    Scene scene = Cloud({ 13, 16, 11 }, thickness, 0.98, 4);
    const std::vector<float> grey = scene.sigma_s;
    scene.sigma_s.clear();
    for (float sigma : grey)
    {
      scene.sigma_s.insert(scene.sigma_s.end(), { sigma, 0.5f * sigma, 0.1f * sigma });
    }
    Scene before = scene;
    before.light.sky = {};
    before.light.lights[0].power = { 1.0, 0.0, 2.0 }; // nothing is known of green
    this->Follow(before, scene, "green on");
    this->Follow(scene, before, "green off");
  }
}

TEST_F(WarmStarts, GoRoundPeriodicAxes)
{
  for (double thickness : { 2.0, 60.0 })
  {
    Scene scene = Cloud({ 14, 9, 12 }, thickness, 0.99, 3);
    scene.settings.periodic = { true, false, true };
    Scene after = scene;
    Scatter(after, 1.05);
    const Outcome found = this->Follow(scene, after, "periodic, sigma_s 5% more");
    EXPECT_LE(found.warm, found.cold);
  }
}

TEST_F(WarmStarts, DoNotDriftInALongSeries)
{
  for (double thickness : { 5.0, 100.0 })
  {
    Scene scene = Cloud({ 15, 14, 16 }, thickness, 0.99);
    KeptLight kept;
    std::size_t sweeps = 0;
    LightField warm;
    for (int step = 0; step < 12; ++step)
    {
      scene.light.lights = { SunAt(20.0 + 5.0 * step, 30.0) };
      Scatter(scene, 0.97);
      warm = scene.Solve(this->GetDevice(), {}, &kept);
      sweeps += warm.convergence.size();
    }
    const LightField cold = scene.Solve(this->GetDevice());
    std::printf("twelve steps: %zu sweeps, the last from darkness %zu\n", sweeps, cold.convergence.size());
    EXPECT_LT(sweeps, 12 * cold.convergence.size());
    EXPECT_LT(warm.balance.RelativeError(1), 1e-5);
    scene.settings.tolerance = 1e-7;
    EXPECT_LT(RelativeRmse(warm.fluence, scene.Solve(this->GetDevice()).fluence), 1e-4);
  }
}

TEST_F(WarmStarts, BeginInTheDarkWhereLightDoesNotFitAndSayWhy)
{
  Scene scene = Cloud({ 10, 9, 8 }, 4.0, 0.9);
  scene.settings.source = PropagationSource::Constant; // what voxels send by octant is not kept
  const auto expectCold = [this, &scene](Scene after, const char* why) {
    KeptLight kept;
    Scene before = scene;
    before.Solve(this->GetDevice(), {}, &kept);
    const LightField found = after.Solve(this->GetDevice(), {}, &kept);
    EXPECT_EQ(found.fluence, after.Solve(this->GetDevice()).fluence) << why;
    EXPECT_THAT(found.leftOut, testing::Contains(testing::HasSubstr(why)));
    EXPECT_EQ(found.sweepsSaved, std::vector<int>(found.convergence.size(), 0)) << why;
    if (after.settings.maximumOrders == 0)
    {
      EXPECT_LE(after.Solve(this->GetDevice(), {}, &kept).convergence.size(), 3u) << "the new light is kept";
    }
  };
  Scene after = Cloud({ 10, 9, 9 }, 4.0, 0.9);
  after.settings.source = PropagationSource::Constant;
  expectCold(after, "the grid has changed");
  after = scene;
  after.medium.grid.spacing = { 1.0, 1.1, 1.0 };
  expectCold(after, "the grid has changed");
  after = scene;
  after.light.sky = { 0.1, 0.2, 0.3 };
  after.light.lights[0].power = { 3.0, 0.1, 0.2 };
  expectCold(after, "the number of channels has changed");
  after = scene;
  ScatterForwards(after, 0.6, 2);
  expectCold(after, "the degree of angular moments has changed");
  after = scene;
  after.settings.directionsPerFace = 16;
  expectCold(after, "the directions have changed");
  after = scene;
  after.settings.periodic = { true, false, false };
  expectCold(after, "the periodic axes have changed");
  after = scene;
  Scatter(after, 100.0);
  expectCold(after, "the light was found by source iteration");
  after = scene;
  after.settings.maximumOrders = 4;
  expectCold(after, "MaximumOrders counts iterations from darkness on");
}

TEST_F(WarmStarts, ComeBackToAMediumThatScatteredNothing)
{
  const Scene scene = Cloud({ 10, 9, 8 }, 4.0, 0.9);
  Scene black = scene;
  Scatter(black, 0.0);
  KeptLight kept;
  for (Scene next : { scene, black, scene, scene })
  {
    const LightField found = next.Solve(this->GetDevice(), {}, &kept);
    EXPECT_LT(RelativeRmse(found.fluence, next.Solve(this->GetDevice()).fluence), 1e-4);
    EXPECT_LT(found.balance.RelativeError(1), 1e-5);
  }
}

TEST_F(WarmStarts, SayHowManySweepsTheySaved)
{
  Scene scene = Cloud({ 15, 14, 16 }, 5.0, 0.98);
  KeptLight kept;
  const LightField cold = scene.Solve(this->GetDevice(), {}, &kept);
  Scatter(scene, 1.05);
  const LightField warm = scene.Solve(this->GetDevice(), {}, &kept);
  EXPECT_THAT(cold.sweepsSaved, testing::Each(0));
  EXPECT_EQ(warm.sweepsSaved[0], 0);
  for (std::size_t row = 1; row < warm.convergence.size(); ++row)
  {
    const std::size_t same = row + warm.sweepsSaved[row];
    EXPECT_GT(cold.convergence[same - 1].residual, warm.convergence[row].residual);
    EXPECT_TRUE(same == cold.convergence.size() || cold.convergence[same].residual <= warm.convergence[row].residual);
  }
  EXPECT_GT(warm.sweepsSaved.back(), 2);
  EXPECT_TRUE(scene.Solve(this->GetDevice()).sweepsSaved.empty());
}

TEST_F(WarmStarts, AreNotMadeAsPublished)
{
  LitMedium scene({ 6, 5, 7 }, 0.05f, 0.4f);
  scene.ShineAlong({ 0.2, 0.1, -1.0 });
  scene.how.scheme = OrdinatesScheme::Published;
  scene.how.directionsPerFace = 4;
  scene.how.terms = 16;
  KeptLight kept;
  scene.SolveOrdinates(this->GetDevice(), {}, &kept);
  const LightField again = scene.SolveOrdinates(this->GetDevice(), {}, &kept);
  EXPECT_EQ(again.fluence, scene.SolveOrdinates(this->GetDevice()).fluence);
  EXPECT_THAT(again.leftOut, testing::Contains(testing::HasSubstr("as published begin in the dark")));
}

TEST_F(WarmStarts, AreNotMadeOfSourcesThatAreCutOrderByOrder)
{
  LitMedium scene({ 6, 5, 7 }, 0.05f, 0.4f);
  scene.ShineAlong({ 0.2, 0.1, -1.0 });
  scene.ScatterWith(0.8);
  scene.how.directionsPerFace = 9;
  KeptLight kept;
  scene.SolveOrdinates(this->GetDevice(), {}, &kept);
  const LightField again = scene.SolveOrdinates(this->GetDevice(), {}, &kept);
  EXPECT_EQ(again.fluence, scene.SolveOrdinates(this->GetDevice()).fluence);
  EXPECT_THAT(again.leftOut, testing::Contains(testing::HasSubstr("set to 0 order by order")));
}
