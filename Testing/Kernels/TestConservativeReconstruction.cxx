#include "Caustic.h"
#include "DeviceTest.h"
#include "ReconstructionScene.h"

using namespace tyndall;

namespace
{
class ConservativeReconstruction : public DeviceTest
{
protected:
  ReconstructedLight Of(const ReconstructionScene& scene, const ReconstructionSettings& settings = {})
  {
    return Reconstruct(this->GetDevice(), Domain(scene.grid), scene.Seen(), settings);
  }
};

double Deviation(const std::vector<float>& values, double from)
{
  double sum = 0.0;
  for (float v : values)
  {
    sum += (v - from) * (v - from);
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// A soft beam through a lit volume.
double Beam(const ReconstructionScene& scene, std::size_t voxel)
{
  const std::array<int, 3> p = scene.Place(voxel);
  const double x = (p[0] + 0.5) / scene.grid.size[0] - 0.4, y = (p[1] + 0.5) / scene.grid.size[1] - 0.5;
  const double edge = 0.12 + 0.1 * (p[2] + 0.5) / scene.grid.size[2];
  return 1.0 + 4.0 / (1.0 + std::exp((std::hypot(x, y) - edge) * 60.0));
}
}

TEST_F(ConservativeReconstruction, IndependentNoiseOnEvenLightIsTwentyTimesLess)
{
  for (int batches : { 2, 3, 4 })
  {
    ReconstructionScene scene({ 64, 64, 64 }, 1, batches);
    scene.Light([](std::size_t) { return 2.0; }, 0.5);
    const ReconstructedLight light = this->Of(scene);
    EXPECT_LT(20.0 * Deviation(light.fluence, 2.0), Deviation(scene.fluence, 2.0)) << batches;
  }
}

TEST_F(ConservativeReconstruction, ABrightVoxelThatBatchesAgreeOnIsKept)
{
  ReconstructionScene scene({ 32, 32, 32 });
  const std::size_t bright = (16 * 32 + 15) * 32 + 17;
  scene.Light([&](std::size_t i) { return i == bright ? 1000.0 : 1.0; }, 0.0);
  const ReconstructedLight light = this->Of(scene);
  EXPECT_NEAR(light.fluence[bright], 1000.0, 10.0);
  EXPECT_NEAR(light.fluence[bright + 1], 1.0, 10.0);
  EXPECT_LT(light.mipLevel[bright], 0.1);
}

TEST_F(ConservativeReconstruction, TheTotalOfEachChannelStays)
{
  for (int channels : { 1, 3 })
  {
    ReconstructionScene scene({ 40, 33, 21 }, channels);
    scene.Light([&](std::size_t i) { return (1 + i % channels) * Beam(scene, i / channels); }, 0.55);
    const ReconstructedLight light = this->Of(scene);
    for (int c = 0; c < channels; ++c)
    {
      const double before = Total(scene.batchFluence, channels, c) / 2.0;
      EXPECT_NEAR(Total(light.fluence, channels, c), before, 1e-6 * before) << c;
    }
    ReconstructionSettings raw;
    raw.conserve = false;
    const ReconstructedLight left = this->Of(scene, raw);
    double after = 0.0, before = 0.0;
    for (int c = 0; c < channels; ++c)
    {
      after += Total(left.fluence, channels, c);
      before += Total(scene.batchFluence, channels, c) / 2.0;
    }
    EXPECT_NEAR(left.bias, after / before - 1.0, 1e-6);
    EXPECT_NEAR(left.bias, light.bias, 1e-9);
  }
}

/// Part of the voxels whose error is within two standard errors, where the truth is a beam.
double HeldBy(const ReconstructionScene& scene, const ReconstructedLight& light)
{
  double held = 0.0;
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    held += std::abs(light.fluence[i] - Beam(scene, i)) <= 2.0 * light.fluenceError[i];
  }
  return held / static_cast<double>(light.fluence.size());
}

/// Photons at random, whose noise is the same along rays. Those of real scenes are spread better: see
/// TestAdaptivePhotons.
TEST_F(ConservativeReconstruction, TwoStandardErrorsHoldTheTruthInAboutNineteenVoxelsOfTwenty)
{
  constexpr unsigned seeds = 5;
  for (const int batches : { 2, 4 })
  {
    for (const double photons : { 1.0, 4.0, 16.0 })
    {
      double held = 0.0;
      for (unsigned seed = 1; seed <= seeds; ++seed)
      {
        ReconstructionScene scene({ 64, 64, 64 }, 1, batches);
        scene.LightAlongRays([&](std::size_t i) { return Beam(scene, i); }, photons, seed);
        held += HeldBy(scene, this->Of(scene)) / seeds;
      }
      EXPECT_NEAR(held, 0.95, 0.03) << batches << " batches, " << photons << " photons";
    }
  }
}

TEST_F(ConservativeReconstruction, TheErrorIsOnTheSafeSideWhereVoxelsHaveNoiseOfTheirOwn)
{
  for (const int batches : { 2, 4 })
  {
    ReconstructionScene scene({ 64, 64, 64 }, 1, batches);
    scene.Light([&](std::size_t i) { return Beam(scene, i); }, 0.55);
    EXPECT_GT(HeldBy(scene, this->Of(scene)), 0.95) << batches;
  }
}

TEST_F(ConservativeReconstruction, ColoursThatDifferHaveErrorsOfTheirOwn)
{
  ReconstructionScene scene({ 48, 48, 48 }, 3);
  scene.Light([&](std::size_t i) { return i % 3 == 0 ? 0.2 * Beam(scene, i / 3) : Beam(scene, i / 3); }, 0.55);
  for (std::size_t i = 0; i < scene.batchFluence.size(); ++i)
  {
    if (i % 3 == 2)
    {
      scene.batchFluence[i] = static_cast<float>(Beam(scene, scene.ValueOf(i) / 3)); // blue has no noise
    }
  }
  scene.Average();
  const ReconstructedLight light = this->Of(scene);
  for (std::size_t c = 0; c < 3; ++c)
  {
    double held = 0.0, error = 0.0;
    for (std::size_t i = c; i < light.fluence.size(); i += 3)
    {
      const double truth = (c == 0 ? 0.2 : 1.0) * Beam(scene, i / 3);
      held += std::abs(light.fluence[i] - truth) <= 2.0 * light.fluenceError[i] + 1e-5;
      error += light.fluenceError[i] / (c == 0 ? 0.2 : 1.0);
    }
    EXPECT_GT(held / (light.fluence.size() / 3), 0.93) << c;
    EXPECT_EQ(error / (light.fluence.size() / 3) < 1e-3, c == 2) << c;
  }
}

TEST_F(ConservativeReconstruction, LightOfAnyPowerIsTheSameLight)
{
  ReconstructionScene scene({ 32, 20, 17 });
  scene.Light([&](std::size_t i) { return Beam(scene, i); }, 0.5);
  const ReconstructedLight light = this->Of(scene);
  for (double power : { 1e-30, 1e-6, 1e6, 1e30 })
  {
    ReconstructionScene other = scene;
    for (float& value : other.batchFluence)
    {
      value = static_cast<float>(value * power);
    }
    const ReconstructedLight scaled = this->Of(other);
    for (std::size_t i = 0; i < light.fluence.size(); ++i)
    {
      ASSERT_NEAR(scaled.fluence[i] / power, light.fluence[i], 1e-5) << power;
      ASSERT_NEAR(scaled.fluenceError[i] / power, light.fluenceError[i], 1e-5) << power;
      ASSERT_NEAR(scaled.mipLevel[i], light.mipLevel[i], 1e-3) << power;
    }
  }
}

TEST_F(ConservativeReconstruction, ColoursAreFilteredAlike)
{
  ReconstructionScene grey({ 32, 24, 16 });
  grey.Light([&](std::size_t i) { return Beam(grey, i); }, 0.5);
  ReconstructionScene coloured({ 32, 24, 16 }, 3);
  const float tint[3] = { 0.5f, 0.25f, 0.25f };
  for (std::size_t i = 0; i < coloured.batchFluence.size(); ++i)
  {
    coloured.batchFluence[i] = tint[i % 3] * grey.batchFluence[i / 3];
  }
  const ReconstructedLight a = this->Of(grey), b = this->Of(coloured.Average());
  for (std::size_t i = 0; i < b.fluence.size(); ++i)
  {
    ASSERT_NEAR(b.fluence[i], tint[i % 3] * a.fluence[i / 3], 1e-5);
    ASSERT_NEAR(b.fluenceError[i], tint[i % 3] * a.fluenceError[i / 3], 1e-5);
  }
  EXPECT_EQ(b.mipLevel.size(), a.mipLevel.size());
}

TEST_F(ConservativeReconstruction, IsTheSameEveryTime)
{
  ReconstructionScene scene({ 48, 31, 22 }, 1, 3);
  scene.Light([&](std::size_t i) { return Beam(scene, i); }, 0.55);
  const ReconstructedLight a = this->Of(scene), b = this->Of(scene);
  EXPECT_EQ(a.fluence, b.fluence);
  EXPECT_EQ(a.fluenceError, b.fluenceError);
  EXPECT_EQ(a.meanDirection, b.meanDirection);
  EXPECT_EQ(a.mipLevel, b.mipLevel);
}

TEST_F(ConservativeReconstruction, ALineIsFilteredAlikeAlongEachAxis)
{
  ReconstructionScene along({ 1000, 1, 1 }), across({ 1, 1, 1000 });
  along.Light([](std::size_t i) { return 2.0 + std::sin(0.01 * static_cast<double>(i)); }, 0.4);
  across.Light([](std::size_t i) { return 2.0 + std::sin(0.01 * static_cast<double>(i)); }, 0.4);
  const ReconstructedLight a = this->Of(along), b = this->Of(across);
  for (std::size_t i = 0; i < 1000; ++i)
  {
    ASSERT_NEAR(a.fluence[i], b.fluence[i], 1e-5) << i;
    ASSERT_NEAR(a.fluenceError[i], b.fluenceError[i], 1e-5) << i;
  }
}

TEST_F(ConservativeReconstruction, ACausticOfFewPhotonsComesNearerToThatOfMany)
{
  const int edge = 48;
  PhotonScene ball = caustic::BallScene(this->GetDevice(), edge);
  PhotonMarcher marcher = ball.Marcher(this->GetDevice());
  Illumination sun;
  sun.lights = { Light() };
  sun.lights[0].direction = caustic::Askew().along;
  const auto march = [&](std::size_t count, std::uint64_t seed) {
    return marcher.March(EmitPhotons(ball.medium.grid, sun, { count, Sampler::Random, seed }).photons);
  };
  const std::vector<float> truth = march(1000000, 1).light.fluence;
  ReconstructionScene scene({ edge, edge, edge });
  const PhotonLight batches[] = { march(8000, 2), march(8000, 3) };
  scene.direction = batches[1].meanDirection;
  ASSERT_EQ(scene.batchFluence.size(), 2 * truth.size());
  for (std::size_t i = 0; i < scene.batchFluence.size(); ++i)
  {
    scene.batchFluence[i] = batches[scene.BatchOf(i)].light.fluence[scene.ValueOf(i)];
  }
  scene.Average();
  const ReconstructedLight light = this->Of(scene);
  const auto error = [&](const std::vector<float>& values) {
    double sum = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i)
    {
      sum += (values[i] - truth[i]) * (values[i] - truth[i]);
    }
    return std::sqrt(sum);
  };
  EXPECT_LT(2.0 * error(light.fluence), error(scene.fluence));
  const ReconstructedLight wide = Reconstruct(
    this->GetDevice(), Domain(scene.grid), scene.Seen(), By(ReconstructionSettings::Estimator::ConstantRadius));
  EXPECT_LT(error(light.fluence), error(wide.fluence));
}
