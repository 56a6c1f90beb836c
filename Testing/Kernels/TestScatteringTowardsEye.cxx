#include "ViewScene.h"

#include "Numerics/Legendre.h"

using namespace tyndall;
using namespace viewing;

namespace
{
class ScatteringTowardsEye : public DeviceTest
{
};

/// Thin haze in light of mean direction x and anisotropy a.
Scene Haze(double g, double a)
{
  Scene scene(GridOf(8, 8, 8));
  scene.settings.imageSize = { 1, 1 };
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
double Seen(Device& device, const Scene& scene, double cosine, int channel = 0)
{
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const Camera camera = Along(scene.grid, { -cosine, 0.0, sine }, 1e-3); // against the light that leaves
  const Picture picture = scene.Seen(device, camera);
  return picture.radiance[channel] * 8.0 / Chord(RayThrough(camera, picture, 0, 0), scene.grid);
}

double HenyeyGreensteinOf(double g, double cosine)
{
  return (1.0 - g * g) / std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5);
}

Scene Haze(const PhaseOfMedium& phase, double a)
{
  Scene scene = Haze(0.0, a);
  scene.phase = phase;
  return scene;
}

/// A table that a function could be printed as, in steps of half a degree.
PhaseFunction Printed(const PhaseFunction& function)
{
  std::vector<double> cosines, values;
  for (int step = 0; step <= 360; ++step)
  {
    cosines.push_back(std::cos(step * Pi / 360.0));
    values.push_back(function.Value(cosines.back()));
  }
  return PhaseFunction::Tabulated(cosines, values);
}

/// Every kind there is, with light of one direction.
std::vector<PhaseFunction> AllKinds()
{
  return { PhaseFunction::HenyeyGreenstein(0.85), PhaseFunction::HenyeyGreenstein(-0.5),
    PhaseFunction::DoubleHenyeyGreenstein(0.8, -0.4, 0.7), PhaseFunction::Schlick(0.75), PhaseFunction::Schlick(-0.3),
    PhaseFunction::Rayleigh(), Printed(PhaseFunction::DoubleHenyeyGreenstein(0.7, -0.5, 0.8)) };
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
      }
    }
  }
}

TEST_F(ScatteringTowardsEye, ShowsEveryKindAsItIsInLightOfOneDirection)
{
  for (const PhaseFunction& function : AllKinds())
  {
    for (const double cosine : { 0.999, 0.8, 0.1, -0.6, -0.99 })
    {
      const double expected = 4.0 * Pi * function.Value(cosine);
      EXPECT_NEAR(Seen(this->GetDevice(), Haze(function, 1.0), cosine), expected, 2e-4 * expected)
        << static_cast<int>(function.TheKind()) << " at " << cosine;
    }
  }
}

// Light that is spread about its direction scatters by moments that are products, and keeps what it has.
TEST_F(ScatteringTowardsEye, HasTheMomentsOfLightAndFunctionTogether)
{
  const GaussLegendre rule(16);
  const double a = 0.5;
  for (const PhaseFunction& function : AllKinds())
  {
    const Scene scene = Haze(function, a);
    const std::vector<double> chi = function.Moments(2);
    std::array<double, 3> seen = {};
    for (std::size_t i = 0; i < rule.points.size(); ++i)
    {
      const double value = Seen(this->GetDevice(), scene, rule.points[i]);
      const std::vector<double> p = LegendrePolynomials(2, rule.points[i]);
      for (int l = 0; l <= 2; ++l)
      {
        seen[l] += 0.5 * rule.weights[i] * value * p[l];
      }
    }
    const bool schlick =
      function.TheKind() == PhaseFunction::Kind::Schlick; // which stays Schlick's, of mean cosine g a
    EXPECT_NEAR(seen[0], 1.0, 5e-4) << static_cast<int>(function.TheKind());
    EXPECT_NEAR(seen[1], a * chi[1], 5e-4) << static_cast<int>(function.TheKind());
    EXPECT_NEAR(seen[2], a * a * chi[2], schlick ? 0.05 : 5e-4) << static_cast<int>(function.TheKind());
  }
}

