#include "DeviceTest.h"

#include "Viewing/MediumRayCaster.h"
#include "Viewing/ToneMapping.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace tyndall;

namespace
{
constexpr double Pi = 3.14159265358979323846;
using Vec = std::array<double, 3>;

/// A medium that owns its arrays.
struct Scene
{
  Grid grid;
  std::vector<float> sigma_a, sigma_s, emission, fluence, fluenceDirect;
  int components = 1; ///< of sigma_a and sigma_s
  double g = 0.0;
  Illumination illumination;
  ViewSettings settings;

  explicit Scene(const Grid& g = {})
    : grid(g)
  {
    this->settings.imageSize = { 61, 43 };
    this->settings.minimumTransmittance = 0.0;
  }

  std::vector<float> Everywhere(double value) const
  {
    return std::vector<float>(this->grid.VoxelCount(), static_cast<float>(value));
  }

  static Field See(const std::vector<float>& values, int components)
  {
    return { values.empty() ? nullptr : values.data(), components };
  }

  MediumRayCaster Caster(Device& device) const
  {
    Medium medium;
    medium.grid = this->grid;
    medium.sigma_a = See(this->sigma_a, this->components);
    medium.sigma_s = See(this->sigma_s, this->components);
    medium.emission = See(this->emission, 1);
    medium.g = this->g;
    return { device, medium, { See(this->fluence, 1), See(this->fluenceDirect, 1) }, this->illumination,
      this->settings };
  }

