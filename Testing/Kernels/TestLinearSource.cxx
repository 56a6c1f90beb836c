#include "CubeReference.h"
#include "DeviceTest.h"
#include "MediumScene.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
constexpr double Pi = 3.14159265358979323846;

/// A slab across z of 32 voxels, diffuse light of power 1 on its lower face.
Scene Slab(double tau, double albedo, int voxels = 32)
{
  Scene scene(
    { 1, 1, voxels }, static_cast<float>(tau / voxels * (1.0 - albedo)), static_cast<float>(tau / voxels * albedo));
  scene.settings.periodic = { true, true, false };
  scene.settings.directionsPerFace = 100;
  scene.settings.source = PropagationSource::Linear;
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  return scene;
}

Scene Cube(int n, double tau, double albedo)
{
  Scene scene({ n, n, n }, static_cast<float>(tau / n * (1.0 - albedo)), static_cast<float>(tau / n * albedo));
  scene.settings.source = PropagationSource::Linear;
  return scene;
}

double Out(const LightField& light, int face)
{
  return light.facePowerOut[face][0] / light.balance.entered[0];
}

double Least(const LightField& light)
{
  return *std::min_element(light.fluence.begin(), light.fluence.end());
}

/// Of the 2 x 2 x 2 voxels around the centre, over 4 pi.
double MeanRadianceAtCentre(const Scene& scene, const LightField& light)
{
  const std::array<int, 3>& n = scene.medium.grid.size;
  double sum = 0.0;
  for (int z : { n[2] / 2 - 1, n[2] / 2 })
  {
    for (int y : { n[1] / 2 - 1, n[1] / 2 })
    {
      for (int x : { n[0] / 2 - 1, n[0] / 2 })
      {
        sum += light.fluence[(static_cast<std::size_t>(z) * n[1] + y) * n[0] + x];
      }
    }
  }
  return sum / 8.0 / (4.0 * Pi);
}

/// Mean over a voxel of the reference, which is a few of the scene's.
double MeanFluence(const CubeReference& row, const Scene& scene, const LightField& light)
{
  const int n = scene.medium.grid.size[0];
  const int part = n / 10;
  double fluence = 0.0;
  for (int z = 0; z < part; ++z)
  {
    for (int y = 0; y < part; ++y)
    {
      for (int x = 0; x < part; ++x)
      {
        fluence += light.fluence[((row.z * part + z) * n + row.y * part + y) * n + row.x * part + x];
      }
    }
  }
  return fluence / (part * part * part);
}

/// Three standard errors or 1%, whichever is larger, voxel by voxel.
void ExpectAsPhotonsDo(
  const std::vector<CubeReference>& reference, const Scene& scene, const LightField& light, double unit)
{
  for (const CubeReference& row : reference)
  {
    const double fluence = MeanFluence(row, scene, light) * unit;
    EXPECT_NEAR(fluence / row.fluence, 1.0, std::max(0.01, 3.0 * row.error / row.fluence))
      << row.x << ' ' << row.y << ' ' << row.z;
  }
}
struct Transmittance
{
  double tau, transmitted;
};

/// Diffuse light through slabs of albedo 1. Thin: adding-doubling (slab.csv of the project's reference values); thick: 4 / (3 (tau +
/// 1.4208922)).
std::vector<Transmittance> TransmittancesOfWhiteSlabs()
{
  std::vector<Transmittance> rows = { { 0.01, 9.90274573e-01 }, { 0.1, 9.15702874e-01 }, { 1.0, 5.53405993e-01 },
    { 5.0, 2.07657278e-01 } };
  for (double tau : { 10.0, 20.0, 50.0, 100.0, 300.0, 1e3, 1e4, 1e5, 1e6 })
  {
    rows.push_back({ tau, 4.0 / (3.0 * (tau + 1.4208922)) });
  }
  return rows;
}
}

class LinearSource : public DeviceTest
{
};

TEST_F(LinearSource, TransmitsAsSlabsDoHoweverThickVoxelsAre)
{
  for (const Transmittance& row : TransmittancesOfWhiteSlabs())
  {
    const LightField light = Slab(row.tau, 1.0).Solve(this->GetDevice());
    EXPECT_NEAR(Out(light, 5) / row.transmitted, 1.0, 0.005) << "optical thickness " << row.tau;
    EXPECT_NEAR(Out(light, 4) + Out(light, 5), 1.0, 1e-4) << "optical thickness " << row.tau;
    EXPECT_LE(light.convergence.size(), 15u) << "optical thickness " << row.tau;
    EXPECT_GE(Least(light), 0.0);
    this->RecordProperty("T at " + std::to_string(row.tau), std::to_string(Out(light, 5) / row.transmitted - 1.0));
  }
}

