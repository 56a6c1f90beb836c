#include "DeviceTest.h"
#include "ErrorWords.h"
#include "MeshShapes.h"

#include "Comparison/PhotonReference.h"
#include "Comparison/SolverComparison.h"
#include "Device/Clock.h"
#include "Medium/Coarsening.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace
{
using namespace tyndall;

ComparisonRow Row(double seconds, double error, ComparedMethod method = ComparedMethod::LightPropagationMaps)
{
  ComparisonRow row;
  row.method = method;
  row.seconds = seconds;
  row.errorL2 = error;
  return row;
}

TEST(SolverComparison, FindsTheFrontOfAMadeTable)
{
  std::vector<ComparisonRow> rows = { Row(1.0, 0.1), Row(2.0, 0.1), Row(2.0, 0.05), Row(4.0, 0.06), Row(8.0, 0.01),
    Row(0.5, std::nan("")), Row(0.5, 0.2, ComparedMethod::Photons), Row(0.6, 0.3, ComparedMethod::AdaptivePhotons) };
  MarkPareto(rows);
  const bool expected[] = { true, false, true, false, true, false, true, false };
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    EXPECT_EQ(rows[i].pareto, expected[i]) << "row " << i;
  }
}

TEST(SolverComparison, KeepsBothOfTwoThatAreAlike)
{
  std::vector<ComparisonRow> rows = { Row(1.0, 0.1), Row(1.0, 0.1) };
  MarkPareto(rows);
  EXPECT_TRUE(rows[0].pareto);
  EXPECT_TRUE(rows[1].pareto);
}

ComparisonRow Made(const char* filters, double seconds, double error, ComparedMethod method)
{
  ComparisonRow row = Row(seconds, error, method);
  row.filters = filters;
  return row;
}

TEST(SolverComparison, RecommendsTheFastestThatIsGoodEnoughAndCanBeMade)
{
  const ComparedMethod maps = ComparedMethod::LightPropagationMaps, photons = ComparedMethod::Photons;
  std::vector<ComparisonRow> rows = { Made("A", 1.0, 0.1, maps), Made("", 2.0, 0.001, maps), Made("B", 3.0, 0.01, maps),
    Made("C | D Input=#1", 4.0, 0.001, maps), Made("E", 1.0, 0.3, photons), Made("F", 2.0, 0.2, photons),
    Made("G", 0.1, std::nan(""), maps), Made("H", 1.0, 0.0001, ComparedMethod::Pictures) };
  MarkRecommended(rows, 0.01);
  const bool expected[] = { false, false, true, false, false, true, false, true };
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    EXPECT_EQ(rows[i].recommended, expected[i]) << "row " << i;
  }
  EXPECT_EQ(rows[7].filters, "B | H Input=#1") << "pictures show the recommended light";
  EXPECT_EQ(RecommendedOf(rows), &rows[7]);
  rows.pop_back();
  EXPECT_EQ(RecommendedOf(rows), &rows[2]);
  EXPECT_EQ(RecommendedOf({}), nullptr);
}

TEST(SolverComparison, MeasuresErrorsAgainstTheReferenceAlone)
{
  const RelativeErrors errors = ErrorsOf({ 3.0f, 4.5f, 7.0f }, { 3.0f, 4.0f, std::nanf("") });
  EXPECT_NEAR(errors.l2, 0.5 / 5.0, 1e-12);
  EXPECT_NEAR(errors.max, 0.5 / 4.0, 1e-12);
  EXPECT_NEAR(errors.relative, 0.125 / std::sqrt(2.0), 1e-12);
  EXPECT_TRUE(std::isnan(ErrorsOf({ 1.0f }, { 0.0f }).l2)) << "there is no error relative to the dark";
  EXPECT_TRUE(std::isnan(ErrorsOf({ 1.0f, std::nanf("") }, { 1.0f, 1.0f }).max)) << "light that is no number shows";
}

TEST(GridTransfer, AveragesWhatItRepeats)
{
  Grid fine;
  fine.size = { 4, 2, 1 };
  fine.spacing = { 0.5, 1.0, 3.0 };
  const std::optional<Factors> factors = CoarseningBy(2, fine);
  ASSERT_TRUE(factors);
  EXPECT_EQ(*factors, (Factors{ 2, 2, 1 })) << "an axis of one voxel stays";
  const std::vector<float> means = Averaged(std::vector<float>{ 1, 2, 3, 4, 5, 6, 7, 8 }.data(), 1, fine, *factors);
  EXPECT_EQ(means, (std::vector<float>{ 3.5f, 5.5f }));
  const Grid coarse = Coarsened(fine, *factors);
  EXPECT_EQ(coarse.size, (std::array<int, 3>{ 2, 1, 1 }));
  const std::vector<float> repeated = Repeated(means.data(), 1, coarse, *factors);
  EXPECT_EQ(repeated, (std::vector<float>{ 3.5f, 3.5f, 5.5f, 5.5f, 3.5f, 3.5f, 5.5f, 5.5f }));
  EXPECT_EQ(Averaged(repeated.data(), 1, fine, *factors), means);
}

