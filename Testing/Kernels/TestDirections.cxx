#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/RayBundles.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

using namespace tyndall;

namespace
{
double Moment(const DirectionSet& set, int px, int py, int pz)
{
  double sum = 0.0;
  for (const Direction& d : set.directions)
  {
    sum += d.weight * std::pow(d.omega[0], px) * std::pow(d.omega[1], py) * std::pow(d.omega[2], pz);
  }
  return sum;
}

double HalfRangeFlux(const DirectionSet& set, int axis)
{
  double sum = 0.0;
  for (const Direction& d : set.directions)
  {
    sum += d.weight * std::abs(d.omega[axis]);
  }
  return sum;
}

/// By equal angles, and fitted.
std::vector<DirectionSet> BothSets(const std::vector<int>& perFace)
{
  std::vector<DirectionSet> sets;
  for (int number : perFace)
  {
    sets.push_back(EquiangularDirections(number));
    sets.push_back(FittedDirections(number));
  }
  return sets;
}

/// The largest relative error of the transmission of diffuse light through absorbing slabs, 2 E3(tau) of pi, by a set
/// against the sum over very many cosines, in slabs across y of optical thickness 0.1 to 5.
double SlabError(const DirectionSet& set)
{
  double largest = 0.0;
  for (double tau : { 0.1, 0.14, 0.2, 0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 2.7, 3.5, 5.0 })
  {
    constexpr int Parts = 20000;
    double exact = 0.0, found = 0.0;
    for (int i = 0; i < Parts; ++i)
    {
      const double cosine = (i + 0.5) / Parts;
      exact += 2.0 * Pi * cosine * std::exp(-tau / cosine) / Parts;
    }
    for (const Direction& d : set.directions)
    {
      found += d.omega[1] > 0.0 ? d.weight * d.omega[1] * std::exp(-tau / d.omega[1]) : 0.0;
    }
    largest = std::max(largest, std::abs(found / exact - 1.0));
  }
  return largest;
}
}

TEST(Directions, IntegrateConstantsDirectionsAndTheirProductsExactly)
{
  for (const DirectionSet& set : BothSets({ 1, 4, 9, 16, 25, 36, 49, 64, 100, 256 }))
  {
    const int perFace = set.PerFace();
    ASSERT_EQ(set.directions.size(), 6u * perFace);
    EXPECT_NEAR(Moment(set, 0, 0, 0), 4.0 * Pi, 1e-12) << perFace;
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_NEAR(Moment(set, axis == 0, axis == 1, axis == 2), 0.0, 1e-13) << perFace;
      EXPECT_NEAR(Moment(set, 2 * (axis == 0), 2 * (axis == 1), 2 * (axis == 2)), 4.0 * Pi / 3.0, 1e-12) << perFace;
    }
    EXPECT_NEAR(Moment(set, 1, 1, 0), 0.0, 1e-13) << perFace;
    EXPECT_NEAR(Moment(set, 0, 1, 1), 0.0, 1e-13) << perFace;
    EXPECT_NEAR(Moment(set, 1, 0, 1), 0.0, 1e-13) << perFace;
  }
}

TEST(EquiangularDirections, LetADiffuseFaceShineWithPiMoreExactlyTheMoreThereAre)
{
  const auto error = [](int perFace) {
    const double flux = HalfRangeFlux(EquiangularDirections(perFace), 2);
    return std::abs(flux / (2.0 * Pi) - 1.0);
  };
  EXPECT_LT(error(25), 1.3e-2);
  EXPECT_LT(error(100), 2e-3);
  EXPECT_LT(error(256), 8e-4);
}

TEST(EquiangularDirections, HavePositiveWeightsNearTheirSolidAngle)
{
  for (int perFace : { 4, 9, 16, 25, 36, 100, 400 })
  {
    const DirectionSet set = EquiangularDirections(perFace);
    const double mean = 4.0 * Pi / set.directions.size();
    for (const Direction& d : set.directions)
    {
      EXPECT_GT(d.weight, 0.8 * mean) << perFace;
      EXPECT_LT(d.weight, 1.2 * mean) << perFace;
    }
  }
}

