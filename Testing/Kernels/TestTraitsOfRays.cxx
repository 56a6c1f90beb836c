#include "DeviceTest.h"
#include "Difference.h"
#include "PhotonScene.h"
#include "ViewScene.h"

#include "Light/LeftOut.h"

#include <gmock/gmock.h>

#include <random>
#include <string>

using namespace tyndall;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

namespace
{
constexpr double Same = 1e-6;               ///< of the largest
constexpr double SameWhereRaysAddUp = 5e-5; ///< 2.1e-5 was measured, see there

/// Photons of one colour from above, many ways.
std::vector<Photon> Rain(const std::array<float, 3>& power, int count = 5000)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-0.95f, 0.95f);
  std::vector<Photon> photons;
  for (int i = 0; i < count; ++i)
  {
    Photon photon;
    photon.position = { place(random), place(random), 1.0 };
    const float x = 0.4f * place(random), y = 0.4f * place(random), length = std::sqrt(x * x + y * y + 1.0f);
    photon.direction = { x / length, y / length, -1.0f / length };
    photon.power = power;
    photons.push_back(photon);
  }
  return photons;
}

PhotonScene Fog()
{
  PhotonScene scene(16, 1.0, 0.3f, 0.7f);
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    scene.sigma_s[i] *= 1.0f + 0.1f * static_cast<float>(i % 7);
  }
  return scene;
}
}

class TraitsOfRays : public DeviceTest
{
protected:
  PhotonLight ExpectLeftOut(PhotonScene& scene, const std::vector<Photon>& photons, const std::string& word)
  {
    scene.settings.leaveOut = false;
    const PhotonLight all = scene.March(this->GetDevice(), photons);
    scene.settings.leaveOut = true;
    const PhotonLight less = scene.March(this->GetDevice(), photons);
    EXPECT_THAT(less.light.leftOut, Contains(HasSubstr(word)));
    EXPECT_THAT(all.light.leftOut, Not(Contains(HasSubstr(word))));
    EXPECT_EQ(less.light.channels, all.light.channels);
    EXPECT_LT(RelativeDifference(less.light.fluence, all.light.fluence), Same);
    EXPECT_LT(RelativeDifference(less.meanDirection, all.meanDirection), Same);
    const double entered = Sum(all.light.balance.entered);
    for (int c = 0; c < 3; ++c)
    {
      EXPECT_NEAR(less.light.balance.absorbed[c], all.light.balance.absorbed[c], Same * entered);
      EXPECT_NEAR(less.light.balance.escaped[c], all.light.balance.escaped[c], Same * entered);
      EXPECT_NEAR(less.scattered[c], all.scattered[c], Same * entered);
    }
    return less;
  }

  void ExpectLeftOut(viewing::Scene& scene, const std::string& word, double same = Same)
  {
    scene.settings.leaveOut = false;
    MediumRayCaster general = scene.Caster(this->GetDevice());
    const Picture all = general.Render(scene.Framed());
    scene.settings.leaveOut = true;
    MediumRayCaster caster = scene.Caster(this->GetDevice());
    const Picture less = caster.Render(scene.Framed());
    EXPECT_THAT(caster.LeftOut(), Contains(HasSubstr(word)));
    EXPECT_THAT(general.LeftOut(), Not(Contains(HasSubstr(word))));
    EXPECT_LT(RelativeDifference(less.radiance, all.radiance), same);
    EXPECT_LT(RelativeDifference(less.alpha, all.alpha), same);
  }
};

TEST_F(TraitsOfRays, GreyPhotonsInAGreyMediumAreOneChannel)
{
  PhotonScene scene = Fog();
  scene.SetBall(0.5, 1.3);
  EXPECT_EQ(this->ExpectLeftOut(scene, Rain({ 1.0f, 1.0f, 1.0f }), left_out::Grey).light.channels, 1);
  std::vector<float> rgb;
  for (const float s : scene.sigma_s)
  {
    rgb.insert(rgb.end(), 3, s);
  }
  scene.sigma_s = rgb; // grey all the same
  EXPECT_EQ(this->ExpectLeftOut(scene, Rain({ 1.0f, 1.0f, 1.0f }), left_out::Grey).light.channels, 3);
}

