// Scattered photons of several colours: each channel is a scene of its own.

#include "DeviceTest.h"
#include "ScatteredScene.h"

#include <array>
#include <random>
#include <vector>

using namespace tyndall;

namespace
{
/// Every voxel a medium of its own, in a box that is no cube.
PhotonScene AnyScene(std::size_t components)
{
  PhotonScene scene({ 7, 5, 9 }, 0.2, 0.3, 0.0f, 0.0f);
  scene.medium.grid.spacing = { 0.2, 0.35, 0.15 };
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  scene.sigma_a.resize(scene.medium.grid.VoxelCount() * components);
  scene.sigma_s.resize(scene.sigma_a.size());
  for (std::size_t i = 0; i < scene.sigma_a.size(); ++i)
  {
    scene.sigma_a[i] = 0.5f * uniform(random);
    scene.sigma_s[i] = 8.0f * uniform(random) * uniform(random);
  }
  scene.settings.maximumOrders = 0;
  return scene;
}
}

class ScatteredColours : public DeviceTest
{
protected:
  void ExpectEachAlone(PhotonScene& scene)
  {
    const std::vector<Photon> photons = RandomPhotons(scene.medium.grid).ThroughAllFaces(2000);
    const PhotonLight all = scene.March(this->GetDevice(), photons);
    ASSERT_EQ(all.light.channels, 3);
    ASSERT_EQ(all.light.fluence.size(), 3 * scene.medium.grid.VoxelCount());
    EXPECT_LT(all.light.balance.RelativeError(3), 1e-6);
    const auto components = static_cast<std::size_t>(scene.ComponentsOf(scene.sigma_a));
    for (std::size_t c = 0; c < 3; ++c)
    {
      PhotonScene one = AnyScene(1);
      for (std::size_t i = 0; i < one.sigma_a.size(); ++i)
      {
        one.sigma_a[i] = scene.sigma_a[i * components + (components == 3 ? c : 0)];
        one.sigma_s[i] = scene.sigma_s[i * components + (components == 3 ? c : 0)];
      }
      one.medium.phase = scene.medium.phase.Seen(static_cast<int>(c));
      const PhotonLight alone = one.March(this->GetDevice(), photons);
      for (std::size_t i = 0; i < alone.light.fluence.size(); ++i)
      {
        ASSERT_NEAR(all.light.fluence[3 * i + c], alone.light.fluence[i], 1e-5f * alone.light.fluence[i]) << c;
      }
      EXPECT_NEAR(all.light.balance.absorbed[c], alone.light.balance.absorbed[0], 1e-5);
    }
  }
};

TEST_F(ScatteredColours, OfCoefficientsAreScenesOfTheirOwn)
{
  PhotonScene scene = AnyScene(3);
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  this->ExpectEachAlone(scene);
}

// Of a medium whose coefficients are grey, and of white light.
TEST_F(ScatteredColours, OfThePhaseFunctionAreScenesOfTheirOwn)
{
  PhotonScene scene = AnyScene(1);
  scene.medium.phase = PhaseOfMedium(std::array<PhaseFunction, 3>{
    PhaseFunction::HenyeyGreenstein(0.8), PhaseFunction::Rayleigh(), PhaseFunction::HenyeyGreenstein(-0.3) });
  this->ExpectEachAlone(scene);
}

// Faint channels are rounded in proportion to their own power.
TEST_F(ScatteredColours, OfVeryUnlikePowersBalance)
{
  PhotonScene scene = AnyScene(3);
  const std::vector<Photon> white = RandomPhotons(scene.medium.grid).ThroughAllFaces(2000);
  std::vector<Photon> photons = white;
  for (Photon& photon : photons)
  {
    photon.power[0] *= 1e-7f;
    photon.power[2] *= 1e-4f;
  }
  const PhotonLight bright = scene.March(this->GetDevice(), white), found = scene.March(this->GetDevice(), photons);
  const EnergyBalance& balance = found.light.balance;
  for (std::size_t c = 0; c < 3; ++c)
  {
    EXPECT_NEAR((balance.absorbed[c] + balance.escaped[c] + balance.leftOver[c]) / balance.entered[c], 1.0, 1e-5) << c;
  }
  for (std::size_t i = 0; i < found.light.fluence.size(); i += 3)
  {
    ASSERT_NEAR(1e7f * found.light.fluence[i], bright.light.fluence[i], 3e-4f * bright.light.fluence[i]);
  }
}

TEST_F(ScatteredColours, WhereNothingScattersAllLightIsDirect)
{
  PhotonScene scene = UnitCube(3, 2.0, 0.0);
  const PhotonLight light = scene.March(this->GetDevice(), RandomPhotons(scene.medium.grid).ThroughFace(2, 500));
  EXPECT_EQ(light.light.fluenceDirect, light.light.fluence);
  EXPECT_EQ(light.scatterings, 0u);
}
