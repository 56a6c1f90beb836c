// Photons that are scattered in a medium that is spread over ranks, against those in the whole on one.

#include "BlocksOfScene.h"
#include "DeviceTest.h"
#include "PhotonWays.h"

#include "PhaseFunction/PhaseOfMedium.h"

#include <cmath>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
/// Sums of floats in another order; what each row of voxels absorbs is in whole units, and blocks have more rows.
void ExpectSamePower(const Rgb& found, const Rgb& expected, double all, const char* what)
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(found[c], expected[c], 1e-9 * all) << what << ", channel " << c;
  }
}

/// Arrays bit for bit, and as many scatterings.
void ExpectScatteredLightOfTheWhole(const PhotonLight& found, const PhotonLight& expected)
{
  EXPECT_EQ(found.light.fluence, expected.light.fluence);
  EXPECT_EQ(found.light.fluenceDirect, expected.light.fluenceDirect);
  EXPECT_EQ(found.light.fluenceError, expected.light.fluenceError);
  EXPECT_EQ(found.meanDirection, expected.meanDirection);
  EXPECT_EQ(found.scatterings, expected.scatterings);
  EXPECT_EQ(found.light.channels, expected.light.channels);
  const EnergyBalance &balance = found.light.balance, &wanted = expected.light.balance;
  const double all = Sum(wanted.entered);
  ExpectSamePower(balance.entered, wanted.entered, all, "entered");
  ExpectSamePower(balance.absorbed, wanted.absorbed, all, "absorbed");
  ExpectSamePower(balance.escaped, wanted.escaped, all, "escaped");
  ExpectSamePower(balance.leftOver, wanted.leftOver, all, "left over");
  ExpectSamePower(found.exchanged, expected.exchanged, all, "exchanged");
  ExpectSamePower(found.scattered, expected.scattered, all, "scattered");
  for (std::size_t face = 0; face < 6; ++face)
  {
    ExpectSamePower(found.light.facePowerOut[face], expected.light.facePowerOut[face], all, "through a face");
  }
  EXPECT_LT(balance.RelativeError(found.light.channels), 1e-5);
}

void ExpectSameOnRanks(
  Device& device, PhotonScene& scene, const std::vector<Photon>& photons, const std::vector<int>& ranks)
{
  const PhotonLight expected = scene.March(device, photons);
  EXPECT_GT(expected.scatterings, 0u);
  for (const int number : ranks)
  {
    SCOPED_TRACE(std::to_string(number) + " ranks");
    ExpectScatteredLightOfTheWhole(
      LightOfAll(device, scene, BlockPartition::Even(scene.medium.grid, number), photons), expected);
  }
}

PhotonScene ScatteringScene(std::size_t components = 1)
{
  PhotonScene scene = SmallScene(components);
  scene.settings.maximumOrders = 0;
  return scene;
}
}

class ScatteredBlocks : public DeviceTest
{
};

TEST_F(ScatteredBlocks, HaveTheLightOfTheWholeBitForBit)
{
  PhotonScene scene = ScatteringScene();
  ExpectSameOnRanks(GetDevice(), scene, AnyPhotons(scene.medium.grid, 3000), { 1, 3, 8 });
}

TEST_F(ScatteredBlocks, HaveItForSoManyOrders)
{
  PhotonScene scene = ScatteringScene();
  for (const int orders : { 2, 3, 7 })
  {
    SCOPED_TRACE(std::to_string(orders) + " orders");
    scene.settings.maximumOrders = orders;
    scene.settings.seed = static_cast<std::uint64_t>(orders);
    ExpectSameOnRanks(GetDevice(), scene, AnyPhotons(scene.medium.grid, 1000), { 4 });
  }
}

TEST_F(ScatteredBlocks, HaveItWhereRaysBend)
{
  PhotonScene scene = ScatteringScene();
  scene.SetBall(0.6, 1.5, 1.0);
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 500);
  for (const int order : { 1, 2, 4 })
  {
    SCOPED_TRACE("order " + std::to_string(order));
    scene.settings.order = order;
    ExpectSameOnRanks(GetDevice(), scene, photons, { 2, 8 });
  }
}

/// Steps are shorter for the jumps of the index, which only some blocks have.
TEST_F(ScatteredBlocks, HaveItWhereTheIndexJumpsInOneBlock)
{
  PhotonScene scene = ScatteringScene();
  scene.SetIndex([](double x, double y, double z) { return x < -0.3 && y < -0.3 && z < -0.3 ? 2.0 : 1.0; });
  ExpectSameOnRanks(GetDevice(), scene, AnyPhotons(scene.medium.grid, 500), { 3, 8 });
}

TEST_F(ScatteredBlocks, HaveItByTheStepsOfAnOctree)
{
  for (const std::size_t components : { std::size_t(1), std::size_t(3) })
  {
    PhotonScene scene = SceneOfNodes(components == 1, components);
    scene.settings.order = components == 1 ? 4 : 2;
    scene.settings.maximumOrders = 0;
    ExpectSameOnRanks(GetDevice(), scene, AnyPhotons(scene.medium.grid, 500), { 1, 3, 8 });
  }
}

