#include "Device/Errors.h"
#include "ErrorWords.h"
#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Emission/SampleSequence.h"
#include "Photons/Importance/ImportanceMap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
constexpr int Size = 16;
constexpr std::size_t Cells = Size * Size;

/// Densities over two orders of magnitude, mean 1.
std::vector<float> Hills()
{
  std::vector<float> density(Cells);
  for (int j = 0; j < Size; ++j)
  {
    for (int i = 0; i < Size; ++i)
    {
      density[j * Size + i] = 0.05f + std::exp(-0.05f * ((i - 4) * (i - 4) + (j - 10) * (j - 10)));
    }
  }
  const float mean = std::accumulate(density.begin(), density.end(), 0.0f) / Cells;
  std::for_each(density.begin(), density.end(), [&](float& d) { d /= mean; });
  return density;
}

ImportanceMap MapOf(std::vector<float> density, int light = 0)
{
  return { Size, { light }, std::move(density) };
}

Grid Box()
{
  Grid grid;
  grid.size = { 8, 8, 8 };
  grid.spacing = { 0.25, 0.25, 0.25 };
  return grid;
}

/// A sun that shines straight down on the box: the photon plane is its upper face.
Illumination Sun()
{
  Light sun;
  sun.type = LightType::Directional;
  sun.direction = { 0.0, 0.0, -1.0 };
  sun.power = { 4.0, 2.0, 1.0 };
  Illumination light;
  light.lights = { sun };
  return light;
}

/// Chi-square of counts against densities of mean 1.
double ChiSquare(const std::vector<double>& counts, const std::vector<float>& density)
{
  const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
  double chi = 0.0;
  for (std::size_t i = 0; i < Cells; ++i)
  {
    const double expected = all * density[i] / Cells;
    chi += (counts[i] - expected) * (counts[i] - expected) / expected;
  }
  return chi;
}

std::vector<double> CountsOf(const EmittedPhotons& emitted, const std::vector<float>& density)
{
  // The cell of a photon by its weight is not known, but that by its place on the upper face is, up to the face's axes.
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  for (int turn = 0; turn < 8; ++turn)
  {
    std::vector<double> counts(Cells, 0.0);
    for (const Photon& photon : emitted.photons)
    {
      double x = photon.position[0] / 2.0, y = photon.position[1] / 2.0;
      if (turn & 4)
      {
        std::swap(x, y);
      }
      x = turn & 1 ? 1.0 - x : x;
      y = turn & 2 ? 1.0 - y : y;
      const auto cell = [](double at) { return std::min(std::max(static_cast<int>(at * Size), 0), Size - 1); };
      counts[cell(y) * Size + cell(x)] += 1.0;
    }
    const double chi = ChiSquare(counts, density);
    if (chi < least)
    {
      least = chi;
      best = counts;
    }
  }
  return best;
}
}

TEST(ImportanceSampler, MakesEvenPointsAsDenseAsTheMap)
{
  const std::vector<float> density = Hills();
  const ImportanceSampler sampler(density.data(), Size, 100.0);
  const SampleSequence points(Sampler::Random, 200000, 7);
  std::vector<double> counts(Cells, 0.0);
  for (std::size_t i = 0; i < 200000; ++i)
  {
    const ImportanceSampler::Place place = sampler.At(points[i][0], points[i][1]);
    counts[static_cast<int>(place.v * Size) * Size + static_cast<int>(place.u * Size)] += 1.0;
  }
  // 255 degrees of freedom: mean 255, deviation 22.6. Too small would be as wrong as too large.
  EXPECT_NEAR(ChiSquare(counts, density), 255.0, 4.0 * 22.6);
}

TEST(ImportanceSampler, SpreadsPointsEvenlyWithinACell)
{
  std::vector<float> density(Cells, 1.0f);
  density[5 * Size + 7] = 500.0f;
  const ImportanceSampler sampler(density.data(), Size, 1e9);
  double mean[2] = {}, square[2] = {};
  int inside = 0;
  for (int k = 0; k < 300; ++k)
  {
    for (int l = 0; l < 300; ++l)
    {
      const ImportanceSampler::Place place = sampler.At((k + 0.5) / 300, (l + 0.5) / 300);
      const double x = place.u * Size - 7, y = place.v * Size - 5;
      if (x >= 0.0 && x < 1.0 && y >= 0.0 && y < 1.0)
      {
        ++inside;
        mean[0] += x;
        mean[1] += y;
        square[0] += x * x;
        square[1] += y * y;
      }
    }
  }
  EXPECT_GT(inside, 40000);
  for (int a = 0; a < 2; ++a)
  {
    EXPECT_NEAR(mean[a] / inside, 0.5, 5e-3);
    EXPECT_NEAR(square[a] / inside, 1.0 / 3.0, 5e-3);
  }
}

