#include "ViewScene.h"

using namespace tyndall;
using namespace viewing;

namespace
{
class ScatteringTowardsEye : public DeviceTest
{
};

/// Thin haze in light of mean direction x and anisotropy a.
Scene Haze(double g, double a, ViewedPhase phase = ViewedPhase::HenyeyGreenstein)
{
  Scene scene(GridOf(8, 8, 8));
  scene.settings.imageSize = { 1, 1 };
  scene.settings.phaseFunction = phase;
  scene.g = g;
  scene.sigma_s = scene.Everywhere(1e-6);
  scene.fluence = scene.Everywhere(4.0 * Pi * 1e6 / 8.0);
  for (std::size_t voxel = 0; voxel < scene.grid.VoxelCount(); ++voxel)
  {
    scene.meanDirection.insert(scene.meanDirection.end(), { static_cast<float>(a), 0.0f, 0.0f });
  }
  return scene;
}

/// 4 pi p of light that travels along x and leaves at an angle of that cosine, as a picture shows it.
double Seen(Device& device, const Scene& scene, double cosine)
{
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const Camera camera = Along(scene.grid, { -cosine, 0.0, sine }, 1e-3); // against the light that leaves
  const Picture picture = scene.Seen(device, camera);
  return picture.radiance[0] * 8.0 / Chord(RayThrough(camera, picture, 0, 0), scene.grid);
}

double HenyeyGreensteinOf(double g, double cosine)
{
  return (1.0 - g * g) / std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5);
}

double SchlickOf(double g, double cosine)
{
  const double k = 1.55 * g - 0.55 * g * g * g;
  return (1.0 - k * k) / ((1.0 - k * cosine) * (1.0 - k * cosine));
}

TEST_F(ScatteringTowardsEye, FollowsThePhaseFunction)
{
  for (const double g : { 0.7, -0.4 })
  {
    for (const double a : { 1.0, 0.5 })
    {
      for (const double cosine : { 1.0, 0.8, 0.1, -0.6, -1.0 })
      {
        const double expected = HenyeyGreensteinOf(g * a, cosine);
        EXPECT_NEAR(expected, Seen(this->GetDevice(), Haze(g, a), cosine), 2e-4 * expected) << g << " " << a;
        const double schlick = SchlickOf(g * a, cosine);
        EXPECT_NEAR(schlick, Seen(this->GetDevice(), Haze(g, a, ViewedPhase::Schlick), cosine), 2e-4 * schlick);
      }
    }
  }
}

// Gauss and Legendre's rule with eight points.
TEST_F(ScatteringTowardsEye, IsNormalisedAndHasTheMeanCosine)
{
  const std::array<double, 4> points = { 0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
    0.9602898564975363 };
  const std::array<double, 4> weights = { 0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
    0.1012285362903763 };
  const double g = 0.6, a = 0.5;
  for (const ViewedPhase phase : { ViewedPhase::HenyeyGreenstein, ViewedPhase::Schlick })
  {
    const Scene scene = Haze(g, a, phase);
    double sum = 0.0, cosine = 0.0, reference = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      for (const double side : { -1.0, 1.0 })
      {
        const double value = Seen(this->GetDevice(), scene, side * points[i]);
        sum += 0.5 * weights[i] * value;
        cosine += 0.5 * weights[i] * side * points[i] * value;
        reference += 0.5 * weights[i] * side * points[i] * SchlickOf(g * a, side * points[i]);
      }
    }
    EXPECT_NEAR(1.0, sum, 2e-4);
    EXPECT_NEAR(phase == ViewedPhase::HenyeyGreenstein ? g * a : reference, cosine, 2e-4);
    EXPECT_NEAR(g * a, cosine, 0.02); // Schlick's k is a fit
  }
}