  double Aspect() const { return static_cast<double>(this->settings.imageSize[0]) / this->settings.imageSize[1]; }
  Camera Framed() const { return FrameGrid(this->grid, this->Aspect()); }
  Picture Seen(Device& device, const Camera& camera) const { return this->Caster(device).Render(camera); }
  Picture Seen(Device& device) const { return this->Seen(device, this->Framed()); }
};

Grid GridOf(int nx, int ny, int nz, Vec spacing = { 1.0, 1.0, 1.0 }, Vec origin = { 0.0, 0.0, 0.0 })
{
  Grid grid;
  grid.size = { nx, ny, nz };
  grid.spacing = spacing;
  grid.origin = origin;
  return grid;
}

/// The ray through a pixel's centre, in double: where it starts, and its direction of unit length.
struct Ray
{
  Vec from, direction;
};

Ray RayThrough(const Camera& camera, const Picture& picture, int i, int j)
{
  const auto axes = Axes(camera);
  const double half = camera.parallelProjection ? camera.parallelScale : std::tan(camera.viewAngle * Pi / 360.0);
  const double x = ((i + 0.5) / picture.width * 2.0 - 1.0) * half * picture.width / picture.height;
  const double y = ((j + 0.5) / picture.height * 2.0 - 1.0) * half;
  Ray ray = { camera.position, axes[2] };
  for (int axis = 0; axis < 3; ++axis)
  {
    (camera.parallelProjection ? ray.from : ray.direction)[axis] += x * axes[0][axis] + y * axes[1][axis];
  }
  const double length = std::hypot(ray.direction[0], ray.direction[1], ray.direction[2]);
  for (double& component : ray.direction)
  {
    component /= length;
  }
  return ray;
}

/// Length of the ray's part in the grid's box.
double Chord(const Ray& ray, const Grid& grid)
{
  double in = 0.0;
  double out = 1e300;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double a = (grid.origin[axis] - ray.from[axis]) / ray.direction[axis];
    const double b = a + grid.Length(axis) / ray.direction[axis];
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return std::max(out - in, 0.0);
}

/// Calls check(pixel, ray) for every pixel.
template <class Check>
void ForEveryPixel(const Picture& picture, const Camera& camera, const Check& check)
{
  for (int j = 0; j < picture.height; ++j)
  {
    for (int i = 0; i < picture.width; ++i)
    {
      check(static_cast<std::size_t>(j) * picture.width + i, RayThrough(camera, picture, i, j));
    }
  }
}

/// The largest difference of two arrays.
double Distance(const std::vector<float>& a, const std::vector<float>& b)
{
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
  {
    largest = std::max(largest, std::abs(static_cast<double>(a[i]) - b[i]));
  }
  return largest;
}

std::vector<float> Random(std::size_t count, float largest, unsigned seed)
{
  std::mt19937 generator(seed);
  std::vector<float> values(count);
  for (float& value : values)
  {
    value = largest * static_cast<float>(generator() % 10000) / 10000.0f;
  }
  return values;
}

/// value(x, y, z) at the voxels' centres, in units of the box.
template <class Function>
std::vector<float> AtCentres(const Grid& grid, const Function& value)
{
  std::vector<float> values;
  values.reserve(grid.VoxelCount());
  for (int k = 0; k < grid.size[2]; ++k)
  {
    for (int j = 0; j < grid.size[1]; ++j)
    {
      for (int i = 0; i < grid.size[0]; ++i)
      {
        values.push_back(
          static_cast<float>(value((i + 0.5) / grid.size[0], (j + 0.5) / grid.size[1], (k + 0.5) / grid.size[2])));
      }
    }
  }
  return values;
}

/// Some blobs in a large void.
Scene Blobs()
{
  Scene scene(GridOf(50, 41, 37));
  scene.sigma_s = AtCentres(scene.grid, [](double x, double y, double z) {
    return std::max(0.0, std::sin(9.0 * x) * std::sin(8.0 * y) * std::sin(7.0 * z) - 0.6);
  });
  scene.sigma_a = scene.sigma_s;
  scene.fluence = Random(scene.grid.VoxelCount(), 5.0f, 3);
  scene.illumination.sky = { 0.2, 0.3, 0.4 };
  return scene;
}

Camera FromAbove(const Grid& grid, double height)
{
  Camera camera = FrameGrid(grid, 1.0, 30.0, { 0.0, 0.0, 1.0 }, { 0.0, 1.0, 0.0 });
  camera.position[2] = grid.origin[2] + grid.Length(2) + height;
  camera.parallelProjection = true;
  return camera;
}

std::size_t Middle(const Picture& picture)
{
  return static_cast<std::size_t>(picture.height / 2) * picture.width + picture.width / 2;
}

Environment SmoothEnvironment()
{
  Environment environment;
  environment.width = 32;
  environment.height = 16;
  for (int j = 0; j < 16; ++j)
  {
    for (int i = 0; i < 32; ++i)
    {
      const double azimuth = 2.0 * Pi * (i + 0.5) / 32;
      environment.radiance.push_back(static_cast<float>(2.0 + std::sin(azimuth)));
      environment.radiance.push_back(static_cast<float>(2.0 + std::cos(azimuth)));
      environment.radiance.push_back(static_cast<float>(1.0 + j));
    }
  }
  return environment;
}

class MediumRayCasterTest : public DeviceTest
{
};

TEST_F(MediumRayCasterTest, VacuumShowsTheBackgroundColourExactly)
{
  Scene scene(GridOf(5, 6, 7));
  scene.settings.backgroundColor = { 0.25, 0.5, 3.0 };
  const Picture picture = scene.Seen(this->GetDevice());
  for (std::size_t pixel = 0; pixel < picture.alpha.size(); ++pixel)
  {
    EXPECT_EQ(0.25f, picture.radiance[3 * pixel]);
    EXPECT_EQ(0.5f, picture.radiance[3 * pixel + 1]);
    EXPECT_EQ(3.0f, picture.radiance[3 * pixel + 2]);
    EXPECT_EQ(0.0f, picture.alpha[pixel]);
    EXPECT_EQ(picture.farDepth, picture.depth[pixel]);
  }
}

TEST_F(MediumRayCasterTest, VacuumShowsTheEnvironmentInEveryDirection)
{
  Scene scene(GridOf(4, 4, 4));
  scene.illumination.environment = SmoothEnvironment();
  scene.illumination.sky = { 0.5, 0.0, 0.0 };
  const std::vector<Vec> directions = { { 1, 0.1, 0.2 }, { -1, 0.01, 0 }, { -1, -0.01, 0 }, { 0.1, 1, -3 },
    { 0.01, 0.02, 1 }, { 0.01, 0, -1 } };
  for (const Vec& towards : directions)
  {
    Camera camera;
    camera.position = { 2, 2, 2 }; // inside the medium
    camera.focalPoint = { 2 + towards[0], 2 + towards[1], 2 + towards[2] };
    camera.viewUp = { 0, 1, 0.3 };
    camera.viewAngle = 70.0;
    const Picture picture = scene.Seen(this->GetDevice(), camera);
    ForEveryPixel(picture, camera, [&](std::size_t pixel, const Ray& ray) {
      const Rgb expected = Lookup(scene.illumination.environment, ray.direction);
      EXPECT_NEAR(expected[0] + 0.5, picture.radiance[3 * pixel], 2e-5);
      EXPECT_NEAR(expected[1], picture.radiance[3 * pixel + 1], 2e-5);
      EXPECT_NEAR(expected[2], picture.radiance[3 * pixel + 2], 1e-4);
    });
  }
}

TEST_F(MediumRayCasterTest, BackgroundIsSeenThroughTheMediumAndCanBeLeftOut)
{
  Scene scene(GridOf(6, 6, 6));
  scene.sigma_a = scene.Everywhere(0.1);
  scene.illumination.sky = { 2.0, 2.0, 2.0 };
  const Picture with = scene.Seen(this->GetDevice());
  scene.settings.showBackground = false;
  const Picture without = scene.Seen(this->GetDevice());
  EXPECT_EQ(with.alpha, without.alpha);
  for (std::size_t pixel = 0; pixel < with.alpha.size(); ++pixel)
  {
    EXPECT_NEAR(2.0 * (1.0 - with.alpha[pixel]), with.radiance[3 * pixel], 1e-6);
    EXPECT_EQ(0.0f, without.radiance[3 * pixel]);
  }
}

/// Every odd grid: one voxel, flat, unequal spacing, far away.
class MediumRayCasterGrids
  : public DeviceTest
  , public testing::WithParamInterface<Grid>
{
};

TEST_P(MediumRayCasterGrids, HomogeneousAbsorberFollowsBeerAndLambert)
{
  Scene scene(GetParam());
  for (double step : { 0.37, 1.0, 3.0 })
  {
    scene.settings.stepSize = step;
    Camera camera = scene.Framed();
    const double diagonal = std::hypot(scene.grid.Length(0), scene.grid.Length(1), scene.grid.Length(2));
    for (double thickness : { 0.0, 0.01, 3.0, 50.0 })
    {
      const double sigma = thickness / diagonal;
      scene.sigma_a = scene.Everywhere(0.25 * sigma);
      scene.sigma_s = scene.Everywhere(0.75 * sigma);
      for (bool parallel : { false, true })
      {
        camera.parallelProjection = parallel;
        const Picture picture = scene.Seen(this->GetDevice(), camera);
        ForEveryPixel(picture, camera, [&](std::size_t pixel, const Ray& ray) {
          EXPECT_NEAR(-std::expm1(-sigma * Chord(ray, scene.grid)), picture.alpha[pixel], 1e-5 * (1.0 + thickness));
        });
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, MediumRayCasterGrids,
  testing::Values(GridOf(20, 20, 20), GridOf(1, 1, 1), GridOf(1, 7, 5), GridOf(9, 1, 1),
    GridOf(17, 5, 11, { 1, 2, 0.3 }), GridOf(8, 9, 10, { 1e-3, 1e-3, 2e-3 }, { 100.0, -50.0, 3.0 })));

TEST_F(MediumRayCasterTest, HomogeneousEmitterFollowsTheClosedForm)
{
  for (double sigma : { 0.0, 1e-6, 0.2, 40.0 })
  {
    Scene scene(GridOf(12, 10, 14, { 0.5, 0.5, 0.5 }));
    scene.sigma_a = scene.Everywhere(sigma);
    scene.emission = scene.Everywhere(0.7);
    const Camera camera = scene.Framed();
    const Picture picture = scene.Seen(this->GetDevice(), camera);
    ForEveryPixel(picture, camera, [&](std::size_t pixel, const Ray& ray) {
      const double chord = Chord(ray, scene.grid);
      const double expected = sigma > 0.0 ? 0.7 * -std::expm1(-sigma * chord) / sigma : 0.7 * chord;
      EXPECT_NEAR(expected, picture.radiance[3 * pixel], 2e-5 * expected + 5e-6);
    });
  }
}

TEST_F(MediumRayCasterTest, FurnaceLooksUniform)
{
  const double radiance = 1.7;
  for (int components : { 1, 3 })
  {
    Scene scene(GridOf(23, 18, 15));
    scene.components = components;
    scene.sigma_s = Random(scene.grid.VoxelCount() * components, 3.0f, 1);
    scene.sigma_a = Random(scene.grid.VoxelCount(), 0.5f, 2);
    scene.emission = scene.sigma_a;
    for (float& value : scene.emission)
    {
      value *= static_cast<float>(radiance);
    }
    if (components == 3)
    {
      std::vector<float> colours;
      for (float value : scene.sigma_a)
      {
        colours.insert(colours.end(), 3, value);
      }
      scene.sigma_a = colours;
    }
    scene.fluence = scene.Everywhere(4.0 * Pi * radiance);
    scene.illumination.sky = { radiance, radiance, radiance };
    const Picture picture = scene.Seen(this->GetDevice());
    for (float value : picture.radiance)
    {
      EXPECT_NEAR(radiance, value, 1e-5 * radiance);
    }
  }
}

TEST_F(MediumRayCasterTest, HalvingTheStepQuartersTheError)
{
  Scene scene(GridOf(32, 32, 32));
  const auto bump = [](double x, double y, double z) {
    return std::exp(-12.0 * ((x - 0.5) * (x - 0.5) + (y - 0.4) * (y - 0.4) + (z - 0.6) * (z - 0.6)));
  };
  scene.sigma_s = AtCentres(scene.grid, [&](double x, double y, double z) { return 0.3 * bump(x, y, z); });
  scene.fluence = AtCentres(scene.grid, [](double x, double y, double z) { return 1.0 + x + y * y + z; });
  const auto seenWith = [&](double step) {
    scene.settings.stepSize = step;
    return scene.Seen(this->GetDevice()).radiance;
  };
  const std::vector<float> exact = seenWith(0.05);
  const double coarse = Distance(exact, seenWith(4.0));
  const double fine = Distance(exact, seenWith(1.0));
  const double order = 0.5 * std::log2(coarse / fine);
  std::printf("order of convergence %.2f, error at one voxel a step %.2g of %.2g\n", order, fine,
    static_cast<double>(*std::max_element(exact.begin(), exact.end())));
  this->RecordProperty("order", std::to_string(order));
  EXPECT_GT(order, 1.7);
  EXPECT_LT(fine, 5e-4 * *std::max_element(exact.begin(), exact.end()));
}

TEST_F(MediumRayCasterTest, MirroredSceneGivesMirroredPicture)
{
  Scene scene(GridOf(16, 11, 13));
  scene.sigma_s = Random(scene.grid.VoxelCount(), 0.4f, 4);
  scene.fluence = Random(scene.grid.VoxelCount(), 2.0f, 5);
  const Camera camera = scene.Framed();
  const Picture seen = scene.Seen(this->GetDevice(), camera);

  const auto mirror = [&](std::vector<float>& values) {
    for (auto row = values.begin(); row != values.end(); row += scene.grid.size[0])
    {
      std::reverse(row, row + scene.grid.size[0]);
    }
  };
  mirror(scene.sigma_s);
  mirror(scene.fluence);
  Camera mirrored = camera;
  mirrored.position[0] = scene.grid.Length(0) - camera.position[0];
  const Picture other = scene.Seen(this->GetDevice(), mirrored);
  for (int j = 0; j < seen.height; ++j)
  {
    for (int i = 0; i < seen.width; ++i)
    {
      const std::size_t here = 3 * (static_cast<std::size_t>(j) * seen.width + i);
      const std::size_t there = 3 * (static_cast<std::size_t>(j) * seen.width + seen.width - 1 - i);
      EXPECT_NEAR(seen.radiance[here], other.radiance[there], 2e-5);
    }
  }
}

TEST_F(MediumRayCasterTest, SkippingEmptyBricksChangesNothing)
{
  Scene scene = Blobs();
  const Picture skipping = scene.Seen(this->GetDevice());
  scene.settings.skipEmptyBricks = false;
  const Picture marching = scene.Seen(this->GetDevice());
  EXPECT_EQ(marching.radiance, skipping.radiance);
  EXPECT_EQ(marching.alpha, skipping.alpha);
  EXPECT_EQ(marching.depth, skipping.depth);
  EXPECT_GT(*std::max_element(skipping.alpha.begin(), skipping.alpha.end()), 0.5f);
}

TEST_F(MediumRayCasterTest, PacketsOfEveryWidthGiveTheSamePicture)
{
  Scene scene = Blobs();
  scene.illumination.environment = SmoothEnvironment();
  const Picture best = scene.Seen(this->GetDevice());
  for (int width : { 1, 4, 8, 16 })
  {
    scene.settings.packetWidth = width;
    const Picture picture = scene.Seen(this->GetDevice());
    EXPECT_LT(Distance(best.radiance, picture.radiance), 1e-6) << width;
    EXPECT_LT(Distance(best.alpha, picture.alpha), 1e-6) << width;
    EXPECT_LT(Distance(best.depth, picture.depth), 1e-3) << width;
  }
}

TEST_F(MediumRayCasterTest, TheSameAgainToTheLastBit)
{
  const Scene scene = Blobs();
  MediumRayCaster caster = scene.Caster(this->GetDevice());
  EXPECT_EQ(caster.Render(scene.Framed()).radiance, caster.Render(scene.Framed()).radiance);
  EXPECT_EQ(caster.Render(scene.Framed()).radiance, scene.Seen(this->GetDevice()).radiance);
}

// A caster that is kept shows what a new one would.
TEST_F(MediumRayCasterTest, AdoptsWhatNeedsNothingNewOnTheDevice)
{
  for (bool shadowRays : { false, true })
  {
    Scene scene = Blobs();
    scene.illumination.sky = { 0.0, 0.0, 0.0 };
    scene.fluenceDirect = scene.Everywhere(0.1);
    scene.illumination.lights.resize(1);
    scene.settings.shadowRays = shadowRays;
    MediumRayCaster kept = scene.Caster(this->GetDevice());
    const Picture before = kept.Render(scene.Framed());
    scene.settings.imageSize = { 40, 52 };
    scene.settings.stepSize = 0.8;
    scene.settings.backgroundColor = { 0.1, 0.2, 0.3 };
    scene.settings.minimumTransmittance = 0.1;
    ASSERT_TRUE(kept.Adopt(scene.settings));
    const Picture after = kept.Render(scene.Framed());
    const Picture fresh = scene.Seen(this->GetDevice());
    EXPECT_EQ(fresh.radiance, after.radiance);
    EXPECT_EQ(fresh.alpha, after.alpha);
    EXPECT_EQ(fresh.depth, after.depth);
    EXPECT_NE(before.radiance.size(), after.radiance.size());

    ViewSettings other = scene.settings;
    other.singleScatteringOnly = true;
    other.imageSize = { 3, 3 };
    EXPECT_FALSE(kept.Adopt(other));
    EXPECT_EQ(fresh.radiance, kept.Render(scene.Framed()).radiance);
    other = scene.settings;
    other.stepSize = -1.0;
    EXPECT_THROW(kept.Adopt(other), InvalidInput);
    EXPECT_EQ(fresh.radiance, kept.Render(scene.Framed()).radiance);
  }
}

// Steps of an optical length up to 2 are crossed another way than longer ones, if there are no longer ones: an opaque voxel
// that nobody sees decides.
TEST_F(MediumRayCasterTest, ThinAndThickStepsAgree)
{
  for (int components : { 1, 3 })
  {
    Scene scene(GridOf(20, 20, 20));
    scene.components = components;
    scene.settings.stepSize = 1.0;
    scene.sigma_a = Random(components * scene.grid.VoxelCount(), 1.99f, 6); // of a step: a voxel is 1 long
    scene.emission = Random(scene.grid.VoxelCount(), 1.0f, 7);
    const Camera above = FromAbove(scene.grid, 5.0);
    const Picture thin = scene.Seen(this->GetDevice(), above);
    scene.sigma_a[0] = 50.0f; // at the bottom
    const Picture thick = scene.Seen(this->GetDevice(), above);
    EXPECT_LT(Distance(thin.alpha, thick.alpha), 1e-6);
    EXPECT_LT(Distance(thin.radiance, thick.radiance), 2e-6);
    EXPECT_LT(Distance(thin.depth, thick.depth), 1e-4);
  }
}

TEST_F(MediumRayCasterTest, GreyAndColouredExtinctionAgree)
{
  Scene scene = Blobs();
  const Picture grey = scene.Seen(this->GetDevice());
  const auto colour = [&](const std::vector<float>& values, Rgb factor) {
    std::vector<float> coloured;
    for (float value : values)
    {
      for (double channel : factor)
      {
        coloured.push_back(static_cast<float>(channel) * value);
      }
    }
    return coloured;
  };
  const std::vector<float> scattering = scene.sigma_s;
  scene.components = 3;
  scene.sigma_s = scene.sigma_a = colour(scattering, { 1.0, 1.0, 1.0 });
  const Picture same = scene.Seen(this->GetDevice());
  EXPECT_LT(Distance(grey.radiance, same.radiance), 1e-6);
  EXPECT_LT(Distance(grey.alpha, same.alpha), 1e-6);
  EXPECT_LT(Distance(grey.depth, same.depth), 1e-3);

  // Each channel sees its own extinction, as if it were alone.
  scene.sigma_s = scene.sigma_a = colour(scattering, { 0.5, 1.0, 4.0 });
  const Picture coloured = scene.Seen(this->GetDevice());
  for (int c = 0; c < 3; ++c)
  {
    Scene alone = Blobs();
    for (std::size_t voxel = 0; voxel < scattering.size(); ++voxel)
    {
      alone.sigma_s[voxel] = alone.sigma_a[voxel] = scene.sigma_s[3 * voxel + c];
    }
    const Picture picture = alone.Seen(this->GetDevice());
    for (std::size_t pixel = 0; pixel < picture.alpha.size(); ++pixel)
    {
      EXPECT_NEAR(picture.radiance[3 * pixel + c], coloured.radiance[3 * pixel + c], 1e-6);
    }
  }
}

TEST_F(MediumRayCasterTest, DepthIsWhereHalfTheLightIsLeft)
{
  Scene scene(GridOf(16, 16, 64));
  const double sigma = 0.11;
  scene.sigma_a = scene.Everywhere(sigma);
  const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 5.0));
  EXPECT_NEAR(5.0 + std::log(2.0) / sigma, picture.depth[Middle(picture)], 1e-3);
  EXPECT_EQ(69.0f, picture.farDepth);

  scene.sigma_a = scene.Everywhere(0.6 / 64.0);
  const Picture thin = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 5.0));
  EXPECT_EQ(thin.farDepth, thin.depth[Middle(thin)]);
}

