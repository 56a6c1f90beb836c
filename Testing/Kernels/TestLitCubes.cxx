// Cubes that diffuse light comes into through one face, by default settings, against Monte Carlo of another program.

#include "DeviceTest.h"
#include "MediumScene.h"

#include "Numerics/Constants.h"
#include "Reference/CubeReference.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

using namespace tyndall;

namespace
{
constexpr int Edge = 40; ///< voxels

/// Light of flux 1 through one face of a cube of side 1.
Scene LitCube(double tau, double albedo, int face)
{
  Scene scene({ Edge, Edge, Edge }, static_cast<float>(tau * (1.0 - albedo)), static_cast<float>(tau * albedo));
  scene.medium.grid.spacing = { 1.0 / Edge, 1.0 / Edge, 1.0 / Edge };
  scene.light.faces[face] = { 1.0 / Pi, 1.0 / Pi, 1.0 / Pi };
  return scene;
}

/// As the table has them: reflected, transmitted, through the four sides, absorbed.
std::array<double, 4> PartsOf(const LightField& light, int face)
{
  std::array<double, 4> parts = { light.facePowerOut[face][0], light.facePowerOut[face ^ 1][0], 0.0,
    light.balance.absorbed[0] };
  for (int side = 0; side < 6; ++side)
  {
    parts[2] += side / 2 != face / 2 ? light.facePowerOut[side][0] : 0.0;
  }
  return parts;
}

/// The root of the mean square of what block means differ by, relative.
/// @param face  that is lit; the reference's is -z
double DifferenceFrom(const CubeReference& reference, const std::vector<float>& fluence, int face)
{
  std::array<double, 1000> mean = {};
  const double voxels = std::pow(Edge / 10.0, 3);
  for (std::size_t i = 0; i < fluence.size(); ++i)
  {
    const auto voxel = static_cast<int>(i);
    const std::array<int, 3> block = { voxel % Edge * 10 / Edge, voxel / Edge % Edge * 10 / Edge,
      voxel / Edge / Edge * 10 / Edge };
    const int axis = face / 2, u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const int depth = face % 2 == 0 ? block[axis] : 9 - block[axis];
    mean[(depth * 10 + block[v]) * 10 + block[u]] += fluence[i] / voxels;
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < mean.size(); ++i)
  {
    squares += std::pow(mean[i] / reference[i].fluence - 1.0, 2);
  }
  return std::sqrt(squares / 1000.0);
}

struct Cube
{
  double tau, albedo;
};
}

class LitCubes
  : public DeviceTest
  , public testing::WithParamInterface<std::tuple<Cube, int>>
{
};

TEST_P(LitCubes, ShareTheirLightAsMonteCarloHasIt)
{
  const auto [cube, face] = this->GetParam();
  Scene scene = LitCube(cube.tau, cube.albedo, face);
  const LightField light = scene.Solve(this->GetDevice());
  const CubePowers powers = CubePowersOf(cube.tau, cube.albedo);
  const std::array<double, 4> found = PartsOf(light, face);
  for (int i = 0; i < 4; ++i)
  {
    EXPECT_NEAR(found[i], powers.part[i], 0.01 * std::max(powers.part[i], 0.01)) << "RTSA"[i];
  }
  EXPECT_NEAR(light.balance.entered[0], 1.0, 0.002);
  EXPECT_LT(light.balance.RelativeError(1), 1e-5);
  if (cube.tau == 1.0 && cube.albedo == 0.9)
  {
    EXPECT_LT(DifferenceFrom(CubeInDiffuseLight(), light.fluence, face), 0.015);
  }
}

INSTANTIATE_TEST_SUITE_P(Isotropic, LitCubes,
  testing::Combine(testing::Values(Cube{ 0.1, 0.5 }, Cube{ 0.1, 0.9 }, Cube{ 0.1, 1.0 }, Cube{ 1.0, 0.5 },
                     Cube{ 1.0, 0.9 }, Cube{ 1.0, 1.0 }, Cube{ 5.0, 0.5 }, Cube{ 5.0, 0.9 }, Cube{ 5.0, 1.0 },
                     Cube{ 10.0, 0.9 }, Cube{ 10.0, 1.0 }, Cube{ 50.0, 0.9 }, Cube{ 50.0, 1.0 }),
    testing::Range(0, 6)));
