#include "CubeTurns.h"
#include "DeviceTest.h"
#include "Difference.h"
#include "ErrorWords.h"
#include "OrdinatesScene.h"

#include "Comparison/ComparedRun.h"
#include "DiscreteOrdinates/OrdinateGroups.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "Numerics/Constants.h"
#include "Reference/ReferenceTable.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
/// A slab of `layers` voxels along z, lit by diffuse light of unit flux from below.
LitMedium Slab(int layers, double tau, double albedo, double g)
{
  LitMedium slab({ 1, 1, layers }, static_cast<float>(tau * (1.0 - albedo)), static_cast<float>(tau * albedo));
  slab.medium.grid.spacing = { 1.0, 1.0, 1.0 / layers };
  slab.how.periodic = { true, true, false };
  slab.how.tolerance = 1e-6;
  slab.ScatterWith(g);
  slab.light.faces[4] = { 1.0 / Pi, 1.0 / Pi, 1.0 / Pi };
  return slab;
}

struct Fractions
{
  double reflected, transmitted, sides, absorbed;
};

Fractions FractionsOf(const LightField& light)
{
  const double in = light.balance.entered[0];
  const auto out = [&](int face) { return light.facePowerOut[face][0] / in; };
  return { out(4), out(5), out(0) + out(1) + out(2) + out(3), light.balance.absorbed[0] / in };
}

/// A cube of optical side tau, lit by diffuse light on its face -z.
Fractions SolveCube(Device& device, int edge, double tau, double albedo, double g)
{
  LitMedium cube({ edge, edge, edge }, static_cast<float>(tau * (1.0 - albedo)), static_cast<float>(tau * albedo));
  cube.medium.grid.spacing = { 1.0 / edge, 1.0 / edge, 1.0 / edge };
  cube.light.faces[4] = { 1.0, 1.0, 1.0 };
  cube.ScatterWith(g);
  cube.how.acceleration = PropagationAcceleration::None;
  return FractionsOf(cube.SolveOrdinates(device));
}
}

class DiscreteOrdinates : public DeviceTest
{
};

TEST(OrdinateGroups, HaveEveryDirectionOnceInItsOctant)
{
  for (int perFace : { 1, 4, 9, 16, 25 })
  {
    const std::vector<Direction> directions = EquiangularDirections(perFace).directions;
    const OrdinateGroups groups(directions);
    std::multiset<int> found;
    double weights = 0.0;
    for (int g = 0; g < groups.Count(); ++g)
    {
      for (int lane = 0; lane < OrdinateLanes; ++lane)
      {
        for (int a = 0; a < 3; ++a)
        {
          const double along = groups.Of(g, lane).omega[a];
          EXPECT_TRUE(along == 0.0 || (along > 0.0) == groups.All()[g].up[a]);
        }
        weights += groups.Weight(g, lane);
        if (lane < groups.All()[g].count)
        {
          found.insert(groups.All()[g].direction[lane]);
        }
      }
    }
    EXPECT_EQ(found.size(), directions.size());
    EXPECT_EQ(std::set<int>(found.begin(), found.end()).size(), directions.size());
    EXPECT_NEAR(weights, 4.0 * Pi, 1e-12);
  }
}

TEST_F(DiscreteOrdinates, FillAFurnaceWithRadianceOneForAnyMeanCosine)
{
  for (double g : { -0.5, 0.0, 0.5, 0.9 })
  {
    for (OrdinatesScattering scattering :
      { OrdinatesScattering::Matrix, OrdinatesScattering::SingularValues, OrdinatesScattering::SphericalHarmonics })
    {
      LitMedium furnace({ 11, 9, 6 });
      furnace.Randomise(2.0, 4.0, 1.0);
      furnace.ShineFromEverywhere(1.0);
      furnace.ScatterWith(g);
      furnace.how.scattering = scattering;
      furnace.how.directionsPerFace = 9;
      furnace.how.terms = 16;
      furnace.how.tolerance = 1e-7;
      const LightField light = furnace.SolveOrdinates(this->GetDevice());
      for (float fluence : light.fluence)
      {
        ASSERT_NEAR(fluence / (4.0 * Pi), 1.0, 1e-5) << g << " " << static_cast<int>(scattering);
      }
    }
  }
}

