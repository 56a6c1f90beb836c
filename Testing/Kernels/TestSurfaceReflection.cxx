#include "ViewScene.h"

using namespace tyndall;
using namespace viewing;

namespace
{
class SurfaceReflects : public DeviceTest
{
};

double Fresnel(double n1, double n2, double angle)
{
  const double in = std::cos(angle);
  const double sine = n1 * std::sin(angle) / n2;
  if (sine >= 1.0)
  {
    return 1.0;
  }
  const double out = std::sqrt(1.0 - sine * sine);
  const double s = (n1 * in - n2 * out) / (n1 * in + n2 * out);
  const double p = (n2 * in - n1 * out) / (n2 * in + n1 * out);
  return 0.5 * (s * s + p * p);
}

/// Glass of index n below air, before an environment that shines 1 from above and nothing from below.
Scene Pond(double n)
{
  Scene scene(GridOf(96, 12, 32));
  scene.settings.imageSize = { 5, 5 };
  scene.settings.surfaceReflection = SurfaceReflection::Fresnel;
  scene.ior = Layers(scene.grid, 1.0, n, 19.0, 15.0);
  scene.illumination.environment = DirectionEnvironment();
  for (std::size_t i = 0; i < scene.illumination.environment.radiance.size(); ++i)
  {
    const std::size_t row = i / (3 * 1024);
    scene.illumination.environment.radiance[i] = row >= 256 ? 1.0f : 0.0f;
  }
  return scene;
}

Camera Down(const Scene& scene, double degrees)
{
  const double slope = degrees * Pi / 180.0;
  return Along(scene.grid, { std::sin(slope), 0.0, -std::cos(slope) }, 0.2);
}

TEST_F(SurfaceReflects, AsFresnelSaysByAngle)
{
  for (const double n : { 1.2, 1.5 })
  {
    const Scene scene = Pond(n);
    for (const double degrees : { 0.0, 20.0, 40.0, 56.0, 65.0 })
    {
      const Picture picture = scene.Seen(this->GetDevice(), Down(scene, degrees));
      EXPECT_NEAR(Fresnel(1.0, n, degrees * Pi / 180.0), picture.radiance[3 * Middle(picture)], 2e-4)
        << n << " " << degrees;
    }
  }
}

TEST_F(SurfaceReflects, AFixedPart)
{
  Scene scene = Pond(1.4);
  scene.settings.surfaceReflection = SurfaceReflection::Fixed;
  scene.settings.surfaceReflectance = 0.3;
  for (const double degrees : { 0.0, 40.0 })
  {
    const Picture picture = scene.Seen(this->GetDevice(), Down(scene, degrees));
    EXPECT_NEAR(0.3, picture.radiance[3 * Middle(picture)], 1e-5);
  }
}

TEST_F(SurfaceReflects, NothingThatComesFromInside)
{
  Scene scene = Pond(1.4);
  scene.ior = Layers(scene.grid, 1.4, 1.0, 20.0, 13.0);
  EXPECT_EQ(0.0f, scene.Seen(this->GetDevice(), Down(scene, 0.0)).radiance[0]);
  scene.settings.surfaceReflection = SurfaceReflection::None;
  scene.ior = Layers(scene.grid, 1.0, 1.4, 20.0, 13.0);
  EXPECT_EQ(0.0f, scene.Seen(this->GetDevice(), Down(scene, 0.0)).radiance[0]);
}

TEST_F(SurfaceReflects, NothingWhereTheIndexIsConstant)
{
  Scene scene = Blobs();
  const Picture plain = scene.Seen(this->GetDevice());
  scene.settings.surfaceReflection = SurfaceReflection::Fixed;
  scene.ior = scene.Everywhere(1.5);
  EXPECT_EQ(plain.radiance, scene.Seen(this->GetDevice()).radiance);
  const std::vector<std::string> leftOut = scene.Caster(this->GetDevice()).LeftOut();
  EXPECT_NE(
    leftOut.end(), std::find(leftOut.begin(), leftOut.end(), "surface reflection: the refractive index is constant"));
}

// In fog the brightness of a mirror tells how far it is: exp(-2 sigma d).
TEST_F(SurfaceReflects, WhereTheIndexIsThatOfTheSurface)
{
  Scene scene = Pond(1.5);
  scene.ior = Layers(scene.grid, 1.0, 1.5, 26.0, 6.0);
  const double sigma = 0.05;
  scene.sigma_a = scene.Everywhere(sigma);
  scene.settings.surfaceReflection = SurfaceReflection::Fixed;
  scene.settings.surfaceReflectance = 1.0;
  for (const double step : { 0.5, 1.0, 2.3 })
  {
    scene.settings.stepSize = step;
    for (const double square : { 1.3, 1.625, 1.95 })
    {
      scene.settings.surfaceIndex = std::sqrt(square);
      const double height = 26.0 - 20.0 * (square - 1.0) / 1.25; // n^2 is linear in between
      const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 5.0));
      const double way = -0.5 * std::log(picture.radiance[3 * Middle(picture)]) / sigma;
      EXPECT_NEAR(32.0 - height, way, 2e-3) << step << " " << square;
      EXPECT_EQ(1.0f, picture.alpha[Middle(picture)]);
      const double half = std::log(2.0) / sigma; // of the light is lost before or at the mirror
      EXPECT_NEAR(5.0 + std::min(half, 32.0 - height), picture.depth[Middle(picture)], 2e-3) << step << " " << square;
    }
  }
}