TEST(ResampledScene, WeighsTheMeanCosineByScattering)
{
  const std::vector<float> sigma_s = { 1.0f, 3.0f, 0.0f, 0.0f }, g = { 0.8f, 0.4f, 0.7f, -0.7f };
  Medium medium;
  medium.grid.size = { 4, 1, 1 };
  medium.sigma_s = { sigma_s.data() };
  medium.phase = PhaseOfMedium(PhaseFunction::Schlick(0.0), Field{ g.data() });
  const Illumination dark;
  const SceneBlock scene = { Domain(medium.grid), medium, dark };
  const CoarseScene coarser(scene, Coarsened(medium.grid, { 2, 1, 1 }));
  EXPECT_NEAR(coarser.Scene().medium.phase.MeanCosine(0, 0), (0.8 + 3.0 * 0.4) / 4.0, 1e-6);
  EXPECT_EQ(coarser.Scene().medium.phase.MeanCosine(1, 0), 0.0) << "where nothing scatters";
  EXPECT_EQ(coarser.Scene().medium.phase.At(0, 0).TheKind(), PhaseFunction::Kind::Schlick);
  const DividedScene finer(scene, { 2, 1, 1 });
  EXPECT_EQ(finer.Scene().medium.phase.MeanCosine(3, 0), 0.4f);
  EXPECT_EQ(finer.Scene().medium.phase.MeanCosine(4, 0), 0.7f);
}

TEST(MeansOfSets, KnowTheirErrors)
{
  MeansOfSets means;
  means.Add({ 1.0f, 4.0f }, 1);
  means.Add({ 3.0f, 4.0f }, 1);
  means.Add({ 5.0f, 4.0f }, 1);
  EXPECT_EQ(means.Values(), (std::vector<float>{ 3.0f, 4.0f }));
  EXPECT_NEAR(means.Variance(), 4.0 / 3.0, 1e-12); // 4, that of one set, of three
  EXPECT_NEAR(means.RelativeError(), std::sqrt(4.0 / 3.0 / 25.0), 1e-12);
  EXPECT_EQ(means.SquaredErrorOf({ 3.0f, 4.1f }, 1), 0.0) << "chance alone puts them off by more";
  EXPECT_NEAR(means.SquaredErrorOf({ 3.0f, 14.0f }, 1), 100.0 - 4.0 / 3.0 * (1.0 + 2.0 * std::sqrt(1.5)), 1e-5);
}

// A set of few photons may have met white lamps only.
TEST(MeansOfSets, TakeLightOfOneChannelForAll)
{
  MeansOfSets means;
  means.Add({ 1.0f, 2.0f }, 1);
  means.Add({ 1.0f, 3.0f, 5.0f, 2.0f, 4.0f, 6.0f }, 3);
  means.Add({ 4.0f, 6.0f }, 1);
  EXPECT_EQ(means.Channels(), 3);
  const float thirds[] = { 6.0f, 8.0f, 10.0f, 10.0f, 12.0f, 14.0f };
  const std::vector<float> values = means.Values();
  ASSERT_EQ(values.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i)
  {
    EXPECT_NEAR(values[i], thirds[i] / 3.0, 1e-6);
  }
  const double ofGrey = means.SquaredErrorOf({ 100.0f, 200.0f }, 1),
               ofAll = means.SquaredErrorOf({ 100.0f, 100.0f, 100.0f, 200.0f, 200.0f, 200.0f }, 3);
  EXPECT_EQ(ofGrey, ofAll);
  EXPECT_GT(ofGrey, 0.0);
}

TEST(Coarsening, WeighsByChannel)
{
  const std::vector<float> sigma_s = { 1.0f, 0.0f, 2.0f, 1.0f, 1.0f, 0.0f }, g = { 0.2f, 0.6f };
  Grid fine;
  fine.size = { 2, 1, 1 };
  const std::vector<float> means = Coarsening(fine).Average(Field{ g.data() }, Field{ sigma_s.data(), 3 });
  ASSERT_EQ(means.size(), 3u);
  EXPECT_NEAR(means[0], 0.4, 1e-6);
  EXPECT_NEAR(means[1], 0.6, 1e-6) << "the first voxel does not scatter green";
  EXPECT_NEAR(means[2], 0.2, 1e-6);
}

TEST(Coarsening, LeavesNoMeanCosineBeyondThoseThereAre)
{
  const float close = std::nextafter(1.0f, 0.0f);
  const std::vector<float> sigma_s = { 0.1f, 0.7f, 0.3f }, g = { close, close, close };
  Grid fine, coarse;
  fine.size = { 3, 1, 1 };
  coarse.spacing = { 3.0, 1.0, 1.0 };
  coarse.size = { 1, 1, 1 };
  EXPECT_LE(Coarsening(fine, coarse).Average(Field{ g.data() }, Field{ sigma_s.data() })[0], close);
}

TEST(GridTransfer, KnowsWhichGridsFit)
{
  Grid fine;
  fine.size = { 6, 6, 6 };
  EXPECT_FALSE(CoarseningBy(4, fine));
  Grid coarse = Coarsened(fine, { 3, 2, 1 });
  EXPECT_EQ(FactorsBetween(fine, coarse), (Factors{ 3, 2, 1 }));
  EXPECT_FALSE(FactorsBetween(coarse, fine));
  coarse.origin[1] += 0.1;
  EXPECT_FALSE(FactorsBetween(fine, coarse));
}
}

