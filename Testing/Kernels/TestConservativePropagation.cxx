#include "DeviceTest.h"
#include "Difference.h"
#include "ErrorWords.h"
#include "MediumScene.h"

#include "Numerics/Constants.h"
#include "Reference/SlabReference.h"

#include <algorithm>
#include <cmath>
#include <utility>

using namespace tyndall;

namespace
{
double LargestRelativeDifference(const std::vector<float>& a, const std::vector<float>& b)
{
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
  {
    largest = std::max(largest, std::abs(static_cast<double>(a[i]) - b[i]) / std::max<double>(std::abs(b[i]), 1e-30));
  }
  return largest;
}

std::vector<float> MirroredInX(const std::vector<float>& values, std::array<int, 3> size)
{
  std::vector<float> mirrored(values);
  for (std::size_t row = 0; row < values.size(); row += size[0])
  {
    std::reverse(mirrored.begin() + row, mirrored.begin() + row + size[0]);
  }
  return mirrored;
}
}

class ConservativePropagation : public DeviceTest
{
};

TEST_F(ConservativePropagation, GivesBackEveryWattItTakes)
{
  for (double albedo : { 0.0, 0.5, 1.0 })
  {
    for (double thickest : { 0.0, 1e-8, 1e-4, 1.0, 1e3, 1e6 })
    {
      for (bool periodic : { false, true })
      {
        Scene scene({ 19, 16, 13 });
        scene.Randomise(thickest, 8.0, albedo);
        scene.ShineFromEverywhere(1.0);
        scene.ShineAlong({ 0.3, -0.5, -0.8 }, 2.0);
        scene.settings.maximumOrders = 3;
        scene.settings.periodic = { periodic, periodic, false };
        const LightField light = scene.Solve(this->GetDevice());
        EXPECT_LT(light.balance.RelativeError(1), 1e-5)
          << "albedo " << albedo << ", sigma_t up to " << thickest << (periodic ? ", periodic" : ", open");
        EXPECT_GT(light.balance.entered[0], 0.0);
        ExpectFiniteAndNotNegative(light.fluence);
      }
    }
  }
}

TEST_F(ConservativePropagation, LetsEachFaceShineAlone)
{
  for (int cells : { 5, 9, 16 }) // rows of no whole number of vectors, and of one
  {
    for (bool periodic : { false, true })
    {
      for (int face = 0; face < 6; ++face)
      {
        Scene scene({ cells, cells, cells }, 0.05f, 0.0f);
        scene.settings.periodic[(face / 2 + 1) % 3] = periodic;
        scene.light.faces[face] = { 1.0, 1.0, 1.0 };
        const LightField light = scene.Solve(this->GetDevice());
        EXPECT_LT(light.balance.RelativeError(1), 1e-5) << cells << " voxels, face " << face;
        if (face / 2 != 0)
        {
          EXPECT_LT(LargestRelativeDifference(light.fluence, MirroredInX(light.fluence, { cells, cells, cells })), 1e-5)
            << cells << " voxels, face " << face;
        }
      }
    }
  }
}

TEST_F(ConservativePropagation, LetsLightInOnceWhereRaysGoRoundOneAxis)
{
  // Rows of no whole number of vectors: what waits beside them comes in on the first round only.
  Scene scene({ 10, 5, 9 }, 0.001f, 3.0f);
  scene.ShineFromEverywhere(1.0);
  scene.settings.maximumOrders = 3;
  scene.settings.periodic = { true, false, false };
  EXPECT_LT(scene.Solve(this->GetDevice()).balance.RelativeError(1), 1e-5);
}

TEST_F(ConservativePropagation, CountsEnteringPowerAsTheSurfaceIntegralOfRadiance)
{
  Scene scene({ 40, 40, 40 }, 0.01f, 0.0f);
  scene.ShineFromEverywhere(3.0);
  scene.settings.directionsPerFace = 100;
  const LightField light = scene.Solve(this->GetDevice());
  EXPECT_NEAR(light.balance.entered[0] / (6.0 * 40.0 * 40.0 * Pi * 3.0), 1.0, 0.01);
}