TEST_F(DiscreteOrdinates, GiveBackEveryWattTheyTake)
{
  for (double g : { -0.8, 0.0, 0.85 })
  {
    for (double thickest : { 0.0, 1e-4, 1.0, 1e3 })
    {
      for (bool periodic : { false, true })
      {
        LitMedium scene({ 12, 7, 9 });
        scene.medium.grid.spacing = { 1.0, 1.3, 0.8 };
        scene.Randomise(thickest, 5.0, 0.9);
        scene.emission.assign(scene.sigma_a.size(), 0.0f);
        scene.emission[100] = 3.0f;
        scene.ShineFromEverywhere(1.0);
        scene.ShineAlong({ 0.3, 0.2, -1.0 });
        scene.light.lights.push_back(PointLamp({ 4.1, 3.2, 2.9 }, { 30.0, 30.0, 30.0 }));
        scene.light.faces[0] = { 0.5, 0.5, 0.5 };
        scene.ScatterWith(g);
        scene.how.directionsPerFace = 4;
        scene.how.terms = 9;
        scene.how.periodic = { periodic, false, false };
        const LightField light = scene.SolveOrdinates(this->GetDevice());
        EXPECT_LT(light.balance.RelativeError(1), 1e-5) << g << " " << thickest << " " << periodic;
        ExpectFiniteAndNotNegative(light.fluence);
        ExpectFiniteAndNotNegative(light.fluenceDirect);
      }
    }
  }
}

TEST_F(DiscreteOrdinates, ArePositiveInVoxelsOfAHundredMeanFreePaths)
{
  for (double g : { -0.9, 0.0, 0.9 })
  {
    LitMedium thick({ 8, 8, 8 }, 10.0f, 90.0f);
    thick.ShineAlong({ 0.5, 0.1, -1.0 });
    thick.ScatterWith(g);
    thick.how.directionsPerFace = 9;
    const LightField light = thick.SolveOrdinates(this->GetDevice());
    ExpectFiniteAndNotNegative(light.fluence);
    EXPECT_LT(light.balance.RelativeError(1), 1e-5) << g;
    EXPECT_TRUE(light.converged);
  }
}

TEST_F(DiscreteOrdinates, SeeAnEvenEnvironmentAsTheSky)
{
  for (int spiral : { 0, 60 })
  {
    LitMedium scene({ 5, 6, 4 }, 0.2f, 0.8f);
    scene.ScatterWith(0.6);
    scene.how.directionsPerFace = 9;
    scene.how.spiralDirections = spiral;
    LitMedium environment = scene;
    scene.ShineFromEverywhere(0.7);
    environment.light.environment.width = 16;
    environment.light.environment.height = 8;
    environment.light.environment.radiance.assign(3 * 16 * 8, 0.7f);
    const LightField sky = scene.SolveOrdinates(this->GetDevice());
    const LightField seen = environment.SolveOrdinates(this->GetDevice());
    EXPECT_LT(RelativeDifference(seen.fluence, sky.fluence), 1e-5) << spiral;
    EXPECT_GT(sky.balance.entered[0], 0.0);
  }
}

TEST_F(DiscreteOrdinates, ScatterALampTheSameToAllSides)
{
  LitMedium scene({ 9, 9, 9 }, 0.05f, 0.2f);
  scene.light.lights.push_back(PointLamp({ 4.5, 4.5, 4.5 }, { 5.0, 5.0, 5.0 }));
  scene.ScatterWith(0.8);
  scene.how.directionsPerFace = 9;
  scene.how.terms = 16;
  const LightField light = scene.SolveOrdinates(this->GetDevice());
  for (const CubeTurn& turn : AllCubeTurns())
  {
    EXPECT_LT(RelativeDifference(turn.Field(light.fluence, scene.medium.grid.size), light.fluence), 3e-5);
  }
  for (int face = 1; face < 6; ++face)
  {
    EXPECT_NEAR(light.facePowerOut[face][0], light.facePowerOut[0][0], 1e-5 * light.facePowerOut[0][0]);
  }
  EXPECT_LT(light.balance.RelativeError(1), 1e-5);
}