namespace
{
/// A small cube in the sun, which scatters.
struct SunlitCube
{
  explicit SunlitCube(int edge)
    : sigma_a(static_cast<std::size_t>(edge * edge * edge), 0.2f)
    , sigma_s(sigma_a.size(), 2.0f)
    , ior(sigma_a.size(), 1.0f)
  {
    this->scene.medium.grid.size = { edge, edge, edge };
    this->scene.medium.grid.spacing = { 1.0 / edge, 1.0 / edge, 1.0 / edge };
    this->scene.medium.sigma_a = { this->sigma_a.data() };
    this->scene.medium.sigma_s = { this->sigma_s.data() };
    Light sun;
    sun.direction = { 0.3, 0.1, -1.0 };
    sun.power = { 3.0, 3.0, 3.0 };
    this->scene.illumination.lights = { sun };
    this->settings.methods = { ComparedMethod::MonteCarlo };
    this->settings.tried.photonCounts = { 2000, 50000 };
    this->settings.repeats = 1;
    this->settings.timeBudget = 120.0; // kernels are compiled in it, on a busy machine
    this->settings.tried.monteCarloReference = MonteCarloReference::Never;
  }

  std::vector<float> sigma_a, sigma_s, ior;
  ComparedScene scene;
  ComparisonSettings settings;
};
}

class ComparedMonteCarlo : public DeviceTest
{
};

using ComparedEstimates = ComparedMonteCarlo;

TEST_F(ComparedEstimates, AreMadeByEverySolverOfAllOrders)
{
  SunlitCube cube(16);
  cube.settings.methods = { ComparedMethod::LightPropagationMaps, ComparedMethod::ConstantSource,
    ComparedMethod::DiscreteOrdinates, ComparedMethod::LatticeBoltzmann };
  cube.settings.tried.directionsPerFace = { 9, 25 };
  cube.settings.tried.mapResolutions = { 1 };
  const Comparison found = CompareSolvers(this->GetDevice(), cube.scene, cube.settings);
  std::set<ComparedMethod> seen;
  for (const ComparisonRow& row : found.rows)
  {
    // not known of few orders; of coarser voxels estimated from coarser voxels still
    if (std::isnan(row.estimatedError) || row.grid.VoxelCount() != 4096)
    {
      continue;
    }
    seen.insert(row.method);
    EXPECT_LT(row.errorL2, 2.0 * row.estimatedError + 0.01) << NameOf(row.method) << ", " << row.setting;
  }
  EXPECT_EQ(seen.size(), cube.settings.methods.size());
}

// All light, by the errors that it estimates itself: the reference is of propagation.
TEST_F(ComparedMonteCarlo, ComesNearConvergedPropagation)
{
  SunlitCube cube(8);
  const Comparison found = CompareSolvers(this->GetDevice(), cube.scene, cube.settings);
  ASSERT_EQ(found.rows.size(), 2u);
  EXPECT_LT(found.rows[1].errorL2, 0.5 * found.rows[0].errorL2);
  for (const ComparisonRow& row : found.rows)
  {
    EXPECT_EQ(row.method, ComparedMethod::MonteCarlo);
    EXPECT_LT(row.errorL2, 2.0 * row.estimatedError + 0.01) << row.setting;
    EXPECT_LT(row.balance, 1e-5);
  }
}

// Light that is bent has no other reference than such photons.
TEST_F(ComparedMonteCarlo, IsItsOwnReferenceWhereLightIsBent)
{
  SunlitCube cube(6);
  for (std::size_t i = 0; i < cube.ior.size(); ++i)
  {
    cube.ior[i] = 1.0f + 0.002f * static_cast<float>(i);
  }
  cube.scene.ior = { cube.ior.data() };
  cube.settings.methods.push_back(ComparedMethod::Photons);
  cube.settings.tried.photonCounts = { 4000 };
  const Comparison found = CompareSolvers(this->GetDevice(), cube.scene, cube.settings);
  EXPECT_FALSE(found.reference.fluence.empty());
  ASSERT_EQ(found.reference.fluence.size(), found.reference.fluenceDirect.size());
  for (std::size_t i = 0; i < found.reference.fluence.size(); ++i)
  {
    ASSERT_GT(found.reference.fluence[i], found.reference.fluenceDirect[i]);
  }
  ASSERT_EQ(found.rows.size(), 2u);
  EXPECT_LT(found.rows.back().errorL2, 2.0 * found.rows.back().estimatedError);
}

TEST_F(ComparedMonteCarlo, IsLeftOutWhereItsPhotonsMissLight)
{
  SunlitCube cube(4);
  ReferenceLight reference;
  reference.grid = cube.scene.medium.grid;
  reference.fluence.assign(cube.sigma_a.size(), 1.0f);
  cube.scene.illumination.faceAlbedo[4] = { 0.5, 0.5, 0.5 };
  EXPECT_EQ(CompareSolvers(this->GetDevice(), cube.scene, cube.settings, &reference).leftOut.size(), 1u);
  cube.scene.illumination.faceAlbedo[4] = {};
  cube.scene.medium.emission = { cube.sigma_a.data() };
  EXPECT_EQ(CompareSolvers(this->GetDevice(), cube.scene, cube.settings, &reference).leftOut.size(), 1u);
  cube.scene.medium.emission = {};
  EXPECT_TRUE(CompareSolvers(this->GetDevice(), cube.scene, cube.settings, &reference).leftOut.empty());
}

