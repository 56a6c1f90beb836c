// Parallel light through a voxelised ball of glass against geometrical optics: the focus of the ball lens, from paths
// and from fluence, and the brightness about it. TyndallBenchPhotons has the table, by voxels and smoothing.
#include "Caustic.h"
#include "DeviceTest.h"

using namespace tyndall;
using namespace caustic;

namespace
{
/// Of the Gaussian of n on a grid as the voxeliser has it, cut off, on occupancy that is a mean over a voxel; in radii.
double WidthOfBorder(int edge, int filterSize)
{
  double sum = 0.0, squares = 0.0;
  for (int k = -(filterSize / 2); k <= filterSize / 2; ++k)
  {
    const double weight = std::exp(-0.5 * k * k * 36.0 / (filterSize * filterSize));
    sum += weight;
    squares += weight * k * k;
  }
  return std::sqrt(squares / sum + 1.0 / 12.0) * 2.0 / edge / Radius;
}

std::vector<float> FluenceOf(PhotonMarcher& marcher, const std::vector<Photon>& photons)
{
  return marcher.March(photons).light.fluence;
}
}

class GlassBall : public DeviceTest
{
};

TEST_F(GlassBall, RaysMeetInTheFocusOfTheBallLens)
{
  const Axis axes[] = { AxisAlong(1.0, 0.0, 1e-12), AxisAlong(0.0, 1.0, 0.0), AxisAlong(0.0, 0.0, 1.0), Askew() };
  for (int edge : { 64, 128, 256 })
  {
    PhotonScene scene = BallScene(this->GetDevice(), edge);
    PhotonMarcher marcher = scene.Marcher(this->GetDevice());
    const double smoothed = optics::SmoothedBallFocus(Index, WidthOfBorder(edge, 9)); // at most 0.01 beyond
    for (const Axis& axis : axes)
    {
      const double focus = ParaxialFocus(marcher, axis);
      EXPECT_NEAR(focus, smoothed, 0.01) << edge << ' ' << axis.along[0] << ' ' << axis.along[1];
      EXPECT_NEAR(focus, Focus, 0.02) << edge << ' ' << axis.along[0] << ' ' << axis.along[1];
    }
  }
}

TEST_F(GlassBall, AWiderBorderMovesTheFocusAsBouguersFormulaSays)
{
  const int edge = 128;
  double last = 1.0;
  for (int filterSize : { 33, 25, 17 })
  {
    PhotonScene scene = BallScene(this->GetDevice(), edge, filterSize);
    PhotonMarcher marcher = scene.Marcher(this->GetDevice());
    const double expected = optics::SmoothedBallFocus(Index, WidthOfBorder(edge, filterSize));
    EXPECT_NEAR(ParaxialFocus(marcher, Askew(), 0.1), expected, 0.005) << filterSize;
    EXPECT_LT(std::abs(expected - Focus), last);
    last = std::abs(expected - Focus);
  }
}

TEST_F(GlassBall, AParaxialBeamIsNarrowestAndBrightestInTheFocus)
{
  const double reach = 0.2;
  for (int edge : { 128, 256 })
  {
    PhotonScene scene = BallScene(this->GetDevice(), edge);
    scene.settings.meanDirection = false;
    PhotonMarcher marcher = scene.Marcher(this->GetDevice());
    const Grid& grid = scene.medium.grid;
    for (const Axis& axis : { Askew(), AxisAlong(0.0, 0.0, 1.0) })
    {
      const double waist = Waist(grid, axis, FluenceOf(marcher, Beam(grid, axis, 1000000, reach)));
      EXPECT_NEAR(waist, Focus, 0.03) << edge; // of which aberration has 0.011
      EXPECT_NEAR(waist, ExpectedWaist(reach), 0.02) << edge;
    }
  }
  PhotonScene scene = BallScene(this->GetDevice(), 128);
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  const Grid& grid = scene.medium.grid;
  const Axis axis = AxisAlong(0.0, 0.0, 1.0);
  const std::vector<float> fluence = FluenceOf(marcher, Beam(grid, axis, 1000000, reach));
  EXPECT_NEAR(BrightStretch(grid, axis, fluence), Focus, 0.03);
}

TEST_F(GlassBall, TheProfileThroughTheFocusConvergesAsPhotonsGrow)
{
  PhotonScene scene = BallScene(this->GetDevice(), 64);
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  const Grid& grid = scene.medium.grid;
  const std::vector<double> rich = Profile(grid, Askew(), FluenceOf(marcher, Beam(grid, Askew(), 2000000, 2.0)));
  double last = 0.1;
  for (std::size_t count : { 4000u, 16000u, 64000u, 256000u })
  {
    const std::vector<Photon> photons = Beam(grid, Askew(), count, 2.0, Sampler::Hammersley, 1);
    const double error = Difference(Profile(grid, Askew(), FluenceOf(marcher, photons)), rich);
    EXPECT_LT(error, 0.6 * last) << count;
    last = error;
  }
  EXPECT_LT(last, 0.005);
}

TEST_F(GlassBall, TheProfileThroughTheFocusTendsToGeometricalOpticsAsVoxelsShrink)
{
  const Axis axis = AxisAlong(0.0, 0.0, 1.0);
  double last = 0.3;
  for (int edge : { 64, 128, 256 })
  {
    PhotonScene scene = BallScene(this->GetDevice(), edge);
    scene.settings.meanDirection = false;
    PhotonMarcher marcher = scene.Marcher(this->GetDevice());
    const std::vector<float> fluence = FluenceOf(marcher, Beam(scene.medium.grid, axis, 500000, 2.0));
    const double error = Difference(Profile(scene.medium.grid, axis, fluence), ExpectedProfile());
    EXPECT_LT(error, 0.8 * last) << edge;
    last = error;
  }
  EXPECT_LT(last, 0.08);
}