/// Its light is scattered voxel by voxel, that of a beam by one table: power and mean cosine are right in both.
TEST_F(DiscreteOrdinates, ScatterALampFarAwayAsABeam)
{
  for (double g : { 0.8, -0.6 })
  {
    LitMedium beam({ 1, 1, 1 }, 0.0f, 0.3f);
    beam.ScatterWith(g);
    beam.how.directionsPerFace = 4;
    beam.how.terms = 16;
    LitMedium far = beam;
    beam.ShineAlong({ 0.0, 0.0, -1.0 }, 1.0);
    Light lamp;
    lamp.type = LightType::Point;
    lamp.position = { 0.5, 0.5, 1e4 };
    lamp.power.fill(4.0 * Pi * 1e8);
    far.light.lights.push_back(lamp);
    const LightField expected = beam.SolveOrdinates(this->GetDevice()), found = far.SolveOrdinates(this->GetDevice());
    for (int face = 0; face < 6; ++face)
    {
      EXPECT_NEAR(found.facePowerOut[face][0] / expected.facePowerOut[face][0], 1.0, 5e-3) << g << ' ' << face;
    }
  }
}

TEST_F(DiscreteOrdinates, ScatterLampsByPeaksThatAreNarrowerThanTheirDirections)
{
  for (double g : { -0.999, 0.99, 0.999 })
  {
    LitMedium scene({ 9, 9, 9 }, 0.05f, 1.0f);
    scene.light.lights.push_back(PointLamp({ 3.3, 4.4, 5.2 }, { 5.0, 5.0, 5.0 }));
    const std::array<double, 3> along = EquiangularDirections(25).directions[3].omega;
    scene.ShineAlong(along);
    scene.ScatterWith(g);
    scene.how.maximumOrders = 20;
    const LightField light = scene.SolveOrdinates(this->GetDevice());
    ExpectFiniteAndNotNegative(light.fluence);
    EXPECT_LT(light.balance.RelativeError(1), 1e-5) << g;
  }
}

/// Sweeps smear the edges of a face's light, whatever the number of directions: it was 6% off. Rays do not.
TEST_F(DiscreteOrdinates, SeeAFaceUnderItsSolidAngle)
{
  for (const double g : { 0.0, 0.5, 0.9 })
  {
    for (const int directions : { 9, 25, 144 })
    {
      LitMedium empty({ 16, 16, 16 }, 1e-6f, 1e-6f);
      empty.ScatterWith(g);
      empty.light.faces[4] = { 1.0, 1.0, 1.0 };
      empty.how.directionsPerFace = directions;
      const LightField light = empty.SolveOrdinates(this->GetDevice());
      const double error = ErrorInEmptyCube(light.fluence, empty.medium.grid);
      EXPECT_LT(error, directions == 25 && g == 0.0 ? 0.015 : 0.025) << directions << " directions, g " << g;
      EXPECT_LT(light.balance.RelativeError(1), 1e-5);
    }
  }
}

TEST_F(DiscreteOrdinates, AreComparedWithTheOthers)
{
  LitMedium scene({ 8, 8, 8 }, 0.05f, 0.1f);
  scene.ShineFromEverywhere(1.0);
  scene.Attach();
  ComparedScene compared;
  compared.medium = scene.medium;
  compared.illumination = scene.light;
  ComparedSettings settings;
  settings.directionsPerFace = { 1, 4, 9 };
  settings.coarsenings = { 1 };
  settings.orders = {};
  const std::vector<ComparedRun> runs =
    RunsOf(ComparedMethod::DiscreteOrdinates, this->GetDevice(), compared, settings);
  ASSERT_EQ(runs.size(), 3u) << "no finer maps";
  const std::vector<float> maps = Propagate(this->GetDevice(), compared, {}, {}).fluence;
  EXPECT_STREQ(NameOf(runs[0].method), "discrete ordinates");
  EXPECT_LT(RelativeDifference(runs[2].solve(false, {}).fluence, maps), 0.05);
  EXPECT_NO_THROW(runs[0].solve(false, {})) << "fewer terms where directions are few";
}

namespace
{
/// tau 0.1, 1, 10, albedo 0.9 and 1, g 0.5, 0.85, 0.9
std::vector<ReferenceRow> SomeSlabs()
{
  std::vector<ReferenceRow> some;
  for (const ReferenceRow& row : ReadReference("slab_forward"))
  {
    const auto isOneOf = [&](const char* column, const std::vector<double>& numbers) {
      return std::find(numbers.begin(), numbers.end(), row[column]) != numbers.end();
    };
    if (isOneOf("tau", { 0.1, 1.0, 10.0 }) && isOneOf("omega", { 0.9, 1.0 }) && isOneOf("g", { 0.5, 0.85, 0.9 }))
    {
      some.push_back(row);
    }
  }
  return some;
}
}