TEST_F(MediumRayCasterTest, StoppingOpaqueRaysChangesLittle)
{
  Scene scene = Blobs();
  for (float& value : scene.sigma_a)
  {
    value *= 20.0f;
  }
  const Picture whole = scene.Seen(this->GetDevice());
  scene.settings.minimumTransmittance = 1e-3;
  const Picture stopped = scene.Seen(this->GetDevice());
  EXPECT_LT(Distance(whole.radiance, stopped.radiance), 1e-3);
}

// Light from above through a slab that is looked at from above: J = E exp(-sigma z) p, seen through exp(-sigma z).
TEST_F(MediumRayCasterTest, ShadowRaysScatterOnceAsTheClosedFormSays)
{
  for (double g : { 0.0, 0.6, -0.4 })
  {
    for (int components : { 1, 3 })
    {
      Scene scene(GridOf(6, 6, 64));
      const double sigma_a = 0.01;
      const double sigma_s = 0.03;
      scene.components = components;
      scene.sigma_a.assign(components * scene.grid.VoxelCount(), static_cast<float>(sigma_a));
      scene.sigma_s.assign(components * scene.grid.VoxelCount(), static_cast<float>(sigma_s));
      scene.g = g;
      Light sun;
      sun.direction = { 0.0, 0.0, -2.0 };
      sun.power = { 1.0, 2.0, 3.0 };
      scene.illumination.lights = { sun };
      scene.settings.shadowRays = true;
      const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 10.0));
      const double sigma = sigma_a + sigma_s;
      const double phase = (1.0 - g * g) / (4.0 * Pi * std::pow(1.0 + g, 3.0)); // straight back
      const double expected = sigma_s * phase * -std::expm1(-2.0 * sigma * 64.0) / (2.0 * sigma);
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_NEAR(expected * (c + 1), picture.radiance[3 * Middle(picture) + c], 5e-4 * expected * (c + 1)) << g;
      }
    }
  }
}

