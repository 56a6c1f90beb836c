#include "DeviceTest.h"
#include "ReflectingScene.h"

#include "Reference/ReferenceTable.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace tyndall;
using testing::HasSubstr;

namespace
{
Scene Furnace(const std::array<int, 3>& size, double thickest, double albedo, const Rgb& colour)
{
  Scene scene(size);
  MakeReflectingFurnace(scene, thickest, albedo, colour);
  return scene;
}

/// A slab above ground, lit from above by diffuse light (cosine 0) or a sun.
Scene SlabOverGround(double tau, double albedo, double g, double ground, double cosine)
{
  const int layers = tau < 1.0 ? 20 : tau < 10.0 ? 40 : 200;
  Scene scene(
    { 1, 1, layers }, static_cast<float>((1.0 - albedo) * tau / layers), static_cast<float>(albedo * tau / layers));
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
  scene.settings.periodic = { true, true, false };
  scene.settings.angularDegree = g > 0.0 ? 5 : 0;
  scene.settings.source = PropagationSource::Linear;
  LightOverGround(scene, ground, cosine);
  return scene;
}
}

class FaceAlbedo : public DeviceTest
{
};

TEST_F(FaceAlbedo, KeepsEvenLightEvenWhateverEachFaceGivesBack)
{
  const Rgb colour = { 1.0, 0.5, 2.0 };
  Scene scene = Furnace({ 7, 5, 9 }, 1.0, 0.5, colour);
  scene.settings.acceleration = PropagationAcceleration::None;
  scene.settings.tolerance = 1e-7;
  const LightField light = scene.Solve(this->GetDevice());
  EXPECT_LE(Deviation(light, colour), 1e-5);
  EXPECT_LE(light.balance.RelativeError(3), 1e-5);
}

TEST_F(FaceAlbedo, KeepsEvenLightEvenWhereOrdersAreAccelerated)
{
  const Rgb colour = { 1.0, 0.5, 2.0 };
  for (double thickest : { 0.3, 3.0, 30.0 })
  {
    Scene scene = Furnace({ 7, 5, 9 }, thickest, 0.9, colour);
    scene.settings.source = PropagationSource::Linear;
    scene.settings.tolerance = 1e-6;
    const LightField light = scene.Solve(this->GetDevice());
    EXPECT_LE(Deviation(light, colour), 1e-5) << thickest;
    EXPECT_LE(light.balance.RelativeError(3), 1e-5) << thickest;
    EXPECT_TRUE(light.converged);
    EXPECT_LE(light.convergence.size(), 30u) << thickest;
  }
}

TEST_F(FaceAlbedo, LetsNothingOutOfAClosedBox)
{
  for (PropagationSource source : { PropagationSource::Constant, PropagationSource::Linear })
  {
    Scene scene({ 6, 5, 4 }, 0.3f, 0.2f);
    scene.settings.source = source;
    scene.settings.tolerance = 1e-7;
    scene.emission.assign(scene.sigma_a.size(), 0.0f);
    scene.emission[17] = 1.0f;
    scene.light.faceAlbedo.fill(Grey(1.0));
    const LightField light = scene.Solve(this->GetDevice());
    const EnergyBalance& balance = light.balance;
    EXPECT_NEAR(balance.absorbed[0], balance.emitted[0], 1e-5 * balance.emitted[0]);
    EXPECT_NEAR(balance.escaped[0], 0.0, 1e-5 * balance.emitted[0]);
    EXPECT_TRUE(light.converged);
  }
}

TEST_F(FaceAlbedo, TellsWhatLeavesEveryCell)
{
  for (PropagationSource source : { PropagationSource::Constant, PropagationSource::Linear })
  {
    Scene scene({ 8, 6, 5 });
    scene.settings.source = source;
    scene.settings.tolerance = 1e-6;
    scene.Randomise(1.0, 2.0, 0.7);
    scene.emission.assign(scene.sigma_a.size(), 0.0f);
    scene.emission[33] = 1.0f;
    scene.light.sky = { 0.3, 0.2, 0.1 };
    scene.ShineAlong({ 0.3, -0.5, -1.0 });
    Light lamp;
    lamp.type = LightType::Point;
    lamp.position = { 3.3, 2.2, 4.4 };
    scene.light.lights.push_back(lamp);
    scene.light.faceAlbedo[1] = { 0.5, 0.4, 0.3 };
    scene.light.faceAlbedo[4] = Grey(0.8);
    const LightField light = scene.Solve(this->GetDevice());
    const double entered = light.balance.entered[0];
    ASSERT_EQ(light.facePower.size(), 3 * BoxFaceCellCount(scene.medium.grid));
    for (int face = 0; face < 6; ++face)
    {
      for (int c = 0; c < 3; ++c)
      {
        const double kept = 1.0 - scene.light.faceAlbedo[face][c];
        EXPECT_NEAR(kept * Leaving(light, scene.medium.grid, face, c), light.facePowerOut[face][c], 2e-5 * entered)
          << face << ' ' << c;
      }
    }
    EXPECT_LE(light.balance.RelativeError(3), 1e-5);
  }
}

