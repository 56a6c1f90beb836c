#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/RayBundles.h"

#include "Device/Errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace tyndall;

namespace
{
constexpr double Pi = 3.14159265358979323846;

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
}

TEST(EquiangularDirections, IntegrateConstantsDirectionsAndTheirProductsExactly)
{
  for (int perFace : { 1, 4, 9, 16, 25, 36, 64, 100, 256 })
  {
    const DirectionSet set = EquiangularDirections(perFace);
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

TEST(EquiangularDirections, AreUnchangedByEveryRotationAndMirroringOfTheCube)
{
  const DirectionSet set = EquiangularDirections(25);
  std::set<std::array<double, 4>> rows;
  for (const Direction& d : set.directions)
  {
    rows.insert({ d.omega[0], d.omega[1], d.omega[2], d.weight });
  }
  for (const Direction& d : set.directions)
  {
    EXPECT_TRUE(rows.count({ d.omega[1], d.omega[2], d.omega[0], d.weight }));
    EXPECT_TRUE(rows.count({ d.omega[1], d.omega[0], d.omega[2], d.weight }));
    EXPECT_TRUE(rows.count({ d.omega[0] == 0.0 ? 0.0 : -d.omega[0], d.omega[1], d.omega[2], d.weight }));
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
  for (const DirectionSet& set : { EquiangularDirections(25), PublishedDirections(16) })
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
  EXPECT_THROW(EquiangularDirections(0), InvalidInput);
  EXPECT_THROW(PublishedDirections(-25), InvalidInput);
}

TEST(BoundaryRadiance, LetsAUniformEnvironmentInUnchanged)
{
  Environment environment;
  environment.width = 16;
  environment.height = 8;
  environment.radiance.assign(3 * 16 * 8, 2.5f);
  for (const Rgb& radiance : BoundaryRadiance(EquiangularDirections(25), environment, { 0.0, 1.0, 0.0 }))
  {
    EXPECT_NEAR(radiance[0], 2.5, 1e-12);
    EXPECT_NEAR(radiance[1], 3.5, 1e-12);
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
  const DirectionSet set = EquiangularDirections(25);
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

TEST(RayPattern, CubicVoxelsNeedSixBundlesForTwentyFiveDirections)
{
  const std::vector<Bundle> bundles = BundlesAlong(2, Grid(), {}, EquiangularDirections(25), 1);
  EXPECT_EQ(bundles.size(), 6u);
}

TEST(RayPattern, EveryMemberHasItsMirrorImage)
{
  const DirectionSet set = EquiangularDirections(25);
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