TEST_F(MediumRayCasterTest, FarLightsOfEveryKindLookAlike)
{
  Scene scene = Blobs();
  scene.fluence.clear();
  scene.g = 0.3;
  scene.settings.shadowRays = true;
  const Vec centre = { 25.0, 20.5, 18.5 };
  const double r = 1e4;
  const Vec direction = { -0.6, 0.0, -0.8 };
  Light light;
  light.direction = direction;
  for (int axis = 0; axis < 3; ++axis)
  {
    light.position[axis] = centre[axis] - r * direction[axis];
  }
  light.angle = 2.0;
  light.size = { 3.0, 5.0 };
  const auto seenBy = [&](LightType type, double power) {
    light.type = type;
    light.power = { power, power, power };
    scene.illumination.lights = { light };
    return scene.Seen(this->GetDevice()).radiance;
  };
  const std::vector<float> sun = seenBy(LightType::Directional, 10.0);
  EXPECT_GT(*std::max_element(sun.begin(), sun.end()), 0.1f);
  const double sphere = r * r * 10.0;
  EXPECT_LT(Distance(sun, seenBy(LightType::Point, 4.0 * Pi * sphere)), 0.01);
  EXPECT_LT(Distance(sun, seenBy(LightType::Spot, 2.0 * Pi * (1.0 - std::cos(Pi / 180.0)) * sphere)), 0.01);
  EXPECT_LT(Distance(sun, seenBy(LightType::Rectangle, Pi * sphere)), 0.01);
}

