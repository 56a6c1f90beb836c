// Paths of photons against closed forms. Order of the integrators and closed forms: the project's
// grin_integrator_errors.csv.
#include "DeviceTest.h"
#include "PhotonScene.h"

#include "Numerics/ChooseEvenly.h"
#include "Prism.h"

#include <algorithm>

using namespace tyndall;

namespace
{
using Point = std::array<double, 3>;

/// A photon along +x.
Photon Ray(const Point& from)
{
  Photon photon;
  photon.position = from;
  photon.direction = { 1.0f, 0.0f, 0.0f };
  photon.power = { 1.0f, 1.0f, 1.0f };
  return photon;
}
}

class PhotonPaths : public DeviceTest
{
};

TEST_F(PhotonPaths, AreStraightWhereTheIndexIsConstant)
{
  PhotonScene scene({ 20, 30, 40 }, 0.1, 1.0, 0.0f, 0.0f);
  scene.SetIndex([](double, double, double) { return 1.33; });
  const PhotonPath path = scene.Path(this->GetDevice(), { -1.0, -0.5, -1.0 }, { 0.3, 0.5, 0.7 });
  ASSERT_EQ(path.points.size(), 2u);
  const Point direction = LastDirection(path);
  const double length = std::hypot(0.3, 0.5, 0.7);
  EXPECT_NEAR(direction[0], 0.3 / length, 1e-6);
  EXPECT_NEAR(direction[2], 0.7 / length, 1e-6);
}

TEST_F(PhotonPaths, KnowWhatIsLeftOfAllColours)
{
  PhotonScene scene(8, 1.0);
  const auto left = [&](std::array<float, 3> sigma, std::array<float, 3> power) {
    scene.sigma_a.clear();
    for (std::size_t i = 0; i < scene.medium.grid.VoxelCount(); ++i)
    {
      scene.sigma_a.insert(scene.sigma_a.end(), sigma.begin(), sigma.end());
    }
    Photon photon = Ray({ -1.0, 0.1, 0.1 });
    photon.power = power;
    return scene.Marcher(this->GetDevice()).Paths({ photon }, { 0 }).at(0).left;
  };
  const std::array<float, 3> clear = { 0.0f, 0.0f, 0.0f }, eatsRed = { 50.0f, 0.0f, 0.0f };
  EXPECT_FLOAT_EQ(left(clear, { 0.0f, 1.0f, 1.0f }).front(), 1.0f);
  EXPECT_FLOAT_EQ(left(clear, { 0.0f, 1.0f, 1.0f }).back(), 1.0f);
  EXPECT_NEAR(left(eatsRed, { 1.0f, 1.0f, 2.0f }).back(), 0.75f, 1e-6f);
  EXPECT_FLOAT_EQ(left(clear, { 0.0f, 0.0f, 0.0f }).back(), 1.0f);
}

TEST_F(PhotonPaths, OfALuneburgLensMeetAtTheFarPoleIn64Steps)
{
  // As in the reference: from the surface, and the index goes on beyond it as it is in the lens.
  PhotonScene scene(128, 1.1);
  scene.SetIndex(luneburg::Endless);
  scene.settings.stepSize = 2.0;
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  for (double b : { 0.1, 0.3, 0.5, 0.7, 0.85 })
  {
    const Photon photon = Ray({ -std::sqrt(1.0 - b * b), b, 0.0 });
    EXPECT_LE(marcher.March({ photon }).steps, 64u);
    EXPECT_LT(Miss(marcher.Paths({ photon }, { 0 }).at(0), { 1.0, 0.0, 0.0 }), 2e-4) << b;
  }
}

TEST_F(PhotonPaths, OfALensInAirMeetAtTheFarPole)
{
  // With the kink of the index at the surface, which voxels smooth; steps of a voxel.
  PhotonScene scene(128, 1.1);
  scene.SetIndex(luneburg::Index);
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  for (double b : { 0.1, 0.3, 0.5, 0.7, 0.85 })
  {
    EXPECT_LT(Miss(marcher.Paths({ Ray({ -1.1, b, 0.0 }) }, { 0 }).at(0), { 1.0, 0.0, 0.0 }), 1e-3) << b;
  }
}

TEST_F(PhotonPaths, OfALensInAirMissTheFarPoleByWhatVoxelsLoseOfTheKink)
{
  // Many rays: neither finer steps nor a higher order help, finer voxels do.
  std::vector<double> misses;
  for (int edge : { 64, 128, 256 })
  {
    PhotonScene scene(edge, 1.1);
    scene.SetIndex(luneburg::Index);
    const double miss = luneburg::MissInAir(this->GetDevice(), scene);
    scene.settings.stepSize = 0.5;
    EXPECT_NEAR(luneburg::MissInAir(this->GetDevice(), scene), miss, 0.03 * miss) << edge;
    scene.settings.order = 4;
    EXPECT_NEAR(luneburg::MissInAir(this->GetDevice(), scene), miss, 0.03 * miss) << edge;
    misses.push_back(miss);
  }
  EXPECT_LT(misses[1], 1e-3);
  EXPECT_LT(misses[1], 0.8 * misses[0]);
  EXPECT_LT(misses[2], 0.8 * misses[1]);
}

