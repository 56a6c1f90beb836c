#include "DeviceTest.h"
#include "ErrorWords.h"
#include "OnRanks.h"
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

class Reconstruction
  : public DeviceTest
  , public testing::WithParamInterface<int>
{
protected:
  /// Light of the whole grid, made on as many ranks as the parameter says.
  ReconstructedLight Of(
    const NoisyLight& light, const ReconstructionSettings& settings = {}, const Monitor& monitor = {})
  {
    return this->On(this->GetParam(), light, settings, monitor);
  }

  ReconstructedLight On(
    int ranks, const NoisyLight& light, const ReconstructionSettings& settings, const Monitor& monitor = {})
  {
    const std::size_t voxels = light.grid.VoxelCount(), values = voxels * static_cast<std::size_t>(light.channels);
    const bool conservative = settings.estimator == Estimator::Conservative;
    ReconstructedLight joined;
    joined.fluence.resize(values);
    joined.fluenceError.resize(conservative ? values : 0);
    joined.mipLevel.resize(voxels);
    joined.meanDirection.resize(light.meanDirection ? 3 * voxels : 0);
    OnRanks(light.grid, ranks, [&](const Domain& domain) {
      const auto cut = [&](const float* all, std::size_t components) {
        return all ? BlockOf(domain, std::vector<float>(all, all + voxels * components)) : std::vector<float>();
      };
      const auto batchWidth = static_cast<std::size_t>(light.channels) * static_cast<std::size_t>(light.batches);
      const std::vector<float> own[] = { cut(light.fluence, values / voxels), cut(light.batchFluence, batchWidth),
        cut(light.meanDirection, 3), cut(light.photonCount, 1), cut(light.photonWeight, 1) };
      NoisyLight part = light;
      part.fluence = light.fluence ? own[0].data() : nullptr;
      part.batchFluence = light.batchFluence ? own[1].data() : nullptr;
      part.meanDirection = light.meanDirection ? own[2].data() : nullptr;
      part.photonCount = light.photonCount ? own[3].data() : nullptr;
      part.photonWeight = light.photonWeight ? own[4].data() : nullptr;
      const ReconstructedLight found = Reconstruct(this->GetDevice(), domain, part, settings, monitor);
      PutBlock(domain, found.fluence, joined.fluence);
      PutBlock(domain, found.fluenceError, joined.fluenceError);
      PutBlock(domain, found.mipLevel, joined.mipLevel);
      PutBlock(domain, found.meanDirection, joined.meanDirection);
      if (domain.Rank() == 0)
      {
        joined.bias = found.bias;
        joined.leftOut = found.leftOut;
      }
      domain.Comm().Sum({ 0.0 }); // the first rank has told
      EXPECT_EQ(found.bias, joined.bias);
      EXPECT_EQ(found.leftOut, joined.leftOut);
    });
    return joined;
  }

  std::string Complaint(const NoisyLight& light, const ReconstructionSettings& settings)
  {
    return ErrorWords([&] { this->Of(light, settings); });
  }
};
}

INSTANTIATE_TEST_SUITE_P(Ranks, Reconstruction, SomeRanks());

