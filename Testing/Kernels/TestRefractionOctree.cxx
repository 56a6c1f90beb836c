#include "DeviceTest.h"
#include "ErrorWords.h"
#include "Medium/Grid.h"
#include "OnRanks.h"

#include "Numerics/NumberText.h"
#include "Refraction/Octree/RefractionOctree.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

using namespace tyndall;
using testing::Each;
using testing::HasSubstr;

namespace
{
using Size = std::array<int, 3>;

/// Of any shape: single voxels, rows, layers, powers of two, one more, one less, primes.
const std::vector<Size> Sizes = { { 1, 1, 1 }, { 2, 1, 1 }, { 1, 5, 1 }, { 1, 1, 64 }, { 1, 9, 7 }, { 33, 1, 4 },
  { 8, 8, 8 }, { 16, 16, 16 }, { 15, 17, 16 }, { 7, 7, 7 }, { 31, 3, 13 }, { 40, 24, 65 } };

Grid GridOf(const Size& size)
{
  Grid grid;
  grid.size = size;
  return grid;
}

/// value(x, y, z) of voxels
std::vector<float> Fill(const Size& size, const std::function<double(int, int, int)>& value)
{
  std::vector<float> values;
  ForGridVoxels(size, [&](std::size_t, int x, int y, int z) { values.push_back(static_cast<float>(value(x, y, z))); });
  return values;
}

std::vector<float> Random(const Size& size, unsigned seed = 1)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> index(1.0, 1.5);
  return Fill(size, [&](int, int, int) { return index(random); });
}

/// Slow waves, so that nodes of many levels are whole.
std::vector<float> Smooth(const Size& size)
{
  return Fill(size,
    [](int x, int y, int z) { return 1.3 + 0.2 * std::sin(0.11 * x) * std::cos(0.07 * y) * std::exp(-0.002 * z * z); });
}

/// A glass ball in air, off the middle.
std::vector<float> Ball(const Size& size)
{
  return Fill(size, [&](int x, int y, int z) {
    return std::hypot(x - 0.4 * size[0], y - 0.6 * size[1], z - 0.5 * size[2]) < 0.3 * size[0] ? 1.5 : 1.0;
  });
}

/// What Octree promises, word by word: no pyramid, each node's range from its voxels.
/// @param tolerance  (level)
std::vector<std::uint8_t> BruteForce(
  const Size& size, const std::vector<float>& values, const std::function<double(int)>& tolerance)
{
  std::vector<std::uint8_t> levels(values.size(), 0);
  std::vector<float> lowest(values.size());
  std::vector<float> highest(values.size());
  const int longest = *std::max_element(size.begin(), size.end());
  for (int level = 1; (1 << (level - 1)) < longest; ++level)
  {
    const auto node = [&](std::size_t i) {
      const std::size_t x = i % size[0], y = i / size[0] % size[1], z = i / size[0] / size[1];
      return ((z >> level) * size[1] + (y >> level)) * size[0] + (x >> level);
    };
    std::fill(lowest.begin(), lowest.end(), std::numeric_limits<float>::infinity());
    std::fill(highest.begin(), highest.end(), -std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      lowest[node(i)] = std::min(lowest[node(i)], values[i]);
      highest[node(i)] = std::max(highest[node(i)], values[i]);
    }
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      if (highest[node(i)] - lowest[node(i)] <= tolerance(level))
      {
        levels[i] = static_cast<std::uint8_t>(level);
      }
    }
  }
  return levels;
}

