// Photons that march while what they have left diffuses on a lattice.

#include "DeviceTest.h"
#include "Difference.h"
#include "PhotonScene.h"
#include "PhotonWays.h"

#include "LatticeBoltzmann/LatticeBoltzmann.h"

#include <gmock/gmock.h>

#include <cmath>

using namespace tyndall;

namespace
{
LatticeSettings Interleaved(int stretches)
{
  LatticeSettings settings;
  settings.interleaves = true;
  settings.stretches = stretches;
  settings.tolerance = 1e-5;
  return settings;
}

/// W that leave the volume or are absorbed, of those that entered; the worst channel.
double PowerKept(const LightField& light)
{
  double worst = 1.0;
  for (int c = 0; c < light.channels; ++c)
  {
    const double kept = (light.balance.absorbed[c] + light.balance.escaped[c]) / light.balance.entered[c];
    worst = std::abs(kept - 1.0) > std::abs(worst - 1.0) ? kept : worst;
  }
  return worst;
}
}

class InterleavedLattices : public DeviceTest
{
protected:
  LightField Solve(PhotonScene& scene, const std::vector<Photon>& photons, const LatticeSettings& settings,
    const Monitor& monitor = {})
  {
    return SolveLatticeBoltzmann(this->GetDevice(), Domain(scene.Medium().grid), scene.Medium(), scene.Index(), photons,
      this->Illumination, settings, monitor);
  }

  /// Fog round a ball of glass, no axis as long as another.
  PhotonScene Ball() const
  {
    PhotonScene scene({ 19, 26, 23 }, 0.1, 1.0, 0.2f, 3.0f);
    scene.SetBall(0.5, 1.3);
    return scene;
  }

  tyndall::Illumination Illumination;
};

TEST_F(InterleavedLattices, HaveTheLightOfPhotonsThatMarchFirst)
{
  PhotonScene scene = this->Ball();
  std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 4000);
  for (const bool coloured : { false, true })
  {
    for (std::size_t i = 0; coloured && i < photons.size(); i += 2)
    {
      photons[i].power[0] *= 0.2f;
      photons[i].power[2] = 0.0f;
    }
    const LightField first = this->Solve(scene, photons, {});
    for (const int stretches : { 4, 16, 0 })
    {
      const LightField light = this->Solve(scene, photons, Interleaved(stretches));
      EXPECT_EQ(light.channels, coloured ? 3 : 1);
      EXPECT_EQ(light.fluenceDirect, first.fluenceDirect);
      EXPECT_LT(RelativeDifference(light.fluence, first.fluence), 3e-4) << stretches;
      EXPECT_NEAR(PowerKept(light), 1.0, 1e-3) << stretches;
      EXPECT_NEAR(light.balance.entered[0], first.balance.entered[0], 1e-6 * first.balance.entered[0]);
      EXPECT_TRUE(light.converged);
    }
  }
}

/// Light in the units of floats, of any colour, of one colour that has no red, of a coloured medium, with a glow.
TEST_F(InterleavedLattices, TakePhotonsOfAnyColourAndPower)
{
  PhotonScene scene({ 11, 9, 14 }, 0.002, 0.01, 1.0f, 200.0f);
  std::vector<float> glow(scene.medium.grid.VoxelCount(), 0.0f);
  const std::size_t middle = glow.size() / 2;
  for (const bool mediumHasColour : { false, true })
  {
    if (mediumHasColour)
    {
      scene.sigma_s.clear();
      for (std::size_t i = 0; i < glow.size(); ++i)
      {
        scene.sigma_s.insert(scene.sigma_s.end(), { 100.0f, 200.0f, 300.0f });
      }
    }
    for (const double power : { 1e-20, 1.0, 1e20 })
    {
      std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 500);
      for (Photon& photon : photons)
      {
        photon.power = { 0.0f, static_cast<float>(2.0 * power), static_cast<float>(power) };
      }
      glow[middle] = static_cast<float>(power * 1e5);
      scene.medium.emission = { glow.data() };
      const LightField first = this->Solve(scene, photons, {}), light = this->Solve(scene, photons, Interleaved(5));
      EXPECT_EQ(light.channels, 3);
      EXPECT_LT(RelativeDifference(light.fluence, first.fluence), 3e-4) << mediumHasColour << power;
      EXPECT_EQ(light.fluenceDirect, first.fluenceDirect) << mediumHasColour << power;
    }
  }
}