TEST_F(LinearSource, SlabsAreRightAsSettingsAreByDefault)
{
  for (const Transmittance& row : TransmittancesOfWhiteSlabs())
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      std::array<int, 3> size = { 1, 1, 1 };
      size[axis] = 32;
      Scene scene(size, 0.0f, static_cast<float>(row.tau / 32.0));
      scene.settings.periodic = { axis != 0, axis != 1, axis != 2 };
      scene.light.faces[2 * axis + 1] = { 1.0, 1.0, 1.0 };
      const LightField light = scene.Solve(this->GetDevice());
      const std::string where = "optical thickness " + std::to_string(row.tau) + " along axis " + std::to_string(axis);
      EXPECT_NEAR(Out(light, 2 * axis) / row.transmitted, 1.0, 0.005) << where;
      EXPECT_NEAR(Out(light, 2 * axis + 1) / (1.0 - row.transmitted), 1.0, 0.01) << where;
      EXPECT_NEAR(Out(light, 2 * axis) + Out(light, 2 * axis + 1), 1.0, 1e-4) << where;
      EXPECT_LE(light.convergence.size(), 15u) << where;
      EXPECT_NEAR(light.balance.entered[0], Pi, 0.01 * Pi) << where << ": W through a face of area 1";
      EXPECT_EQ(light.directionsPerFace, 144);
    }
  }
}

TEST_F(LinearSource, TransmitsBeamsAsSlabsDoHoweverThickVoxelsAre)
{
  // Albedo 1, beams at cosine 1 and 0.5: slab.csv; between and beyond its rows the diffusion limit H(mu) / sqrt(3) / (tau + 1.4208922)
  // (H: Chandrasekhar's function, 2.9078107 and 2.0127788).
  struct Row
  {
    double tau, across, oblique;
  };
  std::vector<Row> rows = { { 0.01, 9.95024714e-01, 9.90098531e-01 }, { 0.1, 9.52311414e-01, 9.08956820e-01 },
    { 0.5, 7.97494027e-01, 6.65618362e-01 }, { 1.0, 6.58671240e-01, 5.01624471e-01 },
    { 5.0, 2.61278832e-01, 1.81004274e-01 }, { 10.0, 1.46995381e-01, 1.01750251e-01 },
    { 100.0, 1.65530509e-02, 1.14579781e-02 }, { 1000.0, 1.67644300e-03, 1.16042942e-03 } };
  for (double tau : { 20.0, 30.0, 50.0, 70.0, 150.0, 200.0, 300.0, 1e4, 1e5, 1e6 })
  {
    rows.push_back(
      { tau, 2.9078107 / std::sqrt(3.0) / (tau + 1.4208922), 2.0127788 / std::sqrt(3.0) / (tau + 1.4208922) });
  }
  for (const Row& row : rows)
  {
    for (bool oblique : { false, true })
    {
      Scene scene = Slab(row.tau, 1.0);
      scene.light.faces[4] = {};
      scene.ShineAlong({ oblique ? std::sqrt(0.75) : 0.0, 0.0, oblique ? 0.5 : 1.0 });
      const LightField light = scene.Solve(this->GetDevice());
      const double transmitted = oblique ? row.oblique : row.across;
      EXPECT_NEAR(Out(light, 5) / transmitted, 1.0, 0.005)
        << "optical thickness " << row.tau << ", oblique " << oblique;
      EXPECT_NEAR(Out(light, 4) / (1.0 - transmitted), 1.0, 0.005) << "optical thickness " << row.tau;
      EXPECT_NEAR(Out(light, 4) + Out(light, 5), 1.0, 1e-4) << "optical thickness " << row.tau;
      EXPECT_GE(Least(light), 0.0);
      this->RecordProperty((oblique ? "oblique " : "across ") + std::to_string(row.tau),
        std::to_string(Out(light, 5) / transmitted - 1.0));
    }
  }
}

