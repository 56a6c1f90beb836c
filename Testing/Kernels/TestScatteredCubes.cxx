// Photons that are scattered many times, against Monte Carlo of another program and adding-doubling.

#include "DeviceTest.h"
#include "ScatteredScene.h"

#include "Reference/CubeReference.h"
#include "Reference/ReferenceTable.h"

#include <cmath>
#include <string>

using namespace tyndall;

class ScatteredCubes : public DeviceTest
{
};

namespace
{
/// A part of all power against the table's: of some hundred, 3.5 standard errors hold all.
void ExpectPart(double found, double photons, double expected, double error, const std::string& what)
{
  const double own = std::sqrt(std::max(expected * (1.0 - expected), 1e-12) / photons);
  EXPECT_NEAR(found, expected, 3.5 * std::hypot(own, error) + 1e-6) << what;
}

double ChiSquare(const PhotonLight& light, const CubeReference& reference, double factor)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i)
  {
    const double off = light.light.fluence[i] * factor - reference[i].fluence;
    const double error = std::hypot(light.light.fluenceError[i] * factor, reference[i].error);
    sum += off * off / (error * error);
  }
  return sum / static_cast<double>(reference.size());
}
}

TEST_F(ScatteredCubes, PowersAreThoseOfTheTables)
{
  constexpr std::size_t Photons = 40000;
  for (const char* table : { "cube_RTSA", "cube_RTSA_anisotropic" })
  {
    for (const ReferenceRow& cube : ReadReference(table))
    {
      const int source = static_cast<int>(cube["src"]);
      if (cube["tau"] > 20.0 || cube["slab"] != 0.0 || cube["tau"] == 0.1)
      {
        continue;
      }
      PhotonScene scene = UnitCube(3, cube["tau"], cube["omega"], cube["g"]);
      RandomPhotons random(scene.medium.grid);
      const PhotonLight light = scene.March(this->GetDevice(),
        source == 0     ? random.ThroughFace(4, Photons)
          : source == 1 ? random.Beam(1.0, Photons)
                        : random.Within(Photons));
      double sides = 0.0;
      for (int face = 0; face < 4; ++face)
      {
        sides += light.light.facePowerOut[face][0];
      }
      const std::string what = std::string(table) + ", tau " + cube.Text("tau") + ", albedo " + cube.Text("omega") +
        ", g " + cube.Text("g") + ", source " + cube.Text("src");
      ExpectPart(light.light.facePowerOut[4][0], Photons, cube["R"], cube["sR"], what + ": R");
      ExpectPart(light.light.facePowerOut[5][0], Photons, cube["T"], cube["sT"], what + ": T");
      ExpectPart(sides, Photons, cube["S"], cube["sS"], what + ": S");
      ExpectPart(light.light.balance.absorbed[0], Photons, cube["A"], cube["sA"], what + ": A");
      EXPECT_LT(light.light.balance.RelativeError(1), 1e-6) << what;
    }
  }
}

TEST_F(ScatteredCubes, VoxelsAreThoseOfTheTablesWithinTheErrorsThatAreSaid)
{
  constexpr std::size_t Photons = 400000;
  PhotonScene lit = UnitCube(10, 1.0, 0.9);
  lit.settings.errorBatches = 64;
  RandomPhotons random(lit.medium.grid);
  const double diffuse =
    ChiSquare(lit.March(this->GetDevice(), random.ThroughFace(4, Photons)), CubeInDiffuseLight(), 1.0);
  EXPECT_GT(diffuse, 0.8);
  EXPECT_LT(diffuse, 1.2);
  PhotonScene shining = UnitCube(10, 5.0, 0.9);
  shining.settings.errorBatches = 64;
  const double emitted = ChiSquare(shining.March(this->GetDevice(), random.Within(Photons)), ShiningCube(), 1.0);
  EXPECT_GT(emitted, 0.8);
  EXPECT_LT(emitted, 1.2);
}

TEST_F(ScatteredCubes, SlabsReflectAndTransmitAsByAddingDoubling)
{
  constexpr std::size_t Photons = 40000;
  for (const ReferenceRow& slab : ReadReference("slab"))
  {
    const double tau = slab["tau"], albedo = slab["omega"], g = slab["g"];
    if ((tau != 0.5 && tau != 5.0) || (albedo != 0.9 && albedo != 1.0))
    {
      continue;
    }
    PhotonScene scene(
      { 1, 1, 3 }, 1.0 / 3.0, 0.0, static_cast<float>(tau * (1.0 - albedo)), static_cast<float>(tau * albedo));
    scene.medium.grid.spacing = { 1e5, 1e5, 1.0 / 3.0 };
    scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
    scene.settings.maximumOrders = 0;
    RandomPhotons random(scene.medium.grid);
    const std::string what = "tau " + slab.Text("tau") + ", albedo " + slab.Text("omega") + ", g " + slab.Text("g");
    const PhotonLight diffuse = scene.March(this->GetDevice(), random.ThroughFace(4, Photons));
    ExpectPart(diffuse.light.facePowerOut[4][0], Photons, slab["R_diffuse"], 1e-6, what + ": R");
    ExpectPart(diffuse.light.facePowerOut[5][0], Photons, slab["T_diffuse"], 1e-6, what + ": T");
    const PhotonLight beam = scene.March(this->GetDevice(), random.Beam(0.5, Photons));
    ExpectPart(beam.light.facePowerOut[4][0], Photons, slab["R_mu05"], 1e-6, what + ": R of a beam");
    ExpectPart(beam.light.facePowerOut[5][0], Photons, slab["T_mu05"], 1e-6, what + ": T of a beam");
  }
}