class ComparedLattice : public DeviceTest
{
protected:
  /// Errors by setting, against photons.
  std::vector<ComparisonRow> Compared(SunlitCube& cube)
  {
    cube.settings.methods = { ComparedMethod::LatticeBoltzmann };
    cube.settings.tried.monteCarloReference = MonteCarloReference::Always;
    cube.settings.tried.coarsenings = { 1, 2 };
    const Comparison found = CompareSolvers(this->GetDevice(), cube.scene, cube.settings);
    EXPECT_NE(found.reference.text.find("scattered until they end"), std::string::npos) << found.reference.text;
    return found.rows;
  }
};

// Cheap ones first: 6 directions before 18 on each grid. Voxels of half a mean free path; with those twice as large,
// in which light does not fall off, diffusion begins too deep.
TEST_F(ComparedLattice, ComesNearPhotonsWhereVoxelsAreThin)
{
  SunlitCube cube(12);
  cube.sigma_s.assign(cube.sigma_s.size(), 6.0f);
  cube.settings.tried.photonCounts = { 20000 };
  const std::vector<ComparisonRow> rows = this->Compared(cube);
  ASSERT_EQ(rows.size(), 4u);
  const char* const settings[] = { "6 directions, voxels x 2", "18 directions, voxels x 2", "6 directions",
    "18 directions" };
  for (std::size_t i = 0; i < 4; ++i)
  {
    EXPECT_EQ(rows[i].method, ComparedMethod::LatticeBoltzmann);
    EXPECT_EQ(rows[i].setting, settings[i]);
    EXPECT_LT(rows[i].balance, 1e-5) << rows[i].setting;
  }
  EXPECT_LT(rows[3].errorL2, 0.08);
  EXPECT_GT(rows[1].errorL2, rows[3].errorL2);
}

// Bent light comes to the lattice by photons: more of them, less noise.
TEST_F(ComparedLattice, TakesBentLightOfPhotons)
{
  SunlitCube cube(6);
  for (std::size_t i = 0; i < cube.ior.size(); ++i)
  {
    cube.ior[i] = 1.0f + 0.002f * static_cast<float>(i);
  }
  cube.scene.ior = { cube.ior.data() };
  cube.settings.tried.photonCounts = { 50, 20000 };
  const std::vector<ComparisonRow> rows = this->Compared(cube);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[1].setting, "18 directions, uncollided light of 50 photons");
  EXPECT_EQ(rows[3].setting, "18 directions, uncollided light of 20000 photons");
  EXPECT_LT(rows[3].errorL2, 0.5 * rows[1].errorL2);
  EXPECT_LT(rows[3].errorL2, 0.1);
}

TEST_F(ComparedLattice, IsLeftOutWhereVoxelsAreNoCubes)
{
  SunlitCube cube(4);
  ReferenceLight reference;
  cube.scene.medium.grid.spacing[1] *= 1.01;
  reference.grid = cube.scene.medium.grid;
  reference.fluence.assign(cube.sigma_a.size(), 1.0f);
  cube.settings.methods = { ComparedMethod::LatticeBoltzmann };
  const Comparison found = CompareSolvers(this->GetDevice(), cube.scene, cube.settings, &reference);
  ASSERT_EQ(found.leftOut.size(), 1u);
  EXPECT_EQ(found.leftOut[0], "lattice Boltzmann: its voxels have to be cubes");
}

// The two references share no solver.
TEST_F(ComparedMonteCarlo, MakesAReferenceThatAgreesWithConvergedPropagation)
{
  SunlitCube cube(8);
  ComparedSettings& tried = cube.settings.tried;
  tried.photonCounts = { 50000 };
  tried.monteCarloReference = MonteCarloReference::Never;
  const ReferenceLight maps = ConvergedLight(this->GetDevice(), cube.scene, tried, 5.0);
  tried.monteCarloReference = MonteCarloReference::Always;
  const ReferenceLight photons = ConvergedLight(this->GetDevice(), cube.scene, tried, 0.1);
  const std::optional<Factors> factors = FactorsBetween(maps.grid, photons.grid);
  ASSERT_TRUE(factors);
  const RelativeErrors errors = ErrorsOf(photons.fluence, Averaged(maps.fluence.data(), 1, maps.grid, *factors));
  EXPECT_LT(errors.l2, 0.02) << photons.text; // 0.0064 of it is noise
  EXPECT_GT(errors.l2, 0.0);
}