TEST_F(ScatteringTowardsEye, ATableIsSeenAsWhatItSamples)
{
  const PhaseFunction function = PhaseFunction::HenyeyGreenstein(0.7);
  for (const double a : { 0.0, 0.3, 0.8, 0.97 })
  {
    for (const double cosine : { 1.0, 0.7, -0.2, -1.0 })
    {
      const double expected = HenyeyGreensteinOf(0.7 * a, cosine);
      EXPECT_NEAR(Seen(this->GetDevice(), Haze(Printed(function), a), cosine), expected, 1e-3 * expected)
        << a << " " << cosine;
    }
  }
}

TEST_F(ScatteringTowardsEye, IsThatOfEachChannel)
{
  const std::array<PhaseFunction, 3> alike = { PhaseFunction::HenyeyGreenstein(0.3),
    PhaseFunction::HenyeyGreenstein(0.6), PhaseFunction() };
  const std::array<PhaseFunction, 3> schlick = { PhaseFunction::Schlick(0.3), PhaseFunction::Schlick(-0.6),
    PhaseFunction::Schlick(0.0) };
  const std::array<PhaseFunction, 3> mixed = { PhaseFunction::Rayleigh(), PhaseFunction::HenyeyGreenstein(0.6),
    PhaseFunction::Schlick(0.2) };
  for (const std::array<PhaseFunction, 3>& functions : { alike, schlick, mixed })
  {
    const Scene scene = Haze(PhaseOfMedium(functions), 1.0);
    for (int c = 0; c < 3; ++c)
    {
      const double expected = 4.0 * Pi * functions[c].Value(-0.4);
      EXPECT_NEAR(Seen(this->GetDevice(), scene, -0.4, c), expected, 3e-4 * expected) << c;
    }
  }
}

// Parallel rays through two halves of a box.
TEST_F(ScatteringTowardsEye, IsThatOfEachVoxel)
{
  for (const PhaseFunction& kind : { PhaseFunction::HenyeyGreenstein(0.0), PhaseFunction::Schlick(0.0) })
  {
    for (const int components : { 1, 3 })
    {
      Scene scene = Haze(0.0, 1.0);
      std::vector<float> g;
      for (std::size_t i = 0; i < scene.grid.VoxelCount() * components; ++i)
      {
        g.push_back((i / components % 8 < 4 ? 0.7f : -0.2f) * (i % components == 1 ? 0.5f : 1.0f));
      }
      scene.phase = PhaseOfMedium(kind, Field{ g.data(), components });
      scene.settings.imageSize = { 8, 1 };
      const Camera camera = Along(scene.grid, { 0.0, 1.0, 0.0 }, 0.5); // from the side, x to the right
      const Picture picture = scene.Seen(this->GetDevice(), camera);
      for (int c = 0; c < components; ++c)
      {
        for (const int pixel : { 1, 6 })
        {
          const double expected = 4.0 * Pi * scene.phase->At(pixel, c).Value(0.0);
          EXPECT_NEAR(picture.radiance[3 * pixel + c], expected, 3e-4 * expected) << components << " " << pixel;
        }
      }
    }
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
  for (const PhaseFunction& function : { PhaseFunction::HenyeyGreenstein(0.9999999), PhaseFunction::Schlick(0.9999999),
         PhaseFunction::DoubleHenyeyGreenstein(0.9999999, -0.9999999, 0.5),
         PhaseFunction::Tabulated({ -1.0, 0.9999999, 1.0 }, { 0.0, 0.0, 1.0 }) })
  {
    for (const double cosine : { 1.0, -1.0 })
    {
      const double seen = Seen(this->GetDevice(), Haze(function, 5.0), cosine);
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
