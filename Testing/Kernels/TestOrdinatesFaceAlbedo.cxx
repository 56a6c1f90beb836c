#include "DeviceTest.h"
#include "OrdinatesScene.h"
#include "ReflectingScene.h"

#include "Device/Errors.h"
#include "Reference/ReferenceTable.h"

#include <gmock/gmock.h>

#include <cmath>

using namespace tyndall;

namespace
{
/// A slab above ground.
LitMedium SlabOverGround(double tau, double albedo, double g, double ground, double cosine, int layers)
{
  LitMedium slab(
    { 1, 1, layers }, static_cast<float>((1.0 - albedo) * tau / layers), static_cast<float>(albedo * tau / layers));
  slab.how.periodic = { true, true, false };
  slab.how.tolerance = 1e-5;
  slab.ScatterWith(g);
  LightOverGround(slab, ground, cosine);
  return slab;
}

struct Powers
{
  double reflected, taken;
};

Powers PowersOf(const LightField& light)
{
  const double in = light.balance.entered[0];
  return { light.facePowerOut[5][0] / in, light.facePowerOut[4][0] / in };
}
}

class OrdinatesFaceAlbedo : public DeviceTest
{
};

TEST_F(OrdinatesFaceAlbedo, KeepsEvenLightEvenWhateverEachFaceGivesBack)
{
  const Rgb colour = { 1.0, 0.5, 2.0 };
  LitMedium scene({ 7, 5, 9 });
  MakeReflectingFurnace(scene, 1.0, 0.5, colour);
  scene.how.directionsPerFace = 9;
  scene.how.tolerance = 1e-7;
  const LightField light = scene.SolveOrdinates(this->GetDevice());
  EXPECT_LE(Deviation(light, colour), 1e-5);
  EXPECT_LE(light.balance.RelativeError(3), 1e-5);
  EXPECT_TRUE(light.converged);
}

TEST_F(OrdinatesFaceAlbedo, LetsNothingOutOfAClosedBox)
{
  LitMedium scene({ 6, 5, 4 }, 0.3f, 0.2f);
  scene.how.tolerance = 1e-7;
  scene.how.directionsPerFace = 9;
  scene.emission.assign(scene.sigma_a.size(), 0.0f);
  scene.emission[17] = 1.0f;
  scene.light.faceAlbedo.fill(Grey(1.0));
  const LightField light = scene.SolveOrdinates(this->GetDevice());
  const EnergyBalance& balance = light.balance;
  EXPECT_NEAR(balance.absorbed[0], balance.emitted[0], 1e-5 * balance.emitted[0]);
  EXPECT_NEAR(balance.escaped[0], 0.0, 1e-5 * balance.emitted[0]);
  EXPECT_TRUE(light.converged);
}

TEST_F(OrdinatesFaceAlbedo, TellsWhatLeavesEveryCell)
{
  LitMedium scene({ 8, 6, 5 });
  scene.Randomise(0.5, 2.0, 0.7);
  scene.how.directionsPerFace = 9;
  scene.how.periodic = { false, true, false };
  scene.light.sky = { 0.3, 0.2, 0.1 };
  scene.ShineAlong({ 0.3, -0.5, -1.0 });
  Light lamp;
  lamp.type = LightType::Point;
  lamp.position = { 3.3, 2.2, 4.4 };
  scene.light.lights.push_back(lamp);
  scene.light.faceAlbedo[1] = { 0.5, 0.4, 0.3 };
  scene.light.faceAlbedo[4] = Grey(0.8);
  const LightField light = scene.SolveOrdinates(this->GetDevice());
  const double entered = light.balance.entered[0];
  ASSERT_EQ(light.facePower.size(), 3 * BoxFaceCellCount(scene.medium.grid));
  for (int face : { 0, 1, 4, 5 })
  {
    for (int c = 0; c < 3; ++c)
    {
      const double kept = 1.0 - scene.light.faceAlbedo[face][c];
      EXPECT_NEAR(kept * Leaving(light, scene.medium.grid, face, c), light.facePowerOut[face][c], 2e-5 * entered)
        << face << ' ' << c;
    }
  }
}