TEST(ImportanceSampler, TellsTheDensityThatItHas)
{
  const std::vector<float> density = Hills();
  const ImportanceSampler sampler(density.data(), Size, 100.0);
  double mean = 0.0;
  for (int j = 0; j < Size; ++j)
  {
    for (int i = 0; i < Size; ++i)
    {
      EXPECT_NEAR(sampler.DensityOf(i, j), density[j * Size + i], 1e-5 * density[j * Size + i]);
      mean += sampler.DensityOf(i, j) / Cells;
    }
  }
  EXPECT_NEAR(mean, 1.0, 1e-12);
  const ImportanceSampler::Place place = sampler.At(0.3, 0.9);
  EXPECT_EQ(place.density, sampler.DensityOf(static_cast<int>(place.u * Size), static_cast<int>(place.v * Size)));
}

TEST(ImportanceSampler, CapsTheDensityAndSharesTheRest)
{
  std::vector<float> density(Cells, 1.0f);
  density[3] = 1000.0f;
  density[4] = 30.0f;
  const ImportanceSampler sampler(density.data(), Size, 5.0);
  EXPECT_NEAR(sampler.DensityOf(3, 0), 5.0, 1e-9);
  EXPECT_NEAR(sampler.DensityOf(4, 0), 5.0, 1e-9);
  EXPECT_NEAR(sampler.DensityOf(5, 5), (Cells - 10.0) / (Cells - 2.0), 1e-9);
}

TEST(ImportanceSampler, NeverStartsWhereTheMapIsZero)
{
  std::vector<float> density(Cells, 0.0f);
  density[2 * Size + 15] = 1e-30f; // the last column: rounding must not lead beyond it
  density[9 * Size] = 3e-30f;
  const ImportanceSampler sampler(density.data(), Size, 1e9);
  for (const double u : { 0.0, 0.25, 0.5, 1.0 - 0x1p-53 })
  {
    for (const double v : { 0.0, 0.2499, 0.2501, 1.0 - 0x1p-53 })
    {
      const ImportanceSampler::Place place = sampler.At(u, v);
      const int column = static_cast<int>(place.u * Size), row = static_cast<int>(place.v * Size);
      EXPECT_TRUE((column == 15 && row == 2) || (column == 0 && row == 9)) << column << ", " << row;
      EXPECT_GT(place.density, 0.0);
    }
  }
}

TEST(ImportanceSampler, IsTheSameAtAnyScale)
{
  std::vector<float> density = Hills();
  const ImportanceSampler sampler(density.data(), Size, 3.0);
  for (const float scale : { 1e-36f, 1e36f })
  {
    std::vector<float> scaled = density;
    std::for_each(scaled.begin(), scaled.end(), [&](float& d) { d *= scale; });
    const ImportanceSampler other(scaled.data(), Size, 3.0);
    for (int i = 0; i < Size; ++i)
    {
      EXPECT_NEAR(other.DensityOf(i, 10), sampler.DensityOf(i, 10), 1e-5);
    }
  }
}

TEST(AdaptiveEmission, PhotonsAreAsDenseAsTheMap)
{
  const ImportanceMap map = MapOf(Hills());
  EmissionSettings settings = { 100000, Sampler::Random, 3 };
  settings.map = &map;
  settings.densestAtMost = 100.0;
  const EmittedPhotons emitted = EmitPhotons(Box(), Sun(), settings);
  ASSERT_EQ(emitted.photons.size(), 100000u);
  EXPECT_NEAR(ChiSquare(CountsOf(emitted, map.density), map.density), 255.0, 4.0 * 22.6);
}