TEST_F(DiscreteOrdinates, HaveTheReflectanceAndTransmittanceOfSlabs)
{
  int compared = 0;
  for (const ReferenceRow& row : SomeSlabs())
  {
    LitMedium slab = Slab(row["tau"] > 1.0 ? 128 : 32, row["tau"], row["omega"], row["g"]);
    const Fractions found = FractionsOf(slab.SolveOrdinates(this->GetDevice()));
    EXPECT_NEAR(found.reflected, row["R_diffuse"], 1e-3) << row["tau"] << " " << row["omega"] << " " << row["g"];
    EXPECT_NEAR(found.transmitted, row["T_diffuse"], 1e-3) << row["tau"] << " " << row["omega"] << " " << row["g"];
    ++compared;
  }
  EXPECT_EQ(compared, 18);
}

TEST_F(DiscreteOrdinates, HaveTheReflectanceAndTransmittanceOfBeams)
{
  int compared = 0;
  for (const ReferenceRow& row : SomeSlabs())
  {
    LitMedium slab = Slab(row["tau"] > 1.0 ? 128 : 32, row["tau"], row["omega"], row["g"]);
    slab.light.faces[4] = {};
    slab.ShineAlong({ std::sqrt(0.75), 0.0, 0.5 }, 2.0);
    const Fractions found = FractionsOf(slab.SolveOrdinates(this->GetDevice()));
    EXPECT_NEAR(found.reflected, row["R_mu05"], 2e-3) << row["tau"] << " " << row["omega"] << " " << row["g"];
    EXPECT_NEAR(found.transmitted, row["T_mu05"], 2e-3) << row["tau"] << " " << row["omega"] << " " << row["g"];
    ++compared;
  }
  EXPECT_EQ(compared, 18);
}

TEST_F(DiscreteOrdinates, AreOfSecondOrderInSlabsAndOfFirstInCubes)
{
  const auto transmitted = [&](int layers) {
    LitMedium slab = Slab(layers, 4.0, 0.9, 0.5);
    return FractionsOf(slab.SolveOrdinates(this->GetDevice())).transmitted;
  };
  const double slab = (transmitted(8) - transmitted(16)) / (transmitted(16) - transmitted(32));
  EXPECT_NEAR(std::log2(slab), 2.0, 0.4);
  const auto ofCube = [&](int edge) { return SolveCube(this->GetDevice(), edge, 5.0, 0.9, 0.5).transmitted; };
  const double cube = (ofCube(8) - ofCube(16)) / (ofCube(16) - ofCube(32));
  EXPECT_NEAR(std::log2(cube), 1.0, 0.4);
}

TEST_F(DiscreteOrdinates, ComeNearToMonteCarloInCubesByFirstOrder)
{
  for (double g : { 0.5, 0.85 })
  {
    for (double tau : { 1.0, 5.0 })
    {
      const ReferenceRow row =
        ReferenceRowWhere("cube_RTSA_anisotropic", { { "tau", tau }, { "omega", 0.9 }, { "g", g }, { "src", 0.0 } });
      const Fractions coarse = SolveCube(this->GetDevice(), 16, tau, 0.9, g);
      const Fractions fine = SolveCube(this->GetDevice(), 32, tau, 0.9, g);
      // Two grids take away the error of first order.
      const auto limit = [&](double Fractions::*part) { return 2.0 * fine.*part - coarse.*part; };
      EXPECT_NEAR(fine.reflected, row["R"], 0.03) << g << " " << tau;
      EXPECT_NEAR(fine.transmitted, row["T"], 0.03) << g << " " << tau;
      EXPECT_NEAR(fine.sides, row["S"], 0.03) << g << " " << tau;
      EXPECT_NEAR(limit(&Fractions::reflected), row["R"], 0.01) << g << " " << tau;
      EXPECT_NEAR(limit(&Fractions::transmitted), row["T"], 0.01) << g << " " << tau;
      EXPECT_NEAR(limit(&Fractions::sides), row["S"], 0.01) << g << " " << tau;
      EXPECT_NEAR(limit(&Fractions::absorbed), row["A"], 0.01) << g << " " << tau;
    }
  }
}

