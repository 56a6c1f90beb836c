#include "DeviceTest.h"
#include "Difference.h"
#include "Medium/Grid.h"
#include "MediumScene.h"

#include "LightPropagation/Problem/ScatteringOrders.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <tuple>
#include <utility>

using namespace tyndall;

namespace
{
/// A round cloud, off the middle, in a thin haze: edges of voxels differ, rows do not fill cells.
/// @param divided  into so many along each axis, the same cloud
Scene Cloud(double tau, double albedo, double haze, int divided = 1)
{
  const std::array<int, 3> n = { 19 * divided, 26 * divided, 13 * divided };
  Scene scene(n);
  scene.medium.grid.spacing = { 1.0 / divided, 0.75 / divided, 1.5 / divided };
  ForGridVoxels(n, [&](std::size_t i, int u, int v, int w) {
    const int x = u / divided, y = v / divided, z = w / divided;
    const double r = std::hypot(x - 8.0, 0.75 * (y - 14.0), 1.5 * (z - 6.0));
    const double sigma_t = tau / 19.0 * (r < 7.0 ? 1.0 + 0.3 * std::sin(x + 2.0 * y) : haze);
    scene.sigma_s[i] = static_cast<float>(albedo * sigma_t);
    scene.sigma_a[i] = static_cast<float>((1.0 - albedo) * sigma_t);
  });
  scene.ShineAlong({ 0.4, 0.3, -0.8 }, 2.0);
  scene.light.faces[1] = { 0.7, 0.7, 0.7 };
  return scene;
}

/// Means over the voxels that were divided.
std::vector<float> Means(const Scene& scene, const LightField& light, int divided)
{
  const std::array<int, 3>& n = scene.medium.grid.size;
  std::vector<float> means(light.fluence.size() / (divided * divided * divided), 0.0f);
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    const std::size_t x = i % n[0], y = i / n[0] % n[1], z = i / n[0] / n[1];
    means[(z / divided * (n[1] / divided) + y / divided) * (n[0] / divided) + x / divided] +=
      light.fluence[i] / static_cast<float>(divided * divided * divided);
  }
  return means;
}

IterationScheme How(Scene scene)
{
  scene.Attach();
  return ChooseIterationScheme(PropagationProblem(scene.medium, scene.light, scene.settings, {}));
}

/// Cubes of eight voxels, each a hundred times as thick as the next one or as thin.
/// @param tau  of a voxel of the thick ones
Scene Blocks(double tau, double albedo)
{
  constexpr int Edge = 24, Block = 8;
  Scene scene({ Edge, Edge, Edge });
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    const std::array<int, 3> at = scene.medium.grid.VoxelAt(i);
    const bool thick = (at[0] / Block + at[1] / Block + at[2] / Block) % 2 == 0;
    scene.sigma_s[i] = static_cast<float>(albedo * (thick ? tau : 0.01 * tau));
    scene.sigma_a[i] = static_cast<float>((1.0 - albedo) * (thick ? tau : 0.01 * tau));
  }
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  return scene;
}

/// Two balls apart from each other, with nothing around them.
/// @param tau  of a voxel in their middles
Scene Cloudlets(double tau, double albedo)
{
  Scene scene({ 32, 32, 32 });
  const std::array<std::array<double, 3>, 2> middles = { { { 10.0, 11.0, 9.0 }, { 22.0, 20.0, 24.0 } } };
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    const std::array<int, 3> at = scene.medium.grid.VoxelAt(i);
    double density = 0.0;
    for (const std::array<double, 3>& middle : middles)
    {
      const double away = std::hypot(at[0] + 0.5 - middle[0], at[1] + 0.5 - middle[1], at[2] + 0.5 - middle[2]);
      density = std::max(density, std::clamp(3.0 * (1.0 - away / 8.0), 0.0, 1.0));
    }
    scene.sigma_s[i] = static_cast<float>(albedo * tau * density);
    scene.sigma_a[i] = static_cast<float>((1.0 - albedo) * tau * density);
  }
  scene.ShineAlong({ -0.5, 0.4, -0.8 }, 1.0);
  return scene;
}