TEST_F(MediumRayCasterTest, SpotAndRectangleShineToOneSide)
{
  Scene scene(GridOf(20, 20, 20));
  scene.sigma_s = scene.Everywhere(1e-3);
  scene.settings.shadowRays = true;
  scene.settings.showBackground = false;
  Light light;
  light.position = { 10.0, 10.0, 10.0 };
  light.direction = { 1.0, 0.0, 0.0 };
  light.size = { 1.0, 1.0 };
  light.angle = 60.0;
  for (LightType type : { LightType::Spot, LightType::Rectangle })
  {
    light.type = type;
    scene.illumination.lights = { light };
    const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 5.0));
    const std::size_t middle = Middle(picture);
    EXPECT_GT(picture.radiance[3 * (middle + 8)], 0.0f);
    EXPECT_EQ(0.0f, picture.radiance[3 * (middle - 8)]);
    EXPECT_TRUE(
      std::all_of(picture.radiance.begin(), picture.radiance.end(), [](float v) { return std::isfinite(v); }));
  }
}

// A medium so thin that every voxel gets 3 of the sun, 5 that was scattered and 2 straight from an environment.
TEST_F(MediumRayCasterTest, DirectLightCountsOnce)
{
  Scene scene(GridOf(8, 8, 8));
  scene.sigma_s = scene.Everywhere(1e-6);
  scene.settings.showBackground = false;
  Light sun;
  sun.power = { 3.0, 3.0, 3.0 };
  scene.illumination.lights = { sun };
  const auto seen = [&](bool shadowRays, bool single) {
    scene.settings.shadowRays = shadowRays;
    scene.settings.singleScatteringOnly = single;
    const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 5.0));
    return picture.radiance[3 * Middle(picture)] * 4.0 * Pi / (8.0 * 1e-6);
  };
  scene.fluence = scene.Everywhere(8.0);
  scene.fluenceDirect = scene.Everywhere(3.0);
  EXPECT_NEAR(8.0, seen(false, false), 1e-3);
  EXPECT_NEAR(8.0, seen(true, false), 1e-3);
  EXPECT_NEAR(3.0, seen(false, true), 1e-3);
  EXPECT_NEAR(3.0, seen(true, true), 1e-3);

  scene.fluence = scene.Everywhere(10.0);
  scene.fluenceDirect = scene.Everywhere(5.0);
  scene.illumination.environment = SmoothEnvironment();
  EXPECT_NEAR(10.0, seen(false, false), 1e-3);
  EXPECT_NEAR(10.0, seen(true, false), 1e-3);
  EXPECT_NEAR(5.0, seen(false, true), 1e-3);
}

