#include "DeviceTest.h"
#include "Difference.h"
#include "ErrorWords.h"
#include "Medium/Grid.h"
#include "MediumScene.h"

#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "Numerics/Constants.h"
#include "Reference/CubeReference.h"
#include "Reference/SlabReference.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace tyndall;
using testing::Contains;
using testing::HasSubstr;

namespace
{
/// A cube lit from below.
Scene LitCube(int n, double tau, double albedo)
{
  Scene scene({ n, n, n }, static_cast<float>(tau / n * (1.0 - albedo)), static_cast<float>(tau / n * albedo));
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  return scene;
}

/// Solid angle of a rectangle at distance 1, from its corner.
double CornerSolidAngle(double s, double t)
{
  return std::atan2(s * t, std::sqrt(1.0 + s * s + t * t));
}

/// Of the cube's lower face, seen from a voxel's middle.
double SolidAngleOfFloor(int n, int x, int y, int z)
{
  const double h = z + 0.5;
  const double x0 = (x + 0.5) / h, x1 = (n - x - 0.5) / h, y0 = (y + 0.5) / h, y1 = (n - y - 0.5) / h;
  return CornerSolidAngle(x0, y0) + CornerSolidAngle(x0, y1) + CornerSolidAngle(x1, y0) + CornerSolidAngle(x1, y1);
}

/// The root of the mean square of what blocks differ from the cube of optical thickness 1, relative.
/// @param fluence  of n^3 voxels, lit through face +x
double DifferenceFromCube(const std::vector<float>& fluence, int n)
{
  const CubeReference reference = CubeInDiffuseLight(); // through -z
  std::array<double, 1000> mean = {};
  for (int i = 0; i < n * n * n; ++i)
  {
    const int x = i % n * 10 / n, y = i / n % n * 10 / n, z = i / n / n * 10 / n;
    mean[((9 - x) * 10 + z) * 10 + y] += fluence[i] * 1000.0 / (n * n * n);
  }
  double squares = 0.0;
  for (int i = 0; i < 1000; ++i)
  {
    squares += std::pow(mean[i] / reference[i].fluence - 1.0, 2);
  }
  return std::sqrt(squares / 1000.0);
}

double Out(const LightField& light, int channel)
{
  double power = 0.0;
  for (const Rgb& face : light.facePowerOut)
  {
    power += face[channel];
  }
  return power;
}
}

class UncollidedBoundary : public DeviceTest
{
};

TEST_F(UncollidedBoundary, SeesAShiningFaceAsLargeAsItIs)
{
  constexpr int n = 16;
  std::array<double, 2> squares = {};
  for (const int fine : { 0, 900 })
  {
    Scene scene = LitCube(n, 0.0, 0.0);
    scene.settings.uncollidedDirections = fine;
    const LightField light = scene.Solve(this->GetDevice());
    ForGridVoxels({ n, n, n }, [&](std::size_t i, int x, int y, int z) {
      const double exact = SolidAngleOfFloor(n, x, y, z);
      squares[fine > 0] += z > 0 ? std::pow(light.fluence[i] / exact - 1.0, 2) / (n * n * (n - 1)) : 0.0;
      EXPECT_NEAR(light.fluenceDirect[i], light.fluence[i], 1e-6);
    });
  }
  EXPECT_GT(std::sqrt(squares[0]), 0.05); // or the test shows nothing
  EXPECT_LT(std::sqrt(squares[1]), 0.008);
}

TEST_F(UncollidedBoundary, AlongTheUsualDirectionsChangesNothing)
{
  // The rays are the same, only carried in two parts: orders one by one, accelerated with thin and with thick voxels,
  // as published.
  const auto linear = PropagationSource::Automatic, constant = PropagationSource::Constant;
  for (const auto& [tau, source] : { std::pair(2.0, linear), { 20.0, linear }, { 2000.0, linear }, { 20.0, constant } })
  {
    Scene scene = LitCube(16, tau, tau == 2.0 ? 0.9 : 0.999);
    scene.settings.source = source;
    scene.light.faces[0] = { 0.5, 0.5, 0.5 };
    scene.settings.staggeredRays = true;
    scene.settings.tolerance = 1e-6;
    scene.settings.uncollidedDirections = 0;
    const LightField usual = scene.Solve(this->GetDevice());
    scene.settings.uncollidedDirections = scene.settings.directionsPerFace;
    const LightField light = scene.Solve(this->GetDevice());
    EXPECT_LT(RelativeDifference(light.fluence, usual.fluence), 1e-5) << tau;
    EXPECT_LT(RelativeDifference(light.fluenceDirect, usual.fluenceDirect), 1e-5) << tau;
    for (int face = 0; face < 6; ++face)
    {
      EXPECT_NEAR(light.facePowerOut[face][0], usual.facePowerOut[face][0], 1e-5 * usual.balance.entered[0]) << tau;
    }
  }
}