TEST_F(LinearSource, TransmitsBeamsBetweenClearVoxels)
{
  // 16 voxels of albedo 1 between 8 clear ones on either side. At 30 (2 mean free paths a voxel) 6% are missed.
  for (double tau : { 1.0, 10.0, 30.0, 100.0, 300.0, 1e3, 1e4 })
  {
    Scene scene = Slab(0.0, 1.0);
    scene.light.faces[4] = {};
    scene.ShineAlong({ 0.0, 0.0, 1.0 });
    std::fill(scene.sigma_s.begin() + 8, scene.sigma_s.begin() + 24, static_cast<float>(tau / 16.0));
    const LightField light = scene.Solve(this->GetDevice());
    const double transmitted = tau == 1.0 ? 6.58671240e-01 : 2.9078107 / std::sqrt(3.0) / (tau + 1.4208922);
    EXPECT_NEAR(Out(light, 5) / transmitted, 1.0, tau == 30.0 ? 0.065 : 0.02) << "optical thickness " << tau;
    EXPECT_NEAR(Out(light, 4) + Out(light, 5), 1.0, 1e-4) << "optical thickness " << tau;
    EXPECT_GE(Least(light), 0.0);
  }
}

TEST_F(LinearSource, LampsOfAllKindsReachAsDeepIntoThickVoxelsAsIntoThinOnes)
{
  // A cube of optical thickness 100, coarse voxels (6.25 mean free paths) against finer ones (2.1), light out of the face beyond.
  for (LightType type : { LightType::Directional, LightType::Point, LightType::Spot, LightType::Rectangle })
  {
    std::array<double, 2> through = {};
    for (int fine : { 0, 1 })
    {
      const int n = fine ? 48 : 16;
      Scene scene = Cube(n, 100.0, 1.0);
      Light lamp;
      lamp.type = type;
      lamp.power = { 1.0, 1.0, 1.0 };
      lamp.direction = { 0.0, 0.0, 1.0 };
      lamp.position = { 0.45 * n, 0.55 * n, -0.6 * n };
      lamp.angle = 40.0;
      lamp.size = { 0.3 * n, 0.3 * n };
      scene.light.lights.push_back(lamp);
      const LightField light = scene.Solve(this->GetDevice());
      through[fine] = Out(light, 5);
      EXPECT_LT(light.balance.RelativeError(1), 1e-4);
      EXPECT_GE(Least(light), 0.0);
    }
    EXPECT_NEAR(through[0] / through[1], 1.0, 0.1) << static_cast<int>(type);
    this->RecordProperty("lamp " + std::to_string(static_cast<int>(type)), std::to_string(through[0] / through[1]));
  }
}

TEST_F(LinearSource, ReflectsAsAbsorbingSlabsDo)
{
  // slab.csv
  struct Row
  {
    double tau, albedo, reflected, transmitted, tolerance;
  };
  for (const Row& row :
    { Row{ 1.0, 0.9, 3.52712040e-01, 4.74745855e-01, 0.005 }, Row{ 5.0, 0.9, 4.76338493e-01, 5.34214494e-02, 0.005 },
      Row{ 10.0, 0.99, 7.85324130e-01, 6.64331966e-02, 0.005 },
      Row{ 100.0, 0.999, 9.29711087e-01, 5.66953603e-04, 0.012 } })
  {
    const LightField light = Slab(row.tau, row.albedo).Solve(this->GetDevice());
    EXPECT_NEAR(Out(light, 4) / row.reflected, 1.0, 0.005) << row.tau;
    EXPECT_NEAR(Out(light, 5) / row.transmitted, 1.0, row.tolerance) << row.tau;
  }
}

TEST_F(LinearSource, EndsWithTheSquareOfTheVoxel)
{
  const double exact = Out(Slab(8.0, 1.0, 256).Solve(this->GetDevice()), 5);
  const double coarse = std::abs(Out(Slab(8.0, 1.0, 4).Solve(this->GetDevice()), 5) - exact);
  const double fine = std::abs(Out(Slab(8.0, 1.0, 16).Solve(this->GetDevice()), 5) - exact);
  EXPECT_LT(fine, coarse / 12.0) << "coarse " << coarse << " fine " << fine;
}

TEST_F(LinearSource, OneShiningFaceIsASixthAtTheCentreOfACube)
{
  for (double tau : { 1e-6, 1.0, 10.0, 100.0, 1e4 })
  {
    Scene scene = Cube(32, tau, 1.0);
    scene.light.faces[4] = { 1.0, 1.0, 1.0 };
    EXPECT_NEAR(6.0 * MeanRadianceAtCentre(scene, scene.Solve(this->GetDevice())), 1.0, 0.002) << tau;
  }
}

TEST_F(LinearSource, KeepsTheFurnaceWithVoidsAndAContrastOfAHundredMillion)
{
  Scene scene({ 20, 21, 19 });
  scene.Randomise(1e4, 8.0, 1.0);
  for (std::size_t i = 0; i < scene.sigma_s.size(); i += 5)
  {
    scene.sigma_s[i] = 0.0f;
  }
  scene.ShineFromEverywhere(1.0);
  scene.settings.source = PropagationSource::Linear;
  scene.settings.tolerance = 1e-6;
  const LightField light = scene.Solve(this->GetDevice());
  for (float fluence : light.fluence)
  {
    ASSERT_NEAR(fluence / (4.0 * Pi), 1.0, 1e-5);
  }
}