TEST_F(ConservativePropagation, KeepsTheFurnaceAtItsTemperature)
{
  Scene scene({ 17, 12, 9 });
  scene.Randomise(1e3, 8.0, 0.0);
  scene.emission.resize(scene.sigma_a.size());
  const float equilibrium = 2.0f;
  for (std::size_t i = 0; i < scene.emission.size(); ++i)
  {
    scene.emission[i] = scene.sigma_a[i] * equilibrium;
  }
  scene.ShineFromEverywhere(equilibrium);
  const LightField light = scene.Solve(this->GetDevice());
  for (float fluence : light.fluence)
  {
    ASSERT_NEAR(fluence / (4.0 * Pi * equilibrium), 1.0, 1e-5);
  }
}

TEST_F(ConservativePropagation, LeavesRadianceInVacuumAlone)
{
  Scene scene({ 21, 8, 5 });
  scene.ShineFromEverywhere(1.0);
  const LightField light = scene.Solve(this->GetDevice());
  for (float fluence : light.fluence)
  {
    ASSERT_NEAR(fluence / (4.0 * Pi), 1.0, 2e-6);
  }
}

TEST_F(ConservativePropagation, AttenuatesABeamExponentiallyAlongEachAxis)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    for (double sign : { -1.0, 1.0 })
    {
      for (double sigma : { 1e-6, 0.1, 3.0 })
      {
        Scene scene({ 20, 20, 20 }, static_cast<float>(sigma), 0.0f);
        std::array<double, 3> direction = {};
        direction[axis] = sign;
        scene.ShineAlong(direction);
        const LightField light = scene.Solve(this->GetDevice());
        const double out = light.facePowerOut[2 * axis + (sign > 0.0 ? 1 : 0)][0] / light.balance.entered[0];
        EXPECT_NEAR(light.balance.entered[0], 400.0, 1e-3);
        EXPECT_NEAR(out / std::exp(-20.0 * sigma), 1.0, 1e-5 * std::max(1.0, 20.0 * sigma));
        EXPECT_NEAR(light.balance.absorbed[0] / (400.0 * -std::expm1(-20.0 * sigma)), 1.0, 1e-5);
      }
    }
  }
}

TEST_F(ConservativePropagation, CastsTheSunsShadowAlongExactRays)
{
  Scene scene({ 24, 24, 24 });
  scene.sigma_a[(static_cast<std::size_t>(20) * 24 + 12) * 24 + 12] = 1e6f;
  scene.ShineAlong({ 0.0, 0.0, -1.0 });
  const LightField light = scene.Solve(this->GetDevice());
  for (int z = 0; z < 24; ++z)
  {
    const float shaded = light.fluence[(static_cast<std::size_t>(z) * 24 + 12) * 24 + 12];
    const float beside = light.fluence[(static_cast<std::size_t>(z) * 24 + 12) * 24 + 13];
    EXPECT_NEAR(beside, 1.0, 1e-6);
    EXPECT_NEAR(shaded, z > 20 ? 1.0 : 0.0, 1e-5) << z;
  }
}