TEST_F(FaceAlbedo, LightsAVacuumAsMattGroundDoes)
{
  // A sun from above on ground of albedo 0.5: the radiance that comes back is 0.5 E cos / pi, and the fluence above
  // the ground's middle that times the solid angle of the ground.
  const int n = 20;
  Scene scene({ n, n, n });
  scene.settings.directionsPerFace = 256;
  scene.ShineAlong({ 0.0, 0.0, -1.0 }, 2.0);
  scene.light.faceAlbedo[4] = Grey(0.5);
  const LightField light = scene.Solve(this->GetDevice());
  const double area = n * n;
  EXPECT_NEAR(light.balance.entered[0], 2.0 * area, 1e-4 * area);
  EXPECT_NEAR(light.balance.escaped[0], 2.0 * area, 1e-4 * area);
  EXPECT_NEAR(light.facePowerOut[4][0], area, 1e-4 * area);
  for (int k : { 0, 5, 10, 19 })
  {
    const double h = k + 0.5, s = (n / 2 - 0.5) / h, t = (n / 2 + 0.5) / h;
    const auto corner = [](double a, double b) { return std::atan2(a * b, std::sqrt(1.0 + a * a + b * b)); };
    const double solidAngle = corner(s, s) + 2.0 * corner(s, t) + corner(t, t);
    const std::size_t voxel = (static_cast<std::size_t>(k) * n + n / 2) * n + n / 2;
    const double expected = 2.0 + solidAngle / Pi;
    EXPECT_NEAR(light.fluence[voxel * light.channels], expected, 0.02 * expected) << k;
  }
}

TEST_F(FaceAlbedo, IsLitByALampAsItsDistanceAndSlantSay)
{
  // Irradiance of the ground at (x, y): P h / (4 pi (h^2 + x^2 + y^2)^(3/2)).
  const int n = 16;
  for (int face = 0; face < 6; ++face)
  {
    Scene scene({ n, n, n });
    const int axis = face / 2;
    Light lamp;
    lamp.type = LightType::Point;
    lamp.position = { 8.0, 8.0, 8.0 };
    lamp.position[axis] = face % 2 ? n - 5.5 : 5.5;
    scene.light.lights.push_back(lamp);
    scene.settings.facePower = true;
    scene.settings.maximumOrders = 1;
    const LightField light = scene.Solve(this->GetDevice());
    const BoxFaceLayout layout = LayoutOfFace(scene.medium.grid, face);
    const auto cells = [&](int i, int j) { return light.facePower[(layout.first + j * n + i) * light.channels]; };
    for (int i : { 2, 8, 12 })
    {
      for (int j : { 5, 7 })
      {
        const double x = i + 0.5 - 8.0, y = j + 0.5 - 8.0, d2 = 5.5 * 5.5 + x * x + y * y;
        const double expected = 5.5 / (4.0 * Pi * std::pow(d2, 1.5));
        EXPECT_NEAR(cells(i, j), expected, 0.02 * expected) << face << ' ' << i << ' ' << j;
      }
    }
  }
}