TEST_F(LinearSource, LightsACubeAsPhotonsDo)
{
  // The light that comes straight from the face needs many directions: its shadows have edges.
  Scene lit = Cube(30, 1.0, 0.9);
  lit.settings.directionsPerFace = 900;
  lit.settings.mapResolution = 2;
  lit.light.faces[4] = { 1.0, 1.0, 1.0 };
  const LightField light = lit.Solve(this->GetDevice());
  ExpectAsPhotonsDo(CubeInDiffuseLight, lit, light, 900.0 / light.balance.entered[0]); // of flux 1, side 1

  Scene shining = Cube(30, 5.0, 0.9);
  shining.settings.directionsPerFace = 100;
  shining.settings.mapResolution = 2;
  shining.emission.assign(27000, static_cast<float>(1.0 / (4.0 * Pi * 27000.0)));
  ExpectAsPhotonsDo(ShiningCube, shining, shining.Solve(this->GetDevice()), 900.0);
}

TEST_F(LinearSource, SendsThroughACubesFacesWhatPhotonsDo)
{
  // cube_RTSA.csv, albedo, diffuse light on one face: reflected, through four sides, absorbed, to 1%; transmitted is less than
  // a hundredth of it all and left to the sum.
  struct Row
  {
    double tau, albedo, reflected, sides, absorbed;
  };
  for (const Row& row : { Row{ 5.0, 0.9, 0.307663, 0.435358, 0.245893 }, Row{ 10.0, 0.9, 0.380822, 0.264722, 0.353452 },
         Row{ 10.0, 1.0, 0.551624, 0.437810, 0.0 } })
  {
    Scene scene = Cube(48, row.tau, row.albedo);
    scene.settings.directionsPerFace = 100;
    scene.light.faces[4] = { 1.0, 1.0, 1.0 };
    const LightField light = scene.Solve(this->GetDevice());
    EXPECT_NEAR(Out(light, 4) / row.reflected, 1.0, 0.01) << row.tau;
    EXPECT_NEAR((Out(light, 0) + Out(light, 1) + Out(light, 2) + Out(light, 3)) / row.sides, 1.0, 0.01) << row.tau;
    EXPECT_NEAR(light.balance.absorbed[0] / light.balance.entered[0], row.absorbed, 0.01 * row.absorbed + 1e-6)
      << row.tau;
  }
}

TEST_F(LinearSource, NeedsNoDoublePrecision)
{
  for (double tau : { 1.0, 100.0, 1e4 })
  {
    Scene scene = Slab(tau, 1.0);
    scene.ShineAlong({ 0.0, 0.0, 1.0 });
    const LightField exact = scene.Solve(this->GetDevice());
    setenv("TYNDALL_WITHOUT", "cl_khr_fp64", 1);
    const LightField light = scene.Solve(this->GetDevice());
    unsetenv("TYNDALL_WITHOUT");
    EXPECT_NE(light.fluence, exact.fluence) << "the variable is heeded";
    EXPECT_NEAR(Out(light, 5) / Out(exact, 5), 1.0, 1e-3) << "optical thickness " << tau;
    EXPECT_NEAR(Out(light, 4) + Out(light, 5), 1.0, 1e-3) << "optical thickness " << tau;
    EXPECT_LE(light.convergence.size(), 20u);
    this->RecordProperty("T at " + std::to_string(tau), std::to_string(Out(light, 5) / Out(exact, 5) - 1.0));
  }
}

TEST_F(LinearSource, IsNotNegativeBesideAShield)
{
  Scene scene = Cube(16, 1.0, 0.0);
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    const std::size_t place = i % 16 + i / 16 % 16 + i / 256;
    const double sigma_t = place % 2 ? 1e4 : 1e-4;
    scene.sigma_s[i] = static_cast<float>(0.99 * sigma_t);
    scene.sigma_a[i] = static_cast<float>(0.01 * sigma_t);
  }
  scene.emission.assign(scene.sigma_s.size(), 0.0f);
  scene.emission[0] = 1.0f;
  const LightField light = scene.Solve(this->GetDevice());
  EXPECT_GE(Least(light), 0.0);
  EXPECT_LT(light.balance.RelativeError(1), 1e-4);
}