TEST_F(PhotonPaths, ConvergeWithTheOrderOfTheIntegrator)
{
  PhotonScene scene(128, 1.1);
  scene.SetIndex(luneburg::Endless);
  for (int order : { 1, 2, 4 })
  {
    std::vector<double> errors;
    const double longest = order == 4 ? 24.0 : 8.0; // shorter ones of order 4 are a matter of rounding
    for (double step : { longest, longest / 2.0, longest / 4.0 })
    {
      scene.settings.order = order;
      scene.settings.stepSize = step;
      double worst = 0.0; // of several paths: in one alone, rounding shows at 6 voxels a step of order 4
      for (double b : { 0.3, 0.5, 0.7 })
      {
        const PhotonPath path = scene.Path(this->GetDevice(), { -std::sqrt(1.0 - b * b), b, 0.0 }, { 1.0, 0.0, 0.0 });
        worst = std::max(worst, luneburg::WorstCorner(path, b));
      }
      errors.push_back(worst);
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), order, 0.4) << errors[0] << ' ' << errors[1] << ' ' << errors[2];
    EXPECT_NEAR(std::log2(errors[1] / errors[2]), order, 0.4) << errors[0] << ' ' << errors[1] << ' ' << errors[2];
  }
}

TEST_F(PhotonPaths, OfMaxwellsFishEyeAreCirclesThroughTheAntipode)
{
  const double angle = 110.0 * 3.14159265358979323846 / 180.0;
  const double c = std::cos(angle) / std::sin(angle);
  for (int edge : { 64, 128 })
  {
    PhotonScene scene(edge, 2.0);
    scene.SetIndex(fisheye::Index);
    scene.settings.order = 4;
    const PhotonPath path = scene.Path(this->GetDevice(), { 1.0, 0.0, 0.0 }, { std::cos(angle), std::sin(angle), 0.0 });
    EXPECT_LT(fisheye::WorstCorner(path, c, 2 * static_cast<std::size_t>(edge)), 1e-4) << edge;
    EXPECT_LT(Miss(path, { -1.0, 0.0, 0.0 }), 1e-3) << edge; // the middle of a chord, at worst
  }
}

TEST_F(PhotonPaths, GoRoundAFishEyeWithoutSpirallingOut)
{
  PhotonScene scene(64, 2.0);
  scene.SetIndex(fisheye::Index);
  const PhotonPath path = scene.Path(this->GetDevice(), { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 });
  EXPECT_GT(path.points.size(), 4000u); // dozens of rounds
  EXPECT_LT(fisheye::WorstCorner(path, 0.0, path.points.size()), 0.01);
}

TEST_F(PhotonPaths, InALinearGradientOfNSquaredAreParabolas)
{
  PhotonScene scene(32, 1.0);
  const double slope = 0.4;
  scene.SetIndex([&](double, double y, double) { return std::sqrt(2.0 + slope * y); });
  for (int order : { 2, 4 })
  {
    scene.settings.order = order;
    const PhotonPath path = scene.Path(this->GetDevice(), { -1.0, -0.2, 0.0 }, { 1.0, 0.1, 0.0 });
    const double n = std::sqrt(2.0 - 0.2 * slope), length = std::hypot(1.0, 0.1);
    const double t = 2.0 / (n / length);
    const double y = -0.2 + 0.1 * n / length * t + 0.25 * slope * t * t;
    EXPECT_NEAR(path.points.back()[0], 1.0, 1e-5);
    EXPECT_NEAR(path.points.back()[1], y, 1e-3);
  }
}

TEST_F(PhotonPaths, ObeySnellAcrossASmoothedPlane)
{
  // A prism's face: normal at 30 degrees to the ray, glass beyond.
  const double s = std::sin(0.5235987755982988), c = std::cos(0.5235987755982988);
  for (double inside : { 1.5, 1.1 })
  {
    PhotonScene scene(128, 1.0);
    const double width = 1.5 * scene.medium.grid.spacing[0] * std::sqrt(2.0);
    scene.SetIndex(
      [&](double x, double y, double) { return 1.0 + (inside - 1.0) * 0.5 * std::erfc(-(c * x + s * y) / width); });
    const Point direction = LastDirection(scene.Path(this->GetDevice(), { -1.0, 0.3, 0.05 }, { 1.0, 0.0, 0.0 }));
    const double across = -s / inside; // of the unit vector, along the face (-s, c)
    const double through = std::sqrt(1.0 - across * across);
    EXPECT_NEAR(direction[0], c * through - s * across, 1e-3) << inside;
    EXPECT_NEAR(direction[1], s * through + c * across, 1e-3) << inside;
  }
}