TEST_F(ConservativePropagation, ReflectsAndTransmitsAsSlabsDo)
{
  const std::pair<double, double> slabs[] = { { 0.1, 0.5 }, { 1.0, 0.5 }, { 1.0, 0.9 }, { 1.0, 0.999 }, { 5.0, 0.99 } };
  for (const auto& [tau, albedo] : slabs)
  {
    const SlabReference slab = SlabOf(tau, albedo);
    const int cells = 24;
    Scene scene({ 1, 1, cells }, static_cast<float>(slab.tau * (1.0 - slab.albedo) / cells),
      static_cast<float>(slab.tau * slab.albedo / cells));
    scene.settings.periodic = { true, true, false };
    scene.settings.tolerance = 1e-5;
    scene.settings.directionsPerFace = 49;
    scene.light.faces[4] = { 1.0, 1.0, 1.0 };
    const LightField diffuse = scene.Solve(this->GetDevice());
    const double in = diffuse.balance.entered[0];
    EXPECT_NEAR(in / Pi, 1.0, 1e-2);
    EXPECT_NEAR(diffuse.facePowerOut[4][0] / in, slab.diffuseR, 6e-3) << slab.tau << ' ' << slab.albedo;
    EXPECT_NEAR(diffuse.facePowerOut[5][0] / in, slab.diffuseT, 6e-3) << slab.tau << ' ' << slab.albedo;

    scene.light.faces[4] = {};
    scene.ShineAlong({ 0.0, 0.0, 1.0 });
    const LightField beam = scene.Solve(this->GetDevice());
    EXPECT_NEAR(beam.facePowerOut[4][0], slab.beamR, 2e-3) << slab.tau << ' ' << slab.albedo;
    EXPECT_NEAR(beam.facePowerOut[5][0], slab.beamT, 2e-3) << slab.tau << ' ' << slab.albedo;
  }
}

TEST_F(ConservativePropagation, ConvergesWithTheSquareOfTheVoxelOnASlab)
{
  const double tau = 5.0, albedo = 0.99;
  std::vector<double> transmitted;
  for (int cells : { 8, 16, 32 })
  {
    Scene scene(
      { 1, 1, cells }, static_cast<float>(tau * (1.0 - albedo) / cells), static_cast<float>(tau * albedo / cells));
    scene.settings.periodic = { true, true, false };
    scene.settings.source = PropagationSource::Constant; // a linear one has hardly an error to see the order of
    scene.settings.acceleration = PropagationAcceleration::None;
    scene.settings.tolerance = 1e-6;
    scene.ShineAlong({ 0.0, 0.0, 1.0 });
    transmitted.push_back(scene.Solve(this->GetDevice()).facePowerOut[5][0]);
  }
  const double order = std::log2((transmitted[0] - transmitted[1]) / (transmitted[1] - transmitted[2]));
  RecordProperty("order", std::to_string(order));
  EXPECT_GT(order, 1.8);
}

TEST_F(ConservativePropagation, TakesAnyGrid)
{
  const std::array<int, 3> sizes[] = { { 1, 1, 1 }, { 1, 7, 3 }, { 5, 1, 1 }, { 33, 2, 17 }, { 1, 1, 65 } };
  for (const std::array<int, 3>& size : sizes)
  {
    for (const std::array<double, 3>& spacing :
      { std::array<double, 3>{ 1.0, 1.0, 1.0 }, std::array<double, 3>{ 0.1, 1.0, 3.0 },
        std::array<double, 3>{ 1000.0, 1.0, 1.0 }, std::array<double, 3>{ 2e-9, 1e-9, 1e-9 } })
    {
      Scene scene(size, static_cast<float>(0.1 / spacing[1]), static_cast<float>(0.4 / spacing[1]));
      scene.medium.grid.spacing = spacing;
      scene.medium.grid.origin = { 1e6, -1e6, 5e5 };
      scene.ShineFromEverywhere(1.0);
      scene.settings.maximumOrders = 4;
      const LightField light = scene.Solve(this->GetDevice());
      EXPECT_LT(light.balance.RelativeError(1), 1e-5) << size[0] << 'x' << size[1] << 'x' << size[2];
      ExpectFiniteAndNotNegative(light.fluence);
      EXPECT_LT(*std::max_element(light.fluence.begin(), light.fluence.end()), 4.0 * Pi * 1.0001);
    }
  }
}

TEST_F(ConservativePropagation, SolvesColoursWithTheirOwnSigmaT)
{
  Scene rgb({ 8, 9, 10 });
  rgb.sigma_a.assign(3 * rgb.medium.grid.VoxelCount(), 0.0f);
  for (std::size_t i = 0; i < rgb.sigma_a.size(); ++i)
  {
    rgb.sigma_a[i] = 0.1f * (1.0f + i % 3);
  }
  rgb.ShineAlong({ 0.0, 1.0, 0.0 });
  const LightField light = rgb.Solve(this->GetDevice());
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(light.facePowerOut[3][c] / (80.0 * std::exp(-0.9 * (1 + c))), 1.0, 1e-5);
    EXPECT_LT(light.balance.RelativeError(3), 1e-6);
  }
}

