#include "ErrorWords.h"
#include "Light/LeftOut.h"
#include "ViewScene.h"

using namespace tyndall;
using namespace viewing;

namespace
{
class RefractiveView : public DeviceTest
{
};

/// Fog with lumps of glass in it that do not reach the faces.
Scene GlassInFog()
{
  Scene scene(GridOf(40, 33, 36));
  scene.ior = AtCentres(scene.grid, [](double x, double y, double z) {
    const double r = std::hypot(x - 0.5, y - 0.45, z - 0.55);
    return 1.0 +
      0.4 * std::exp(-40.0 * r * r) * (r < 0.35) * std::pow(std::cos(std::min(r / 0.35, 1.0) * Pi / 2.0), 2.0);
  });
  scene.sigma_s = AtCentres(scene.grid, [](double x, double y, double z) {
    return 0.03 * (1.2 + std::sin(7.0 * x) * std::sin(5.0 * y + 1.0) * std::sin(6.0 * z));
  });
  scene.fluence = AtCentres(scene.grid, [](double x, double y, double z) { return 1.0 + x + y * y + z; });
  scene.illumination.environment = SmoothEnvironment();
  return scene;
}

/// What lives in a furnace of radiance `l`: light and emission grow as n^2.
void HeatTo(Scene& scene, double l)
{
  scene.fluence = scene.Everywhere(4.0 * Pi * l);
  scene.emission = scene.Everywhere(0.0);
  const int components = scene.components;
  for (std::size_t voxel = 0; voxel < scene.ior.size(); ++voxel)
  {
    const float square = scene.ior[voxel] * scene.ior[voxel];
    scene.fluence[voxel] *= square;
    scene.emission[voxel] = static_cast<float>(l) * scene.sigma_a[components * voxel] * square;
  }
  scene.illumination = {};
  scene.illumination.sky = { l, l, l };
}

TEST_F(RefractiveView, ConstantIndexIsTheSamePictureToTheLastBit)
{
  Scene scene = Blobs();
  const Picture without = scene.Seen(this->GetDevice());
  scene.ior = scene.Everywhere(1.37);
  const Picture with = scene.Seen(this->GetDevice());
  EXPECT_EQ(without.radiance, with.radiance);
  EXPECT_EQ(without.alpha, with.alpha);
  EXPECT_EQ(without.depth, with.depth);
  const std::vector<std::string> leftOut = scene.Caster(this->GetDevice()).LeftOut();
  EXPECT_NE(leftOut.end(), std::find(leftOut.begin(), leftOut.end(), left_out::ConstantIndex));
}

TEST_F(RefractiveView, FurnaceLooksUniformWhateverTheIndexAndWhatReflects)
{
  for (const int components : { 1, 3 })
  {
    Scene scene = GlassInFog();
    scene.components = components;
    scene.sigma_s = Random(scene.grid.VoxelCount() * components, 0.4f, 1);
    scene.sigma_a = scene.Everywhere(0.0);
    for (std::size_t voxel = 0; voxel < scene.sigma_a.size(); ++voxel)
    {
      scene.sigma_a[voxel] = 0.02f * static_cast<float>(voxel % 7);
    }
    if (components == 3)
    {
      std::vector<float> grey;
      for (const float value : scene.sigma_a)
      {
        grey.insert(grey.end(), 3, value);
      }
      scene.sigma_a = grey;
    }
    HeatTo(scene, 1.7);
    for (const SurfaceReflection reflection :
      { SurfaceReflection::None, SurfaceReflection::Fresnel, SurfaceReflection::Fixed })
    {
      scene.settings.surfaceReflection = reflection;
      scene.settings.surfaceReflectance = 0.6;
      for (const double mirrored : { -1.0, 0.0, 0.3, 1.0 })
      {
        scene.settings.tableFace = mirrored < 0.0 ? -1 : 4;
        const double scattered = 1.0 - std::max(mirrored, 0.0);
        scene.settings.tableColor = { scattered, scattered, scattered };
        scene.settings.tableReflectance = std::max(mirrored, 0.0);
        const Picture picture = scene.Seen(this->GetDevice());
        for (const float value : picture.radiance)
        {
          ASSERT_NEAR(1.7, value, 2e-5) << static_cast<int>(reflection) << " " << mirrored;
        }
      }
    }
  }
}

// Also where the faces have an index of their own, and from inside the glass.
TEST_F(RefractiveView, RadianceGrowsAsTheSquareOfTheIndexWhereTheEyeIs)
{
  Scene scene = GlassInFog();
  scene.sigma_a = scene.sigma_s;
  HeatTo(scene, 1.0);
  Camera camera = scene.Framed();
  camera.position = { 20.0, 0.45 * 33, 0.55 * 36 };
  camera.focalPoint = { 30.0, 10.0, 15.0 };
  const Picture inside = scene.Seen(this->GetDevice(), camera);
  for (const float value : inside.radiance)
  {
    ASSERT_NEAR(1.4 * 1.4, value, 0.05); // the voxels' largest index is a little less
    ASSERT_NEAR(inside.radiance[0], value, 4e-5);
  }
}

/// Rays along a slope through layers whose index changes along z only.
class RefractiveViewOfLayers
  : public DeviceTest
  , public testing::WithParamInterface<double> // spacing along z
{
};

TEST_P(RefractiveViewOfLayers, ObeySnell)
{
  Scene scene(GridOf(80, 16, 32, { 1.0, 1.0, GetParam() }));
  scene.settings.imageSize = { 5, 5 };
  scene.settings.stepSize = 0.25;
  scene.illumination.environment = DirectionEnvironment();
  for (const double degrees : { 10.0, 35.0, 55.0 })
  {
    for (const double n : { 1.5, 1.2, 0.85 })
    {
      scene.ior = Layers(scene.grid, 1.0, n, 20.0, 13.0);
      const double slope = degrees * Pi / 180.0;
      const Picture picture =
        scene.Seen(this->GetDevice(), Along(scene.grid, { std::sin(slope), 0.0, -std::cos(slope) }, 0.3));
      const double across = std::sin(slope) / n;
      // Radiance is that of the index at the far face, which goes on behind it.
      const Vec seen = SeenDirection(picture, Middle(picture), 1.0 / (n * n));
      if (across < 1.0)
      {
        EXPECT_NEAR(across, seen[0], 3e-4) << degrees << " " << n;
        EXPECT_NEAR(-std::sqrt(1.0 - across * across), seen[2], 3e-4) << degrees << " " << n;
      }
      EXPECT_NEAR(0.0, seen[1], 2e-5);
    }
  }
}

TEST_P(RefractiveViewOfLayers, ReflectTotally)
{
  Scene scene(GridOf(80, 16, 32, { 1.0, 1.0, GetParam() }));
  scene.settings.imageSize = { 5, 5 };
  scene.illumination.environment = DirectionEnvironment();
  scene.ior = Layers(scene.grid, 1.5, 1.0, 14.0, 7.0);
  for (const double degrees : { 45.0, 55.0 })
  {
    const double slope = degrees * Pi / 180.0;
    const Picture picture =
      scene.Seen(this->GetDevice(), Along(scene.grid, { std::sin(slope), 0.0, -std::cos(slope) }, 0.3));
    const Vec seen = SeenDirection(picture, Middle(picture));
    EXPECT_NEAR(std::sin(slope), seen[0], 1e-3) << degrees;
    EXPECT_NEAR(std::cos(slope), seen[2], 1e-3) << degrees;
  }
}

INSTANTIATE_TEST_SUITE_P(Spacings, RefractiveViewOfLayers, testing::Values(1.0, 0.6));

// All rays of parallel light meet at the far pole and leave along (sqrt(1 - b^2), -b).
TEST_F(RefractiveView, LuneburgLensSendsParallelRaysWhereTheClosedFormSays)
{
  std::vector<double> worst;
  for (const int edge : { 48, 96 })
  {
    const double h = 2.2 / edge;
    Scene scene(GridOf(edge, edge, edge, { h, h, h }, { -1.1, -1.1, -1.1 }));
    scene.ior = AtCentres(scene.grid, [](double x, double y, double z) {
      const double r = 2.2 * std::hypot(x - 0.5, y - 0.5, z - 0.5);
      return std::sqrt(std::max(2.0 - r * r, 1.0));
    });
    scene.illumination.environment = DirectionEnvironment();
    scene.settings.imageSize = { 31, 31 };
    const Camera camera = Along(scene.grid, { 1.0, 0.0, 0.0 }, 0.9);
    const Picture picture = scene.Seen(this->GetDevice(), camera);
    worst.push_back(0.0);
    ForEveryPixel(picture, camera, [&](std::size_t pixel, const Ray& ray) {
      const double b = std::hypot(ray.from[1], ray.from[2]);
      if (b < 0.85)
      {
        const Vec expected = { std::sqrt(1.0 - b * b), -ray.from[1], -ray.from[2] };
        const Vec seen = SeenDirection(picture, pixel);
        for (int c = 0; c < 3; ++c)
        {
          worst.back() = std::max(worst.back(), std::abs(expected[c] - seen[c]));
        }
      }
    });
  }
  std::printf("Luneburg lens, largest error of a direction: %.2g on 48^3, %.2g on 96^3\n", worst[0], worst[1]);
  EXPECT_LT(worst[1], 6e-3);
  EXPECT_LT(worst[1], 0.6 * worst[0]);
}

/// Difference of deflection to two surfaces that refract as Snell has it, over impact parameters up to 0.8 radii: the
/// mean and the largest.
std::array<double, 2> DeflectionError(Device& device, int edge, double n)
{
  Scene scene(GridOf(edge, edge, edge));
  scene.ior = Ball(scene.grid, 0.4, n);
  scene.illumination.environment = DirectionEnvironment();
  scene.settings.imageSize = { 65, 65 };
  const double radius = 0.4 * edge;
  const Camera camera = Along(scene.grid, { 1.0, 0.0, 0.0 }, 0.8 * radius);
  const Picture picture = scene.Seen(device, camera);
  double sum = 0.0, largest = 0.0;
  int count = 0;
  ForEveryPixel(picture, camera, [&](std::size_t pixel, const Ray& ray) {
    const double y = ray.from[1] - 0.5 * edge, z = ray.from[2] - 0.5 * edge;
    const double b = std::hypot(y, z) / radius;
    if (b < 0.8)
    {
      const double deflection = 2.0 * (std::asin(b) - std::asin(b / n));
      const Vec seen = SeenDirection(picture, pixel);
      const double scale = b > 0.0 ? std::sin(deflection) / (b * radius) : 0.0;
      const double error = std::max({ std::abs(seen[0] - std::cos(deflection)), std::abs(seen[1] + y * scale),
        std::abs(seen[2] + z * scale) }); // upside down
      largest = std::max(largest, error);
      sum += error;
      ++count;
    }
  });
  return { sum / count, largest };
}

// The border's smoothing is the same number of voxels on every grid: its part of the ball shrinks with them.
TEST_F(RefractiveView, GlassBallTurnsTheEnvironmentUpsideDownAsSnellSays)
{
  std::vector<std::array<double, 2>> errors;
  for (const int edge : { 32, 64, 128 })
  {
    errors.push_back(DeflectionError(this->GetDevice(), edge, 1.5));
    std::printf(
      "glass ball on %d^3, error of a direction: mean %.4f, largest %.4f\n", edge, errors.back()[0], errors.back()[1]);
  }
  EXPECT_LT(errors[1][0], 0.7 * errors[0][0]);
  EXPECT_LT(errors[2][0], 0.7 * errors[1][0]);
  EXPECT_LT(errors[2][0], 0.005);
  EXPECT_LT(errors[2][1], 0.015);
}

// Straight through layers: the way is as long as it looks.
TEST_F(RefractiveView, ExtinctionAndDepthFollowTheWayNotTheTime)
{
  Scene scene(GridOf(12, 12, 40, { 1.0, 1.0, 0.5 }));
  scene.ior = Layers(scene.grid, 1.0, 1.6, 30.0, 8.0);
  const double sigma = 0.07;
  scene.sigma_a = scene.Everywhere(sigma);
  for (const double step : { 0.5, 1.7 })
  {
    scene.settings.stepSize = step;
    const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 5.0));
    EXPECT_NEAR(-std::expm1(-20.0 * sigma), picture.alpha[Middle(picture)], 1e-4);
    EXPECT_NEAR(5.0 + std::log(2.0) / sigma, picture.depth[Middle(picture)], 5e-3);
  }
}