TEST_F(DiscreteOrdinates, AgreeWithLightPropagationMapsWhereLightIsScatteredEvenly)
{
  const auto difference = [&](int edge) {
    LitMedium cube({ edge, edge, edge }, 0.4f, 3.6f);
    cube.medium.grid.spacing = { 1.0 / edge, 1.0 / edge, 1.0 / edge };
    cube.ShineAlong({ 0.2, 0.3, -1.0 });
    cube.light.faces[5] = { 0.2, 0.2, 0.2 };
    cube.how.directionsPerFace = cube.settings.directionsPerFace = 100; // else it is their directions that differ
    const std::vector<float> ordinates = cube.SolveOrdinates(this->GetDevice()).fluence;
    cube.settings.source = PropagationSource::Constant;
    cube.settings.acceleration = PropagationAcceleration::None;
    const std::vector<float> maps = cube.Solve(this->GetDevice()).fluence;
    double squares = 0.0, all = 0.0;
    for (std::size_t i = 0; i < maps.size(); ++i)
    {
      squares += (ordinates[i] - maps[i]) * (ordinates[i] - maps[i]);
      all += maps[i] * maps[i];
    }
    return std::sqrt(squares / all);
  };
  const double coarse = difference(12), fine = difference(24);
  EXPECT_LT(fine, 0.03);
  EXPECT_LT(fine, 0.65 * coarse); // of first order: half, in the limit
}

TEST_F(DiscreteOrdinates, AreTheSameByMatrixAndByAllSingularValues)
{
  LitMedium scene({ 6, 7, 8 }, 0.1f, 1.0f);
  scene.ShineAlong({ 0.1, 0.2, -1.0 });
  scene.ScatterWith(0.7);
  scene.how.directionsPerFace = 4;
  scene.how.scattering = OrdinatesScattering::Matrix;
  const std::vector<float> matrix = scene.SolveOrdinates(this->GetDevice()).fluence;
  scene.how.scattering = OrdinatesScattering::SingularValues;
  scene.how.terms = 24;
  EXPECT_LT(RelativeDifference(scene.SolveOrdinates(this->GetDevice()).fluence, matrix), 1e-5);
  scene.how.spiralDirections = 40;
  scene.how.terms = 40;
  const std::vector<float> terms = scene.SolveOrdinates(this->GetDevice()).fluence;
  scene.how.scattering = OrdinatesScattering::Matrix;
  EXPECT_LT(RelativeDifference(scene.SolveOrdinates(this->GetDevice()).fluence, terms), 1e-5);
}

// In empty space every voxel adds the same numbers up: rounding would not even out.
TEST_F(DiscreteOrdinates, HaveLightInProportionToWhatShines)
{
  std::vector<float> alone;
  for (const double factor : { 1.0, 22.4159, 3.0, 0.1 })
  {
    LitMedium empty({ 3, 8, 8 });
    empty.ShineFromEverywhere(0.1167527 * factor);
    empty.light.faces[5] = { 0.0236657 * factor, 0.0236657 * factor, 0.0236657 * factor };
    std::vector<float> fluence = empty.SolveOrdinates(this->GetDevice()).fluence;
    for (float& value : fluence)
    {
      value = static_cast<float>(value / factor);
    }
    alone = alone.empty() ? fluence : alone;
    EXPECT_LT(LargestDifference(fluence, alone), 1e-6 * *std::max_element(alone.begin(), alone.end())) << factor;
  }
}

TEST_F(DiscreteOrdinates, HaveTheNetFluxThatTheBalanceAsksFor)
{
  LitMedium slab = Slab(80, 2.0, 0.7, 0.5);
  slab.how.netFlux = true;
  const LightField light = slab.SolveOrdinates(this->GetDevice());
  // Through a layer goes what the layers above absorb and what leaves on top.
  double above = light.facePowerOut[5][0];
  for (int k = 79; k >= 0; --k)
  {
    const double absorbed = 0.6 * light.fluence[k] / 80.0;
    EXPECT_NEAR(light.netFlux[3 * k + 2], above + 0.5 * absorbed, 1e-3 * above) << k;
    EXPECT_NEAR(light.netFlux[3 * k], 0.0, 1e-5) << k;
    above += absorbed;
  }
}