Scene Plain(Scene scene)
{
  scene.settings.acceleration = PropagationAcceleration::None;
  return scene;
}
}

class DiffusionOnCells : public DeviceTest
{
};

TEST_F(DiffusionOnCells, EndsAtTheLightOfManyOrders)
{
  for (const double haze : { 1.0, 0.01 })
  {
    for (const bool periodic : { false, true })
    {
      Scene scene = Cloud(4.5, 0.995, haze);
      scene.emission.assign(scene.sigma_a.size(), 0.003f);
      scene.settings.periodic = { false, periodic, false };
      scene.settings.source = PropagationSource::Constant;
      scene.settings.uncollidedDirections = 0;
      scene.settings.tolerance = 1e-6;
      scene.settings.netFlux = true;
      ASSERT_EQ(How(scene), IterationScheme::CoarseMeshDsa) << haze;
      const LightField light = scene.Solve(this->GetDevice());
      const LightField exact = Plain(scene).Solve(this->GetDevice());
      EXPECT_LE(light.convergence.size(), 16u) << haze;
      EXPECT_GT(exact.convergence.size(), 2 * light.convergence.size()) << haze;
      EXPECT_LT(RelativeRmse(light.fluence, exact.fluence), 1e-5) << haze << periodic;
      EXPECT_LT(RelativeRmse(light.netFlux, exact.netFlux), 1e-5) << haze << periodic;
      if (!periodic) // else rays are on the way when the first order ends
      {
        EXPECT_LT(RelativeRmse(light.fluenceDirect, exact.fluenceDirect), 1e-6) << haze;
      }
      EXPECT_LT(light.balance.RelativeError(1), 1e-5) << haze << periodic;
      for (int face = 0; face < 6; ++face)
      {
        EXPECT_NEAR(light.facePowerOut[face][0], exact.facePowerOut[face][0], 2e-5 * light.balance.escaped[0]) << face;
      }
    }
  }
}

TEST_F(DiffusionOnCells, TellsItsErrorAndCountsItsPower)
{
  for (const double tau : { 2.0, 4.5 })
  {
    for (const double albedo : { 0.97, 1.0 })
    {
      Scene scene = Cloud(tau, albedo, 0.05);
      scene.settings.source = PropagationSource::Linear;
      ASSERT_EQ(How(scene), IterationScheme::CoarseMeshDsa) << tau;
      const LightField light = scene.Solve(this->GetDevice());
      scene.settings.tolerance = 1e-7;
      const LightField exact = scene.Solve(this->GetDevice());
      const double error = RelativeRmse(light.fluence, exact.fluence);
      EXPECT_LT(error, 1e-4) << tau << ' ' << albedo;
      EXPECT_LT(error, 2.0 * light.convergence.back().residual) << tau << ' ' << albedo;
      EXPECT_LE(light.convergence.size(), 12u) << tau << ' ' << albedo;
      EXPECT_LT(light.balance.RelativeError(1), 1e-5) << tau << ' ' << albedo;
      EXPECT_LT(std::abs(light.balance.leftOver[0]), 1e-4 * light.balance.entered[0]) << tau << ' ' << albedo;
    }
  }
}

/// Light goes through gaps as thin cells let it, neither faster nor slower: else what is left swings or creeps.
TEST_F(DiffusionOnCells, CrossesGapsInFewSweeps)
{
  const std::array<std::pair<Scene, std::size_t>, 2> cases = { { { Blocks(0.3, 1.0), 7 },
    { Cloudlets(0.45, 0.99), 8 } } };
  for (std::size_t i = 0; i < cases.size(); ++i)
  {
    Scene scene = cases[i].first;
    scene.settings.source = PropagationSource::Constant;
    scene.settings.uncollidedDirections = 0;
    ASSERT_EQ(How(scene), IterationScheme::CoarseMeshDsa) << i;
    const LightField light = scene.Solve(this->GetDevice());
    EXPECT_LE(light.convergence.size(), cases[i].second) << i;
    scene.settings.tolerance = 1e-6;
    EXPECT_LT(RelativeRmse(light.fluence, Plain(scene).Solve(this->GetDevice()).fluence), 1e-4) << i;
  }
}