TEST_F(RefractiveView, HalvingTheStepQuartersTheError)
{
  const Scene scene = GlassInFog();
  EXPECT_GT(StepConvergence(this->GetDevice(), scene, scene.Framed(), 4.0).order, 1.8);
}

TEST_F(RefractiveView, SkippingEmptyBricksChangesNothing)
{
  Scene scene(GridOf(50, 41, 37));
  scene.ior = Ball(scene.grid, 0.2, 1.4);
  scene.sigma_s = Blobs().sigma_s;
  scene.fluence = scene.Everywhere(2.0);
  scene.illumination.environment = SmoothEnvironment();
  const Picture skipping = scene.Seen(this->GetDevice());
  scene.settings.skipEmptyBricks = false;
  const Picture marching = scene.Seen(this->GetDevice());
  EXPECT_EQ(marching.radiance, skipping.radiance);
  EXPECT_EQ(marching.alpha, skipping.alpha);
  EXPECT_EQ(marching.depth, skipping.depth);
}

TEST_F(RefractiveView, PacketsOfEveryWidthGiveTheSamePicture)
{
  Scene scene = GlassInFog();
  scene.g = 0.4;
  for (std::size_t voxel = 0; voxel < scene.grid.VoxelCount(); ++voxel)
  {
    scene.meanDirection.insert(scene.meanDirection.end(), { 0.3f, 0.1f, -0.8f });
  }
  scene.settings.surfaceReflection = SurfaceReflection::Fresnel;
  scene.settings.tableFace = 4;
  // Packets change from straight to bent steps together, which rounds their samples' places another way.
  ExpectSameInPackets(this->GetDevice(), scene, scene.Framed(), 5e-5, 1e-5);
}

