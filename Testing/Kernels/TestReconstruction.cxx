#include "DeviceTest.h"
#include "ReconstructionScene.h"

#include <gmock/gmock.h>

#include <limits>

using namespace tyndall;
using Estimator = ReconstructionSettings::Estimator;
using testing::Contains;
using testing::HasSubstr;

namespace
{
constexpr Estimator All[] = { Estimator::Published, Estimator::Conservative, Estimator::ConstantRadius,
  Estimator::NearestPhotons };
constexpr std::array<int, 3> Sizes[] = { { 1, 1, 1 }, { 1, 1, 1000 }, { 5, 7, 3 }, { 32, 16, 16 }, { 37, 18, 9 } };

class Reconstruction : public DeviceTest
{
protected:
  std::string Complaint(const NoisyLight& light, const ReconstructionSettings& settings)
  {
    try
    {
      Reconstruct(this->GetDevice(), light, settings);
    }
    catch (const InvalidInput& error)
    {
      return error.what();
    }
    return {};
  }
};
}

TEST_F(Reconstruction, EvenLightComesBackAsItIs)
{
  for (const std::array<int, 3>& size : Sizes)
  {
    for (int channels : { 1, 3 })
    {
      ReconstructionScene scene(size, channels, 3);
      scene.Light([](std::size_t) { return 2.5; }, 0.0);
      for (Estimator estimator : All)
      {
        const ReconstructedLight light = Reconstruct(this->GetDevice(), scene.Seen(), By(estimator));
        ASSERT_EQ(light.fluence.size(), scene.Values());
        ASSERT_EQ(light.fluenceError.size(), estimator == Estimator::Conservative ? scene.Values() : 0);
        EXPECT_NEAR(light.bias, 0.0, 1e-6);
        for (std::size_t i = 0; i < scene.Values(); ++i)
        {
          ASSERT_NEAR(light.fluence[i], 2.5, 2.5e-6) << size[0] << ' ' << static_cast<int>(estimator) << ' ' << i;
          ASSERT_NEAR(light.meanDirection[3 * (i / channels)], 0.6, 1e-6);
          ASSERT_NEAR(light.meanDirection[3 * (i / channels) + 2], -0.3, 1e-6);
          if (estimator == Estimator::Conservative)
          {
            ASSERT_NEAR(light.fluenceError[i], 0.0, 2.5e-6);
          }
        }
      }
    }
  }
}

TEST_F(Reconstruction, DarkLightStaysDark)
{
  ReconstructionScene scene({ 17, 6, 5 }, 3);
  scene.Light([](std::size_t) { return 0.0; }, 0.0);
  scene.count.assign(scene.count.size(), 0.0f);
  scene.weight.assign(scene.weight.size(), 0.0f);
  scene.direction.assign(scene.direction.size(), 0.0f);
  for (Estimator estimator : All)
  {
    const ReconstructedLight light = Reconstruct(this->GetDevice(), scene.Seen(), By(estimator));
    EXPECT_THAT(light.fluence, testing::Each(0.0f));
    EXPECT_THAT(light.fluenceError, testing::Each(0.0f));
    EXPECT_THAT(light.meanDirection, testing::Each(0.0f));
    EXPECT_EQ(light.bias, 0.0);
  }
}

TEST_F(Reconstruction, SaysWhatIsMissingAndWhoMakesIt)
{
  const ReconstructionScene scene = ReconstructionScene({ 4, 4, 4 }).Light([](std::size_t) { return 1.0; }, 0.0);
  NoisyLight light = scene.Seen();
  light.photonCount = nullptr;
  EXPECT_THAT(this->Complaint(light, By(Estimator::NearestPhotons)), HasSubstr("PhotonCounts"));
  EXPECT_THAT(this->Complaint(light, By(Estimator::Published)), HasSubstr("photon_count"));
  light.batches = 1;
  EXPECT_THAT(this->Complaint(light, By(Estimator::Conservative)), HasSubstr("1 batch;"));
  light.batchFluence = nullptr;
  EXPECT_THAT(this->Complaint(light, By(Estimator::Conservative)), HasSubstr("PhotonEmitter"));
  light.fluence = nullptr;
  EXPECT_THAT(this->Complaint(light, By(Estimator::ConstantRadius)), HasSubstr("fluence"));
}

