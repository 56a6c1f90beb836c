#include "DeviceTest.h"
#include "Difference.h"
#include "Medium/Grid.h"
#include "MediumScene.h"

#include "Device/Errors.h"
#include "LightPropagation/Problem/ScatteringOrders.h"

#include <algorithm>
#include <cmath>

using namespace tyndall;

namespace
{
void ExpectNear(const std::vector<float>& a, const std::vector<float>& b, double tolerance)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    ASSERT_NEAR(a[i], b[i], tolerance * std::abs(b[i])) << i;
  }
}

/// sigma_t of every voxel of a cube of n voxels, at albedo.
template <class Density>
Scene Cube(int n, double albedo, Density&& density)
{
  Scene scene({ n, n, n });
  ForGridVoxels({ n, n, n }, [&](std::size_t i, int x, int y, int z) {
    const double sigma_t = density(x, y, z);
    scene.sigma_s[i] = static_cast<float>(sigma_t * albedo);
    scene.sigma_a[i] = static_cast<float>(sigma_t * (1.0 - albedo));
  });
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  return scene;
}

/// A smooth random field in [0, 1].
std::vector<double> SmoothNoise(int n)
{
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> field(static_cast<std::size_t>(n) * n * n);
  std::generate(field.begin(), field.end(), [&] { return normal(random); });
  for (int round = 0; round < 3; ++round)
  {
    const std::vector<double> rough = field;
    ForGridVoxels({ n, n, n }, [&](std::size_t i, int x, int y, int z) {
      field[i] = 0.0;
      for (int d = n - 1; d <= n + 1; ++d)
      {
        field[i] += rough[(z * n + y) * n + (x + d) % n] + rough[(z * n + (y + d) % n) * n + x] +
          rough[((z + d) % n * n + y) * n + x];
      }
    });
  }
  const auto [least, most] = std::minmax_element(field.begin(), field.end());
  const double low = *least, range = *most - *least;
  for (double& value : field)
  {
    value = (value - low) / range;
  }
  return field;
}

Scene Plain(Scene scene)
{
  scene.settings.acceleration = PropagationAcceleration::None;
  scene.settings.source = PropagationSource::Constant;
  return scene;
}
}

class Acceleration : public DeviceTest
{
protected:
  /// At most 20 sweeps to a true error of 1e-4, which the residual does not flatter; nothing negative, nothing lost.
  void ExpectFewSweeps(Scene scene, const char* name)
  {
    scene.settings.tolerance = 1e-8;
    const LightField exact = scene.Solve(this->GetDevice());
    scene.settings.tolerance = 1e-4;
    const LightField light = scene.Solve(this->GetDevice());
    const double error = RelativeRmse(light.fluence, exact.fluence);
    EXPECT_LE(light.convergence.size(), 20u) << name;
    EXPECT_LT(error, 1e-4) << name;
    EXPECT_LT(error, 2.0 * light.convergence.back().residual + 1e-7) << name;
    EXPECT_LT(light.balance.RelativeError(1), 1e-4) << name;
    EXPECT_GE(*std::min_element(light.fluence.begin(), light.fluence.end()), 0.0f) << name;
    EXPECT_GT(light.convergence.size(), 1u) << name;
    this->RecordProperty(name, std::to_string(light.convergence.size()) + " sweeps, error " + std::to_string(error));
  }
};

// By the thickest line of voxels alone nearly twice as many orders were expected.
TEST_F(Acceleration, ForecastsTheOrdersOfUnevenMedia)
{
  const int n = 24;
  const std::vector<double> noise = SmoothNoise(n);
  for (const double albedo : { 0.8, 0.9, 0.95 })
  {
    Scene scene = Plain(Cube(n, albedo, [&](int x, int y, int z) {
      return 0.02 * std::exp(6.0 * noise[static_cast<std::size_t>((z * n + y) * n + x)]);
    }));
    const double orders = static_cast<double>(scene.Solve(this->GetDevice()).convergence.size());
    const double expected = OrdersNeeded(PropagationProblem(scene.medium, scene.light, scene.settings, {}));
    EXPECT_GT(expected, 0.7 * orders) << albedo;
    EXPECT_LT(expected, 1.5 * orders) << albedo;
  }
}

TEST_F(Acceleration, NeedsFewSweepsInHomogeneousCubes)
{
  this->ExpectFewSweeps(Cube(32, 1.0, [](int, int, int) { return 100.0 / 32.0; }), "100");
  this->ExpectFewSweeps(Cube(32, 0.99, [](int, int, int) { return 100.0 / 32.0; }), "100, albedo 0.99");
  this->ExpectFewSweeps(Cube(32, 1.0, [](int, int, int) { return 1e4 / 32.0; }), "10000");
}

TEST_F(Acceleration, NeedsFewSweepsInCheckerboards)
{
  const auto board = [](int x, int y, int z) { return (x + y + z) % 2 ? 1e4 : 1e-4; };
  this->ExpectFewSweeps(Cube(32, 1.0, board), "checkerboard");
  this->ExpectFewSweeps(Cube(32, 0.99, board), "checkerboard, albedo 0.99");
}

TEST_F(Acceleration, NeedsFewSweepsAlongAVoidDuct)
{
  const auto duct = [](int x, int y, int) { return x >= 12 && x < 20 && y >= 12 && y < 20 ? 0.0 : 100.0 / 32.0; };
  this->ExpectFewSweeps(Cube(32, 1.0, duct), "duct");
}

