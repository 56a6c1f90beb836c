// Cubes whose medium scatters forwards, lit on a face evenly or by a beam, or shining themselves, against Monte Carlo.

#include "DeviceTest.h"
#include "MediumScene.h"

#include "Numerics/Constants.h"
#include "Reference/ReferenceTable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
constexpr const char* Parts[] = { "R", "T", "S", "A" }; ///< back, through, out of the sides, absorbed

using PowerParts = std::array<double, 4>;

/// One watt, of one of the table's sources.
void ShineAs(Scene& scene, int source)
{
  if (source == 0)
  {
    scene.light.faces[4] = { 1.0 / Pi, 1.0 / Pi, 1.0 / Pi };
  }
  else if (source == 1)
  {
    scene.ShineAlong({ 0.0, 0.0, 1.0 });
  }
  else
  {
    scene.emission.assign(scene.sigma_s.size(), static_cast<float>(0.25 / Pi));
  }
}

PowerParts SolvedCube(Device& device, const ReferenceRow& cube, int degree)
{
  constexpr int Edge = 32;
  Scene scene({ Edge, Edge, Edge }, static_cast<float>(cube["tau"] * (1.0 - cube["omega"])),
    static_cast<float>(cube["tau"] * cube["omega"]));
  scene.medium.grid.spacing = { 1.0 / Edge, 1.0 / Edge, 1.0 / Edge };
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(cube["g"]);
  ShineAs(scene, static_cast<int>(cube["src"]));
  scene.settings.angularDegree = degree;
  scene.settings.directionsPerFace = 64;
  scene.settings.uncollidedDirections = 1024;
  scene.settings.staggeredRays = true;
  const LightField light = scene.Solve(device);
  EXPECT_LT(light.balance.RelativeError(light.channels), 1e-5);
  PowerParts parts = { light.facePowerOut[4][0], light.facePowerOut[5][0], 0.0, light.balance.absorbed[0] };
  for (int face = 0; face < 4; ++face)
  {
    parts[2] += light.facePowerOut[face][0];
  }
  for (double& part : parts)
  {
    part /= light.balance.entered[0] + light.balance.emitted[0];
  }
  return parts;
}

/// Of the part that is worst, less three standard errors of the reference.
double LargestError(const PowerParts& found, const ReferenceRow& cube)
{
  double largest = 0.0;
  for (int i = 0; i < 4; ++i)
  {
    const double error = std::abs(found[i] - cube[Parts[i]]) - 3.0 * cube[std::string("s") + Parts[i]];
    largest = std::max(largest, error);
  }
  return largest;
}

class ForwardCubes : public DeviceTest
{
protected:
  struct Errors
  {
    double thin = 0.0;  ///< the largest up to tau 10
    double thick = 0.0; ///< and beyond: voxels of 1.6 mean free paths
  };

  /// Of any source, grey, moderate and thick; white ones take longest.
  static bool IsTypical(const ReferenceRow& cube)
  {
    return cube["omega"] == 0.9 && cube["tau"] >= 5.0 && cube["tau"] != 10.0;
  }

  Errors LargestErrorsOf(double g, int degree, bool all)
  {
    Errors largest;
    int compared = 0;
    for (const ReferenceRow& cube : ReadReference("cube_RTSA_anisotropic"))
    {
      if (cube["g"] == g && (all || IsTypical(cube)))
      {
        const double error = LargestError(SolvedCube(this->GetDevice(), cube, degree), cube);
        std::printf("  g %g, source %g, tau %g, albedo %g, degree %d: %.5f\n", g, cube["src"], cube["tau"],
          cube["omega"], degree, error);
        double& worst = cube["tau"] > 10.0 ? largest.thick : largest.thin;
        worst = std::max(worst, error);
        ++compared;
      }
    }
    EXPECT_EQ(compared, all ? 27 : 4);
    return largest;
  }

  void ExpectTheLightOfMonteCarlo(const std::vector<double>& cosines, bool all)
  {
    for (const double g : cosines)
    {
      const Errors errors = this->LargestErrorsOf(g, -1, all);
      EXPECT_LT(errors.thin, 0.01) << "g " << g;
      EXPECT_LT(errors.thick, 0.02) << "g " << g;
    }
  }
};
}

TEST_F(ForwardCubes, HaveTheLightOfMonteCarlo)
{
  this->ExpectTheLightOfMonteCarlo({ 0.85 }, false);
}

TEST_F(ForwardCubes, NightlyAllHaveTheLightOfMonteCarlo)
{
  this->ExpectTheLightOfMonteCarlo({ 0.5, 0.85 }, true);
}

TEST_F(ForwardCubes, AreWrongBySimilarity)
{
  EXPECT_GT(this->LargestErrorsOf(0.85, 0, false).thin, 0.02) << "the limit tells no difference";
}