TEST(CellsOfVoxels, AreAboutAMeanFreePathWideAtMost)
{
  Grid grid;
  grid.size = { 16, 16, 16 };
  EXPECT_EQ(CellHalvings(grid, 0.12), (std::array<int, 3>{ 3, 3, 3 }));
  EXPECT_EQ(CellHalvings(grid, 0.24), (std::array<int, 3>{ 2, 2, 2 }));
  EXPECT_EQ(CellHalvings(grid, 0.49), (std::array<int, 3>{ 1, 1, 1 }));
  EXPECT_EQ(CellHalvings(grid, 0.51), (std::array<int, 3>{ 0, 0, 0 }));
  grid.size = { 1, 3, 16 };
  EXPECT_EQ(CellHalvings(grid, 0.12), (std::array<int, 3>{ 0, 2, 3 }));
}

/// Which is a solution of its own. Light that is right is that of voxels a third as wide.
TEST_F(DiffusionOnCells, IsAsRightAsTheBalanceOfVoxels)
{
  Scene fine = Plain(Cloud(4.5, 0.995, 0.05, 3));
  fine.settings.uncollidedDirections = 0;
  fine.settings.tolerance = 1e-5;
  const std::vector<float> right = Means(fine, fine.Solve(this->GetDevice()), 3);
  Scene scene = Cloud(4.5, 0.995, 0.05);
  scene.settings.uncollidedDirections = 0;
  ASSERT_EQ(How(scene), IterationScheme::CoarseMeshDsa);
  const double byCells = RelativeRmse(scene.Solve(this->GetDevice()).fluence, right);
  scene.settings.source = PropagationSource::Linear;
  scene.light.faceAlbedo[0] = { 1e-9, 1e-9, 1e-9 }; // faces that reflect are not for cells
  ASSERT_EQ(How(scene), IterationScheme::Dsa);
  const double byBalance = RelativeRmse(scene.Solve(this->GetDevice()).fluence, right);
  EXPECT_LT(byCells, 1.1 * byBalance);
}

TEST_F(DiffusionOnCells, KeepsEvenLightEven)
{
  Scene scene = Cloud(4.5, 1.0, 0.3);
  scene.light = {};
  scene.ShineFromEverywhere(1.0);
  scene.settings.tolerance = 1e-6;
  ASSERT_EQ(How(scene), IterationScheme::CoarseMeshDsa);
  for (const float fluence : scene.Solve(this->GetDevice()).fluence)
  {
    ASSERT_NEAR(fluence / (4.0 * M_PI), 1.0, 2e-5);
  }
}

namespace
{
/// Uneven haze without faces, in which light goes round hundreds of times, lit by a lamp or by two of its voxels.
/// @param thickest  mean free paths of a voxel, at most
/// @param parts  of that, of each channel
Scene ThinBoxWithoutFaces(double thickest, const std::vector<double>& parts, bool lamp)
{
  Scene scene({ 6, 5, 5 });
  scene.medium.grid.spacing = { 0.4, 0.4, 0.4 };
  const std::size_t voxels = scene.sigma_a.size();
  scene.sigma_a.clear();
  scene.sigma_s.clear();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (std::size_t i = 0; i < voxels; ++i)
  {
    const double sigma_t = thickest / 0.4 * unit(random);
    for (const double part : parts)
    {
      scene.sigma_a.push_back(static_cast<float>(0.3 * sigma_t * part));
      scene.sigma_s.push_back(static_cast<float>(0.7 * sigma_t * part));
    }
  }
  scene.settings.periodic = { true, true, true };
  if (lamp)
  {
    scene.light.lights = { PointLamp({ 0.7, 1.2, 0.9 }, { 1.0, 1.0, 1.0 }) };
    return scene;
  }
  scene.emission.assign(voxels, 0.0f);
  scene.emission[20] = scene.emission[77] = 1.0f;
  return scene;
}
}