TEST_F(ScatteringTowardsEye, IsEvenWithoutDirectionAnisotropyOrG)
{
  Scene scene = Blobs();
  const Picture plain = scene.Seen(this->GetDevice());
  scene.g = 0.7;
  EXPECT_EQ(plain.radiance, scene.Seen(this->GetDevice()).radiance);
  scene.meanDirection.assign(3 * scene.grid.VoxelCount(), 0.0f);
  EXPECT_LT(LargestDifference(plain.radiance, scene.Seen(this->GetDevice()).radiance), 1e-6);
  scene.meanDirection.assign(3 * scene.grid.VoxelCount(), 0.5f);
  EXPECT_GT(LargestDifference(plain.radiance, scene.Seen(this->GetDevice()).radiance), 1e-2);
  scene.g = 0.0;
  EXPECT_EQ(plain.radiance, scene.Seen(this->GetDevice()).radiance);
  const std::vector<std::string> leftOut = scene.Caster(this->GetDevice()).LeftOut();
  EXPECT_TRUE(std::any_of(leftOut.begin(), leftOut.end(),
    [](const std::string& text) { return text.find("phase function") != std::string::npos; }));
}

TEST_F(ScatteringTowardsEye, BearsDirectionsLongerThanOne)
{
  const double expected = HenyeyGreensteinOf(0.9, -0.3);
  EXPECT_NEAR(expected, Seen(this->GetDevice(), Haze(0.9, 1.0001), -0.3), 1e-2 * expected);
  for (const ViewedPhase phase : { ViewedPhase::HenyeyGreenstein, ViewedPhase::Schlick })
  {
    for (const double cosine : { 1.0, -1.0 })
    {
      const double seen = Seen(this->GetDevice(), Haze(0.9999999, 5.0, phase), cosine);
      EXPECT_TRUE(std::isfinite(seen));
      EXPECT_GE(seen, 0.0);
    }
  }
}

TEST_F(ScatteringTowardsEye, LeavesEmissionAlone)
{
  Scene scene = Haze(0.7, 0.8);
  const double scattered = Seen(this->GetDevice(), scene, 0.4);
  scene.emission = scene.Everywhere(0.3 / 8.0);
  EXPECT_NEAR(scattered + 0.3, Seen(this->GetDevice(), scene, 0.4), 1e-4);
}

TEST_F(ScatteringTowardsEye, LeavesShadowRaysAlone)
{
  Scene scene = Haze(0.7, 0.8);
  scene.fluenceDirect = scene.fluence;
  scene.illumination.lights.resize(1);
  scene.settings.shadowRays = true;
  const double with = Seen(this->GetDevice(), scene, 0.4);
  scene.meanDirection.clear();
  EXPECT_EQ(with, Seen(this->GetDevice(), scene, 0.4));
}

// Rays that have been bent see by the direction they have got.
TEST_F(ScatteringTowardsEye, IsThatOfTheBentRay)
{
  Scene scene(GridOf(60, 8, 32));
  scene.settings.imageSize = { 1, 1 };
  scene.ior = Layers(scene.grid, 1.0, 1.5, 27.0, 18.0);
  scene.g = 0.6;
  scene.fluence = scene.Everywhere(4.0 * Pi * 1.5 * 1.5);
  scene.sigma_s = AtCentres(scene.grid, [](double, double, double z) { return z < 0.4 ? 1e-3 : 0.0; });
  for (std::size_t voxel = 0; voxel < scene.grid.VoxelCount(); ++voxel)
  {
    scene.meanDirection.insert(scene.meanDirection.end(), { 0.0f, 0.0f, -1.0f });
  }
  const double slope = 0.7;
  const Camera camera = Along(scene.grid, { std::sin(slope), 0.0, -std::cos(slope) }, 1e-3);
  const double bent = scene.Seen(this->GetDevice(), camera).radiance[0];
  scene.g = 0.0;
  const double even = scene.Seen(this->GetDevice(), camera).radiance[0];
  const double cosine = std::sqrt(1.0 - std::pow(std::sin(slope) / 1.5, 2.0));
  EXPECT_NEAR(HenyeyGreensteinOf(0.6, -cosine), bent / even, 1e-4);
}
}