TEST(Directions, AreUnchangedByEveryRotationAndMirroringOfTheCube)
{
  for (const DirectionSet& set : BothSets({ 9, 16, 25, 36, 49, 64, 100 }))
  {
    std::set<std::array<double, 4>> rows;
    for (const Direction& d : set.directions)
    {
      rows.insert({ d.omega[0], d.omega[1], d.omega[2], d.weight });
    }
    EXPECT_EQ(rows.size(), set.directions.size());
    for (const Direction& d : set.directions)
    {
      EXPECT_TRUE(rows.count({ d.omega[1], d.omega[2], d.omega[0], d.weight }));
      EXPECT_TRUE(rows.count({ d.omega[1], d.omega[0], d.omega[2], d.weight }));
      EXPECT_TRUE(rows.count({ d.omega[0] == 0.0 ? 0.0 : -d.omega[0], d.omega[1], d.omega[2], d.weight }));
    }
  }
}

TEST(FittedDirections, SendDiffuseLightThroughSlabsAsItGoes)
{
  // 2 E3(tau) of it, to 0.2%, as equal angles do not; of 9, too few for that, more than equal angles.
  for (int perFace : { 16, 25, 36, 49, 64, 100 })
  {
    const DirectionSet set = FittedDirections(perFace);
    EXPECT_LT(SlabError(set), 2e-3) << perFace;
    EXPECT_NEAR(HalfRangeFlux(set, 0) / (2.0 * Pi), 1.0, 2e-3) << perFace;
  }
  EXPECT_GT(SlabError(EquiangularDirections(25)), 5e-3) << "the limit tells no difference";
  EXPECT_LT(SlabError(FittedDirections(9)), 0.5 * SlabError(EquiangularDirections(9)));
  EXPECT_LT(std::abs(HalfRangeFlux(FittedDirections(9), 1) / (2.0 * Pi) - 1.0), 7e-3);
}

TEST(FittedDirections, OfEvenEdgesGoThroughAllPlanes)
{
  // Light along a plane between two periodic axes would never leave.
  for (int perFace : { 16, 36, 64 })
  {
    for (const Direction& d : FittedDirections(perFace).directions)
    {
      EXPECT_GT(std::abs(d.omega[0] * d.omega[1] * d.omega[2]), 1e-6) << perFace;
    }
  }
}

TEST(FittedDirections, AreThoseOfEqualAnglesWhereThereAreMany)
{
  for (int perFace : { 1, 4, 256 })
  {
    const DirectionSet set = FittedDirections(perFace), equal = EquiangularDirections(perFace);
    for (std::size_t d = 0; d < set.directions.size(); ++d)
    {
      EXPECT_EQ(set.directions[d].omega, equal.directions[d].omega);
      EXPECT_EQ(set.directions[d].weight, equal.directions[d].weight);
    }
  }
}

TEST(FittedDirections, HaveCellsAsLargeAsTheirWeights)
{
  constexpr int Parts = 1000; // of a face's edge
  for (int perFace : { 9, 16, 25, 36, 49, 64, 100 })
  {
    const DirectionSet set = FittedDirections(perFace);
    std::vector<double> found(set.directions.size(), 0.0);
    for (int j = 0; j < Parts; ++j)
    {
      for (int i = 0; i < Parts; ++i)
      {
        const double s = std::tan(Pi / 4.0 * (2.0 * i + 1.0 - Parts) / Parts);
        const double t = std::tan(Pi / 4.0 * (2.0 * j + 1.0 - Parts) / Parts);
        const double part = (1.0 + s * s) * (1.0 + t * t) * std::pow(1.0 + s * s + t * t, -1.5);
        found[Nearest(set, { t, 1.0, s })] += part * std::pow(Pi / 2.0 / Parts, 2); // through face +y
      }
    }
    for (std::size_t d = 0; d < set.directions.size(); ++d)
    {
      const bool ahead = static_cast<int>(d) / perFace == 3;
      EXPECT_NEAR(found[d] / set.directions[d].weight, ahead ? 1.0 : 0.0, 0.01) << perFace;
    }
  }
}