/// A sweep ends before the medium has taken all of it: what is on the way is light to come, and even.
TEST_F(DiffusionOnCells, GiveThinBoxesWithoutFacesAllTheirLight)
{
  const std::vector<double> grey = { 1.0 }, colours = { 10.0, 3.0, 1.0 };
  for (const auto& [thickest, parts, lamp] :
    { std::tuple(1e-3, grey, true), { 1e-3, grey, false }, { 1e-6, grey, false }, { 1e-3, colours, true } })
  {
    Scene scene = ThinBoxWithoutFaces(thickest, parts, lamp);
    ASSERT_EQ(How(scene), IterationScheme::CoarseMeshDsa);
    const LightField light = scene.Solve(this->GetDevice());
    for (std::size_t c = 0; c < parts.size(); ++c)
    {
      SCOPED_TRACE(std::to_string(thickest) + " channel " + std::to_string(c));
      const double in = light.balance.entered[c] + light.balance.emitted[c];
      EXPECT_NEAR(light.balance.absorbed[c] / in, 1.0, 2e-4);
      const double uneven = !lamp ? 0.2 : parts[c] > 1.0 ? 0.3 : 0.02; // voxels that shine are the brightest
      double absorbs = 0.0;
      for (std::size_t i = c; i < scene.sigma_a.size(); i += parts.size())
      {
        absorbs += scene.sigma_a[i] * scene.medium.grid.VoxelVolume();
      }
      for (std::size_t i = c; i < light.fluence.size(); i += parts.size())
      {
        ASSERT_NEAR(light.fluence[i] * absorbs / in, 1.0, uneven);
      }
    }
    EXPECT_LT(light.balance.RelativeError(static_cast<int>(parts.size())), 2e-4); // floats, round thousands of times
  }
}

TEST_F(DiffusionOnCells, TellsWhatLeavesThroughEachCellOfAFace)
{
  Scene scene = Cloud(4.5, 0.995, 0.05);
  scene.settings.facePower = true;
  ASSERT_EQ(How(scene), IterationScheme::CoarseMeshDsa);
  const LightField light = scene.Solve(this->GetDevice());
  const Grid& grid = scene.medium.grid;
  std::size_t cell = 0;
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2;
    const auto cells = grid.VoxelCount() / static_cast<std::size_t>(grid.size[axis]);
    double power = 0.0;
    for (std::size_t i = 0; i < cells; ++i, ++cell)
    {
      power += light.facePower[cell] * grid.VoxelVolume() / grid.spacing[axis];
    }
    EXPECT_NEAR(power / light.facePowerOut[face][0], 1.0, 1e-4) << face;
  }
}

TEST_F(DiffusionOnCells, BeginsFromTheLastLight)
{
  Scene scene = Cloud(4.5, 0.999, 0.05);
  KeptLight kept;
  const LightField first = scene.Solve(this->GetDevice(), {}, &kept);
  const LightField again = scene.Solve(this->GetDevice(), {}, &kept);
  EXPECT_LT(again.convergence.size(), first.convergence.size());
  EXPECT_LT(RelativeRmse(again.fluence, first.fluence), 1e-4);
  for (float& sigma_s : scene.sigma_s)
  {
    sigma_s *= 1.05f;
  }
  const LightField warm = scene.Solve(this->GetDevice(), {}, &kept);
  const LightField cold = scene.Solve(this->GetDevice());
  EXPECT_LE(warm.convergence.size(), cold.convergence.size());
  EXPECT_LT(RelativeRmse(warm.fluence, cold.fluence), 1e-4);
  EXPECT_LT(warm.balance.RelativeError(1), 1e-5);
}