TEST_F(OrdinatesFaceAlbedo, IsMattGroundUnderASlab)
{
  for (double tau : { 0.5, 5.0 })
  {
    for (double g : { 0.0, 0.85 })
    {
      for (double ground : { 0.3, 0.8, 1.0 })
      {
        for (double cosine : { 0.0, 1.0, 0.5 })
        {
          const double albedo = 0.9;
          const ReferenceRow row = ReferenceRowWhere("slab_over_ground",
            { { "tau", tau }, { "albedo", albedo }, { "g", g }, { "ground", ground }, { "cosine", cosine } });
          LitMedium slab = SlabOverGround(tau, albedo, g, ground, cosine, tau > 1.0 ? 100 : 40);
          const LightField light = slab.SolveOrdinates(this->GetDevice());
          EXPECT_NEAR(PowersOf(light).reflected, row["reflected"], 0.003)
            << tau << ' ' << g << ' ' << ground << ' ' << cosine;
          EXPECT_NEAR(PowersOf(light).taken, row["taken"], 0.003) << tau << ' ' << g << ' ' << ground << ' ' << cosine;
          EXPECT_LE(light.balance.RelativeError(1), 1e-5);
          EXPECT_TRUE(light.converged);
        }
      }
    }
  }
}

TEST_F(OrdinatesFaceAlbedo, IsTheSameOnEachSideOfTheBox)
{
  std::vector<double> given;
  for (int face = 0; face < 6; ++face)
  {
    LitMedium scene({ 6, 6, 6 }, 0.05f, 0.2f);
    scene.how.directionsPerFace = 9;
    std::array<double, 3> towards = { 0.2, 0.2, 0.2 };
    towards[face / 2] = face % 2 ? 1.0 : -1.0;
    scene.ShineAlong(towards);
    scene.light.faceAlbedo[face] = Grey(0.7);
    const LightField light = scene.SolveOrdinates(this->GetDevice());
    given.push_back(Leaving(light, scene.medium.grid, face, 0));
  }
  for (double power : given)
  {
    EXPECT_NEAR(power, given[0], 1e-4 * given[0]);
  }
}

TEST_F(OrdinatesFaceAlbedo, IsTheSameFromTheLastLight)
{
  LitMedium scene({ 7, 5, 6 }, 0.05f, 0.3f);
  scene.how.directionsPerFace = 9;
  scene.how.tolerance = 1e-5;
  scene.ShineAlong({ 0.3, -0.2, -1.0 });
  scene.light.faceAlbedo[4] = Grey(0.8);
  scene.light.faceAlbedo[1] = Grey(0.4);
  KeptLight kept;
  scene.SolveOrdinates(this->GetDevice(), {}, &kept);
  scene.sigma_s[30] *= 1.5f;
  scene.light.faceAlbedo[4] = Grey(0.6);
  const LightField warm = scene.SolveOrdinates(this->GetDevice(), {}, &kept);
  const LightField cold = scene.SolveOrdinates(this->GetDevice());
  double most = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < warm.fluence.size(); ++i)
  {
    most = std::max(most, std::abs(static_cast<double>(warm.fluence[i]) - cold.fluence[i]));
    largest = std::max(largest, static_cast<double>(cold.fluence[i]));
  }
  EXPECT_LE(most, 3e-5 * largest);
  EXPECT_TRUE(warm.converged);
  EXPECT_NEAR(warm.facePowerOut[4][0], cold.facePowerOut[4][0], 3e-5 * cold.balance.entered[0]);
}

TEST_F(OrdinatesFaceAlbedo, EndsInABoxThatHardlyAbsorbsAndRefusesOneThatDoesNot)
{
  LitMedium scene({ 3, 3, 3 }, 1e-6f, 0.5f);
  scene.how.directionsPerFace = 9;
  scene.light.faceAlbedo.fill(Grey(1.0));
  scene.emission.assign(scene.sigma_a.size(), 0.0f);
  scene.emission[13] = 1.0f;
  const LightField light = scene.SolveOrdinates(this->GetDevice());
  EXPECT_FALSE(light.converged);
  EXPECT_FALSE(light.doubts.empty());
  EXPECT_LE(light.balance.RelativeError(1), 1e-3);
  scene.sigma_a.assign(scene.sigma_a.size(), 0.0f);
  EXPECT_THROW(scene.SolveOrdinates(this->GetDevice()), InvalidInput);
}

TEST_F(OrdinatesFaceAlbedo, IsRefusedAsPublished)
{
  LitMedium scene({ 3, 3, 3 }, 0.1f, 0.1f);
  scene.how.scheme = OrdinatesScheme::Published;
  scene.light.faceAlbedo[2] = Grey(0.5);
  EXPECT_THAT([&] { scene.SolveOrdinates(this->GetDevice()); },
    testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("set FaceAlbedo to 0")));
}