TEST(AdaptiveEmission, HammersleyFollowsTheMapMoreCloselyThanChanceWould)
{
  const ImportanceMap map = MapOf(Hills());
  EmissionSettings settings = { 100000, Sampler::Hammersley, 3 };
  settings.map = &map;
  settings.densestAtMost = 100.0;
  const EmittedPhotons emitted = EmitPhotons(Box(), Sun(), settings);
  EXPECT_LT(ChiSquare(CountsOf(emitted, map.density), map.density), 0.2 * 255.0);
}

TEST(AdaptiveEmission, PowerIsThatOfTheLightWhateverTheMap)
{
  const ImportanceMap map = MapOf(Hills());
  EmissionSettings settings = { 50000, Sampler::Hammersley, 5 };
  const EmittedPhotons even = EmitPhotons(Box(), Sun(), settings);
  settings.map = &map;
  for (const int batches : { 1, 2, 5 })
  {
    settings.batches = batches;
    const EmittedPhotons adaptive = EmitPhotons(Box(), Sun(), settings);
    for (int c = 0; c < 3; ++c)
    {
      EXPECT_NEAR(adaptive.power[c] / even.power[c], 1.0, 1e-3);
    }
  }
}

TEST(AdaptiveEmission, EachPlaceSendsThePowerThatItHas)
{
  const ImportanceMap map = MapOf(Hills());
  EmissionSettings settings = { 100000, Sampler::Hammersley, 5 };
  settings.map = &map;
  double power[4][4] = {};
  for (const Photon& photon : EmitPhotons(Box(), Sun(), settings).photons)
  {
    power[static_cast<int>(photon.position[1] * 2.0) & 3][static_cast<int>(photon.position[0] * 2.0) & 3] +=
      photon.power[0];
  }
  for (const auto& row : power)
  {
    for (const double watts : row)
    {
      EXPECT_NEAR(watts, 1.0, 0.02);
    }
  }
}

TEST(AdaptiveEmission, WeightIsPowerOverThatOfPhotonsSpreadEvenly)
{
  const ImportanceMap map = MapOf(Hills());
  EmissionSettings settings = { 1000, Sampler::Hammersley, 0 };
  settings.map = &map;
  const EmittedPhotons emitted = EmitPhotons(Box(), Sun(), settings);
  const double evenly = 4.0 * 4.0 / 1000; // W of red, of a plane of 2 x 2
  for (const Photon& photon : emitted.photons)
  {
    EXPECT_NEAR(photon.power[0], photon.weight * evenly, 1e-5 * photon.power[0]);
  }
}

TEST(AdaptiveEmission, ALightWithoutASquareIsSpreadEvenly)
{
  const ImportanceMap map = MapOf(Hills(), 3);
  EmissionSettings settings = { 1000, Sampler::Hammersley, 0 };
  settings.map = &map;
  const EmittedPhotons emitted = EmitPhotons(Box(), Sun(), settings);
  EXPECT_TRUE(std::all_of(
    emitted.photons.begin(), emitted.photons.end(), [](const Photon& photon) { return photon.weight == 1.0f; }));
}

TEST(Batches, EachIsAllTheLightInItsShareOfThePower)
{
  EmissionSettings settings = { 10000, Sampler::Hammersley, 0 };
  settings.batches = 3;
  const EmittedPhotons emitted = EmitPhotons(Box(), Sun(), settings);
  double power[3] = {};
  for (const Photon& photon : emitted.photons)
  {
    ASSERT_GE(photon.batch, 0);
    ASSERT_LT(photon.batch, 3);
    power[photon.batch] += photon.power[0];
  }
  for (const double watts : power)
  {
    EXPECT_NEAR(watts, 16.0 / 3.0, 1e-5);
  }
}

/// Part of the variance that counts of points in cells of a lattice have in common.
double CorrelationOfErrors(Sampler sampler, int first, int second, std::uint64_t seed)
{
  constexpr int n = 40;
  constexpr std::size_t count = 8192;
  std::vector<double> counts[2];
  const int batches[2] = { first, second };
  for (int set = 0; set < 2; ++set)
  {
    const SampleSequence points(sampler, count, seed, batches[set]);
    counts[set].assign(n * n, -static_cast<double>(count) / (n * n));
    for (std::size_t i = 0; i < count; ++i)
    {
      counts[set][static_cast<int>(points[i][1] * n) * n + static_cast<int>(points[i][0] * n)] += 1.0;
    }
  }
  const auto product = [&](int a, int b) {
    return std::inner_product(counts[a].begin(), counts[a].end(), counts[b].begin(), 0.0);
  };
  return product(0, 1) / std::sqrt(product(0, 0) * product(1, 1));
}