// Rays still on their way round a periodic axis when a sweep ends belong to the channel whose sigma_t they go through.
TEST_F(ConservativePropagation, KeepsApartWhatGoesRoundInColoursOfTheirOwnSigmaT)
{
  const std::array<int, 3> size = { 2, 2, 24 };
  const auto solve = [&](std::array<float, 3> sigma_t, int channels) {
    Scene scene(size);
    const std::size_t voxels = scene.medium.grid.VoxelCount();
    scene.sigma_a.resize(channels * voxels);
    scene.sigma_s.resize(channels * voxels);
    for (std::size_t i = 0; i < channels * voxels; ++i)
    {
      scene.sigma_a[i] = 0.5f * sigma_t[i % channels];
      scene.sigma_s[i] = 0.5f * sigma_t[i % channels];
    }
    scene.light.faces[4] = { 1.0, 1.0, 1.0 };
    scene.settings.periodic = { true, true, false };
    scene.settings.acceleration = PropagationAcceleration::None;
    scene.settings.adaptDirections = false;
    scene.settings.maximumOrders = 3;
    scene.settings.directionsPerFace = 9;
    return scene.Solve(this->GetDevice());
  };
  const std::array<float, 3> sigma_t = { 0.0002f, 0.002f, 0.02f };
  const LightField together = solve(sigma_t, 3);
  ASSERT_EQ(together.channels, 3);
  for (int c = 0; c < 3; ++c)
  {
    const LightField alone = solve({ sigma_t[c], sigma_t[c], sigma_t[c] }, 1);
    for (std::size_t i = 0; i < alone.fluence.size(); ++i)
    {
      ASSERT_NEAR(together.fluence[3 * i + c] / alone.fluence[i], 1.0, 1e-5) << "channel " << c << ", voxel " << i;
    }
    EXPECT_NEAR(together.balance.leftOver[c], alone.balance.leftOver[0], 1e-5 * alone.balance.entered[0]);
  }
}

TEST_F(ConservativePropagation, NetFluxHasTheSourcesAndSinksOfTheMedium)
{
  // On the box's faces the flux that goes out less the one that comes in is minus what is absorbed.
  Scene scene({ 16, 16, 16 }, 0.05f, 0.1f);
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  scene.settings.netFlux = true;
  scene.settings.tolerance = 1e-6;
  const LightField light = scene.Solve(this->GetDevice());
  ASSERT_EQ(light.netFlux.size(), 3 * light.fluence.size());
  double throughMiddle[3] = {};
  double absorbedAbove = 0.0;
  for (int z = 0; z < 16; ++z)
  {
    for (int i = 0; i < 256; ++i)
    {
      const std::size_t voxel = static_cast<std::size_t>(z) * 256 + i;
      for (int axis = 0; axis < 3 && z == 8; ++axis)
      {
        throughMiddle[axis] += light.netFlux[3 * voxel + axis];
      }
      absorbedAbove += z > 8 ? 0.05 * light.fluence[voxel] : z == 8 ? 0.025 * light.fluence[voxel] : 0.0;
    }
  }
  EXPECT_GT(throughMiddle[2], 0.0) << "light comes from below";
  EXPECT_NEAR(throughMiddle[0] / throughMiddle[2], 0.0, 1e-5) << "and not from one side";
  EXPECT_NEAR(throughMiddle[1] / throughMiddle[2], 0.0, 1e-5);
  double out = light.facePowerOut[5][0];
  EXPECT_GT(throughMiddle[2], out + 0.5 * absorbedAbove);
  EXPECT_LT(throughMiddle[2], light.balance.entered[0]);
}