TEST_F(UncollidedBoundary, KeepsTheFurnaceWithVoidsAndAContrastOfAHundredMillion)
{
  for (const bool asFaces : { false, true })
  {
    Scene scene({ 20, 21, 19 });
    scene.Randomise(1e4, 8.0, 1.0);
    for (std::size_t i = 0; i < scene.sigma_s.size(); i += 5)
    {
      scene.sigma_s[i] = 0.0f;
    }
    asFaces ? scene.light.faces.fill({ 1.0, 1.0, 1.0 }) : scene.ShineFromEverywhere(1.0);
    scene.settings.uncollidedDirections = 100;
    scene.settings.tolerance = 1e-6;
    const LightField light = scene.Solve(this->GetDevice());
    for (float fluence : light.fluence)
    {
      ASSERT_NEAR(fluence / (4.0 * Pi), 1.0, 1e-5);
    }
    EXPECT_THAT(light.leftOut, Contains(HasSubstr("uncollided flux of the boundaries")));
  }
}

TEST_F(UncollidedBoundary, IsNeverBrighterThanWhatShines)
{
  // Albedo 1, voids, contrast up to a hundred million.
  for (const double thickest : { 0.1, 10.0, 1e4 })
  {
    Scene scene({ 15, 16, 14 });
    scene.Randomise(thickest, 8.0, 1.0);
    for (std::size_t i = 0; i < scene.sigma_s.size(); i += 5)
    {
      scene.sigma_s[i] = 0.0f;
    }
    scene.light.faces[4] = { 1.0, 1.0, 1.0 };
    scene.light.faces[0] = { 0.3, 0.3, 0.3 };
    scene.settings.uncollidedDirections = 225;
    const LightField light = scene.Solve(this->GetDevice());
    const auto [least, most] = std::minmax_element(light.fluence.begin(), light.fluence.end());
    EXPECT_GE(*least, 0.0f) << thickest;
    EXPECT_LE(*most, 4.0 * Pi) << thickest;
    EXPECT_LT(light.balance.RelativeError(1), 1e-5) << thickest;
    EXPECT_NEAR(Out(light, 0) / light.balance.entered[0], 1.0, 1e-4) << thickest;
  }
}

TEST_F(UncollidedBoundary, GivesBackEveryWattInColour)
{
  // Sky, faces and medium with a colour each, no red from outside; channels share sigma_t or not; one by one and
  // accelerated.
  for (const bool shared : { false, true })
  {
    for (const double tau : { 1.0, 50.0 })
    {
      Scene scene({ 12, 10, 11 });
      scene.sigma_a.resize(3 * scene.sigma_s.size());
      scene.sigma_s.resize(scene.sigma_a.size());
      for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
      {
        const double albedo = 0.6 + 0.1 * (i % 3);
        const double sigma_t = tau / 11.0 * (shared ? 1.0 : 1.0 + 0.5 * (i % 3));
        scene.sigma_s[i] = static_cast<float>(albedo * sigma_t);
        scene.sigma_a[i] = static_cast<float>(sigma_t) - scene.sigma_s[i];
      }
      scene.light.sky = { 0.0, 0.2, 0.4 };
      scene.light.faces[1] = { 0.0, 0.0, 1.0 };
      scene.light.faces[5] = { 0.0, 1.0, 0.5 };
      scene.settings.netFlux = true;
      scene.settings.uncollidedDirections = 100;
      const LightField light = scene.Solve(this->GetDevice());
      ASSERT_EQ(light.channels, 3);
      EXPECT_LT(light.balance.RelativeError(3), 1e-5) << tau;
      EXPECT_EQ(light.balance.entered[0], 0.0) << tau;
      for (int c = 1; c < 3; ++c)
      {
        EXPECT_GT(light.balance.entered[c], 0.0) << tau;
        EXPECT_NEAR(Out(light, c) / light.balance.escaped[c], 1.0, 1e-5) << tau;
      }
      for (std::size_t i = 0; i < light.fluence.size(); i += 3)
      {
        ASSERT_EQ(light.fluence[i], 0.0f);
      }
      scene.settings.leaveOut = false;
      EXPECT_LT(RelativeDifference(scene.Solve(this->GetDevice()).fluence, light.fluence), 1e-4) << tau;
    }
  }
}