TEST_F(Reconstruction, NamesTheVoxelThatMeansNothing)
{
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  for (float bad : { nan, infinite, -1.0f })
  {
    ReconstructionScene scene({ 50, 30, 20 });
    scene.Light([](std::size_t) { return 1.0; }, 0.0);
    scene.batchFluence[2 * ((7 * 30 + 5) * 50 + 3) + 1] = bad;
    EXPECT_THAT(this->Complaint(scene.Seen(), By(Estimator::Conservative)), HasSubstr("(3, 5, 7)")) << bad;
    EXPECT_EQ(this->Complaint(scene.Seen(), By(Estimator::Published)), "");
    scene.fluence.back() = bad;
    EXPECT_THAT(this->Complaint(scene.Seen(), By(Estimator::ConstantRadius)), HasSubstr("(49, 29, 19)")) << bad;
    scene.fluence.back() = 1.0f;
    scene.weight[1] = bad;
    EXPECT_THAT(this->Complaint(scene.Seen(), By(Estimator::Published)), HasSubstr("photon_weight")) << bad;
  }
  ReconstructionScene scene({ 4, 4, 4 });
  scene.Light([](std::size_t) { return 1.0; }, 0.0);
  scene.direction[5] = nan;
  EXPECT_THAT(this->Complaint(scene.Seen(), By(Estimator::Conservative)), HasSubstr("mean_direction"));
}

TEST_F(Reconstruction, SettingsOutOfRangeAreRefused)
{
  const ReconstructionScene scene = ReconstructionScene({ 4, 4, 4 }).Light([](std::size_t) { return 1.0; }, 0.0);
  const auto refused = [&](const std::function<void(ReconstructionSettings&)>& change) {
    ReconstructionSettings settings;
    change(settings);
    return !this->Complaint(scene.Seen(), settings).empty();
  };
  EXPECT_FALSE(refused([](ReconstructionSettings&) {}));
  EXPECT_TRUE(refused([](ReconstructionSettings& s) { s.levels = 0; }));
  EXPECT_TRUE(refused([](ReconstructionSettings& s) { s.levels = 9; }));
  EXPECT_TRUE(refused([](ReconstructionSettings& s) { s.level = -1; }));
  EXPECT_TRUE(refused([](ReconstructionSettings& s) { s.nearest = 0; }));
  EXPECT_TRUE(refused([](ReconstructionSettings& s) { s.weightStep = -1.0; }));
  EXPECT_TRUE(refused([](ReconstructionSettings& s) { s.weightStep = std::nan(""); }));
}

TEST_F(Reconstruction, SaysWhatIsLeftOut)
{
  ReconstructionScene scene({ 4, 4, 4 });
  scene.Light([](std::size_t) { return 1.0; }, 0.0);
  scene.direction.clear();
  const ReconstructedLight light = Reconstruct(this->GetDevice(), scene.Seen());
  EXPECT_THAT(light.leftOut, Contains(HasSubstr("mean direction")));
  EXPECT_THAT(light.leftOut, Contains(HasSubstr("colour:")));
  EXPECT_TRUE(light.meanDirection.empty());
}

TEST_F(Reconstruction, StopsWhenTold)
{
  const ReconstructionScene scene = ReconstructionScene({ 32, 32, 32 }).Light([](std::size_t) { return 1.0; }, 0.0);
  for (Estimator estimator : All)
  {
    EXPECT_THROW(
      Reconstruct(this->GetDevice(), scene.Seen(), By(estimator), [](double done) { return done < 0.1; }), Aborted);
  }
}