TEST_F(ScatteredBlocks, HaveItByEachPhaseFunction)
{
  PhotonScene scene = ScatteringScene();
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 500);
  for (const PhaseFunction& phase : { PhaseFunction::HenyeyGreenstein(0.8), PhaseFunction::Schlick(-0.4),
         PhaseFunction::Rayleigh(), PhaseFunction::DoubleHenyeyGreenstein(0.9, -0.3, 0.7) })
  {
    scene.medium.phase = phase;
    ExpectSameOnRanks(GetDevice(), scene, photons, { 3 });
  }
  std::vector<float> g(scene.medium.grid.VoxelCount());
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    g[i] = 0.9f * static_cast<float>(std::sin(0.37 * static_cast<double>(i)));
  }
  scene.medium.phase = PhaseOfMedium(PhaseFunction::HenyeyGreenstein(0.0), { g.data(), 1 });
  ExpectSameOnRanks(GetDevice(), scene, photons, { 3, 8 });
}

TEST_F(ScatteredBlocks, HaveItInColour)
{
  PhotonScene scene = ScatteringScene(3);
  scene.SetBall(0.6, 1.3, 1.0);
  std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 500);
  ExpectSameOnRanks(GetDevice(), scene, photons, { 3 });
  PhotonScene grey = ScatteringScene();
  for (std::size_t i = 0; i < photons.size(); ++i)
  {
    photons[i].power[i % 3] *= 3.0f;
  }
  ExpectSameOnRanks(GetDevice(), grey, photons, { 3 });
  grey.medium.phase = PhaseOfMedium(std::array<PhaseFunction, 3>{
    PhaseFunction::HenyeyGreenstein(0.1), PhaseFunction::HenyeyGreenstein(0.5), PhaseFunction::Rayleigh() });
  ExpectSameOnRanks(GetDevice(), grey, photons, { 3 });
}

TEST_F(ScatteredBlocks, HaveItsStandardErrorByBatches)
{
  PhotonScene scene = ScatteringScene();
  scene.settings.errorBatches = 4;
  ExpectSameOnRanks(GetDevice(), scene, AnyPhotons(scene.medium.grid, 1001), { 2, 5 });
}

TEST_F(ScatteredBlocks, HaveItByEitherKindOfSums)
{
  PhotonScene scene = ScatteringScene();
  scene.settings.meanDirection = false;
  for (const MarchSettings::Sums sums : { MarchSettings::Sums::Private, MarchSettings::Sums::Shared })
  {
    scene.settings.sums = sums;
    ExpectSameOnRanks(GetDevice(), scene, AnyPhotons(scene.medium.grid, 500), { 3 });
  }
}

TEST_F(ScatteredBlocks, MayBeUnevenEmptyOrOneVoxel)
{
  PhotonScene scene = ScatteringScene();
  scene.SetBall(0.6, 1.5, 1.0);
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 500);
  const PhotonLight expected = scene.March(GetDevice(), photons);
  ExpectScatteredLightOfTheWhole(LightOfAll(GetDevice(), scene, UnevenBlocks(scene), photons), expected);

  PhotonScene tiny({ 3, 2, 2 }, 0.5, 0.5, 0.3f, 4.0f);
  tiny.settings.maximumOrders = 0;
  tiny.SetBall(0.5, 1.5, 1.0);
  ExpectSameOnRanks(GetDevice(), tiny, AnyPhotons(tiny.medium.grid, 300), { 12, 13 });
}

/// Scattered on walls between blocks, which rounding puts into either: none is lost.
TEST_F(ScatteredBlocks, KeepWhatIsScatteredOnTheirFaces)
{
  PhotonScene scene({ 8, 8, 8 }, 1.0, 4.0, 0.0f, 3000.0f);
  scene.settings.maximumOrders = 30;
  std::vector<Photon> photons;
  for (int i = 0; i < 400; ++i)
  {
    Photon photon;
    photon.position = { i % 4 - 2.0, i / 4 % 5 - 2.0, 0.01 * (i % 7) };
    photon.direction = { 1.0f, 0.0f, 0.0f };
    photon.power = { 1.0f, 1.0f, 1.0f };
    photons.push_back(photon);
  }
  ExpectSameOnRanks(GetDevice(), scene, photons, { 8, 64 });
}

TEST_F(ScatteredBlocks, HaveNoScatteredLightWhereNothingScatters)
{
  PhotonScene scene({ 6, 5, 4 }, 0.2, 0.5, 0.5f, 0.0f);
  scene.settings.maximumOrders = 0;
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 100);
  const PhotonLight found = LightOfAll(GetDevice(), scene, BlockPartition::Even(scene.medium.grid, 3), photons);
  EXPECT_EQ(found.light.fluence, scene.March(GetDevice(), photons).light.fluence);
  EXPECT_EQ(found.light.fluenceDirect, found.light.fluence);
  EXPECT_EQ(found.scatterings, 0u);
}

TEST_F(ScatteredBlocks, SayOnEachWhatGoesWrongOnOne)
{
  PhotonScene scene = ScatteringScene();
  const BlockPartition partition = BlockPartition::Even(scene.medium.grid, 3);
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 200);
  for (const bool stops : { false, true })
  {
    std::vector<std::string> errors(3);
    RunInThreads(3, [&](Communicator& communicator) {
      const int rank = communicator.Rank();
      BlockOfScene part(scene, partition.blocks[rank]);
      part.medium.phase = PhaseFunction::HenyeyGreenstein(rank == 1 && !stops ? 0.5 : 0.0);
      const Monitor monitor = [&](double done) { return !(stops && rank == 1 && done > 0.1); };
      try
      {
        PhotonMarcherInBlocks(GetDevice(), communicator, partition, part.medium, part.Index(), scene.settings)
          .March(ShareOf(photons, rank, 3), monitor);
      }
      catch (const std::exception& error)
      {
        errors[rank] = error.what();
      }
    });
    for (const std::string& error : errors)
    {
      EXPECT_NE(error.find(stops ? "aborted" : "disagree about g"), std::string::npos) << error;
    }
  }
}
