#include "CubeReference.h"
#include "DeviceTest.h"
#include "MediumScene.h"

#include <algorithm>
#include <cmath>
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

/// Root mean square of the light's relative error, over the reference's voxels, each a few of the scene's.
double ErrorOf(const std::vector<CubeReference>& reference, const Scene& scene, const LightField& light, double unit)
{
  const int n = scene.medium.grid.size[0];
  const int part = n / 10;
  double sum = 0.0;
  for (const CubeReference& row : reference)
  {
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
    const double error = fluence / (part * part * part) * unit / row.fluence - 1.0;
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<double>(reference.size()));
}
}

class LinearSource : public DeviceTest
{
};

TEST_F(LinearSource, TransmitsAsSlabsDoHoweverThickVoxelsAre)
{
  // Albedo 1. Thin: adding-doubling (slab.csv of the project's reference values); thick: 4 / (3 (tau + 1.4208922)).
  struct Row
  {
    double tau, transmitted;
  };
  std::vector<Row> rows = { { 0.01, 9.90274573e-01 }, { 0.1, 9.15702874e-01 }, { 1.0, 5.53405993e-01 },
    { 5.0, 2.07657278e-01 } };
  for (double tau : { 10.0, 20.0, 50.0, 100.0, 300.0, 1e3, 1e4, 1e5, 1e6 })
  {
    rows.push_back({ tau, 4.0 / (3.0 * (tau + 1.4208922)) });
  }
  for (const Row& row : rows)
  {
    const LightField light = Slab(row.tau, 1.0).Solve(this->GetDevice());
    EXPECT_NEAR(Out(light, 5) / row.transmitted, 1.0, 0.005) << "optical thickness " << row.tau;
    EXPECT_NEAR(Out(light, 4) + Out(light, 5), 1.0, 1e-4) << "optical thickness " << row.tau;
    EXPECT_LE(light.convergence.size(), 15u) << "optical thickness " << row.tau;
    EXPECT_GE(Least(light), 0.0);
    this->RecordProperty("T at " + std::to_string(row.tau), std::to_string(Out(light, 5) / row.transmitted - 1.0));
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
  // Single voxels beside a shining face's edges are off by up to 2%, with orders one by one as well: rays, not the source.
  Scene lit = Cube(30, 1.0, 0.9);
  lit.settings.directionsPerFace = 400;
  lit.light.faces[4] = { 1.0, 1.0, 1.0 };
  const LightField light = lit.Solve(this->GetDevice());
  EXPECT_LT(ErrorOf(CubeInDiffuseLight, lit, light, 900.0 / light.balance.entered[0]), 0.01); // of flux 1, side 1

  Scene shining = Cube(30, 5.0, 0.9);
  shining.settings.directionsPerFace = 100;
  shining.emission.assign(27000, static_cast<float>(1.0 / (4.0 * Pi * 27000.0)));
  EXPECT_LT(ErrorOf(ShiningCube, shining, shining.Solve(this->GetDevice()), 900.0), 0.01);
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