TEST_F(RefractiveView, AdoptsWhatNeedsNothingNewOnTheDevice)
{
  Scene scene = GlassInFog();
  scene.settings.tableFace = 4;
  MediumRayCaster kept = scene.Caster(this->GetDevice());
  kept.Render(scene.Framed());
  scene.settings.surfaceReflection = SurfaceReflection::Fixed;
  scene.settings.surfaceReflectance = 0.4;
  scene.settings.surfaceIndex = 1.1;
  scene.settings.tableColor = { 0.1, 0.2, 0.3 };
  scene.settings.tableReflectance = 0.5;
  ASSERT_TRUE(kept.Adopt(scene.settings));
  EXPECT_EQ(scene.Seen(this->GetDevice()).radiance, kept.Render(scene.Framed()).radiance);
  MediumRayCaster fresh = scene.Caster(this->GetDevice());
  fresh.Render(scene.Framed());
  EXPECT_EQ(fresh.LeftOut(), kept.LeftOut());
  scene.settings.tableFace = 2;
  EXPECT_FALSE(kept.Adopt(scene.settings));
}

TEST_F(RefractiveView, GivesItsMemoryBack)
{
  const std::size_t before = this->GetDevice().BytesInUse();
  GlassInFog().Seen(this->GetDevice());
  EXPECT_EQ(before, this->GetDevice().BytesInUse());
}

