// Errors that scattered photons say of themselves, of photons as the emitter makes them; their balance in large runs.

#include "DeviceTest.h"
#include "ScatteredScene.h"

#include "Photons/Emission/PhotonEmitter.h"

#include <cmath>
#include <vector>

using namespace tyndall;

namespace
{
double RootOfSquares(const std::vector<float>& values)
{
  double sum = 0.0;
  for (const float value : values)
  {
    sum += static_cast<double>(value) * value;
  }
  return std::sqrt(sum);
}

std::vector<Photon> OfAFace(const Grid& grid, std::size_t count, Sampler sampler, std::uint64_t seed)
{
  Illumination light;
  light.faces[4] = { 1.0, 1.0, 1.0 };
  return EmitPhotons(grid, light, { count, sampler, seed }).photons;
}
}

class ScatteredErrors : public DeviceTest
{
};

// Samplers spread photons by their numbers' digits; every sixteenth photon would be of one corner of the light.
TEST_F(ScatteredErrors, AreRightForEverySampler)
{
  PhotonScene scene = UnitCube(5, 1.0, 0.9);
  scene.settings.errorBatches = 16;
  for (const Sampler sampler :
    { Sampler::Hammersley, Sampler::Halton, Sampler::Jittered, Sampler::Grid, Sampler::Random })
  {
    const PhotonLight one = scene.March(this->GetDevice(), OfAFace(scene.medium.grid, 20000, sampler, 1));
    scene.settings.errorBatches = 0;
    const PhotonLight many = scene.March(this->GetDevice(), OfAFace(scene.medium.grid, 400000, sampler, 2));
    scene.settings.errorBatches = 16;
    std::vector<float> off;
    for (std::size_t i = 0; i < one.light.fluence.size(); ++i)
    {
      off.push_back(one.light.fluence[i] - many.light.fluence[i]);
    }
    const double ratio = RootOfSquares(one.light.fluenceError) / RootOfSquares(off);
    std::printf("sampler %d: error said, over the true one: %.2f\n", static_cast<int>(sampler), ratio);
    EXPECT_GT(ratio, 0.75) << static_cast<int>(sampler);
    EXPECT_LT(ratio, 2.0) << static_cast<int>(sampler); // low discrepancy is lost between batches
  }
}

TEST_F(ScatteredErrors, AreFoundBesideTheSameLight)
{
  PhotonScene scene = UnitCube(4, 2.0, 0.9);
  const std::vector<Photon> photons = OfAFace(scene.medium.grid, 5003, Sampler::Hammersley, 0);
  const PhotonLight plain = scene.March(this->GetDevice(), photons);
  scene.settings.errorBatches = 16;
  const PhotonLight batched = scene.March(this->GetDevice(), photons);
  EXPECT_EQ(plain.scatterings, batched.scatterings);
  for (std::size_t i = 0; i < plain.light.fluence.size(); ++i)
  {
    ASSERT_NEAR(plain.light.fluence[i], batched.light.fluence[i], 1e-5f * plain.light.fluence[i]);
  }
}

// A photon of many is a few units of the sums: what enters must not be rounded to whole ones.
TEST_F(ScatteredErrors, TheBalanceOfManyPhotonsCloses)
{
  for (const auto& [count, albedo] :
    std::vector<std::pair<std::size_t, double>>{ { 299993, 0.9 }, { 300007, 0.5 }, { 311111, 0.9999 } })
  {
    PhotonScene scene = UnitCube(40, 1.0, albedo);
    const PhotonLight light = scene.March(this->GetDevice(), RandomPhotons(scene.medium.grid).ThroughFace(1, count));
    std::printf("balance of %zu photons: %.1e\n", count, light.light.balance.RelativeError(1));
    EXPECT_LT(light.light.balance.RelativeError(1), 1e-8);
  }
}