TEST_F(UncollidedBoundary, TakesAnEvenSkyWhereTheMediumAbsorbs)
{
  // Against many directions throughout.
  std::vector<std::vector<float>> fluences;
  for (const int directions : { 900, 25, 0 })
  {
    Scene scene = LitCube(16, 5.0, 0.0);
    scene.light.faces = {};
    scene.ShineFromEverywhere(1.0);
    scene.settings.directionsPerFace = std::max(directions, 25);
    scene.settings.uncollidedDirections = directions == 0 ? 400 : 0;
    scene.settings.staggeredRays = true;
    const LightField light = scene.Solve(this->GetDevice());
    fluences.push_back(light.fluence);
    EXPECT_LT(light.balance.RelativeError(1), 1e-5);
  }
  EXPECT_LT(RelativeDifference(fluences[2], fluences[0]), 0.3 * RelativeDifference(fluences[1], fluences[0]));
}

TEST_F(UncollidedBoundary, DiesAwayInAPeriodicAbsorberAsItShould)
{
  // Transmittance of diffuse light: 2 E3(1).
  Scene scene({ 4, 1, 16 }, 1.0f / 16.0f);
  scene.settings.periodic = { true, true, false };
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  scene.settings.directionsPerFace = 9;
  scene.settings.uncollidedDirections = 900;
  const LightField light = scene.Solve(this->GetDevice());
  EXPECT_NEAR(light.facePowerOut[5][0] / light.balance.entered[0], 0.2193839344, 2e-4);
  EXPECT_LT(light.balance.RelativeError(1), 1e-5);
}

TEST_F(UncollidedBoundary, TransmitsAsSlabsDoHoweverThickVoxelsAre)
{
  for (const double tau : { 10.0, 30.0, 100.0, 1e3, 1e6 })
  {
    Scene scene({ 1, 1, 32 }, 0.0f, static_cast<float>(tau / 32.0));
    scene.settings.periodic = { true, true, false };
    scene.settings.uncollidedDirections = 225;
    scene.light.faces[4] = { 1.0, 1.0, 1.0 };
    const LightField light = scene.Solve(this->GetDevice());
    const double transmitted = light.facePowerOut[5][0] / light.balance.entered[0];
    EXPECT_NEAR(transmitted / ThickSlabTransmittance(tau), 1.0, 0.005) << tau;
  }
}

TEST_F(UncollidedBoundary, TakesPartInTheErrorEstimate)
{
  std::array<double, 2> errors = {};
  for (const int fine : { 0, 400 })
  {
    Scene scene = LitCube(24, 1.0, 0.9);
    scene.settings.uncollidedDirections = fine;
    scene.Solve(this->GetDevice()); // lets the medium see its arrays
    errors[fine > 0] = SolveWithErrorEstimate({ Domain(scene.medium.grid), scene.medium, scene.light }, scene.settings,
      {}, [&](const SceneBlock& block, const PropagationSettings& settings, const Monitor& monitor) {
        return SolveConservative(this->GetDevice(), block.domain, block.medium, block.illumination, settings, monitor);
      }).relativeError;
  }
  EXPECT_LT(errors[1], 0.5 * errors[0]);
  EXPECT_GT(errors[1], 0.0005);
}

TEST_F(UncollidedBoundary, HasFinerDirectionsByDefaultWhereAFaceShines)
{
  // One face, and two adjacent ones; orders that become few, and given ones.
  for (int kind = 0; kind < 4; ++kind)
  {
    Scene scene = LitCube(20, kind < 2 ? 1.0 : 3.0, 0.9);
    scene.settings.maximumOrders = kind < 2 ? 0 : 12;
    scene.light.faces[0] = kind % 2 == 1 ? Rgb{ 0.5, 0.5, 0.5 } : Rgb{};
    const LightField light = scene.Solve(this->GetDevice());
    scene.settings.uncollidedDirections = 0;
    const LightField few = scene.Solve(this->GetDevice());
    scene.settings.uncollidedDirections = 1600;
    const LightField exact = scene.Solve(this->GetDevice());
    EXPECT_LT(SumOfDifferences(light.fluence, exact.fluence), 0.8 * SumOfDifferences(few.fluence, exact.fluence))
      << kind;
    EXPECT_NEAR(light.halfRangeFlux[0], 1.0, 0.002) << kind;
    EXPECT_LT(light.balance.RelativeError(1), 1e-5) << kind;
  }
}