TEST_F(RefractiveView, RefusesWhatHasNoMeaning)
{
  const auto refused = [&](const char* named, auto change) {
    Scene scene = GlassInFog();
    change(scene);
    const std::string words = ErrorWords([&] { scene.Seen(this->GetDevice()); });
    EXPECT_NE(std::string::npos, words.find(named)) << words;
  };
  refused("ior", [](Scene& scene) { scene.ior[7] = NAN; });
  refused("ior", [](Scene& scene) { scene.ior[7] = INFINITY; });
  refused("ior", [](Scene& scene) { scene.ior[7] = 5e-4f; });
  refused("ior", [](Scene& scene) { scene.ior[7] = -1.0f; });
  refused("mean_direction", [](Scene& scene) {
    scene.meanDirection.assign(3 * scene.grid.VoxelCount(), 0.0f);
    scene.meanDirection[10] = NAN;
  });
  refused("surface", [](Scene& scene) { scene.settings.surfaceIndex = -0.5; });
  refused("surface", [](Scene& scene) { scene.settings.surfaceIndex = NAN; });
  refused("surface", [](Scene& scene) { scene.settings.surfaceReflectance = 1.5; });
  refused("Surface", [](Scene& scene) { scene.settings.surfaceReflection = static_cast<SurfaceReflection>(7); });
  refused("table", [](Scene& scene) { scene.settings.tableFace = 6; });
  refused("table", [](Scene& scene) { scene.settings.tableFace = -2; });
  refused("table", [](Scene& scene) { scene.settings.tableColor = { 0.5, -0.1, 0.5 }; });
  refused("table", [](Scene& scene) { scene.settings.tableReflectance = NAN; });
  refused("table", [](Scene& scene) { scene.settings.tableReflectance = 0.5; }); // and 0.6 is scattered
}
}