TEST(PublishedDirections, WeighAllTheSameAndMissTheHalfRangeFlux)
{
  const DirectionSet set = PublishedDirections(400);
  EXPECT_NEAR(Moment(set, 0, 0, 0), 4.0 * Pi, 1e-12);
  EXPECT_GT(std::abs(HalfRangeFlux(set, 0) / (2.0 * Pi) - 1.0), 0.01) << "equal weights do not converge";
  EXPECT_LT(std::abs(HalfRangeFlux(EquiangularDirections(400), 0) / (2.0 * Pi) - 1.0), 1e-3);
}

TEST(Directions, NearestFindsEachDirectionOfItsSet)
{
  std::vector<DirectionSet> sets = BothSets({ 9, 16, 25, 36, 49, 64, 100 });
  sets.push_back(PublishedDirections(16));
  for (const DirectionSet& set : sets)
  {
    for (std::size_t d = 0; d < set.directions.size(); ++d)
    {
      EXPECT_EQ(Nearest(set, set.directions[d].omega), static_cast<int>(d));
    }
  }
}

TEST(Directions, RefuseANumberThatIsNoSquare)
{
  EXPECT_THROW(EquiangularDirections(24), InvalidInput);
  EXPECT_THROW(FittedDirections(24), InvalidInput);
  EXPECT_THROW(EquiangularDirections(0), InvalidInput);
  EXPECT_THROW(PublishedDirections(-25), InvalidInput);
}

TEST(BoundaryRadiance, LetsAUniformEnvironmentInUnchanged)
{
  Environment environment;
  environment.width = 16;
  environment.height = 8;
  environment.radiance.assign(3 * 16 * 8, 2.5f);
  for (const DirectionSet& set : BothSets({ 9, 25, 36 }))
  {
    for (const Rgb& radiance : BoundaryRadiance(set, environment, { 0.0, 1.0, 0.0 }))
    {
      EXPECT_NEAR(radiance[0], 2.5, 1e-12);
      EXPECT_NEAR(radiance[1], 3.5, 1e-12);
    }
  }
}

TEST(BoundaryRadiance, HasTheFluxOfTheEnvironmentThroughEveryFace)
{
  // An uneven one, in a colour that another channel does not have; as far as the set has the half-range flux.
  Environment environment;
  environment.width = 64;
  environment.height = 32;
  std::array<std::array<double, 2>, 6> exact = {};
  for (int j = 0; j < environment.height; ++j)
  {
    for (int i = 0; i < environment.width; ++i)
    {
      const double polar = Pi * (j + 0.5) / environment.height, azimuth = 2.0 * Pi * (i + 0.5) / environment.width;
      const double red = 1.2 + std::sin(3.0 * azimuth) * std::cos(2.0 * polar), green = i < 20 && j > 9 ? 1.0 : 0.02;
      environment.radiance.insert(
        environment.radiance.end(), { static_cast<float>(red), static_cast<float>(green), 0.0f });
    }
  }
  const auto add = [&](const std::array<double, 3>& omega, double solidAngle) {
    const Rgb seen = Lookup(environment, { -omega[0], -omega[1], -omega[2] });
    for (int axis = 0; axis < 3; ++axis)
    {
      for (int c = 0; c < 2; ++c)
      {
        exact[2 * axis + (omega[axis] > 0.0)][c] += solidAngle * std::abs(omega[axis]) * seen[c];
      }
    }
  };
  for (const Direction& d : EquiangularDirections(64 * 64).directions)
  {
    add(d.omega, d.weight);
  }
  for (const DirectionSet& set : BothSets({ 25, 36, 100 }))
  {
    const std::vector<Rgb> radiance = BoundaryRadiance(set, environment, {});
    for (int face = 0; face < 6; ++face)
    {
      std::array<double, 2> flux = {};
      for (std::size_t d = 0; d < set.directions.size(); ++d)
      {
        EXPECT_EQ(radiance[d][2], 0.0);
        const double through = set.directions[d].omega[face / 2] * (face % 2 == 0 ? -1.0 : 1.0);
        for (int c = 0; c < 2; ++c)
        {
          EXPECT_GE(radiance[d][c], 0.0);
          flux[c] += set.directions[d].weight * std::max(through, 0.0) * radiance[d][c];
        }
      }
      const double halfRange = HalfRangeFlux(set, face / 2) / (2.0 * Pi);
      EXPECT_NEAR(flux[0] / exact[face][0], halfRange, 2e-3) << set.PerFace();
      EXPECT_NEAR(flux[1] / exact[face][1], halfRange, 2e-3) << set.PerFace();
    }
  }
}

