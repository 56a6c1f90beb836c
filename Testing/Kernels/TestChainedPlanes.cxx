// Planes that a sweep crosses row by row one behind the other, as it does where they are larger than a core's cache:
// the light is the same as plane by plane, bit for bit where all rows of a plane are crossed in one turn, else but for
// the order of sums; and bit for bit wherever ranges of planes begin.

#include "DeviceTest.h"
#include "Difference.h"
#include "MediumScene.h"
#include "RandomMedium.h"

#include "LightPropagation/Conservative/SolveMemory.h"
#include "LightPropagation/Sweep/SweepShared.h"

#include <cstdlib>

using namespace tyndall;

namespace
{
/// As long as it lives all planes are larger than the cache.
struct NoCache
{
  /// @param more  that the device hides
  explicit NoCache(const char* more = "") { setenv("TYNDALL_WITHOUT", (std::string("cache") + more).c_str(), 1); }
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

  struct InBoth
  {
    LightField found, expected;
  };

  /// In tiles of rows, and as it is without.
  InBoth InTilesAndWhole(Scene& scene)
  {
    InBoth light;
    light.expected = scene.Solve(GetDevice());
    const NoCache none;
    light.found = scene.Solve(GetDevice());
    if (GetDevice().IsCpu()) // else planes are not chained where SweepOnGpu sweeps
    {
      EXPECT_NE(light.found.fluence, light.expected.fluence) << "the same order: there are no tiles";
    }
    return light;
  }
};

TEST_F(ChainedPlanes, HaveTheSameLight)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 19, 18, 20 }, { 3, 2, 5 }, { 17, 1, 1 }, { 1, 6, 20 } })
  {
    SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]));
    Scene scene = RandomScene(size);
    ExpectSame(scene);
  }
}

/// Of planes of more rows than bundles cross in turns sums have another order.
TEST_F(ChainedPlanes, HaveTheSameLightInTilesOfRows)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 11, 2 * RowsOfChain + 5, 9 },
         { RowsOfChain + 1, 7, 3 * RowsOfChain }, { 5, 5 * RowsOfChain + 3, 4 } })
  {
    SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]));
    Scene scene = RandomScene(size);
    const auto [found, expected] = this->InTilesAndWhole(scene);
    EXPECT_LT(RelativeRmse(found.fluence, expected.fluence), 3e-7);
    EXPECT_LT(RelativeRmse(found.netFlux, expected.netFlux), 1e-6);
    for (int face = 0; face < 6; ++face)
    {
      EXPECT_NEAR(found.facePowerOut[face][0], expected.facePowerOut[face][0], 1e-6 * expected.facePowerOut[face][0]);
    }
  }
}

/// Slices that cut chains: their rows are crossed in the same order.
TEST_F(ChainedPlanes, AreTheSameBitForBitWhereTheyAreStreamed)
{
  Scene scene = RandomScene({ 37, 2 * RowsOfChain + 5, 45 });
  if (!GetDevice().IsCpu())
  {
    GTEST_SKIP() << "what a GPU holds whole it does not sweep by these kernels";
  }
  const NoCache none(" host_memory");
  const LightField whole = scene.Solve(GetDevice());
  const PropagationProblem problem(scene.medium, scene.light, scene.settings);
  const std::size_t bytes = BytesOfSolve(GetDevice(), problem, ChooseIterationScheme(problem));
  for (const int part : { 2, 5, 8 })
  {
    SCOPED_TRACE("within a part of " + std::to_string(part));
    scene.settings.memoryBudget = bytes / part;
    const LightField light = scene.Solve(GetDevice());
    EXPECT_NE(light.device.find("streamed"), std::string::npos) << light.device;
    EXPECT_EQ(light.fluence, whole.fluence);
    EXPECT_EQ(light.netFlux, whole.netFlux);
    EXPECT_EQ(light.facePowerOut, whole.facePowerOut);
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

/// Planes of more rows than scratch keeps: with partial currents, sources by octant, and rays that go round.
TEST_F(ChainedPlanes, HaveTheSameLightWhereRowsAreKept)
{
  for (const bool periodic : { false, true })
  {
    SCOPED_TRACE(periodic ? "periodic" : "open");
    Scene scene = RandomScene({ 5, 2 * RowsOfChainKept + 37, periodic ? 9 : 6 });
    scene.Randomise(periodic ? 0.4 : 6.0, 3.0, 0.95);
    scene.settings.periodic = { false, false, periodic };
    scene.settings.maximumOrders = periodic ? 3 : 0;
    const auto [found, expected] = this->InTilesAndWhole(scene);
    EXPECT_LT(RelativeRmse(found.fluence, expected.fluence), 1e-6);
    EXPECT_LT(RelativeRmse(found.netFlux, expected.netFlux), 3e-6);
    EXPECT_EQ(found.convergence.size(), expected.convergence.size());
    EXPECT_NEAR(found.balance.absorbed[0], expected.balance.absorbed[0], 1e-6 * expected.balance.absorbed[0]);
  }
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
