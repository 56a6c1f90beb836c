// Photons that march in turns, so that others can use what they have left so far.

#include "DeviceTest.h"
#include "PhotonScene.h"
#include "PhotonWays.h"

#include <gmock/gmock.h>

#include <algorithm>

using namespace tyndall;

namespace
{
/// Light as it was shown after each turn.
struct Shown
{
  std::vector<std::vector<float>> fluence;
  int meanwhiles = 0;
  TurnTimes times;
};

class PhotonTurns : public DeviceTest
{
protected:
  PhotonLight March(PhotonScene& scene, const std::vector<Photon>& photons, int stretches, Shown& shown,
    bool sideBySide = true, const Monitor& monitor = {})
  {
    Device& device = this->GetDevice();
    Buffer<int> any(device, 1, "something to do");
    MarchTurns turns;
    turns.stretches = stretches;
    turns.sideBySide = sideBySide;
    turns.begin = [](const PackedPhotons&, int) {};
    turns.meanwhile = [&](const cl::CommandQueue& queue) {
      ++shown.meanwhiles;
      cl::Event event;
      queue.enqueueFillBuffer(any.Handle(), 1, 0, sizeof(int), nullptr, &event);
      return std::array<cl::Event, 2>{ event, event };
    };
    turns.take = [&](const cl::CommandQueue& queue, const Buffer<float>& fluence) {
      std::vector<float> values(fluence.Size());
      queue.enqueueReadBuffer(fluence.Handle(), CL_TRUE, 0, values.size() * sizeof(float), values.data());
      shown.fluence.push_back(values);
    };
    PhotonMarcher marcher(device, Domain(scene.Medium().grid), scene.Medium(), scene.Index(), scene.settings);
    const PhotonLight found = marcher.MarchByTurns(photons, turns, monitor);
    shown.times = turns.times;
    return found;
  }
};
}

TEST_F(PhotonTurns, LeaveTheLightOfPhotonsThatGoOnAtOnce)
{
  for (const bool bends : { false, true })
  {
    for (const bool shared : { false, true })
    {
      if (shared && !this->GetDevice().HasExtension("cl_khr_int64_base_atomics"))
      {
        continue;
      }
      PhotonScene scene({ 23, 31, 18 }, 0.1, 1.0, 0.3f, 0.9f);
      scene.settings.sums = shared ? MarchSettings::Sums::Shared : MarchSettings::Sums::Private;
      if (bends)
      {
        scene.SetBall(0.6, 1.4);
      }
      std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 3001);
      photons[5].power[1] *= bends ? 0.5f : 1.0f;
      const PhotonLight atOnce = scene.March(this->GetDevice(), photons);
      for (const int stretches : { 1, 3, 16, 0 })
      {
        Shown shown;
        ExpectSameLight(this->March(scene, photons, stretches, shown, stretches != 3), atOnce);
        EXPECT_EQ(shown.fluence.back(), atOnce.light.fluence) << stretches;
        EXPECT_EQ(shown.times.turns, static_cast<int>(shown.fluence.size()));
        EXPECT_EQ(shown.meanwhiles, shown.times.turns - 1);
        EXPECT_GE(shown.times.turns, stretches == 0 ? 1 : 50 / stretches / 2);
      }
    }
  }
}

/// After a turn of k stretches a beam along an axis has lit k voxels, with the extinction of its way.
TEST_F(PhotonTurns, ShowLightAsFarAsPhotonsHaveCome)
{
  PhotonScene scene({ 40, 3, 3 }, 0.1, 0.0, 0.0f, 2.0f);
  Photon photon;
  photon.position = { 0.0, 0.15, 0.15 };
  photon.direction = { 1.0f, 0.0f, 0.0f };
  photon.power = { 1.0f, 1.0f, 1.0f };
  Shown shown;
  this->March(scene, { photon }, 8, shown);
  ASSERT_GE(shown.fluence.size(), 5u);
  for (std::size_t turn = 0; turn < 5; ++turn)
  {
    for (std::size_t x = 0; x < 40; ++x)
    {
      const double mean = std::exp(-0.2 * x) * -std::expm1(-0.2) / 2.0 / 1e-3; // path times power over volume
      EXPECT_NEAR(shown.fluence[turn][4 * 40 + x], x < 8 * (turn + 1) ? mean : 0.0, 2e-5 * mean) << turn << " " << x;
    }
  }
}

TEST_F(PhotonTurns, AreSeenAndStopWhenTold)
{
  PhotonScene scene(24, 1.0, 0.1f, 0.2f);
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 2000);
  std::vector<double> done;
  Shown shown;
  EXPECT_THROW(this->March(scene, photons, 4, shown, true,
                 [&](double fraction) {
                   done.push_back(fraction);
                   return done.size() < 3;
                 }),
    Aborted);
  EXPECT_EQ(done.size(), 3u);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  ExpectSameLight(this->March(scene, photons, 4, shown), scene.March(this->GetDevice(), photons));
}

TEST_F(PhotonTurns, RefuseOrdersAndBatches)
{
  PhotonScene scene(8, 1.0, 0.1f, 0.2f);
  scene.settings.maximumOrders = 2;
  Shown shown;
  EXPECT_THAT([&] { this->March(scene, AnyPhotons(scene.medium.grid, 10), 4, shown); },
    testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("first scattered")));
}

TEST_F(PhotonTurns, AreNoneWithoutPhotons)
{
  PhotonScene scene(8, 1.0, 0.1f, 0.2f);
  Shown shown;
  const PhotonLight light = this->March(scene, {}, 4, shown);
  EXPECT_EQ(shown.times.turns, 0);
  EXPECT_EQ(light.light.balance.entered[0], 0.0);
}