TEST(BoundaryRadiance, KeepsTheIrradianceOfASkyThatIsBrightAbove)
{
  Environment environment;
  environment.width = 64;
  environment.height = 32;
  environment.radiance.assign(3 * 64 * 32, 0.0f);
  std::fill(environment.radiance.begin() + 3 * 64 * 16, environment.radiance.end(), 1.0f);
  const DirectionSet set = EquiangularDirections(100);
  const std::vector<Rgb> radiance = BoundaryRadiance(set, environment, {});
  double down = 0.0;
  double up = 0.0;
  for (std::size_t d = 0; d < set.directions.size(); ++d)
  {
    const double z = set.directions[d].omega[2];
    (z < 0.0 ? down : up) += set.directions[d].weight * std::abs(z) * radiance[d][0];
  }
  EXPECT_NEAR(down, Pi, 0.01) << "light from above travels down";
  EXPECT_LT(up, 0.01);
}

TEST(RayPattern, SegmentsFillThePlaneAndMovesFollowTheTangent)
{
  const DirectionSet set = FittedDirections(25);
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 1, 2, 3 }, { 7, 10, 8 }, { 40, 64, 33 } })
  {
    for (const RayStarts starts : { RayStarts::Middle, RayStarts::Staggered })
    {
      Grid grid;
      grid.size = size;
      grid.spacing = { 1.0, 1.5, 0.8 };
      std::size_t families = 0;
      for (int axis = 0; axis < 3; ++axis)
      {
        double missingU = 0.0, missingV = 0.0, largest = 0.0;
        for (const Bundle& bundle : BundlesAlong(axis, grid, {}, set, 2, starts))
        {
          families += 2 * bundle.members.size();
          double movedU = 0.0, movedV = 0.0;
          for (int k = 0; k < size[axis]; ++k)
          {
            const PlaneCrossing crossing = bundle.Crossing(k);
            double length = 0.0;
            for (int s = 0; s < crossing.count; ++s)
            {
              const Segment& segment = crossing.segments[s];
              length += segment.length;
              movedU += segment.part * segment.moveU;
              movedV += segment.part * segment.moveV;
              EXPECT_GT(segment.part, 0.0);
              EXPECT_LE(segment.part, 1.0);
            }
            EXPECT_NEAR(length, bundle.length, 1e-9 * bundle.length);
          }
          EXPECT_NEAR(movedU, bundle.tangentU * size[axis], 1.0);
          EXPECT_NEAR(movedV, bundle.tangentV * size[axis], 1.0);
          missingU += bundle.power * bundle.members.size() * (bundle.tangentU * size[axis] - movedU);
          missingV += bundle.power * bundle.members.size() * (bundle.tangentV * size[axis] - movedV);
          largest = std::max(largest, bundle.power);
        }
        EXPECT_NEAR(missingU, 0.0, 1e-9 * largest) << "what enters through the sides is what the directions carry";
        EXPECT_NEAR(missingV, 0.0, 1e-9 * largest);
      }
      EXPECT_EQ(families, 4 * set.directions.size()) << "four map points a voxel and direction";
    }
  }
}

TEST(RayPattern, CubicVoxelsNeedFourBundlesForTwentyFiveDirections)
{
  EXPECT_EQ(BundlesAlong(2, Grid(), {}, FittedDirections(25), 1).size(), 4u);
  EXPECT_EQ(BundlesAlong(2, Grid(), {}, EquiangularDirections(25), 1).size(), 6u);
}

TEST(RayPattern, EveryMemberHasItsMirrorImage)
{
  const DirectionSet set = FittedDirections(25);
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const Bundle& bundle : BundlesAlong(axis, Grid(), {}, set, 1))
    {
      for (const Member& member : bundle.members)
      {
        std::array<double, 3> mirrored = set.directions[member.direction].omega;
        mirrored[axis] = -mirrored[axis];
        EXPECT_EQ(set.directions[member.opposite].omega, mirrored);
      }
    }
  }
}