TEST_P(Reconstruction, EvenLightComesBackAsItIs)
{
  for (const std::array<int, 3>& size : Sizes)
  {
    for (int channels : { 1, 3 })
    {
      ReconstructionScene scene(size, channels, 3);
      scene.Light([](std::size_t) { return 2.5; }, 0.0);
      for (Estimator estimator : All)
      {
        const ReconstructedLight light = this->Of(scene.Seen(), By(estimator));
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

TEST_P(Reconstruction, DarkLightStaysDark)
{
  ReconstructionScene scene({ 17, 6, 5 }, 3);
  scene.Light([](std::size_t) { return 0.0; }, 0.0);
  scene.count.assign(scene.count.size(), 0.0f);
  scene.weight.assign(scene.weight.size(), 0.0f);
  scene.direction.assign(scene.direction.size(), 0.0f);
  for (Estimator estimator : All)
  {
    const ReconstructedLight light = this->Of(scene.Seen(), By(estimator));
    EXPECT_THAT(light.fluence, testing::Each(0.0f));
    EXPECT_THAT(light.fluenceError, testing::Each(0.0f));
    EXPECT_THAT(light.meanDirection, testing::Each(0.0f));
    EXPECT_EQ(light.bias, 0.0);
  }
}

TEST_P(Reconstruction, SaysWhatIsMissingAndWhoMakesIt)
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

TEST_P(Reconstruction, NamesTheVoxelThatMeansNothing)
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

TEST_P(Reconstruction, SettingsOutOfRangeAreRefused)
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

TEST_P(Reconstruction, SaysWhatIsLeftOut)
{
  ReconstructionScene scene({ 4, 4, 4 });
  scene.Light([](std::size_t) { return 1.0; }, 0.0);
  scene.direction.clear();
  const ReconstructedLight light = this->Of(scene.Seen());
  EXPECT_THAT(light.leftOut, Contains(HasSubstr("mean direction")));
  EXPECT_THAT(light.leftOut, Contains(HasSubstr("colour:")));
  EXPECT_TRUE(light.meanDirection.empty());
}

TEST_P(Reconstruction, StopsWhenTold)
{
  const ReconstructionScene scene = ReconstructionScene({ 32, 32, 32 }).Light([](std::size_t) { return 1.0; }, 0.0);
  for (Estimator estimator : All)
  {
    EXPECT_THROW(this->Of(scene.Seen(), By(estimator), [](double done) { return done < 0.1; }), Aborted);
  }
}

namespace
{
/// A lit edge, a gradient and a dark corner, with noise, and photons of some weights, more of them where it is bright.
ReconstructionScene Lit(std::array<int, 3> size, int channels, int batches, bool oneColour)
{
  ReconstructionScene scene(size, channels, batches);
  const auto width = static_cast<std::size_t>(channels);
  scene.Light(
    [&](std::size_t value) {
      const std::array<int, 3> at = scene.grid.VoxelAt(value / width);
      const double colour = oneColour ? 1.0 : 1.0 + 0.5 * static_cast<double>(value % width);
      const double edge = at[0] + at[2] > size[0] / 2 + at[1] ? 5.0 * colour : 1.0;
      return (at[2] < 3 ? 0.0 : edge + 0.02 * at[1]) * colour;
    },
    0.4);
  std::mt19937 random(4);
  for (std::size_t i = 0; i < scene.grid.VoxelCount(); ++i)
  {
    std::poisson_distribution<int> photons(0.3 * scene.fluence[i * width] + 1e-3);
    scene.count[i] = static_cast<float>(photons(random));
    scene.weight[i] = scene.count[i] > 0.0f ? 0.5f + 0.01f * static_cast<float>(random() % 100) : 0.0f;
  }
  return scene;
}

void ExpectNear(const std::vector<float>& found, const std::vector<float>& wanted, double precision, const char* what)
{
  ASSERT_EQ(found.size(), wanted.size()) << what;
  double worst = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    worst = std::max<double>(worst, std::abs(found[i] - wanted[i]));
  }
  EXPECT_LE(worst, precision) << what;
}

struct Smoothed
{
  std::array<int, 3> size;
  int channels, batches;
  bool oneColour, directions;
  int levels, level;
  bool conserve;
};
}

TEST_P(Reconstruction, SmoothsLightOfOneColourAtOnce)
{
  const std::array<int, 3> size = { 12, 10, 9 };
  const ReconstructionScene one = Lit(size, 1, 2, true);
  ReconstructionScene scene(size, 3, 2);
  for (std::size_t i = 0; i < scene.batchFluence.size(); ++i)
  {
    scene.batchFluence[i] = one.batchFluence[i / 3] / (1.0f + static_cast<float>(i % 3));
  }
  scene.Average();
  ReconstructionSettings settings;
  const ReconstructedLight less = this->Of(scene.Seen(), settings);
  settings.leaveOut = false;
  const ReconstructedLight all = this->Of(scene.Seen(), settings);
  EXPECT_THAT(less.leftOut, Contains(HasSubstr("one colour")));
  EXPECT_THAT(all.leftOut, Not(Contains(HasSubstr("one colour"))));
  const double brightest = *std::max_element(all.fluence.begin(), all.fluence.end());
  ExpectNear(less.fluence, all.fluence, 1e-5 * brightest, "fluence");
  ExpectNear(less.fluenceError, all.fluenceError, 1e-5 * brightest, "error");
}

/// Blocks that end farther from each other than a box reaches beyond them, light of one and of several colours, and
/// grids smaller than a cell.
TEST_P(Reconstruction, LightDoesNotDependOnTheBlocks)
{
  for (const Smoothed& of :
    { Smoothed{ { 90, 37, 22 }, 1, 2, false, true, 5, 4, true }, { { 211, 12, 9 }, 1, 4, false, true, 8, 1, true },
      { { 211, 12, 9 }, 1, 3, false, false, 1, 2, false }, { { 101, 11, 10 }, 3, 2, false, true, 5, 1, false },
      { { 101, 11, 10 }, 3, 2, true, true, 5, 4, true }, { { 2, 1, 5 }, 1, 2, false, true, 5, 1, true } })
  {
    ReconstructionScene scene = Lit(of.size, of.channels, of.batches, of.oneColour);
    scene.direction.resize(of.directions ? scene.direction.size() : 0);
    for (Estimator estimator : All)
    {
      SCOPED_TRACE(std::to_string(of.size[0]) + " voxels, estimator " + std::to_string(static_cast<int>(estimator)));
      ReconstructionSettings settings = By(estimator);
      settings.levels = of.levels;
      settings.level = of.level;
      settings.conserve = of.conserve;
      const ReconstructedLight serial = this->On(1, scene.Seen(), settings), light = this->Of(scene.Seen(), settings);
      const bool conservative = estimator == Estimator::Conservative;
      const double most = *std::max_element(serial.fluence.begin(), serial.fluence.end());
      ExpectNear(light.fluence, serial.fluence, 1e-6 * most, "fluence");
      ExpectNear(light.fluenceError, serial.fluenceError, 1e-6 * most, "fluence_error");
      ExpectNear(light.mipLevel, serial.mipLevel, conservative ? 1e-4 : 0.0, "mip_level");
      ExpectNear(light.meanDirection, serial.meanDirection, conservative ? 1e-5 : 0.0, "mean_direction");
      EXPECT_NEAR(light.bias, serial.bias, 1e-6);
      EXPECT_EQ(light.leftOut, serial.leftOut);
    }
  }
}

TEST_P(Reconstruction, RefusesRanksThatDisagree)
{
  if (this->GetParam() == 1)
  {
    return;
  }
  const ReconstructionScene scene = Lit({ 12, 10, 8 }, 1, 2, false);
  EXPECT_THROW(OnRanks(scene.grid, this->GetParam(),
                 [&](const Domain& domain) {
                   NoisyLight light = scene.Seen();
                   light.meanDirection = domain.Rank() == 0 ? nullptr : light.meanDirection;
                   Reconstruct(this->GetDevice(), domain, light);
                 }),
    InvalidInput);
}