TEST_F(DiscreteOrdinates, SayWhatTheySpared)
{
  LitMedium dark({ 4, 4, 4 }, 1.0f, 0.0f);
  const LightField light = dark.SolveOrdinates(this->GetDevice());
  EXPECT_EQ(Sum(light.balance.entered), 0.0);
  EXPECT_THAT(light.leftOut, testing::Contains(testing::HasSubstr("sigma_s is zero")));
  EXPECT_THAT(light.leftOut, testing::Contains(testing::HasSubstr("one channel does")));
  EXPECT_THAT(light.leftOut, testing::Contains(testing::HasSubstr("no lights")));
}

TEST_F(DiscreteOrdinates, RefuseWhatHasNoMeaning)
{
  const auto message = [&](const std::function<void(OrdinatesSettings&)>& change) {
    LitMedium scene({ 3, 3, 3 }, 0.1f, 0.1f);
    scene.ScatterWith(0.5);
    change(scene.how);
    return ErrorWords([&] { scene.SolveOrdinates(this->GetDevice()); });
  };
  EXPECT_EQ(message([](OrdinatesSettings&) {}), "");
  EXPECT_THAT(message([](OrdinatesSettings& s) { s.terms = 0; }), testing::HasSubstr("Terms is 0"));
  EXPECT_THAT(message([](OrdinatesSettings& s) { s.terms = 151; }), testing::HasSubstr("151 terms"));
  EXPECT_THAT(message([](OrdinatesSettings& s) { s.directionsPerFace = 7; }), testing::HasSubstr("7"));
  EXPECT_THAT(message([](OrdinatesSettings& s) { s.spiralDirections = 15; }), testing::HasSubstr("15"));
  EXPECT_THAT(message([](OrdinatesSettings& s) { s.spiralDirections = -1; }), testing::HasSubstr("-1"));
  EXPECT_THAT(message([](OrdinatesSettings& s) { s.tolerance = 0.0; }), testing::HasSubstr("Tolerance"));
  EXPECT_THAT(message([](OrdinatesSettings& s) { s.maximumOrders = -2; }), testing::HasSubstr("-2"));
}

TEST_F(DiscreteOrdinates, SayHowMuchMemoryTheyNeedBeforeTheyTakeIt)
{
  LitMedium large({ 1, 1, 1 });
  large.medium.grid.size = { 700, 700, 700 };
  large.ShineFromEverywhere(1.0);
  const std::size_t before = this->GetDevice().BytesInUse();
  this->GetDevice().ResetPeak();
  const std::string words = ErrorWords<DeviceError>([&] {
    SolveDiscreteOrdinates(this->GetDevice(), Domain(large.medium.grid), large.medium, large.light, large.how);
  });
  EXPECT_THAT(words, testing::HasSubstr("150 directions need"));
  EXPECT_THAT(words, testing::HasSubstr("MiB"));
  EXPECT_EQ(this->GetDevice().PeakBytes(), before);
}

// The four terms of a preview were negative in some directions, which were set to 0 order by order: 13% off.
TEST_F(DiscreteOrdinates, FillAFurnaceByTheTermsOfAPreview)
{
  LitMedium scene({ 5, 5, 5 }, 0.2f, 1.8f);
  scene.emission.assign(scene.sigma_a.size(), 0.2f);
  scene.ShineFromEverywhere(1.0);
  scene.ScatterWith(-0.95);
  scene.how.directionsPerFace = scene.how.terms = 4;
  scene.how.seriesAfter = 24;
  for (const float fluence : scene.SolveOrdinates(this->GetDevice()).fluence)
  {
    EXPECT_NEAR(fluence / (4.0 * Pi), 1.0, 0.02);
  }
}

// Accelerated solves are in angular moments, of which there are fewer: an error named a property of the maps.
TEST_F(DiscreteOrdinates, TakeMoreTermsThanThereAreMoments)
{
  LitMedium scene({ 4, 4, 4 }, 0.0f, 300.0f);
  scene.ShineFromEverywhere(1.0);
  scene.ScatterWith(0.9);
  scene.how.directionsPerFace = 64;
  scene.how.terms = 324;
  for (const float fluence : scene.SolveOrdinates(this->GetDevice()).fluence)
  {
    EXPECT_NEAR(fluence / (4.0 * Pi), 1.0, 1e-2);
  }
}