TEST_F(ConservativePropagation, AMapTwiceAsFineEndsNearTheSameLight)
{
  Scene scene({ 12, 12, 12 }, 0.05f, 0.2f);
  scene.ShineFromEverywhere(1.0);
  scene.settings.maximumOrders = 3;
  const LightField coarse = scene.Solve(this->GetDevice());
  scene.settings.mapResolution = 2;
  const LightField fine = scene.Solve(this->GetDevice());
  EXPECT_LT(fine.balance.RelativeError(1), 1e-5);
  EXPECT_LT(LargestRelativeDifference(coarse.fluence, fine.fluence), 0.1);
}

TEST_F(ConservativePropagation, StaysDarkWithoutLight)
{
  Scene scene({ 4, 4, 4 }, 1.0f, 1.0f);
  const LightField light = scene.Solve(this->GetDevice());
  EXPECT_EQ(*std::max_element(light.fluence.begin(), light.fluence.end()), 0.0f);
  EXPECT_EQ(light.balance.RelativeError(1), 0.0);
}

TEST_F(ConservativePropagation, RefusesWhatHasNoMeaning)
{
  const auto solve = [&](auto&& spoil) {
    Scene scene({ 4, 5, 6 }, 0.1f, 0.1f);
    scene.ShineFromEverywhere(1.0);
    spoil(scene);
    scene.Solve(this->GetDevice());
  };
  const auto message = [&](auto&& spoil) { return ErrorWords([&] { solve(spoil); }); };
  EXPECT_NE(message([](Scene& s) { s.sigma_a[(3 * 5 + 2) * 4 + 1] = NAN; }).find("(1, 2, 3)"), std::string::npos);
  EXPECT_NE(message([](Scene& s) { s.sigma_s[7] = -1.0f; }).find("sigma_s"), std::string::npos);
  EXPECT_NE(message([](Scene& s) { s.sigma_s[7] = INFINITY; }).find("sigma_s"), std::string::npos);
  EXPECT_NE(message([](Scene& s) { s.medium.grid.spacing[1] = 0.0; }).find("along y"), std::string::npos);
  EXPECT_NE(message([](Scene& s) { s.ShineAlong({ 0.0, 0.0, 0.0 }); }).find("Light 0"), std::string::npos);
  EXPECT_NE(message([](Scene& s) { s.settings.directionsPerFace = 7; }).find("DirectionsPerFace"), std::string::npos);
  EXPECT_NE(message([](Scene& s) { s.settings.mapResolution = 0; }).find("MapResolution"), std::string::npos);
  EXPECT_NE(message([](Scene& s) { s.settings.tolerance = 0.0; }).find("Tolerance"), std::string::npos);
}

TEST_F(ConservativePropagation, StopsWhereTheToleranceIsMetNotBefore)
{
  // A dense ball in a large vacuum: nearly all light passes by, and says nothing of the orders within the ball.
  Scene scene({ 24, 24, 24 });
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    const double r = std::hypot(i % 24 - 11.5, i / 24 % 24 - 11.5, i / 576 - 11.5);
    scene.sigma_s[i] = r < 5.0 ? 1.98f : 0.0f;
    scene.sigma_a[i] = r < 5.0 ? 0.02f : 0.0f;
  }
  scene.ShineFromEverywhere(1.0);
  scene.settings.acceleration = PropagationAcceleration::None;
  scene.settings.source = PropagationSource::Constant;
  scene.settings.tolerance = 1e-6;
  const LightField exact = scene.Solve(this->GetDevice());
  for (double tolerance : { 1e-2, 1e-3 })
  {
    scene.settings.tolerance = tolerance;
    const LightField light = scene.Solve(this->GetDevice());
    double difference = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
    {
      difference += scene.sigma_s[i] * (exact.fluence[i] - light.fluence[i]);
      sum += scene.sigma_s[i] * exact.fluence[i];
    }
    EXPECT_LT(difference / sum, 2.0 * tolerance);
    EXPECT_GT(difference / sum, 0.1 * tolerance) << "and no more work than that";
  }
}
