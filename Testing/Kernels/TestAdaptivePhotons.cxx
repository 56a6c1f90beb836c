#include "DeviceTest.h"
#include "PhotonScene.h"

#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Importance/PhotonImportance.h"
#include "Reconstruction/PhotonReconstruction.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

using namespace tyndall;

namespace
{
constexpr int Edge = 64;
constexpr std::size_t Uniform = 30000; ///< about as dense for these voxels as the paper's 122000 for its 128^3

/// A ball of glass in fog under a lamp: all of the adaptive pipeline.
class AdaptivePhotons : public DeviceTest
{
protected:
  void SetUp() override
  {
    DeviceTest::SetUp();
    if (!this->TheDevice)
    {
      return;
    }
    Light lamp;
    lamp.type = LightType::Point;
    lamp.position = { 0.7, 0.4, 4.0 };
    lamp.power = { 100.0, 100.0, 100.0 };
    this->Lamp.lights = { lamp };
    this->Scene.SetBall(0.5, 1.5);
    this->Scene.settings.batches = true;
    this->Marcher.emplace(this->Scene.Marcher(this->GetDevice()));
  }

  PhotonLight March(const EmissionSettings& settings)
  {
    return this->Marcher->March(EmitPhotons(this->Scene.medium.grid, this->Lamp, settings).photons);
  }

  /// The default way, with a number of photons in all.
  ReconstructedLight Adaptive(std::size_t photons, std::uint64_t seed)
  {
    ImportanceSettings settings;
    settings.seed = seed;
    const Importance importance = FindImportance(*this->Marcher, this->Scene.medium.grid, this->Lamp, settings);
    EmissionSettings emission = { photons - importance.map.Cells(), Sampler::Hammersley, seed };
    emission.map = &importance.map;
    emission.batches = 2;
    this->Noisy = this->March(emission);
    NoisyLight noisy;
    noisy.fluence = this->Noisy.light.fluence.data();
    noisy.meanDirection = this->Noisy.meanDirection.data();
    noisy.batches = this->Noisy.batches;
    noisy.batchFluence = this->Noisy.batchFluence.data();
    return Reconstruct(this->GetDevice(), Domain(this->Scene.medium.grid), noisy);
  }

  const std::vector<float>& Reference()
  {
    if (this->Rich.empty())
    {
      this->Rich = this->March({ 100 * Uniform, Sampler::Halton, 77 }).light.fluence;
    }
    return this->Rich;
  }

  double ErrorOf(const std::vector<float>& fluence)
  {
    double difference = 0.0, square = 0.0;
    for (std::size_t i = 0; i < fluence.size(); ++i)
    {
      difference += std::pow(double(fluence[i]) - this->Reference()[i], 2);
      square += std::pow(double(this->Reference()[i]), 2);
    }
    return std::sqrt(difference / square);
  }

  PhotonScene Scene{ Edge, 1.0, 0.05f, 0.4f };
  Illumination Lamp;
  std::optional<PhotonMarcher> Marcher;
  PhotonLight Noisy;
  std::vector<float> Rich;
};
}

TEST_F(AdaptivePhotons, NeedLessThanTwoFifthsOfThoseSpreadEvenlyForTheirError)
{
  const double uniform = this->ErrorOf(this->March({ Uniform, Sampler::Hammersley, 1 }).light.fluence);
  for (const std::uint64_t seed : { 1, 2, 3 })
  {
    const double adaptive = this->ErrorOf(this->Adaptive(Uniform * 2 / 5, seed).fluence);
    std::printf(
      "%zu photons spread evenly: %.4f, %zu adaptive ones: %.4f\n", Uniform, uniform, Uniform * 2 / 5, adaptive);
    EXPECT_LT(adaptive, uniform);
  }
}

TEST_F(AdaptivePhotons, TellTheirErrorHonestly)
{
  std::vector<float> sorted = this->Reference();
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  const float lit = 0.1f * sorted[sorted.size() / 2];
  for (const std::uint64_t seed : { 1, 2, 3 })
  {
    const ReconstructedLight light = this->Adaptive(Uniform * 2 / 5, seed);
    std::size_t voxels = 0, within = 0;
    for (std::size_t i = 0; i < light.fluence.size(); ++i)
    {
      if (this->Reference()[i] > lit)
      {
        ++voxels;
        within += std::abs(light.fluence[i] - this->Reference()[i]) <= 2.0f * light.fluenceError[i] ? 1 : 0;
      }
    }
    const double part = static_cast<double>(within) / static_cast<double>(voxels);
    std::printf("within two standard errors: %.4f of %zu voxels\n", part, voxels);
    EXPECT_GT(part, 0.93);
    EXPECT_LT(part, 0.97);
  }
}

TEST_F(AdaptivePhotons, KeepTheLightOfTheVolume)
{
  const ReconstructedLight light = this->Adaptive(8000, 4);
  const auto total = [](const std::vector<float>& fluence) {
    return std::accumulate(fluence.begin(), fluence.end(), 0.0);
  };
  EXPECT_NEAR(total(light.fluence) / total(this->Noisy.light.fluence), 1.0, 1e-6);
  EXPECT_LT(std::abs(light.bias), 0.01); // what had to be put right
}