// In voxels of four mean free paths maps are off by percents; of many voxels photons tell too little in the time.
TEST_F(ComparedMonteCarlo, MakesTheReferenceWhereItCanBeatTheMaps)
{
  SunlitCube cube(8);
  cube.sigma_s.assign(cube.sigma_s.size(), 30.0f);
  cube.settings.tried.monteCarloReference = MonteCarloReference::WhereItCanBeat;
  const ReferenceLight photons = ConvergedLight(this->GetDevice(), cube.scene, cube.settings.tried, 60.0);
  EXPECT_NE(photons.text.find("standard error was forecast"), std::string::npos) << photons.text;
  EXPECT_NE(photons.text.find("scattered until they end"), std::string::npos) << photons.text;

  SunlitCube fine(32);
  fine.settings.tried.photonCounts = { 5000 };
  fine.settings.tried.monteCarloReference = MonteCarloReference::WhereItCanBeat;
  ReferenceLight maps;
  double seconds = 4.0; // more where others have the machine, so that maps are not there in a quarter of it
  do
  {
    maps = ConvergedLight(this->GetDevice(), fine.scene, fine.settings.tried, seconds);
    seconds *= 2.0;
  } while (seconds < 100.0 && maps.text.find("maps take too long") != std::string::npos);
  EXPECT_NE(maps.text.find("not photons: their standard error would be"), std::string::npos) << maps.text;
  EXPECT_EQ(maps.text.find("light propagation maps"), 0u) << maps.text;
}

// What goes straight has no noise in maps.
TEST_F(ComparedMonteCarlo, TakesUnscatteredLightOfMapsWherePhotonsCannotTellItFromTheirs)
{
  SunlitCube cube(8);
  cube.scene.illumination.lights[0].direction = { 0.0, 0.0, -1.0 }; // of which maps make no error
  ComparedSettings tried = cube.settings.tried;
  tried.scattersReference = true;
  LightField maps = Propagate(this->GetDevice(), cube.scene, {}, {});
  const ReferenceLight with = ReferenceOfPhotons(this->GetDevice(), cube.scene, tried, 1000, 0.0, &maps, {});
  EXPECT_EQ(with.fluenceDirect, maps.fluenceDirect) << with.text;
  EXPECT_NE(with.fluence, maps.fluence);
  for (float& direct : maps.fluenceDirect)
  {
    direct *= 1.1f;
  }
  const ReferenceLight without = ReferenceOfPhotons(this->GetDevice(), cube.scene, tried, 1000, 0.0, &maps, {});
  EXPECT_NE(without.fluenceDirect, maps.fluenceDirect) << without.text;
  EXPECT_EQ(without.fluence, with.fluence);
}

TEST_F(ComparedMonteCarlo, IsForecastByFewDirectionsWhereTheFinestMapsDoNotFit)
{
  if (!this->GetDevice().IsCpu())
  {
    GTEST_SKIP() << "a GPU's sweep takes less memory where there is little";
  }
  SunlitCube cube(16);
  cube.settings.tried.photonCounts = { 16000 };
  PropagationSettings finest;
  finest.directionsPerFace = cube.settings.tried.directionsPerFace.back();
  finest.mapResolution = 8;
  cube.settings.tried.mapResolutions = { 1, finest.mapResolution };
  Device& device = this->GetDevice();
  Propagate(device, cube.scene, finest, {}); // compiles
  const std::size_t before = device.BytesInUse();
  device.ResetPeak();
  Propagate(device, cube.scene, finest, {});
  const std::size_t needed = device.PeakBytes() - before;
  const std::vector<Buffer<char>> hoard = AllMemoryBut(device, needed - 1);
  EXPECT_THROW(Propagate(device, cube.scene, finest, {}), DeviceError);
  const PhotonForecast forecast = ForecastOfPhotons(device, cube.scene, cube.settings.tried, 20.0, {});
  ASSERT_TRUE(forecast.maps) << forecast.why;
  EXPECT_EQ(forecast.maps->fluence, Propagate(device, cube.scene, {}, {}).fluence);
}

// Of a fifth of a second maps of many rays take more than their part, whatever a clock says.
TEST_F(ComparedMonteCarlo, MakesTheReferenceWhereMapsTakeTooLong)
{
  SunlitCube cube(24);
  cube.settings.tried.photonCounts = { 16000 };
  const PhotonForecast forecast = ForecastOfPhotons(this->GetDevice(), cube.scene, cube.settings.tried, 0.2, {});
  EXPECT_FALSE(forecast.maps);
  EXPECT_TRUE(forecast.beats) << forecast.why;
  EXPECT_GT(forecast.photonsOfASet, 0u);
  EXPECT_NE(forecast.why.find("maps take too long"), std::string::npos) << forecast.why;
}

// They are compared with light that shares no solver with them.
TEST_F(ComparedMonteCarlo, IsComparedWithMapsWhereNothingElseIsCompared)
{
  SunlitCube cube(8);
  cube.sigma_s.assign(cube.sigma_s.size(), 30.0f); // where photons would beat maps
  cube.settings.tried.monteCarloReference = MonteCarloReference::WhereItCanBeat;
  cube.settings.tried.photonCounts = { 2000 };
  const Comparison found = CompareSolvers(this->GetDevice(), cube.scene, cube.settings);
  EXPECT_EQ(found.reference.text.find("light propagation maps"), 0u) << found.reference.text;
}

TEST_F(ComparedMonteCarlo, LeavesTheReferenceToMapsWhereItKnowsNoPhotons)
{
  SunlitCube cube(4);
  cube.settings.tried.monteCarloReference = MonteCarloReference::WhereItCanBeat;
  cube.scene.medium.emission = { cube.sigma_a.data() };
  const ReferenceLight maps = ConvergedLight(this->GetDevice(), cube.scene, cube.settings.tried, 2.0);
  EXPECT_EQ(maps.text.find("light propagation maps"), 0u) << maps.text;
  EXPECT_NE(maps.text.find("not photons: "), std::string::npos) << maps.text;
}