TEST(Camera, FramesTheWholeBoxTightly)
{
  for (const Grid& grid : { GridOf(64, 64, 64), GridOf(200, 3, 10), GridOf(1, 1, 500, { 1, 1, 0.1 }, { 70, 0, -9 }) })
  {
    for (double aspect : { 4.0 / 3.0, 0.5 })
    {
      for (const Vec& towards : { Vec{ 0.55, -1.0, 0.5 }, Vec{ 0.0, 0.0, 1.0 }, Vec{ 1.0, 0.0, 0.0 } })
      {
        Camera camera = FrameGrid(grid, aspect, 40.0, towards);
        const auto axes = Axes(camera);
        double edge = 0.0;
        double parallelEdge = 0.0;
        for (int corner = 0; corner < 8; ++corner)
        {
          Vec seen = {};
          for (int axis = 0; axis < 3; ++axis)
          {
            const double at =
              grid.origin[axis] + (corner >> axis & 1 ? grid.Length(axis) : 0.0) - camera.position[axis];
            for (int c = 0; c < 3; ++c)
            {
              seen[c] += at * axes[c][axis];
            }
          }
          ASSERT_GT(seen[2], 0.0);
          const double farthest = std::max(std::abs(seen[0]) / aspect, std::abs(seen[1]));
          edge = std::max(edge, farthest / (seen[2] * std::tan(20.0 * Pi / 180.0)));
          parallelEdge = std::max(parallelEdge, farthest / camera.parallelScale);
        }
        EXPECT_NEAR(1.0 / 1.05, edge, 1e-9);
        EXPECT_NEAR(1.0 / 1.05, parallelEdge, 1e-9);
      }
    }
  }
}