/// The octree of a grid, built on so many ranks. All of them say the same but for levels.
Octree BuildOn(int ranks, const Medium& medium, const std::vector<float>& index, const OctreeSettings& settings = {},
  const std::string& device = {}, const Monitor& monitor = {})
{
  Octree joined;
  joined.levels.resize(medium.grid.VoxelCount());
  OnRanks(medium.grid, ranks, [&](const Domain& domain) {
    const auto cut = [&](const Field& field) {
      const std::size_t count = medium.grid.VoxelCount() * static_cast<std::size_t>(field.components);
      return field.values ? BlockOf(domain, std::vector<float>(field.values, field.values + count))
                          : std::vector<float>();
    };
    const std::vector<float> own = BlockOf(domain, index), absorption = cut(medium.sigma_a),
                             scattering = cut(medium.sigma_s);
    Medium part = medium;
    part.grid = domain.OwnGrid();
    part.sigma_a.values = medium.sigma_a.values ? absorption.data() : nullptr;
    part.sigma_s.values = medium.sigma_s.values ? scattering.data() : nullptr;
    const Octree octree =
      BuildOctree(domain, part, { index.empty() ? nullptr : own.data(), 1 }, settings, device, monitor);
    PutBlock(domain, octree.levels, joined.levels);
    if (domain.Rank() == 0)
    {
      joined.topLevel = octree.topLevel;
      joined.device = octree.device;
      joined.leftOut = octree.leftOut;
    }
    domain.Comm().Sum({ 0.0 }); // the first rank has told
    EXPECT_EQ(octree.topLevel, joined.topLevel);
    EXPECT_EQ(octree.device, joined.device);
    EXPECT_EQ(octree.leftOut, joined.leftOut);
  });
  return joined;
}

Octree Build(
  int ranks, const Size& size, const std::vector<float>& index, double tolerance, const std::string& device = {})
{
  Medium medium;
  medium.grid = GridOf(size);
  OctreeSettings settings;
  settings.tolerance = tolerance;
  return BuildOn(ranks, medium, index, settings, device);
}

std::string Named(const Size& size, double tolerance)
{
  return std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]) + ", tolerance " +
    std::to_string(tolerance);
}

}

class RefractionOctree
  : public DeviceTest
  , public testing::WithParamInterface<int>
{
};
class OctreeWithoutDevice : public testing::TestWithParam<int>
{
};
INSTANTIATE_TEST_SUITE_P(Ranks, RefractionOctree, SomeRanks());
INSTANTIATE_TEST_SUITE_P(Ranks, OctreeWithoutDevice, SomeRanks());

TEST_P(RefractionOctree, LevelsEqualABruteForceConstruction)
{
  for (const Size& size : Sizes)
  {
    for (double tolerance : { 0.0, 1e-4, 0.01, 0.1, 0.4, 1.0 })
    {
      for (const std::vector<float>& index : { Random(size), Smooth(size), Ball(size) })
      {
        const Octree octree = Build(this->GetParam(), size, index, tolerance);
        const auto expected = BruteForce(size, index, [&](int) { return tolerance; });
        EXPECT_EQ(octree.levels, expected) << Named(size, tolerance);
      }
    }
  }
}

TEST_P(RefractionOctree, VoxelsOfANodeShareItsLevel)
{
  const Size size = { 40, 24, 65 };
  const std::vector<std::uint8_t> levels = Build(this->GetParam(), size, Smooth(size), 0.05).levels;
  EXPECT_GE(std::set<std::uint8_t>(levels.begin(), levels.end()).size(), 4u) << "nodes of several levels";
  for (std::size_t i = 0; i < levels.size(); ++i)
  {
    const std::size_t x = i % size[0], y = i / size[0] % size[1], z = i / size[0] / size[1];
    const int level = levels[i];
    const std::size_t corner =
      ((z >> level << level) * size[1] + (y >> level << level)) * size[0] + (x >> level << level);
    ASSERT_EQ(levels[corner], level) << VoxelName(GridOf(size), i);
  }
}

TEST_P(RefractionOctree, ADifferenceOfJustTheToleranceIsAllowed)
{
  const std::vector<float> index = { 1.0f, 1.25f };
  EXPECT_THAT(Build(this->GetParam(), { 2, 1, 1 }, index, 0.25).levels, Each(1));
  EXPECT_THAT(Build(this->GetParam(), { 2, 1, 1 }, index, std::nextafter(0.25, 0.0)).levels, Each(0));
  const double apart = static_cast<double>(1.01f) - 1.0; // between two floats near 0.01
  EXPECT_THAT(Build(this->GetParam(), { 2, 1, 1 }, { 1.0f, 1.01f }, apart).levels, Each(1));
  EXPECT_THAT(Build(this->GetParam(), { 2, 1, 1 }, { 1.0f, 1.01f }, std::nextafter(apart, 0.0)).levels, Each(0));
}

TEST_P(RefractionOctree, WithoutToleranceEqualVoxelsMakeNodes)
{
  // Glass in the first half, air in the second: two nodes, though nothing may differ.
  const Size size = { 16, 8, 8 };
  const auto halves = Fill(size, [](int x, int, int) { return x < 8 ? 1.5 : 1.0; });
  EXPECT_THAT(Build(this->GetParam(), size, halves, 0.0).levels, Each(3));
}