TEST_F(ComparedMonteCarlo, RefusesToBeTheReferenceOfWhatItCannotDo)
{
  SunlitCube cube(4);
  cube.settings.tried.monteCarloReference = MonteCarloReference::Always;
  cube.scene.medium.emission = { cube.sigma_a.data() };
  const std::string words = ErrorWords([&] { CompareSolvers(this->GetDevice(), cube.scene, cube.settings); });
  EXPECT_THAT(words, testing::HasSubstr("this medium emits"));
}

/// Comparisons on machines as fast as a test says.
class ComparedByTheClock : public DeviceTest
{
protected:
  void TearDown() override
  {
    if (this->TheDevice)
    {
      this->TheDevice->SetClock(ClockSeconds);
    }
    DeviceTest::TearDown();
  }

  /// A clock that is looked at so many times a second.
  void LookEvery(double seconds)
  {
    this->Looks = 0;
    this->GetDevice().SetClock([this, seconds] { return seconds * ++this->Looks; });
  }

  int Looks = 0;
};

TEST_F(ComparedByTheClock, HaveTheSameReferenceHoweverBusyTheMachineIs)
{
  SunlitCube cube(6);
  cube.settings.methods = { ComparedMethod::LightPropagationMaps };
  cube.settings.tried.directionsPerFace = { 4, 25 };
  cube.settings.tried.coarsenings = { 1 };
  cube.settings.tried.orders = {};
  cube.settings.tried.photonCounts = { 1000 };
  cube.settings.tried.monteCarloReference = MonteCarloReference::WhereItCanBeat;
  cube.settings.timeBudget = 1.0;
  this->LookEvery(0.0);
  const Comparison idle = CompareSolvers(this->GetDevice(), cube.scene, cube.settings);
  this->LookEvery(2e-5);
  const Comparison busy = CompareSolvers(this->GetDevice(), cube.scene, cube.settings);
  EXPECT_EQ(idle.reference.fluence, busy.reference.fluence) << idle.reference.text << "\n" << busy.reference.text;
  ASSERT_EQ(idle.rows.size(), busy.rows.size());
  for (std::size_t i = 0; i < idle.rows.size(); ++i)
  {
    EXPECT_EQ(idle.rows[i].setting, busy.rows[i].setting);
    EXPECT_EQ(idle.rows[i].errorL2, busy.rows[i].errorL2) << idle.rows[i].setting;
  }
}

TEST_F(ComparedByTheClock, TellSecondsWithoutCompilation)
{
  SunlitCube cube(4);
  ReferenceLight reference;
  reference.grid = cube.scene.medium.grid;
  reference.fluence.assign(cube.sigma_a.size(), 1.0f);
  cube.settings.methods = { ComparedMethod::LightPropagationMaps };
  cube.settings.tried.directionsPerFace = { 4, 9 };
  cube.settings.tried.mapResolutions = { 1 };
  cube.settings.tried.coarsenings = { 1 };
  cube.settings.tried.orders = {};
  cube.settings.timeBudget = 1000.0;
  this->GetDevice().SetClock([this] { return 3.0 * static_cast<double>(KernelsMade()) + 1e-6 * ++this->Looks; });
  const Comparison found = CompareSolvers(this->GetDevice(), cube.scene, cube.settings, &reference);
  ASSERT_EQ(found.rows.size(), 2u);
  for (const ComparisonRow& row : found.rows)
  {
    EXPECT_LT(row.seconds, 1.0) << row.setting << ": three seconds go for each kernel that is made";
    EXPECT_EQ(row.coreSeconds > 0.0, this->GetDevice().IsCpu()) << row.setting; // not known on a GPU
  }
}

TEST_F(ComparedByTheClock, EndWithinTheirBudgetAndSayWhatIsMissing)
{
  SunlitCube cube(8);
  cube.settings.methods = { ComparedMethod::LightPropagationMaps, ComparedMethod::MonteCarlo };
  cube.settings.timeBudget = 60.0;
  this->LookEvery(2.0);
  const Comparison found = CompareSolvers(this->GetDevice(), cube.scene, cube.settings);
  const double ofLooks = 2.0 * static_cast<double>(found.rows.size() + found.leftOut.size()); // one for each run
  EXPECT_LT(2.0 * this->Looks, 60.0 + ofLooks + 8.0);
  ASSERT_FALSE(found.warnings.empty());
  EXPECT_NE(found.warnings.back().find("TimeBudget, 60 s, was over before"), std::string::npos)
    << found.warnings.back();
  EXPECT_FALSE(found.leftOut.empty());
}

TEST_F(ComparedByTheClock, GiveTheirRowsWithoutAReferenceThatTakesTooLong)
{
  SunlitCube cube(8);
  cube.settings.methods = { ComparedMethod::LightPropagationMaps };
  cube.settings.tried.directionsPerFace = { 4, 25 };
  cube.settings.tried.coarsenings = { 1 };
  cube.settings.timeBudget = 60.0;
  this->GetDevice().SetClock([this] { return ++this->Looks <= 2 ? 0.0 : 31.0; }); // as fast as can be, after that
  const Comparison found = CompareSolvers(this->GetDevice(), cube.scene, cube.settings);
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_NE(found.warnings[0].find("No reference could be made in half of the 60 s"), std::string::npos)
    << found.warnings[0];
  EXPECT_GE(found.rows.size(), 2u);
  for (const ComparisonRow& row : found.rows)
  {
    EXPECT_TRUE(std::isnan(row.errorL2)) << row.setting;
    EXPECT_LT(row.balance, 1e-4) << row.setting;
  }
}