TEST_F(MediumRayCasterTest, ReportsProgressAndStops)
{
  const Scene scene = Blobs();
  MediumRayCaster caster = scene.Caster(this->GetDevice());
  double last = -1.0;
  caster.Render(scene.Framed(), [&](double done) {
    EXPECT_GE(done, last);
    last = done;
    return true;
  });
  EXPECT_EQ(1.0, last);
  int calls = 0;
  EXPECT_THROW(caster.Render(scene.Framed(), [&](double) { return ++calls < 2; }), Aborted);
  EXPECT_EQ(2, calls);
  EXPECT_EQ(caster.Render(scene.Framed()).radiance, scene.Seen(this->GetDevice()).radiance);
}

TEST_F(MediumRayCasterTest, GivesItsMemoryBack)
{
  const std::size_t before = this->GetDevice().BytesInUse();
  Blobs().Seen(this->GetDevice());
  EXPECT_EQ(before, this->GetDevice().BytesInUse());
}

TEST_F(MediumRayCasterTest, SaysWhatItLeavesOut)
{
  const auto says = [&](const Scene& scene, const std::string& word) {
    const std::vector<std::string> leftOut = scene.Caster(this->GetDevice()).LeftOut();
    return std::any_of(
      leftOut.begin(), leftOut.end(), [&](const std::string& text) { return text.find(word) != std::string::npos; });
  };
  Scene scene = Blobs();
  EXPECT_TRUE(says(scene, "grey"));
  EXPECT_TRUE(says(scene, "emission"));
  scene.emission = scene.sigma_a;
  EXPECT_FALSE(says(scene, "emission"));
}