TEST_F(TraitsOfRays, PhotonsOfOneColourAreOneChannel)
{
  PhotonScene scene = Fog();
  scene.SetBall(0.5, 1.3);
  EXPECT_EQ(this->ExpectLeftOut(scene, Rain({ 0.2f, 0.8f, 0.1f }), left_out::OneColour).light.channels, 3);
}

TEST_F(TraitsOfRays, AGreyMediumHasOneTransmittanceForAllColours)
{
  PhotonScene scene = Fog();
  scene.SetBall(0.5, 1.3);
  std::vector<Photon> photons = Rain({ 0.2f, 0.8f, 0.1f });
  photons.front().power = { 1.0f, 0.0f, 0.0f };
  this->ExpectLeftOut(scene, photons, left_out::GreyExtinction);
}

TEST_F(TraitsOfRays, AConstantIndexNeedsNoIntegrator)
{
  PhotonScene scene = Fog();
  this->ExpectLeftOut(scene, Rain({ 1.0f, 1.0f, 1.0f }), left_out::ConstantIndex);
  scene.ior.assign(scene.sigma_s.size(), 1.5f);
  this->ExpectLeftOut(scene, Rain({ 1.0f, 1.0f, 1.0f }), left_out::ConstantIndex);
}

TEST_F(TraitsOfRays, CoefficientsThatAreZeroNeedNoMemory)
{
  PhotonScene scene = Fog();
  scene.SetBall(0.5, 1.3);
  std::fill(scene.sigma_a.begin(), scene.sigma_a.end(), 0.0f);
  this->ExpectLeftOut(scene, Rain({ 1.0f, 1.0f, 1.0f }), left_out::NoAbsorption);
  scene.sigma_a = scene.sigma_s;
  std::fill(scene.sigma_s.begin(), scene.sigma_s.end(), 0.0f);
  this->ExpectLeftOut(scene, Rain({ 1.0f, 1.0f, 1.0f }), left_out::NoScattering);
}

/// A cloud with holes, and a lens in it that bends rays.
viewing::Scene CloudWithLens()
{
  viewing::Scene scene = viewing::Blobs();
  scene.illumination.sky = { 0.5, 0.5, 0.5 };
  scene.ior = viewing::AtCentres(
    scene.grid, [](double x, double y, double z) { return std::hypot(x - 0.5, y - 0.5, z - 0.5) < 0.1 ? 1.2 : 1.0; });
  return scene;
}

TEST_F(TraitsOfRays, GreyViewOfACloudWithHoles)
{
  viewing::Scene scene = CloudWithLens();
  this->ExpectLeftOut(scene, left_out::Grey);
  this->ExpectLeftOut(scene, left_out::EmptyBricks);
}

TEST_F(TraitsOfRays, ViewOfAGreyMediumInThreeComponents)
{
  viewing::Scene scene = CloudWithLens();
  const auto inThree = [](std::vector<float>& values) {
    std::vector<float> rgb;
    for (const float value : values)
    {
      rgb.insert(rgb.end(), 3, value);
    }
    values = rgb;
  };
  inThree(scene.sigma_a);
  inThree(scene.sigma_s);
  scene.components = 3;
  this->ExpectLeftOut(scene, left_out::Grey);
}

/// Rays that could bend add up their places in float step by step: they do not sample quite where straight ones do.
TEST_F(TraitsOfRays, StraightViewThroughAConstantIndex)
{
  viewing::Scene scene = viewing::Blobs();
  scene.illumination.sky = { 0.5, 0.5, 0.5 };
  this->ExpectLeftOut(scene, left_out::ConstantIndex, SameWhereRaysAddUp);
}