TEST_F(FaceAlbedo, AddsUpAsLayersDo)
{
  // R = R_s + T_s^2 a / (1 - a R_s) of diffuse light, with the slab's own R_s and T_s; what the ground takes:
  // T_s (1 - a) / (1 - a R_s).
  for (double tau : { 0.5, 5.0 })
  {
    for (PropagationSource source : { PropagationSource::Constant, PropagationSource::Linear })
    {
      const bool plain = source == PropagationSource::Constant;
      const int layers = plain ? 10 : 40;
      if (plain && tau > 1.0)
      {
        continue; // would take a minute
      }
      Scene scene({ 1, 1, layers }, static_cast<float>(0.1 * tau / layers), static_cast<float>(0.9 * tau / layers));
      scene.settings.periodic = { true, true, false };
      scene.settings.source = source;
      scene.settings.directionsPerFace = 36;
      scene.settings.tolerance = 1e-5;
      scene.light.faces[5] = Grey(1.0);
      const auto powers = [&](double albedo) {
        scene.light.faceAlbedo[4] = Grey(albedo);
        const LightField light = scene.Solve(this->GetDevice());
        EXPECT_LE(light.balance.RelativeError(1), 1e-5);
        const double in = light.balance.entered[0];
        return std::array<double, 2>{ light.facePowerOut[5][0] / in, light.facePowerOut[4][0] / in };
      };
      const auto [r, t] = powers(0.0);
      for (double albedo : { 0.3, 0.8, 1.0 })
      {
        const auto [reflected, taken] = powers(albedo);
        // The set's own angular distribution of ground light is that of the light from above.
        EXPECT_NEAR(reflected, r + t * t * albedo / (1.0 - albedo * r), 0.002) << tau << ' ' << albedo;
        EXPECT_NEAR(taken, t * (1.0 - albedo) / (1.0 - albedo * r), 0.002) << tau << ' ' << albedo;
      }
    }
  }
}

TEST_F(FaceAlbedo, IsMattGroundUnderASlab)
{
  const std::vector<double> cosines = { 0.0, 1.0, 0.5 };
  for (double tau : { 0.5, 5.0, 50.0 })
  {
    for (double albedo : { 0.9, 1.0 })
    {
      for (double g : { 0.0, 0.85 })
      {
        for (double ground : { 0.3, 0.8, 1.0 })
        {
          for (double cosine : cosines)
          {
            const ReferenceRow row = ReferenceRowWhere("slab_over_ground",
              { { "tau", tau }, { "albedo", albedo }, { "g", g }, { "ground", ground }, { "cosine", cosine } });
            Scene scene = SlabOverGround(tau, albedo, g, ground, cosine);
            const LightField light = scene.Solve(this->GetDevice());
            const double in = light.balance.entered[0];
            EXPECT_NEAR(light.facePowerOut[5][0] / in, row["reflected"], 0.003)
              << tau << ' ' << albedo << ' ' << g << ' ' << ground << ' ' << cosine;
            EXPECT_NEAR(light.facePowerOut[4][0] / in, row["taken"], 0.003)
              << tau << ' ' << albedo << ' ' << g << ' ' << ground << ' ' << cosine;
            EXPECT_LE(light.balance.RelativeError(1), 1e-5);
            EXPECT_TRUE(light.converged);
          }
        }
      }
    }
  }
}

TEST_F(FaceAlbedo, IsTheSameAlongEveryAxis)
{
  std::vector<double> means;
  for (int axis = 0; axis < 3; ++axis)
  {
    Scene scene({ 6, 6, 6 }, 0.05f, 0.2f);
    std::array<double, 3> down = { 0.2, 0.2, 0.2 };
    down[axis] = -1.0;
    scene.ShineAlong(down);
    scene.light.faceAlbedo[2 * axis] = Grey(0.7);
    const LightField light = scene.Solve(this->GetDevice());
    double sum = 0.0;
    for (float fluence : light.fluence)
    {
      sum += fluence;
    }
    means.push_back(sum);
  }
  EXPECT_NEAR(means[1], means[0], 1e-5 * means[0]);
  EXPECT_NEAR(means[2], means[0], 1e-5 * means[0]);
}

TEST_F(FaceAlbedo, IsLookedAt)
{
  const auto refusal = [this](double albedo, bool periodic, double absorption) {
    Scene scene({ 3, 3, 3 }, static_cast<float>(absorption), 0.1f);
    scene.light.sky = Grey(1.0);
    scene.light.faceAlbedo[2] = Grey(albedo);
    scene.settings.periodic = { false, periodic, false };
    if (absorption == 0.0)
    {
      scene.light.faceAlbedo.fill(Grey(1.0));
    }
    try
    {
      scene.Solve(this->GetDevice());
    }
    catch (const InvalidInput& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal(1.5, false, 0.1), HasSubstr("FaceAlbedo of face 2"));
  EXPECT_THAT(refusal(-0.1, false, 0.1), HasSubstr("FaceAlbedo of face 2"));
  EXPECT_THAT(refusal(std::numeric_limits<double>::quiet_NaN(), false, 0.1), HasSubstr("FaceAlbedo of face 2"));
  EXPECT_THAT(refusal(0.5, true, 0.1), HasSubstr("periodic"));
  EXPECT_THAT(refusal(1.0, false, 0.0), HasSubstr("without end"));
  EXPECT_EQ(refusal(0.5, false, 0.1), "");
}