TEST_F(MediumRayCasterTest, RefusesWhatHasNoMeaning)
{
  const auto refused = [&](auto change) {
    Scene scene = Blobs();
    Camera camera = scene.Framed();
    change(scene, camera);
    EXPECT_THROW(scene.Seen(this->GetDevice(), camera), InvalidInput);
  };
  refused([](Scene&, Camera& camera) { camera.focalPoint = camera.position; });
  refused([](Scene&, Camera& camera) { camera.viewUp = { 0, 0, 0 }; });
  refused([](Scene&, Camera& camera) { camera.viewAngle = 180.0; });
  refused([](Scene&, Camera& camera) { camera.position[1] = NAN; });
  refused([](Scene& scene, Camera&) { scene.settings.stepSize = 0.0; });
  refused([](Scene& scene, Camera&) { scene.settings.imageSize[1] = 0; });
  refused([](Scene& scene, Camera&) { scene.settings.packetWidth = 3; });
  refused([](Scene& scene, Camera&) { scene.settings.shadowRays = true; });           // no fluence_direct
  refused([](Scene& scene, Camera&) { scene.settings.singleScatteringOnly = true; }); // no fluence_direct
  refused([](Scene& scene, Camera&) { scene.fluence[7] = INFINITY; });
  refused([](Scene& scene, Camera&) { scene.sigma_a[7] = -1.0f; });
}

TEST(ToneMapping, FollowsSrgb)
{
  ToneMapping linear;
  linear.exposure = 2.0;
  linear.curve = ToneCurve::Linear;
  const auto colour = ToneMap({ 0.0f, 0.25f, 0.0015f, 0.1f, 0.5f, 1e30f }, {}, linear);
  const std::vector<std::uint8_t> expected = { 0, 188, 10, 255, 124, 255, 255, 255 };
  EXPECT_EQ(expected, colour);
}

TEST(ToneMapping, IsMonotonousAndEndsAtWhite)
{
  for (ToneCurve curve : { ToneCurve::Linear, ToneCurve::Filmic })
  {
    ToneMapping settings;
    settings.exposure = 1.0;
    settings.curve = curve;
    int last = 0;
    for (double x = 0.0; x < 100.0; x += 0.01)
    {
      const float value = static_cast<float>(x);
      const int shown = ToneMap({ value, value, value }, {}, settings)[0];
      EXPECT_GE(shown, last);
      last = shown;
    }
    EXPECT_EQ(255, last);
  }
}

TEST(ToneMapping, ExposesTheMeanAsAGreyCard)
{
  EXPECT_NEAR(0.18 / 3.0, AutomaticExposure({ 1.0f, 1.0f, 1.0f, 9.0f, 9.0f, 9.0f, 0.0f, 0.0f, 0.0f }), 2e-4);
  EXPECT_EQ(1.0, AutomaticExposure({ 0.0f, 0.0f, 0.0f }));
}

TEST(ToneMapping, IsNotBlindedByWhatIsNearlyBlack)
{
  std::vector<float> radiance(300, 1e-20f);
  std::fill_n(radiance.begin(), 60, 2.0f);
  EXPECT_NEAR(0.09, AutomaticExposure(radiance), 3e-4);
  std::fill_n(radiance.begin(), 6, 1e5f); // a sun
  EXPECT_NEAR(0.09, AutomaticExposure(radiance), 0.07);
}

TEST(ToneMapping, ColoursLaidOverBlackAreThePicture)
{
  ToneMapping settings;
  settings.exposure = 1.0;
  const int opaque = ToneMap({ 0.1f, 0.1f, 0.1f }, {}, settings)[0];
  const auto half = ToneMap({ 0.1f, 0.1f, 0.1f }, { 0.5f }, settings);
  EXPECT_EQ(128, half[3]);
  EXPECT_NEAR(opaque, half[0] * half[3] / 255.0, 1.0);
}
}