TEST_F(Acceleration, NeedsFewSweepsInACloudWithAContrastOfAHundredMillion)
{
  const std::vector<double> noise = SmoothNoise(32);
  const auto cloud = [&](int x, int y, int z) { return std::pow(10.0, -4.0 + 8.0 * noise[(z * 32 + y) * 32 + x]); };
  this->ExpectFewSweeps(Cube(32, 1.0, cloud), "cloud");
  this->ExpectFewSweeps(Cube(32, 0.999, cloud), "cloud, albedo 0.999");
}

TEST_F(Acceleration, OfAConstantSourceEndsAtTheLightOfManyOrders)
{
  for (bool periodic : { false, true })
  {
    Scene scene({ 12, 11, 10 });
    scene.Randomise(20.0, 2.0, 0.99);
    scene.ShineFromEverywhere(1.0);
    scene.ShineAlong({ 0.3, -0.5, -0.8 }, 2.0);
    scene.emission.assign(scene.sigma_a.size(), 0.01f);
    scene.settings.periodic = { periodic, false, false };
    scene.settings.tolerance = 1e-6;
    scene.settings.source = PropagationSource::Constant;
    const LightField light = scene.Solve(this->GetDevice());
    const LightField exact = Plain(scene).Solve(this->GetDevice());
    EXPECT_GT(exact.convergence.size(), 100u);
    EXPECT_LT(light.convergence.size(), 12u);
    ExpectNear(light.fluence, exact.fluence, 5e-5);
    ExpectNear(light.fluenceDirect, exact.fluenceDirect, 1e-5);
    EXPECT_LT(light.balance.RelativeError(1), 1e-5);
    for (int face = 0; face < 6; ++face)
    {
      EXPECT_NEAR(light.facePowerOut[face][0], exact.facePowerOut[face][0], 1e-4 * exact.facePowerOut[face][0]) << face;
    }
  }
}

TEST_F(Acceleration, NetFluxIsTheSameThroughEveryPlaneOfASlabThatTakesNothing)
{
  Scene scene({ 3, 2, 20 }, 0.0f, 2.0f);
  scene.settings.periodic = { true, true, false };
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  scene.settings.netFlux = true;
  scene.settings.tolerance = 1e-6;
  const LightField light = scene.Solve(this->GetDevice());
  ASSERT_LT(light.convergence.size(), 20u) << "accelerated";
  // In the mean over a plane: which rays cross which of its voxels differs by half a percent.
  for (int z = 0; z < 20; ++z)
  {
    std::array<double, 3> sum = {};
    for (int i = 6 * z; i < 6 * z + 6; ++i)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        sum[axis] += light.netFlux[3 * i + axis];
      }
    }
    EXPECT_NEAR(sum[2] / light.facePowerOut[5][0], 1.0, 1e-4) << z;
    EXPECT_NEAR(sum[0] / light.facePowerOut[5][0], 0.0, 1e-4) << z;
    EXPECT_NEAR(sum[1] / light.facePowerOut[5][0], 0.0, 1e-4) << z;
  }
}

/// Thousands of rays come in through one cell of a slab's face: their sum in floats is off by 1e-5.
TEST_F(Acceleration, CountsWhatComesIntoSlabsToRounding)
{
  for (const int directions : { 64, 144 })
  {
    Scene scene({ 5, 1, 1 }, 0.001f, 5.0f);
    scene.light.faces[0] = { 1.0, 1.0, 1.0 };
    scene.settings.periodic = { false, true, true };
    scene.settings.adaptDirections = false;
    scene.settings.directionsPerFace = directions;
    for (const bool leaveOut : { false, true })
    {
      scene.settings.leaveOut = leaveOut;
      EXPECT_LT(scene.Solve(this->GetDevice()).balance.RelativeError(1), 1e-6) << directions;
    }
  }
}

TEST_F(Acceleration, LeavesThinMediaAsTheyAre)
{
  const auto thin = [](int, int, int) { return 0.05; };
  const Scene scene = Cube(16, 0.9, thin);
  Scene automatic = scene;
  EXPECT_EQ(automatic.Solve(this->GetDevice()).fluence, Plain(scene).Solve(this->GetDevice()).fluence);
}

TEST_F(Acceleration, TakesAnyGrid)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 1, 1, 1 }, { 1, 1, 200 }, { 40, 1, 3 }, { 2, 3, 5 } })
  {
    for (bool periodic : { false, true })
    {
      Scene scene(size, 0.001f, 3.0f);
      scene.medium.grid.spacing = { 0.5, 1.0, 2.0 };
      scene.ShineFromEverywhere(1.0);
      scene.ShineAlong({ 0.3, -0.5, -0.8 }, 2.0);
      scene.settings.periodic = { periodic, false, false };
      scene.settings.source = PropagationSource::Linear;
      const LightField light = scene.Solve(this->GetDevice());
      EXPECT_LT(light.balance.RelativeError(1), 1e-4) << size[0] << " " << size[1] << " " << size[2];
      EXPECT_LE(light.convergence.size(), 20u);
    }
  }
}

TEST_F(Acceleration, RefusesALinearSourceWithoutIt)
{
  Scene scene({ 2, 2, 2 }, 1.0f, 1.0f);
  scene.settings.source = PropagationSource::Linear;
  scene.settings.acceleration = PropagationAcceleration::None;
  EXPECT_THROW(scene.Solve(this->GetDevice()), InvalidInput);
}