class PublishedOrdinates : public DiscreteOrdinates
{
protected:
  LightField SolveThickVoxels(double tau, OrdinatesScattering scattering, int steps)
  {
    LitMedium scene({ 8, 8, 8 }, static_cast<float>(0.5 * tau), static_cast<float>(0.5 * tau));
    scene.light.faces[4] = { 1.0, 1.0, 1.0 };
    scene.ScatterWith(0.5);
    scene.how.scheme = OrdinatesScheme::Published;
    scene.how.scattering = scattering;
    scene.how.directionsPerFace = 4;
    scene.how.terms = 16;
    scene.how.maximumOrders = steps;
    return scene.SolveOrdinates(this->GetDevice());
  }
};

TEST_F(PublishedOrdinates, AreNotStableAboveOneMeanFreePathAVoxel)
{
  const auto least = [](const LightField& light) {
    return *std::min_element(light.fluence.begin(), light.fluence.end());
  };
  const LightField thin = this->SolveThickVoxels(0.9, OrdinatesScattering::SingularValues, 60);
  EXPECT_GE(least(thin), 0.0f);
  EXPECT_TRUE(thin.doubts.empty());
  const LightField thick = this->SolveThickVoxels(1.5, OrdinatesScattering::SingularValues, 60);
  EXPECT_LT(least(thick), 0.0f);
  EXPECT_THAT(thick.doubts, testing::Contains(testing::HasSubstr("here it is up to 1.5")));
  const std::string opaque =
    ErrorWords<InvalidInput>([&] { this->SolveThickVoxels(4.0, OrdinatesScattering::SingularValues, 200); });
  EXPECT_THAT(opaque, testing::HasSubstr("grows without end"));
  EXPECT_THAT(opaque, testing::HasSubstr("here up to 4)"));
}

// Between so few directions the point values of so narrow a phase function scatter many times what comes.
TEST_F(PublishedOrdinates, RefuseAPhaseFunctionThatMakesLight)
{
  LitMedium scene({ 6, 6, 6 }, 0.06f, 0.24f);
  scene.ShineFromEverywhere(1.0);
  scene.ScatterWith(0.99);
  scene.how.scheme = OrdinatesScheme::Published;
  scene.how.scattering = OrdinatesScattering::SingularValues;
  EXPECT_THAT(ErrorWords<InvalidInput>([&] { scene.SolveOrdinates(this->GetDevice()); }),
    testing::HasSubstr("scatters no more than comes"));
}

TEST_F(PublishedOrdinates, AreTheSameByPassesAndByAllTerms)
{
  LitMedium scene({ 6, 5, 7 }, 0.05f, 0.3f);
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  scene.ScatterWith(0.5);
  scene.how.scheme = OrdinatesScheme::Published;
  scene.how.spiralDirections = 40;
  scene.how.terms = 40;
  scene.how.maximumOrders = 30;
  scene.how.scattering = OrdinatesScattering::Matrix;
  const LightField passes = scene.SolveOrdinates(this->GetDevice());
  scene.how.scattering = OrdinatesScattering::SingularValues;
  const LightField terms = scene.SolveOrdinates(this->GetDevice());
  EXPECT_LT(RelativeDifference(terms.fluence, passes.fluence), 1e-5);
}

TEST_F(PublishedOrdinates, DoNotKeepThePowerThatTheConservativeSchemeKeeps)
{
  LitMedium scene({ 12, 12, 12 }, 0.0f, 0.5f);
  scene.ShineFromEverywhere(1.0);
  scene.ScatterWith(0.85);
  scene.how.directionsPerFace = 16;
  scene.how.tolerance = 1e-5;
  EXPECT_LT(scene.SolveOrdinates(this->GetDevice()).balance.RelativeError(1), 1e-5);
  scene.how.scheme = OrdinatesScheme::Published;
  scene.how.scattering = OrdinatesScattering::SingularValues;
  scene.how.maximumOrders = 100;
  EXPECT_GT(scene.SolveOrdinates(this->GetDevice()).balance.RelativeError(1), 1e-3);
}
