#include "Reference/SlabReference.h"

#include "Medium/Classification.h"
#include "Medium/Grid.h"
#include "Medium/VoxelMeans.h"
#include "Numerics/Srgb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <random>
#include <vector>

using namespace tyndall;

namespace
{
unsigned SeedOfTheDay()
{
  return static_cast<unsigned>(std::time(nullptr) / 86400);
}

/// A piecewise-linear opacity between random points over the scalars 0 to 1, per unit distance `unit`, as extinction.
struct RandomOpacity
{
  explicit RandomOpacity(std::mt19937& random, double unit = 1.0, double largest = ThickestVoxel)
    : unitDistance(unit)
    , thickest(largest)
  {
    std::uniform_real_distribution<double> number(0.0, 1.0);
    this->scalars = { 0.0, 1.0 };
    for (int i = 0; i < 6; ++i)
    {
      this->scalars.push_back(number(random));
    }
    std::sort(this->scalars.begin(), this->scalars.end());
    for (std::size_t i = 0; i < this->scalars.size(); ++i)
    {
      this->opacities.push_back(i % 3 == 0 ? 0.0 : number(random));
    }
    this->opacities[4] = 1.0;
  }

  double At(double scalar) const
  {
    const auto above = std::upper_bound(this->scalars.begin() + 1, this->scalars.end() - 1, scalar);
    const std::size_t high = above - this->scalars.begin();
    const double part = (scalar - this->scalars[high - 1]) / (this->scalars[high] - this->scalars[high - 1]);
    const double opacity = this->opacities[high - 1] + part * (this->opacities[high] - this->opacities[high - 1]);
    return ExtinctionOfOpacity(opacity, this->unitDistance, this->thickest);
  }

  CoefficientTable Table() const
  {
    return CoefficientTable([&](double scalar, double* value) { *value = this->At(scalar); }, 1, this->scalars);
  }

  double unitDistance, thickest;
  std::vector<double> scalars, opacities;
};

/// Coefficients that are those of a table, by the first scalar.
class OfTable : public ScalarCoefficients
{
public:
  explicit OfTable(CoefficientTable table)
    : Table(std::move(table))
  {
  }
  int ValueCount() const override { return this->Table.ValueCount(); }
  int KinksBetween(const double* low, const double* high) const override
  {
    return this->Table.NodesBetween(*low, *high);
  }
  void AddMean(const double* from, const double* to, double weight, double* sums) const override
  {
    this->Table.AddMean(*from, *to, weight, sums);
  }

private:
  CoefficientTable Table;
};

/// Extinction = scalar, for scalars of 0 to 100.
OfTable Proportional()
{
  return OfTable(CoefficientTable([](double scalar, double* value) { *value = scalar; }, 1, { 0.0, 100.0 }));
}

double Sum(const std::vector<float>& values)
{
  double sum = 0.0;
  for (const float value : values)
  {
    sum += value;
  }
  return sum;
}

std::vector<float> RandomScalars(const std::array<int, 3>& size, std::mt19937& random)
{
  std::uniform_real_distribution<float> number(0.0f, 1.0f);
  std::vector<float> values(Grid{ size }.VoxelCount());
  std::generate(values.begin(), values.end(), [&] { return number(random); });
  return values;
}

/// Trilinear interpolation between the sites of a lattice of one component, at a position in units of their distance;
/// constant beyond the outermost ones.
double Interpolated(const ScalarLattice& lattice, const std::array<double, 3>& position)
{
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    double weight = 1.0;
    std::array<int, 3> site;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double at = std::clamp(position[axis], 0.0, lattice.size[axis] - 1.0);
      const int low = std::min(static_cast<int>(at), std::max(lattice.size[axis] - 2, 0));
      const int side = corner >> axis & 1;
      weight *= side == 1 ? at - low : 1.0 - (at - low);
      site[axis] = std::min(low + side, lattice.size[axis] - 1);
    }
    sum += weight * lattice.values[Grid{ lattice.size }.IndexOf(site)];
  }
  return sum;
}
}

TEST(Classification, RayMeetsTheOpacityOverTheUnitDistance)
{
  for (const double unit : { 0.25, 1.0, 50.0 })
  {
    for (const double opacity : { 1e-9, 0.01, 0.5, 0.99 })
    {
      const double sigma_t = ExtinctionOfOpacity(opacity, unit, 1e9);
      EXPECT_NEAR(-std::expm1(-sigma_t * unit), opacity, 1e-14 + 1e-12 * opacity) << opacity;
    }
  }
  EXPECT_EQ(ExtinctionOfOpacity(0.0, 1.0, 16.0), 0.0);
  EXPECT_EQ(ExtinctionOfOpacity(1.0, 1e6, 16.0), 16.0);
  EXPECT_EQ(ExtinctionOfOpacity(0.9, 1e-6, 16.0), 16.0);
  EXPECT_EQ(ExtinctionOfOpacity(std::numeric_limits<double>::quiet_NaN(), 1.0, 16.0), 0.0);
}