/// Rows of kinds that are not solvers, against light that the tests know better.
class ComparedStages : public DeviceTest
{
protected:
  /// Error by setting of a method's rows, against the light of its setting Best (without noise: photons are the same)
  /// or, if Best is empty, against the comparison's own reference.
  std::map<std::string, double> ErrorsOf(SunlitCube& cube, ComparedMethod method)
  {
    cube.settings.methods = { method };
    cube.settings.estimates = method == ComparedMethod::Pictures;
    const Comparison found =
      CompareSolvers(this->GetDevice(), cube.scene, cube.settings, this->Reference(cube, method));
    EXPECT_TRUE(found.leftOut.empty()) << found.leftOut.front();
    std::map<std::string, double> errors;
    for (const ComparisonRow& row : found.rows)
    {
      errors[row.setting] = row.errorL2;
      this->Estimates[row.setting] = row.estimatedError;
    }
    return errors;
  }

  /// Light by the run of `method` with the best setting.
  const ReferenceLight* Reference(const SunlitCube& cube, ComparedMethod method)
  {
    if (this->Best.empty())
    {
      return nullptr;
    }
    for (const ComparedRun& run : RunsOf(method, this->GetDevice(), cube.scene, cube.settings.tried))
    {
      if (run.setting == this->Best)
      {
        this->Light = {};
        this->Light.grid = run.grid;
        LightField light = run.solve(false, {});
        (QuantityOf(method) == ComparedQuantity::Fluence ? this->Light.fluence : this->Light.fluenceDirect) =
          std::move(light.fluence);
      }
    }
    return &this->Light;
  }

  /// A ball of glass in fog.
  void PutBallInto(SunlitCube& cube)
  {
    const int edge = cube.scene.medium.grid.size[0];
    this->Occupancy.assign(cube.ior.size(), 0.0f);
    cube.sigma_s.assign(cube.ior.size(), 0.5f);
    for (std::size_t i = 0; i < cube.ior.size(); ++i)
    {
      const std::array<int, 3> voxel = cube.scene.medium.grid.VoxelAt(i);
      double square = 0.0;
      for (int at : voxel)
      {
        square += std::pow((at + 0.5) / edge - 0.5, 2.0);
      }
      const double radius = std::sqrt(square);
      const bool inside = radius < 0.3 - 1.0 / edge;
      const bool outside = radius > 0.3 + 1.0 / edge;
      this->Occupancy[i] = inside ? 1.0f : outside ? 0.0f : 0.5f;
      cube.ior[i] = 1.0f + 0.4f * this->Occupancy[i];
      cube.sigma_s[i] = 0.5f - 0.5f * this->Occupancy[i];
    }
    cube.scene.ior = { cube.ior.data() };
  }

  std::string Best;
  std::map<std::string, double> Estimates; ///< estimated errors by setting
  ReferenceLight Light;
  std::vector<float> Occupancy;
};

TEST_F(ComparedStages, FewerTermsArePoorerOrdinates)
{
  SunlitCube cube(8);
  cube.scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  cube.settings.tried.directionsPerFace = { 9 };
  cube.settings.tried.coarsenings = { 1 };
  cube.settings.tried.orders = {};
  cube.settings.tried.terms = { 1, 4 };
  this->Best = "9 directions";
  std::map<std::string, double> errors = this->ErrorsOf(cube, ComparedMethod::DiscreteOrdinates);
  EXPECT_EQ(errors.size(), 3u);
  EXPECT_EQ(errors["9 directions"], 0.0);
  EXPECT_GT(errors["9 directions, 4 terms"], 0.0);
  EXPECT_GT(errors["9 directions, 1 terms"], 2.0 * errors["9 directions, 4 terms"]);
  cube.settings.tried.terms = { 55 };
  EXPECT_THAT(ErrorWords([&] { CompareSolvers(this->GetDevice(), cube.scene, cube.settings); }),
    testing::HasSubstr("Terms has 55; its numbers must be 1 to 54."));
}

TEST_F(ComparedStages, PreviewsAreFastAndPoor)
{
  SunlitCube cube(16);
  cube.settings.tried.directionsPerFace = { 25 };
  cube.settings.tried.mapResolutions = cube.settings.tried.coarsenings = { 1 };
  cube.settings.tried.orders = {};
  cube.settings.tried.previews = true;
  this->Best = "25 directions";
  std::map<std::string, double> errors = this->ErrorsOf(cube, ComparedMethod::LightPropagationMaps);
  EXPECT_EQ(errors.size(), 2u);
  EXPECT_GT(errors["preview"], 0.005);
  EXPECT_LT(errors["preview"], 0.3);
}