TEST_F(SurfaceReflects, MidwayBetweenTheIndicesByDefault)
{
  Scene scene = Pond(1.5);
  scene.settings.surfaceReflection = SurfaceReflection::Fixed;
  scene.sigma_a = scene.Everywhere(0.05);
  const Picture automatic = scene.Seen(this->GetDevice(), Down(scene, 20.0));
  scene.settings.surfaceIndex = 1.25;
  EXPECT_LT(LargestDifference(automatic.radiance, scene.Seen(this->GetDevice(), Down(scene, 20.0)).radiance), 1e-6);
  scene.settings.surfaceIndex = 1.1;
  EXPECT_GT(LargestDifference(automatic.radiance, scene.Seen(this->GetDevice(), Down(scene, 20.0)).radiance), 1e-3);
}

// What the reflected rays and those that go on pass through does not depend on where steps happen to start.
TEST_F(SurfaceReflects, HalvingTheStepQuartersTheError)
{
  Scene scene = Pond(1.3);
  scene.settings.imageSize = { 40, 5 };
  scene.settings.surfaceReflection = SurfaceReflection::Fixed;
  scene.settings.surfaceReflectance = 0.5;
  scene.emission =
    AtCentres(scene.grid, [](double x, double, double z) { return 0.1 + 0.05 * std::sin(9.0 * x + 8.0 * z); });
  scene.sigma_a =
    AtCentres(scene.grid, [](double x, double, double z) { return 0.05 + 0.02 * std::cos(7.0 * x - 6.0 * z); });
  Camera camera = Down(scene, 30.0);
  camera.parallelScale = 2.0;
  EXPECT_GT(StepConvergence(this->GetDevice(), scene, camera, 3.0).order, 1.7);
}

// A mirror ball: parallel rays turn by pi - 2 asin(b).
TEST_F(SurfaceReflects, AMirrorBallShowsWhatIsBehindTheEye)
{
  std::vector<double> worst;
  for (const int edge : { 32, 64 })
  {
    Scene scene(GridOf(edge, edge, edge));
    scene.ior = Ball(scene.grid, 0.4, 1.5);
    scene.illumination.environment = DirectionEnvironment();
    scene.settings.imageSize = { 33, 33 };
    scene.settings.surfaceReflection = SurfaceReflection::Fixed;
    scene.settings.surfaceReflectance = 1.0;
    const double radius = 0.4 * edge;
    const Camera camera = Along(scene.grid, { 1.0, 0.0, 0.0 }, 0.7 * radius);
    const Picture picture = scene.Seen(this->GetDevice(), camera);
    worst.push_back(0.0);
    ForEveryPixel(picture, camera, [&](std::size_t pixel, const Ray& ray) {
      const double y = (ray.from[1] - 0.5 * edge) / radius, z = (ray.from[2] - 0.5 * edge) / radius;
      const double b = std::hypot(y, z);
      if (b < 0.7)
      {
        const double cosine = std::sqrt(1.0 - b * b);
        const Vec expected = { 1.0 - 2.0 * cosine * cosine, 2.0 * cosine * y, 2.0 * cosine * z };
        const Vec seen = SeenDirection(picture, pixel);
        for (int c = 0; c < 3; ++c)
        {
          worst.back() = std::max(worst.back(), std::abs(expected[c] - seen[c]));
        }
      }
    });
  }
  std::printf("mirror ball, largest error of a direction: %.3f on 32^3, %.3f on 64^3\n", worst[0], worst[1]);
  EXPECT_LT(worst[1], 0.6 * worst[0]);
}
}