TEST(Classification, ReflectanceAlongTheNormalIsChandrasekhars)
{
  for (const double albedo : { 0.2, 0.5, 0.8, 0.9, 0.95, 0.99, 0.999 })
  {
    const double expected = 1.0 - ChandrasekharH(albedo, 1.0) * std::sqrt(1.0 - albedo);
    EXPECT_NEAR(NormalReflectance(albedo), expected, 2e-7) << albedo;
  }
  EXPECT_NEAR(NormalReflectance(0.0), 0.0, 1e-15);
}

TEST(Classification, AlbedoShowsTheColor)
{
  double last = -1.0;
  for (int i = 0; i <= 255; ++i)
  {
    const double color = i / 255.0;
    const double albedo = AlbedoOfColor(color, 0.0);
    EXPECT_GE(albedo, last);
    last = albedo;
    EXPECT_NEAR(NormalReflectance(albedo), std::min(DecodeSrgb(color), NormalReflectance(LargestAlbedo)), 1e-6) << i;
  }
  EXPECT_EQ(AlbedoOfColor(0.0, 0.0), 0.0);
  EXPECT_EQ(AlbedoOfColor(1.0, 0.0), LargestAlbedo);
  EXPECT_GE(std::lround(255.0 * EncodeSrgb(NormalReflectance(LargestAlbedo))), 252);
}

TEST(Classification, ForwardScatteringKeepsTheReducedAlbedo)
{
  for (const double color : { 0.0, 0.1, 0.6, 1.0 })
  {
    const double isotropic = AlbedoOfColor(color, 0.0);
    for (const double g : { -0.5, 0.3, 0.9 })
    {
      const double albedo = AlbedoOfColor(color, g);
      EXPECT_NEAR(albedo * (1.0 - g) / (1.0 - albedo * g), isotropic, 1e-12) << color << " " << g;
      EXPECT_LT(albedo, 1.0);
    }
  }
}

TEST(CoefficientTable, MeansAreIntegrals)
{
  std::mt19937 random(SeedOfTheDay());
  std::uniform_real_distribution<double> number(0.0, 1.0);
  for (int i = 0; i < 20; ++i)
  {
    const RandomOpacity opacity(random);
    const CoefficientTable table = opacity.Table();
    EXPECT_LT(table.NodeCount(), 2000u);
    for (int j = 0; j < 20; ++j)
    {
      const double from = number(random), to = j % 2 == 0 ? number(random) : from + 1e-3 * (number(random) - 0.5);
      constexpr int points = 40000; // resolves peaks between points that are close to each other
      double expected = 0.0, found = 0.0;
      for (int k = 0; k < points; ++k)
      {
        expected += opacity.At(std::clamp(from + (k + 0.5) / points * (to - from), 0.0, 1.0)) / points;
      }
      table.AddMean(std::clamp(from, 0.0, 1.0), std::clamp(to, 0.0, 1.0), 1.0, &found);
      EXPECT_NEAR(found, expected, 2e-3 * expected + 2e-4) << "seed " << SeedOfTheDay() << ": " << from << " " << to;
    }
  }
}

TEST(CoefficientTable, OfOneScalarIsConstant)
{
  const CoefficientTable table([](double, double* value) { *value = 3.0; }, 1, { 5.0 });
  double sum = 0.0;
  table.AddMean(5.0, 5.0, 2.0, &sum);
  EXPECT_EQ(sum, 6.0);
}

TEST(CoefficientTable, FollowsAStep)
{
  const auto step = [](double scalar, double* value) { *value = scalar < 0.3 ? 0.0 : 7.0; };
  const CoefficientTable table(step, 1, { 0.0, 1.0 });
  double sum = 0.0;
  table.AddMean(1.0, 0.0, 1.0, &sum);
  EXPECT_NEAR(sum, 4.9, 1e-5);
}

TEST(VoxelMeans, OfALinearScalarAreThoseOfTheCentre)
{
  const std::array<int, 3> size = { 5, 4, 3 };
  std::vector<float> scalars(Grid{ size }.VoxelCount());
  ForGridVoxels(size, [&](std::size_t i, int x, int y, int z) { scalars[i] = 1.0f + 2.0f * x + 3.0f * y + 5.0f * z; });
  ScalarLattice lattice = { scalars.data(), 1, size, ScalarLattice::Sites::Corners };
  const std::vector<float> between = VoxelMeans(lattice, { 4, 3, 2 }, Proportional());
  ForGridVoxels({ 4, 3, 2 },
    [&](std::size_t i, int x, int y, int z) { EXPECT_NEAR(between[i], 6.0f + 2.0f * x + 3.0f * y + 5.0f * z, 1e-5); });
  lattice.sites = ScalarLattice::Sites::CentresWithin;
  const std::vector<float> around = VoxelMeans(lattice, size, Proportional());
  EXPECT_NEAR(around[Grid{ size }.IndexOf({ 2, 1, 1 })], 1.0 + 4.0 + 3.0 + 5.0, 1e-5);
  EXPECT_NEAR(around[0], (1.0 + 0.25 * 10.0) / 8.0, 1e-6); // an eighth of the voxel at the corner is inside
  EXPECT_NEAR(Sum(around), Sum(between), 1e-4);            // both integrate over the same box
}