/// Of photons that go so far askew of an axis as to tell just something, or nothing, of where in voxels they are lost.
TEST_F(InterleavedLattices, AreLinearInPower)
{
  PhotonScene scene({ 9, 7, 8 }, 0.5, 0.0, 0.3f, 4.0f);
  const Grid& grid = scene.medium.grid;
  for (const LatticeSettings& settings : { Interleaved(4), LatticeSettings() })
  {
    for (const double askew : { 0.1499999, 0.2, 0.25 })
    {
      const auto solve = [&](double power) {
        std::vector<Photon> photons = AnyPhotons(grid, 300);
        for (Photon& photon : photons)
        {
          const double z = std::sqrt(1.0 - askew * askew);
          photon.direction = { static_cast<float>(askew), 0.0f,
            static_cast<float>(photon.direction[2] > 0.0f ? z : -z) };
          photon.power.fill(static_cast<float>(power));
        }
        LightField light = this->Solve(scene, photons, settings);
        std::for_each(light.fluence.begin(), light.fluence.end(),
          [=](float& fluence) { fluence = static_cast<float>(fluence / power); });
        return light.fluence;
      };
      const std::vector<float> one = solve(1.0);
      for (const double power : { 3.0, 0.37, 1e4, 1e-6, 1e12 })
      {
        EXPECT_LT(RelativeDifference(solve(power), one), 1e-6) << askew << ", " << power << " W";
      }
    }
  }
}

TEST_F(InterleavedLattices, AreTheSameSideBySideAndInTurns)
{
  PhotonScene scene = this->Ball();
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 3000);
  LatticeSettings settings = Interleaved(7);
  settings.netFlux = true;
  const LightField beside = this->Solve(scene, photons, settings);
  settings.sideBySide = false;
  const LightField turns = this->Solve(scene, photons, settings);
  EXPECT_EQ(beside.fluence, turns.fluence);
  EXPECT_EQ(beside.netFlux, turns.netFlux);
  EXPECT_EQ(beside.facePowerOut, turns.facePowerOut);
}

TEST_F(InterleavedLattices, SettleInBlocksToTheSameLight)
{
  PhotonScene scene({ 19, 26, 23 }, 0.1, 1.0, 0.2f, 3.0f);
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 3000);
  LatticeSettings settings = Interleaved(8);
  settings.scheme = LatticeScheme::Published;
  const LightField all = this->Solve(scene, photons, settings);
  settings.blockSize = 4;
  EXPECT_LT(RelativeDifference(this->Solve(scene, photons, settings).fluence, all.fluence), 0.01);
}

/// Few probes tell nearly as well as all voxels when light has settled.
TEST_F(InterleavedLattices, EndWhenProbesChangeNoMore)
{
  PhotonScene scene = this->Ball();
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 3000);
  LatticeSettings settings = Interleaved(16);
  settings.tolerance = 1e-3;
  settings.probes = 0;
  const LightField all = this->Solve(scene, photons, settings);
  for (const int probes : { 30, 400 })
  {
    settings.probes = probes;
    const LightField some = this->Solve(scene, photons, settings);
    EXPECT_TRUE(some.converged);
    EXPECT_NEAR(some.convergence.back().iteration, all.convergence.back().iteration, 48) << probes;
    EXPECT_LT(RelativeDifference(some.fluence, all.fluence), 3e-3) << probes;
  }
}

TEST_F(InterleavedLattices, CountStepsBesidePhotonsAmongThoseAskedFor)
{
  PhotonScene scene = this->Ball();
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 1000);
  LatticeSettings settings = Interleaved(6);
  settings.maximumSteps = 50;
  EXPECT_EQ(this->Solve(scene, photons, settings).convergence.back().iteration, 50);
}

TEST_F(InterleavedLattices, ReportProgressAndStopWhenTold)
{
  PhotonScene scene = this->Ball();
  std::vector<double> done;
  EXPECT_THROW(this->Solve(scene, AnyPhotons(scene.medium.grid, 1000), Interleaved(4),
                 [&](double fraction) {
                   done.push_back(fraction);
                   return done.size() < 6;
                 }),
    Aborted);
  EXPECT_EQ(done.size(), 6u);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
}

TEST_F(InterleavedLattices, RefusePeriodicAxesAndNegativeNumbers)
{
  PhotonScene scene = this->Ball();
  LatticeSettings settings = Interleaved(4);
  settings.periodic[1] = true;
  EXPECT_THAT([&] { this->Solve(scene, {}, settings); },
    testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("periodic axes")));
  for (int LatticeSettings::*number : { &LatticeSettings::stretches, &LatticeSettings::probes })
  {
    LatticeSettings wrong;
    wrong.*number = -1;
    EXPECT_THROW(this->Solve(scene, {}, wrong), InvalidInput);
  }
}

TEST_F(InterleavedLattices, SayThatPhotonsMissTheMedium)
{
  PhotonScene scene = this->Ball();
  std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 4);
  for (Photon& photon : photons)
  {
    photon.position = { -50.0, 0.0, 0.0 };
    photon.direction = { -1.0f, 0.0f, 0.0f };
  }
  for (const LatticeSettings& settings : { LatticeSettings(), Interleaved(4) })
  {
    EXPECT_THAT(this->Solve(scene, photons, settings).doubts,
      testing::Contains(testing::HasSubstr("4 of 4 photons do not meet the medium")));
  }
}

TEST_F(InterleavedLattices, AreDarkWithoutPhotons)
{
  PhotonScene scene = this->Ball();
  const LightField light = this->Solve(scene, {}, Interleaved(4));
  EXPECT_TRUE(std::all_of(light.fluence.begin(), light.fluence.end(), [](float fluence) { return fluence == 0.0f; }));
}