TEST(Batches, ErrorsOfAnEvenAndAnOddOneHaveNothingInCommon)
{
  for (const Sampler sampler : { Sampler::Hammersley, Sampler::Halton, Sampler::Jittered, Sampler::Random })
  {
    for (std::uint64_t seed = 0; seed < 20; ++seed)
    {
      EXPECT_LT(std::abs(CorrelationOfErrors(sampler, 0, 1, seed)), 0.15)
        << "sampler " << static_cast<int>(sampler) << ", seed " << seed;
    }
  }
}

TEST(Batches, AreTheSamePhotonsAgainForTheSameSeed)
{
  EmissionSettings settings = { 500, Sampler::Hammersley, 9 };
  settings.batches = 2;
  const EmittedPhotons first = EmitPhotons(Box(), Sun(), settings), second = EmitPhotons(Box(), Sun(), settings);
  ASSERT_EQ(first.photons.size(), second.photons.size());
  for (std::size_t i = 0; i < first.photons.size(); ++i)
  {
    EXPECT_EQ(first.photons[i].position, second.photons[i].position);
  }
}

TEST(Pilots, AreOneInEachCellOfASquare)
{
  const std::vector<PilotPhotons> pilots = EmitPilots(Box(), Sun(), 12, 4);
  ASSERT_EQ(pilots.size(), 1u);
  ASSERT_EQ(pilots[0].photons.size(), 144u);
  std::vector<int> seen(144, 0);
  double power = 0.0;
  for (std::size_t i = 0; i < 144; ++i)
  {
    ++seen[pilots[0].origins[i][1] * 12 + pilots[0].origins[i][0]];
    power += pilots[0].photons[i].power[0];
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), 144);
  EXPECT_NEAR(power, 16.0, 1e-4);
}

TEST(Pilots, OfALightThatMissesAreNone)
{
  Illumination light;
  Light spot;
  spot.type = LightType::Spot;
  spot.position = { 1.0, 1.0, 10.0 };
  spot.direction = { 0.0, 0.0, 1.0 };
  spot.angle = 20.0;
  light.lights = { spot };
  const std::vector<PilotPhotons> pilots = EmitPilots(Box(), light, 8);
  ASSERT_EQ(pilots.size(), 1u);
  EXPECT_TRUE(pilots[0].photons.empty());
}

TEST(ImportanceMapCheck, NamesWhatIsWrongAndWhere)
{
  const auto message = [](const ImportanceMap& map) -> std::string {
    EmissionSettings settings = { 10, Sampler::Hammersley, 0 };
    settings.map = &map;
    return ErrorWords([&] { EmitPhotons(Box(), Sun(), settings); });
  };
  ImportanceMap map = MapOf(Hills());
  map.density[3 * Size + 5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(message(map).find("light 0 is nan in column 5, row 3"), std::string::npos) << message(map);
  map.density[3 * Size + 5] = -1.0f;
  EXPECT_NE(message(map).find("column 5, row 3"), std::string::npos) << message(map);
  map = MapOf(std::vector<float>(Cells, 0.0f), EnvironmentLight);
  EXPECT_NE(message(map).find("the environment is 0 everywhere"), std::string::npos) << message(map);
  map = MapOf(Hills());
  map.density[2 * Size + 9] = map.density[7 * Size] = 0.0f;
  EXPECT_NE(message(map).find("is 0 in 2 cells, first in column 9, row 2"), std::string::npos) << message(map);
  map = MapOf(std::vector<float>(7, 1.0f));
  EXPECT_NE(message(map).find("has 7 cells"), std::string::npos) << message(map);
}

TEST(EmissionSettings, OutOfTheirRangesAreRefused)
{
  EmissionSettings settings = { 10, Sampler::Hammersley, 0 };
  settings.batches = 17;
  EXPECT_THROW(EmitPhotons(Box(), Sun(), settings), InvalidInput);
  settings.batches = 0;
  EXPECT_THROW(EmitPhotons(Box(), Sun(), settings), InvalidInput);
  settings.batches = 1;
  settings.densestAtMost = 0.5;
  EXPECT_THROW(EmitPhotons(Box(), Sun(), settings), InvalidInput);
}