TEST(VoxelMeans, AreIntegralsOfTheFunctionOfTheInterpolatedScalar)
{
  std::mt19937 random(SeedOfTheDay());
  const std::array<int, 3> size = { 4, 3, 5 };
  const std::vector<float> scalars = RandomScalars(size, random);
  const RandomOpacity opacity(random);
  const ScalarLattice lattice = { scalars.data(), 1, size, ScalarLattice::Sites::Centres };
  const std::vector<float> means = VoxelMeans(lattice, size, OfTable(opacity.Table()));
  double worst = 0.0, bias = 0.0, ofMean = 0.0;
  ForGridVoxels(size, [&](std::size_t i, int x, int y, int z) {
    constexpr int points = 40;
    double expected = 0.0, scalar = 0.0;
    ForGridVoxels({ points, points, points }, [&](std::size_t, int a, int b, int c) {
      const auto at = [&](int place, int k) { return place + (k + 0.5) / points - 0.5; };
      const double here = Interpolated(lattice, { at(x, a), at(y, b), at(z, c) });
      expected += opacity.At(here);
      scalar += here;
    });
    const double cells = points * points * points;
    worst = std::max(worst, std::abs(means[i] - expected / cells));
    bias += (means[i] - expected / cells) / means.size();
    ofMean = std::max(ofMean, std::abs(opacity.At(scalar / cells) - expected / cells));
  });
  EXPECT_LT(worst, 0.02 * ThickestVoxel) << "seed " << SeedOfTheDay();
  EXPECT_LT(std::abs(bias), 0.001 * ThickestVoxel) << "seed " << SeedOfTheDay();
  EXPECT_GT(ofMean, worst); // the function of the mean would be wrong
}

TEST(VoxelMeans, DependOnNoAxis)
{
  std::mt19937 random(SeedOfTheDay());
  const std::array<int, 3> size = { 6, 5, 4 };
  const std::vector<float> scalars = RandomScalars(size, random);
  std::vector<float> turned(scalars.size());
  ForGridVoxels(size, [&](std::size_t i, int x, int y, int z) {
    turned[Grid{ { 4, 6, 5 } }.IndexOf({ z, x, y })] = scalars[i];
  });
  const OfTable smooth(CoefficientTable([](double s, double* value) { *value = s * s; }, 1, { 0.0, 0.5, 1.0 }));
  for (const auto sites : { ScalarLattice::Sites::Centres, ScalarLattice::Sites::CentresWithin })
  {
    const std::vector<float> means = VoxelMeans({ scalars.data(), 1, size, sites }, size, smooth);
    const std::vector<float> other = VoxelMeans({ turned.data(), 1, { 4, 6, 5 }, sites }, { 4, 6, 5 }, smooth);
    ForGridVoxels(size, [&](std::size_t i, int x, int y, int z) {
      const std::size_t same = Grid{ { 4, 6, 5 } }.IndexOf({ z, x, y });
      EXPECT_NEAR(means[i], other[same], 1e-3 * means[i] + 1e-5);
    });
  }
}

TEST(VoxelMeans, EmptySitesHaveNoMedium)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> scalars = { 2.0f, 2.0f, nan, 2.0f };
  ScalarLattice lattice = { scalars.data(), 1, { 4, 1, 1 }, ScalarLattice::Sites::Centres };
  EXPECT_EQ(VoxelMeans(lattice, { 4, 1, 1 }, Proportional()), (std::vector<float>{ 2.0f, 2.0f, 0.0f, 2.0f }));
  lattice.sites = ScalarLattice::Sites::CentresWithin; // no medium between a point that is empty and the next
  EXPECT_EQ(VoxelMeans(lattice, { 4, 1, 1 }, Proportional()), (std::vector<float>{ 1.0f, 1.0f, 0.0f, 0.0f }));
}

TEST(VoxelMeans, NearestScalarsAreThoseOfTheSites)
{
  const std::vector<float> scalars = { 1.0f, 5.0f, 3.0f };
  ScalarLattice lattice = { scalars.data(), 1, { 3, 1, 1 }, ScalarLattice::Sites::Centres, true };
  EXPECT_EQ(VoxelMeans(lattice, { 3, 1, 1 }, Proportional()), scalars);
  lattice.sites = ScalarLattice::Sites::CentresWithin;
  EXPECT_EQ(VoxelMeans(lattice, { 3, 1, 1 }, Proportional()), (std::vector<float>{ 0.5f, 5.0f, 1.5f }));
}