TEST_F(UncollidedBoundary, HasTheUsualDirectionsByDefaultWhereTheyDo)
{
  // Under an even sky, where nothing is scattered, in slabs, where faces reflect, where cells accelerate orders.
  enum
  {
    Sky,
    Absorber,
    Slab,
    Ground,
    Cells
  };
  for (int kind : { Sky, Absorber, Slab, Ground, Cells })
  {
    Scene scene = LitCube(12, kind == Cells ? 5.0 : 2.0, kind == Absorber ? 0.0 : kind == Cells ? 1.0 : 0.99);
    if (kind == Slab)
    {
      scene = Scene({ 1, 1, 16 }, 0.01f, 0.1f);
      scene.settings.periodic = { true, true, false };
      scene.light.faces[4] = { 1.0, 1.0, 1.0 };
    }
    if (kind == Sky)
    {
      scene.light.faces = {};
      scene.ShineFromEverywhere(1.0);
    }
    scene.light.faceAlbedo[5] = kind == Ground ? Rgb{ 0.3, 0.3, 0.3 } : Rgb{};
    const LightField light = scene.Solve(this->GetDevice());
    scene.settings.uncollidedDirections = 0;
    EXPECT_EQ(scene.Solve(this->GetDevice()).fluence, light.fluence) << kind;
  }
}

TEST_F(UncollidedBoundary, MakesCubesRightWithOneHundred)
{
  // All parts of the power of a face that shines, to 1% of them or of the light's hundredth; but where voxels are thick
  // and absorb, the directions are not what is wrong. Thin ones, voxel by voxel, to 1.5%.
  constexpr int n = 40;
  for (const auto& [tau, albedo] : { std::pair(0.1, 0.5), { 0.1, 0.9 }, { 0.1, 1.0 }, { 1.0, 0.5 }, { 1.0, 0.9 },
         { 1.0, 1.0 }, { 5.0, 0.5 }, { 5.0, 0.9 }, { 5.0, 1.0 }, { 10.0, 0.9 }, { 10.0, 1.0 } })
  {
    const CubePowers powers = CubePowersOf(tau, albedo);
    Scene scene({ n, n, n }, static_cast<float>(tau * (1.0 - albedo)), static_cast<float>(tau * albedo));
    scene.medium.grid.spacing = { 1.0 / n, 1.0 / n, 1.0 / n };
    scene.light.faces[1] = { 1.0 / Pi, 1.0 / Pi, 1.0 / Pi };
    scene.settings.uncollidedDirections = 100;
    const LightField light = scene.Solve(this->GetDevice());
    const auto out = [&](int face) { return light.facePowerOut[face][0]; };
    const std::array<double, 4> found = { out(1), out(0), out(2) + out(3) + out(4) + out(5),
      light.balance.absorbed[0] };
    for (int i = 0; i < 4; ++i)
    {
      EXPECT_NEAR(found[i], powers.part[i], 0.01 * std::max(powers.part[i], 0.01) + 3.0 * powers.error[i])
        << "tau " << tau << ", albedo " << albedo << ", part " << i;
    }
    EXPECT_NEAR(light.balance.entered[0], 1.0, 0.002) << tau << ' ' << albedo;
    if (tau == 1.0 && albedo == 0.9)
    {
      EXPECT_LT(DifferenceFromCube(light.fluence, n), 0.015);
    }
  }
}

TEST_F(UncollidedBoundary, RefusesANumberThatIsNoSquare)
{
  Scene scene = LitCube(4, 1.0, 0.9);
  for (const int wrong : { -2, 24, 65 * 65 })
  {
    scene.settings.uncollidedDirections = wrong;
    const std::string words = ErrorWords([&] { scene.Solve(this->GetDevice()); });
    EXPECT_THAT(words, HasSubstr("UncollidedDirections is " + std::to_string(wrong)));
  }
}

TEST_F(UncollidedBoundary, LeavesThickCubesAsTheyAre)
{
  // Albedo 1, one face shines: 1/6 in the middle. Without a flight 0.1%; with one 0.5% at most, at 10 mean free paths.
  for (double tau : { 10.0, 100.0, 1e4 })
  {
    Scene scene({ 31, 31, 31 }, 0.0f, static_cast<float>(tau / 31.0));
    scene.light.faces[4] = { 1.0, 1.0, 1.0 };
    scene.settings.uncollidedDirections = 400;
    const LightField light = scene.Solve(this->GetDevice());
    EXPECT_NEAR(light.fluence[(15 * 31 + 15) * 31 + 15] / (4.0 * 3.14159265358979323846) * 6.0, 1.0, 0.006) << tau;
  }
}