TEST_P(RefractionOctree, ANodeThatSticksOutOfTheGridIsWholeWhereItsVoxelsAre)
{
  // 5 voxels: the node of the last one has 4 voxels an edge, 3 of which are not there.
  const std::vector<float> index = { 1.0f, 1.5f, 1.0f, 1.0f, 1.2f };
  EXPECT_EQ(Build(this->GetParam(), { 5, 1, 1 }, index, 0.1).levels, (std::vector<std::uint8_t>{ 0, 0, 1, 1, 2 }));
}

TEST_P(OctreeWithoutDevice, IsOneNodeWhereTheIndexIsConstant)
{
  const std::vector<std::pair<Size, int>> tops = { { { 1, 1, 1 }, 0 }, { { 2, 2, 2 }, 1 }, { { 64, 64, 64 }, 6 },
    { { 65, 2, 3 }, 7 }, { { 1, 100, 37 }, 7 } };
  for (const auto& [size, top] : tops)
  {
    for (double tolerance : { 0.0, 0.01 })
    {
      const std::vector<float> index(GridOf(size).VoxelCount(), 1.33f);
      const Octree octree = Build(this->GetParam(), size, index, tolerance, "no such device");
      EXPECT_THAT(octree.levels, Each(top)) << Named(size, tolerance);
      EXPECT_EQ(octree.levels.size(), index.size());
      EXPECT_EQ(octree.topLevel, top);
      EXPECT_EQ(octree.device, "");
      ASSERT_EQ(octree.leftOut.size(), 1u);
      EXPECT_THAT(octree.leftOut[0], HasSubstr("refractive index is constant"));
    }
  }
  EXPECT_THAT(ErrorWords<std::exception>([&] {
    Build(this->GetParam(), { 2, 1, 1 }, { 1.0f, 1.5f }, 0.1, "no such device");
  }),
    HasSubstr("no such device"));
}

class OctreeOfExtinction
  : public DeviceTest
  , public testing::WithParamInterface<int>
{
protected:
  Octree Build(const Size& size, double extinctionTolerance, bool include = true, bool leaveOut = true)
  {
    this->TheMedium.grid = GridOf(size);
    this->TheMedium.grid.spacing = { 0.5, 1.0, 0.25 };
    OctreeSettings settings;
    settings.tolerance = 0.05;
    settings.includeExtinction = include;
    settings.leaveOut = leaveOut;
    settings.extinctionTolerance = extinctionTolerance;
    return BuildOn(this->GetParam(), this->TheMedium, this->Index, settings);
  }

  Medium TheMedium;
  std::vector<float> Index;
};

INSTANTIATE_TEST_SUITE_P(Ranks, OctreeOfExtinction, SomeRanks());

TEST_P(OctreeOfExtinction, RestrictsNodesByTheOpticalThicknessOfTheirDiagonal)
{
  for (const Size& size : { Size{ 32, 32, 32 }, Size{ 13, 21, 6 } })
  {
    this->Index = Smooth(size);
    const auto even = Fill(size, [](int, int, int) { return 0.2; });
    const auto red = Fill(size, [](int x, int, int) { return 0.001 * x; });
    const auto green = Fill(size, [](int, int y, int z) { return 0.01 + 0.0001 * y * z; });
    std::vector<float> sigma_s;
    for (std::size_t i = 0; i < even.size(); ++i)
    {
      sigma_s.insert(sigma_s.end(), { red[i], green[i], even[i] });
    }
    const auto sigma_a = Ball(size); // grey: added to each channel
    this->TheMedium.sigma_a = { sigma_a.data(), 1 };
    this->TheMedium.sigma_s = { sigma_s.data(), 3 };
    for (double tolerance : { 0.0, 0.02, 0.1, 1.0, 20.0 })
    {
      const double diagonal = std::sqrt(0.25 + 1.0 + 0.0625);
      auto expected = BruteForce(size, this->Index, [](int) { return 0.05; });
      const auto alone = expected;
      for (int channel = 0; channel < 3; ++channel)
      {
        std::vector<float> extinction = sigma_a;
        for (std::size_t i = 0; i < extinction.size(); ++i)
        {
          extinction[i] += sigma_s[3 * i + channel];
        }
        const auto levels =
          BruteForce(size, extinction, [&](int level) { return tolerance / (diagonal * (1 << level)); });
        std::transform(levels.begin(), levels.end(), expected.begin(), expected.begin(),
          [](std::uint8_t a, std::uint8_t b) { return std::min(a, b); });
      }
      EXPECT_EQ(this->Build(size, tolerance).levels, expected) << Named(size, tolerance);
      EXPECT_EQ(this->Build(size, tolerance, false).levels, alone) << "extinction is not asked for";
    }
  }
}