TEST_F(PhotonPaths, AreTurnedByAVoxelisedPrismAsByItsTwoFaces)
{
  EXPECT_LT(optics::PrismTurn(prism::Index, prism::Apex, prism::Incidences()[1]), 0.649);
  for (int edge : { 64, 128, 256 })
  {
    PhotonScene scene = prism::Scene(this->GetDevice(), edge);
    PhotonMarcher marcher = scene.Marcher(this->GetDevice());
    for (double incidence : prism::Incidences())
    {
      const prism::Error error = prism::ErrorOf(prism::Turns(marcher, incidence), incidence);
      EXPECT_LT(std::abs(error.ofMean), 2e-3) << edge << ' ' << incidence;
      EXPECT_LT(error.largest, 3e-3) << edge << ' ' << incidence; // terraces of a quarter voxel would make 8e-3
    }
  }
}

TEST_F(PhotonPaths, AreReflectedTotallyBeyondTheCriticalAngle)
{
  PhotonScene scene(96, 1.0);
  const double width = 1.5 * scene.medium.grid.spacing[0] * std::sqrt(2.0);
  scene.SetIndex([&](double, double y, double) { return 1.0 + 0.25 * std::erfc(y / width); });
  const Point steep = LastDirection(scene.Path(this->GetDevice(), { -1.0, -0.8, 0.0 }, { 0.5, 0.8, 0.0 }));
  EXPECT_GT(steep[1], 0.0); // 32 degrees from the normal: it gets out
  const Point flat = LastDirection(scene.Path(this->GetDevice(), { -1.0, -0.8, 0.0 }, { 0.8, 0.6, 0.0 }));
  EXPECT_NEAR(flat[0], 0.8, 2e-3); // 53 degrees: it does not
  EXPECT_NEAR(flat[1], -0.6, 2e-3);
}

TEST_F(PhotonPaths, ThroughAGlassBallTendToSnellAsVoxelsShrink)
{
  const double radius = 0.5, index = 1.5;
  std::vector<double> errors;
  for (int edge : { 64, 128, 256 })
  {
    PhotonScene scene(edge, 0.8);
    scene.SetBall(radius, index);
    scene.settings.order = 4;
    double worst = 0.0;
    for (double b : { 0.1, 0.2, 0.3 })
    {
      const double turn = 2.0 * (std::asin(b / radius) - std::asin(b / radius / index));
      const Point direction = LastDirection(scene.Path(this->GetDevice(), { -0.8, b, 0.0 }, { 1.0, 0.0, 0.0 }));
      worst = std::max(worst, std::abs(std::atan2(-direction[1], direction[0]) - turn));
    }
    errors.push_back(worst);
  }
  EXPECT_LT(errors[2], 0.02);
  EXPECT_LT(errors[1], 0.75 * errors[0]) << errors[0] << ' ' << errors[1] << ' ' << errors[2];
  EXPECT_LT(errors[2], 0.75 * errors[1]) << errors[0] << ' ' << errors[1] << ' ' << errors[2];
}

// Starting places of Hammersley's set are made of the bits of a photon's number: 300000 / 150 = 16 * 125 would choose
// those of equal low bits, all within one sixteenth of the plane.
TEST(ChosenPaths, AreSpreadOverTheirPlaceWhateverTheStep)
{
  for (const std::size_t count : { 150u, 128u, 7u, 1000u })
  {
    const std::vector<std::size_t> chosen = ChooseEvenly(300000, count);
    ASSERT_EQ(chosen.size(), count);
    std::array<int, 4> quarters = {};
    for (std::size_t i = 0; i < count; ++i)
    {
      EXPECT_EQ(chosen[i] * count / 300000, i) << "one of each stretch";
      ++quarters[(chosen[i] & 1) * 2 + (chosen[i] >> 1 & 1)]; // of the radical inverse to the base 2
    }
    EXPECT_GE(*std::min_element(quarters.begin(), quarters.end()), static_cast<int>(count / 8)) << count;
  }
}

TEST(ChosenPaths, AreAllWhereAllAreAskedFor)
{
  for (const std::size_t size : { 1u, 2u, 13u, 100u })
  {
    for (const std::size_t count : { size, size + 5 })
    {
      const std::vector<std::size_t> chosen = ChooseEvenly(size, count);
      ASSERT_EQ(chosen.size(), size);
      for (std::size_t i = 0; i < size; ++i)
      {
        EXPECT_EQ(chosen[i], i);
      }
    }
  }
  EXPECT_TRUE(ChooseEvenly(10, 0).empty());
}