TEST_F(ComparedStages, LongStepsAndLowOrdersBendLightWrongly)
{
  SunlitCube cube(12);
  this->PutBallInto(cube);
  ComparedSettings& tried = cube.settings.tried;
  tried.photonCounts = { 20000 };
  tried.integratorOrders = { 1, 2 };
  tried.stepSizes = { 0.25, 2.0 };
  tried.octreeTolerances = { 0.0, 0.5 };
  const std::string photons = "20000 photons, Hammersley", steps = " voxels";
  this->Best = photons + ", order 2, steps of 0.25 voxels";
  std::map<std::string, double> errors = this->ErrorsOf(cube, ComparedMethod::Photons);
  EXPECT_EQ(errors.size(), 7u);
  EXPECT_EQ(errors[this->Best], 0.0);
  const double usual = errors[photons], coarse = errors[photons + ", order 2, steps of 2 voxels"];
  EXPECT_GT(usual, 0.0);
  EXPECT_GT(coarse, usual);
  EXPECT_GT(errors[photons + ", order 1, steps of 2 voxels"], coarse);
  EXPECT_GT(errors[photons + ", octree of 0.5"], errors[photons + ", octree of 0"]);
}

TEST_F(ComparedStages, MapsScatterTheLightOfPhotons)
{
  SunlitCube cube(8);
  cube.scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.5);
  cube.settings.tried.photonCounts = { 500, 100000 };
  std::map<std::string, double> errors = this->ErrorsOf(cube, ComparedMethod::PhotonsThenMaps);
  EXPECT_EQ(errors.size(), 2u);
  EXPECT_LT(errors["25 directions, uncollided light of 100000 photons"], 0.02);
  EXPECT_GT(errors["25 directions, uncollided light of 500 photons"],
    errors["25 directions, uncollided light of 100000 photons"]);
}

TEST_F(ComparedStages, FinePicturesAreNearerThanDrafts)
{
  SunlitCube cube(8);
  for (std::size_t i = 0; i < cube.sigma_s.size(); i += 3)
  {
    cube.sigma_s[i] = 12.0f;
  }
  EXPECT_THAT(ErrorWords([&] { this->ErrorsOf(cube, ComparedMethod::Pictures); }), testing::HasSubstr("no camera"));
  cube.scene.imageSize = { 40, 30 };
  cube.scene.camera = FrameGrid(cube.scene.medium.grid, 4.0 / 3.0);
  cube.settings.timeBudget = 20.0;
  std::map<std::string, double> errors = this->ErrorsOf(cube, ComparedMethod::Pictures);
  EXPECT_EQ(errors.size(), 4u);
  EXPECT_LT(errors["quality draft"], 0.2);
  EXPECT_GT(errors["quality draft"], errors["quality default"]);
  EXPECT_GT(errors["quality default"], errors["quality fine"]);
  EXPECT_GT(errors["quality fine"], errors["quality reference"]);
  EXPECT_LT(errors["quality reference"], 0.002);
  for (const auto& [setting, error] : errors)
  {
    EXPECT_GT(this->Estimates[setting], 0.5 * error) << setting;
    EXPECT_LT(this->Estimates[setting], 3.0 * error) << setting;
  }
}

TEST_F(ComparedStages, AVoxelizationIsComparedWithAFinerOne)
{
  SunlitCube cube(12);
  this->PutBallInto(cube);
  const VoxelizedMaterials materials = MaterialsOf(
    cube.scene.medium, cube.scene.ior, { this->Occupancy.data() }, shapes::Sphere({ 0.5, 0.5, 0.5 }, 0.3, 4));
  EXPECT_FLOAT_EQ(materials.inside.material.n, 1.4);
  EXPECT_FLOAT_EQ(materials.outside.n, 1.0);
  EXPECT_EQ(materials.outside.sigma_s, (Rgb{ 0.5, 0.5, 0.5 }));
  cube.scene.mesh = &materials;
  ComparedSettings& tried = cube.settings.tried;
  tried.photonCounts = { 10000 };
  tried.supersamplings = { 1, 4 };
  tried.filterSizes = { 5, 17 };
  std::map<std::string, double> errors = this->ErrorsOf(cube, ComparedMethod::Voxelizer);
  EXPECT_EQ(errors.size(), 4u);
  const std::string photons = ", 10000 photons, Hammersley";
  EXPECT_LT(errors["supersampling 4, filter 5" + photons], 0.3); // of 12 voxels an edge
  EXPECT_LT(errors["supersampling 4, filter 5" + photons], errors["supersampling 4, filter 17" + photons]);
}

TEST_F(ComparedStages, AMeshMustBeClosedAndOfOneMaterial)
{
  SunlitCube cube(12);
  this->PutBallInto(cube);
  const auto words = [&](TriangleMesh mesh) {
    return ErrorWords(
      [&] { MaterialsOf(cube.scene.medium, cube.scene.ior, { this->Occupancy.data() }, std::move(mesh)); });
  };
  TriangleMesh open = shapes::Sphere({ 0.5, 0.5, 0.5 }, 0.3, 3);
  open.triangles.pop_back();
  EXPECT_THAT(words(open), testing::HasSubstr("open"));
  cube.sigma_s[0] *= 2.0f;
  EXPECT_THAT(words(shapes::Sphere({ 0.5, 0.5, 0.5 }, 0.3, 3)), testing::HasSubstr("differ in sigma_s"));
}