TEST_P(OctreeOfExtinction, RestrictsNodesWhereTheIndexIsConstant)
{
  const Size size = { 16, 16, 16 };
  this->Index.assign(4096, 1.0f);
  const auto sigma_t = Fill(size, [](int x, int, int) { return x < 8 ? 1.0 : 0.0; });
  this->TheMedium.sigma_a = { sigma_t.data(), 1 };
  EXPECT_THAT(this->Build(size, 0.01).levels, Each(3));
  EXPECT_THAT(this->Build(size, 0.01, false).levels, Each(4));
  EXPECT_EQ(this->Build(size, 0.01, false).device, "");
}

TEST_P(OctreeOfExtinction, IsLeftOutWhereItIsConstant)
{
  const Size size = { 16, 16, 16 };
  this->Index.assign(4096, 1.0f);
  const std::vector<float> sigma_t(4096, 3.0f);
  this->TheMedium.sigma_s = { sigma_t.data(), 1 };
  const Octree octree = this->Build(size, 0.0);
  EXPECT_THAT(octree.levels, Each(4));
  EXPECT_EQ(octree.device, "");
  EXPECT_EQ(octree.leftOut.size(), 2u);
  const Octree all = this->Build(size, 0.0, true, false);
  EXPECT_EQ(all.levels, octree.levels);
  EXPECT_TRUE(all.leftOut.empty() && !all.device.empty());
}

TEST_P(OctreeWithoutDevice, RefusesWhatHasNoMeaning)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  for (float wrong : { nan, infinite, -infinite, 0.0f, -1.5f, 1e-7f, 1e7f })
  {
    std::vector<float> index(60, 1.0f);
    index[31] = wrong;
    index[59] = wrong;
    EXPECT_THAT(ErrorWords<std::exception>([&] {
      Build(this->GetParam(), { 3, 4, 5 }, index, 0.01);
    }),
      testing::AllOf(HasSubstr("ior is " + Text("%g", wrong)), HasSubstr("voxel (1, 2, 2)")));
  }
  const std::vector<float> index = { 1.0f, 1.5f };
  for (double wrong : { -0.1, 1.1, static_cast<double>(nan) })
  {
    EXPECT_THAT(ErrorWords<std::exception>([&] {
      Build(this->GetParam(), { 2, 1, 1 }, index, wrong);
    }),
      HasSubstr("Tolerance is"));
  }
  EXPECT_THAT(ErrorWords<std::exception>([&] {
    Build(this->GetParam(), { 2, 0, 1 }, index, 0.1);
  }),
    HasSubstr("no voxels along y"));

  Medium medium;
  medium.grid = GridOf({ 2, 1, 1 });
  OctreeSettings settings;
  const auto complaint = [&] {
    return ErrorWords<std::exception>([&] { BuildOn(this->GetParam(), medium, index, settings); });
  };
  EXPECT_THAT(
    ErrorWords<std::exception>([&] { BuildOn(this->GetParam(), medium, {}, settings); }), HasSubstr("must be given"));
  settings.extinctionTolerance = nan;
  EXPECT_THAT(complaint(), HasSubstr("ExtinctionTolerance is nan"));
  settings.extinctionTolerance = 0.1;
  const std::vector<float> negative = { 0.0f, -1.0f };
  medium.sigma_s = { negative.data(), 1 };
  EXPECT_THAT(complaint(), HasSubstr("sigma_s is -1"));
}

TEST_P(OctreeWithoutDevice, StopsWhenItsMonitorSaysSo)
{
  const std::vector<float> index = { 1.0f, 1.5f };
  Medium medium;
  medium.grid = GridOf({ 2, 1, 1 });
  EXPECT_THROW(BuildOn(this->GetParam(), medium, index, {}, {}, [](double) { return false; }), Aborted);
}
