#include "DeviceTest.h"
#include "Difference.h"
#include "ErrorWords.h"
#include "OrdinatesScene.h"
#include "ReflectingScene.h"

#include "Device/Errors.h"
#include "Reference/BoxMonteCarlo.h"
#include "Reference/ReferenceTable.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

using namespace tyndall;
using testing::HasSubstr;

namespace
{
LitMedium Furnace(const std::array<int, 3>& size, double thickest, double albedo, const Rgb& colour)
{
  LitMedium scene(size);
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

/// Of light propagation maps, and of discrete ordinates.
class ReflectingFaces
  : public DeviceTest
  , public testing::WithParamInterface<const char*>
{
protected:
  bool OfOrdinates() const { return this->GetParam() == std::string("Ordinates"); }
  LightField Solve(LitMedium& scene, double tolerance = 1e-4, KeptLight* kept = nullptr)
  {
    scene.settings.tolerance = scene.how.tolerance = tolerance;
    scene.how.directionsPerFace = 9;
    return this->OfOrdinates() ? scene.SolveOrdinates(this->GetDevice(), {}, kept)
                               : scene.Solve(this->GetDevice(), {}, kept);
  }
};

INSTANTIATE_TEST_SUITE_P(
  Of, ReflectingFaces, testing::Values("Maps", "Ordinates"), [](const auto& info) { return std::string(info.param); });

TEST_P(ReflectingFaces, KeepEvenLightEvenWhateverEachFaceGivesBack)
{
  const Rgb colour = { 1.0, 0.5, 2.0 };
  LitMedium scene = Furnace({ 7, 5, 9 }, 1.0, 0.5, colour);
  scene.settings.acceleration = PropagationAcceleration::None;
  const LightField light = this->Solve(scene, 1e-7);
  EXPECT_LE(Deviation(light, colour), 1e-5);
  EXPECT_LE(light.balance.RelativeError(3), 1e-5);
  EXPECT_TRUE(light.converged);
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

TEST_P(ReflectingFaces, LetNothingOutOfAClosedBox)
{
  for (PropagationSource source : { PropagationSource::Constant, PropagationSource::Linear })
  {
    LitMedium scene({ 6, 5, 4 }, 0.3f, 0.2f);
    scene.settings.source = source;
    scene.emission.assign(scene.sigma_a.size(), 0.0f);
    scene.emission[17] = 1.0f;
    scene.light.faceAlbedo.fill(Grey(1.0));
    const LightField light = this->Solve(scene, 1e-7);
    const EnergyBalance& balance = light.balance;
    EXPECT_NEAR(balance.absorbed[0], balance.emitted[0], 1e-5 * balance.emitted[0]);
    EXPECT_NEAR(balance.escaped[0], 0.0, 1e-5 * balance.emitted[0]);
    EXPECT_TRUE(light.converged);
  }
}

TEST_P(ReflectingFaces, TellWhatLeavesEveryCell)
{
  for (PropagationSource source : { PropagationSource::Constant, PropagationSource::Linear })
  {
    LitMedium scene({ 8, 6, 5 });
    scene.settings.source = source;
    scene.how.periodic = { false, true, false };
    scene.Randomise(1.0, 2.0, 0.7);
    scene.emission.assign(scene.sigma_a.size(), 0.0f);
    scene.emission[33] = 1.0f;
    scene.light.sky = { 0.3, 0.2, 0.1 };
    scene.ShineAlong({ 0.3, -0.5, -1.0 });
    scene.light.lights.push_back(PointLamp({ 3.3, 2.2, 4.4 }));
    scene.light.faceAlbedo[1] = { 0.5, 0.4, 0.3 };
    scene.light.faceAlbedo[4] = Grey(0.8);
    const LightField light = this->Solve(scene, 1e-6);
    const double entered = light.balance.entered[0];
    ASSERT_EQ(light.facePower.size(), 3 * BoxFaceCellCount(scene.medium.grid));
    for (const int face : { 0, 1, 4, 5, 2, 3 })
    {
      if (this->OfOrdinates() && face / 2 == 1)
      {
        continue;
      }
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

/// Slabs over grounds, as the reference has them.
static void ExpectMattGround(Device& device, const std::vector<double>& thicknesses)
{
  const std::vector<double> cosines = { 0.0, 1.0, 0.5 };
  for (double tau : thicknesses)
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
            const LightField light = scene.Solve(device);
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

TEST_F(FaceAlbedo, IsMattGroundUnderASlab)
{
  ExpectMattGround(this->GetDevice(), { 5.0 });
}

TEST_F(FaceAlbedo, NightlyIsMattGroundUnderThinAndThickSlabs)
{
  ExpectMattGround(this->GetDevice(), { 0.5, 50.0 });
}

TEST_F(FaceAlbedo, IsMattGroundUnderASlabByDefault)
{
  for (double tau : { 0.5, 5.0, 50.0 })
  {
    for (double ground : { 0.3, 0.8, 1.0 })
    {
      for (double cosine : { 0.0, 1.0, 0.5 })
      {
        const ReferenceRow row = ReferenceRowWhere("slab_over_ground",
          { { "tau", tau }, { "albedo", 0.9 }, { "g", 0.85 }, { "ground", ground }, { "cosine", cosine } });
        Scene scene = SlabOverGround(tau, 0.9, 0.85, ground, cosine);
        scene.settings = {};
        scene.settings.periodic = { true, true, false };
        const LightField light = scene.Solve(this->GetDevice());
        const double in = light.balance.entered[0];
        EXPECT_NEAR(light.facePowerOut[5][0] / in, row["reflected"], 0.003) << tau << ' ' << ground << ' ' << cosine;
        EXPECT_NEAR(light.facePowerOut[4][0] / in, row["taken"], 0.003) << tau << ' ' << ground << ' ' << cosine;
      }
    }
  }
}

/// Light that a face gave back comes in once, and not again with each lap of the rays that go round another axis.
TEST_F(FaceAlbedo, IsTheSameBesideEveryPeriodicAxis)
{
  std::vector<double> means;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int face = 0; face < 6; ++face)
    {
      if (face / 2 == axis)
      {
        continue;
      }
      Scene scene({ 3, 3, 3 }, 0.05f, 0.2f);
      scene.ShineFromEverywhere(0.2);
      scene.settings.periodic[axis] = true;
      scene.settings.maximumOrders = 3;
      scene.light.faceAlbedo[face] = Grey(0.7);
      const LightField light = scene.Solve(this->GetDevice());
      EXPECT_LT(light.balance.RelativeError(1), 1e-5) << axis << ' ' << face;
      means.push_back(std::accumulate(light.fluence.begin(), light.fluence.end(), 0.0) / 27.0);
      EXPECT_NEAR(means.back(), means.front(), 1e-4 * means.front()) << axis << ' ' << face;
    }
  }
}

TEST_P(ReflectingFaces, AreTheSameOnEachSideOfTheBox)
{
  std::vector<double> given;
  for (int face = 0; face < 6; ++face)
  {
    LitMedium scene({ 6, 6, 6 }, 0.05f, 0.2f);
    std::array<double, 3> towards = { 0.2, 0.2, 0.2 };
    towards[face / 2] = face % 2 ? 1.0 : -1.0;
    scene.ShineAlong(towards);
    scene.light.faceAlbedo[face] = Grey(0.7);
    const LightField light = this->Solve(scene);
    given.push_back(Leaving(light, scene.medium.grid, face, 0));
  }
  for (double power : given)
  {
    EXPECT_NEAR(power, given[0], 1e-4 * given[0]);
  }
}

TEST_P(ReflectingFaces, AreTheSameFromTheLastLight)
{
  LitMedium scene({ 7, 5, 6 }, 0.05f, 0.3f);
  scene.ShineAlong({ 0.3, -0.2, -1.0 });
  scene.light.faceAlbedo[4] = Grey(0.8);
  scene.light.faceAlbedo[1] = Grey(0.4);
  KeptLight kept;
  this->Solve(scene, 1e-5, &kept);
  scene.sigma_s[30] *= 1.5f;
  scene.light.faceAlbedo[4] = Grey(0.6);
  const LightField warm = this->Solve(scene, 1e-5, &kept), cold = this->Solve(scene, 1e-5);
  EXPECT_LE(RelativeDifference(warm.fluence, cold.fluence), 3e-5);
  EXPECT_TRUE(warm.converged);
  EXPECT_NEAR(warm.facePowerOut[4][0], cold.facePowerOut[4][0], 3e-5 * cold.balance.entered[0]);
}

/// A cube of optical edge tau that scatters forwards, over ground, one wall less bright, in a low sun.
Scene CubeOverGround(WalledBox& box, int edge, double tau)
{
  box.sigma_t = tau;
  box.albedo = 0.98;
  box.g = 0.85;
  box.sunTravels = { 0.5, 0.3, -0.8 };
  box.faceAlbedo = { 0.0, 0.4, 0.0, 0.0, 0.8, 0.0 };
  Scene cube({ edge, edge, edge }, static_cast<float>(box.sigma_t * (1.0 - box.albedo)),
    static_cast<float>(box.sigma_t * box.albedo));
  cube.medium.grid.spacing = { 1.0 / edge, 1.0 / edge, 1.0 / edge };
  cube.medium.phase = PhaseFunction::HenyeyGreenstein(box.g);
  cube.ShineAlong(box.sunTravels);
  for (int face = 0; face < 6; ++face)
  {
    cube.light.faceAlbedo[face] = Grey(box.faceAlbedo[face]);
  }
  return cube;
}

TEST_F(FaceAlbedo, IsGroundUnderACubeAsPhotonsSay)
{
  for (double tau : { 4.0, 40.0 }) // order by order, and by diffusion acceleration
  {
    WalledBox box;
    Scene cube = CubeOverGround(box, 24, tau);
    const PowersInBox truth = PowersByMonteCarlo(box, 300000, 1);
    const LightField light = cube.Solve(this->GetDevice());
    const double in = light.balance.entered[0];
    for (int face = 0; face < 6; ++face)
    {
      const double out = light.facePowerOut[face][0] / in;
      EXPECT_NEAR(out, truth.out[face], 0.01 + 3.0 * truth.outError[face]) << tau << ' ' << face;
      std::printf(
        "tau %g, face %d: %.4f, photons %.4f +- %.4f\n", tau, face, out, truth.out[face], truth.outError[face]);
    }
    EXPECT_NEAR(light.balance.absorbed[0] / in, truth.absorbed, 0.01 + 3.0 * truth.absorbedError) << tau;
    EXPECT_LE(light.balance.RelativeError(1), 1e-5) << tau;
  }
}

TEST_F(FaceAlbedo, IsTheSameFromTheLastLight)
{
  for (double tau : { 4.0, 40.0 })
  {
    for (int degree : { 0, 3 })
    {
      WalledBox box;
      Scene cube = CubeOverGround(box, 12, tau);
      cube.settings.angularDegree = degree;
      cube.settings.tolerance = 1e-4;
      KeptLight kept;
      cube.Solve(this->GetDevice(), {}, &kept);
      cube.sigma_s[700] *= 1.5f;
      cube.light.faceAlbedo[4] = Grey(0.75);
      const LightField warm = cube.Solve(this->GetDevice(), {}, &kept);
      const LightField cold = cube.Solve(this->GetDevice());
      const std::string which = "tau " + std::to_string(tau) + ", degree " + std::to_string(degree);
      std::printf("%s: %zu rows from the last light, %zu from the dark, difference %.2g\n", which.c_str(),
        warm.convergence.size(), cold.convergence.size(), RelativeDifference(warm.fluence, cold.fluence));
      EXPECT_LE(RelativeDifference(warm.fluence, cold.fluence), 2e-4) << which;
      EXPECT_TRUE(warm.converged && cold.converged) << which;
      EXPECT_LE(warm.convergence.size(), cold.convergence.size()) << which;
      EXPECT_LE(warm.balance.RelativeError(1), 1e-4) << which;
      EXPECT_NEAR(warm.facePowerOut[4][0], cold.facePowerOut[4][0], 2e-4 * cold.balance.entered[0]) << which;
    }
  }
}

TEST_F(FaceAlbedo, EndsInABoxThatHardlyAbsorbs)
{
  // All that is emitted is absorbed after a million crossings, or the solve says that it did not come so far.
  for (double absorption : { 1e-3, 1e-6 })
  {
    Scene scene({ 4, 4, 4 }, static_cast<float>(absorption), 0.5f);
    scene.emission.assign(scene.sigma_a.size(), 0.0f);
    scene.emission[21] = 1.0f;
    scene.light.faceAlbedo.fill(Grey(1.0));
    const LightField light = scene.Solve(this->GetDevice());
    const double lacking = 1.0 - light.balance.absorbed[0] / light.balance.emitted[0];
    std::printf("absorption %g: lacking %g, %zu rows, converged %d, balance %g\n", absorption, lacking,
      light.convergence.size(), light.converged, light.balance.RelativeError(1));
    EXPECT_TRUE(std::abs(lacking) <= 1e-3 || (!light.converged && !light.doubts.empty())) << absorption;
  }
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
    return ErrorWords([&] { scene.Solve(this->GetDevice()); });
  };
  EXPECT_THAT(refusal(1.5, false, 0.1), HasSubstr("FaceAlbedo of face 2"));
  EXPECT_THAT(refusal(-0.1, false, 0.1), HasSubstr("FaceAlbedo of face 2"));
  EXPECT_THAT(refusal(std::numeric_limits<double>::quiet_NaN(), false, 0.1), HasSubstr("FaceAlbedo of face 2"));
  EXPECT_THAT(refusal(0.5, true, 0.1), HasSubstr("periodic"));
  EXPECT_THAT(refusal(1.0, false, 0.0), HasSubstr("without end"));
  EXPECT_EQ(refusal(0.5, false, 0.1), "");
}

class OrdinatesFaceAlbedo : public DeviceTest
{
};

TEST_F(OrdinatesFaceAlbedo, IsMattGroundUnderASlab)
{
  for (double tau : { 0.5, 5.0 })
  {
    for (double g : { 0.0, 0.85 })
    {
      for (double ground : { 0.3, 0.8, 1.0 })
      {
        for (double cosine : { 0.0, 1.0, 0.5 })
        {
          SCOPED_TRACE(testing::Message() << tau << ' ' << g << ' ' << ground << ' ' << cosine);
          const ReferenceRow row = ReferenceRowWhere("slab_over_ground",
            { { "tau", tau }, { "albedo", 0.9 }, { "g", g }, { "ground", ground }, { "cosine", cosine } });
          const int layers = tau > 1.0 ? 100 : 40;
          LitMedium slab(
            { 1, 1, layers }, static_cast<float>(0.1 * tau / layers), static_cast<float>(0.9 * tau / layers));
          slab.how.periodic = { true, true, false };
          slab.how.tolerance = 1e-5;
          slab.ScatterWith(g);
          LightOverGround(slab, ground, cosine);
          const LightField light = slab.SolveOrdinates(this->GetDevice());
          const double in = light.balance.entered[0];
          EXPECT_NEAR(light.facePowerOut[5][0] / in, row["reflected"], 0.003);
          EXPECT_NEAR(light.facePowerOut[4][0] / in, row["taken"], 0.003);
          EXPECT_LE(light.balance.RelativeError(1), 1e-5);
          EXPECT_TRUE(light.converged);
        }
      }
    }
  }
}

TEST_F(OrdinatesFaceAlbedo, EndsInABoxThatHardlyAbsorbsAndRefusesOneThatDoesNot)
{
  LitMedium scene({ 3, 3, 3 }, 1e-6f, 0.5f);
  scene.how.directionsPerFace = 9;
  scene.light.faceAlbedo.fill(Grey(1.0));
  scene.emission.assign(scene.sigma_a.size(), 0.0f);
  scene.emission[13] = 1.0f;
  const LightField accelerated = scene.SolveOrdinates(this->GetDevice());
  EXPECT_TRUE(accelerated.converged);
  EXPECT_LE(accelerated.balance.RelativeError(1), 1e-3);
  scene.how.acceleration = PropagationAcceleration::None;
  const LightField light = scene.SolveOrdinates(this->GetDevice());
  EXPECT_FALSE(light.converged);
  EXPECT_FALSE(light.doubts.empty());
  EXPECT_LE(light.balance.RelativeError(1), 1e-3);
  scene.sigma_a.assign(scene.sigma_a.size(), 0.0f);
  EXPECT_THROW(scene.SolveOrdinates(this->GetDevice()), InvalidInput);
}

TEST_F(OrdinatesFaceAlbedo, IsRefusedAsPublished)
{
  LitMedium scene({ 3, 3, 3 }, 0.1f, 0.1f);
  scene.how.scheme = OrdinatesScheme::Published;
  scene.light.faceAlbedo[2] = Grey(0.5);
  EXPECT_THAT([&] { scene.SolveOrdinates(this->GetDevice()); },
    testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("set FaceAlbedo to 0")));
}
