// Planes that a sweep crosses row by row one behind the other, as it does where they are larger than a core's cache:
// the light is the same, bit for bit, as plane by plane.

#include "DeviceTest.h"
#include "MediumScene.h"
#include "RandomMedium.h"

#include <cstdlib>

using namespace tyndall;

namespace
{
/// As long as it lives all planes are larger than the cache.
struct NoCache
{
  NoCache() { setenv("TYNDALL_WITHOUT", "cache", 1); }
  ~NoCache() { unsetenv("TYNDALL_WITHOUT"); }
};

Scene RandomScene(const std::array<int, 3>& size)
{
  Scene scene(size);
  scene.medium.grid.spacing = { 1.0, 0.9, 1.2 };
  scene.Randomise(0.4, 2.0, 0.8);
  scene.ShineFromEverywhere(0.3);
  scene.ShineAlong({ 0.3, -0.5, -1.0 }, 2.0);
  scene.settings.directionsPerFace = 16;
  scene.settings.maximumOrders = 3;
  scene.settings.netFlux = true;
  return scene;
}
}

class ChainedPlanes : public DeviceTest
{
protected:
  void ExpectSame(Scene& scene)
  {
    const LightField expected = scene.Solve(GetDevice());
    const NoCache none;
    const LightField found = scene.Solve(GetDevice());
    EXPECT_EQ(found.fluence, expected.fluence);
    EXPECT_EQ(found.fluenceDirect, expected.fluenceDirect);
    EXPECT_EQ(found.netFlux, expected.netFlux);
    EXPECT_EQ(found.facePowerOut, expected.facePowerOut);
    EXPECT_EQ(found.balance.absorbed, expected.balance.absorbed);
    EXPECT_EQ(found.convergence.size(), expected.convergence.size());
  }
};

TEST_F(ChainedPlanes, HaveTheSameLight)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 21, 18, 37 }, { 3, 2, 5 }, { 17, 1, 1 }, { 1, 6, 33 } })
  {
    SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]));
    Scene scene = RandomScene(size);
    ExpectSame(scene);
  }
}

/// With partial currents.
TEST_F(ChainedPlanes, HaveTheSameLightWhereItConvergesInThickVoxels)
{
  Scene scene = RandomScene({ 12, 13, 19 });
  scene.Randomise(2.0, 6.0, 0.95);
  scene.settings.maximumOrders = 0;
  ExpectSame(scene);
}

/// What leaves by cells of the box's faces is the same but for the order of sums: rays along a face leave through cells
/// of several planes.
TEST_F(ChainedPlanes, HaveTheSamePowerByCellsOfFaces)
{
  Scene scene = RandomScene({ 14, 11, 23 });
  scene.settings.facePower = true;
  const LightField expected = scene.Solve(GetDevice());
  const NoCache none;
  const LightField found = scene.Solve(GetDevice());
  EXPECT_LT(RelativeRmse(found.facePower, expected.facePower), 1e-6);
  EXPECT_LT(RelativeRmse(found.fluence, expected.fluence), 1e-6);
}

TEST_F(ChainedPlanes, HaveTheSameLightRoundAPeriodicAxis)
{
  Scene scene = RandomScene({ 9, 11, 14 });
  scene.settings.periodic = { false, false, true };
  ExpectSame(scene);
}
