#include "ErrorWords.h"
#include "ViewScene.h"

using namespace tyndall;
using namespace viewing;

namespace
{
class MediumRayCasterTest : public DeviceTest
{
protected:
  /// In vacuum, from within and in every direction, what Lookup has.
  void ExpectEnvironment(const Scene& scene)
  {
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
  this->ExpectEnvironment(scene);
  scene.illumination.environment = Turned(scene.illumination.environment, 0, 30.0);
  this->ExpectEnvironment(scene);
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
  const double coarse = LargestDifference(exact, seenWith(4.0));
  const double fine = LargestDifference(exact, seenWith(1.0));
  const double order = 0.5 * std::log2(coarse / fine);
  std::printf("order of convergence %.2f, error at one voxel a step %.2g of %.2g\n", order, fine,
    static_cast<double>(*std::max_element(exact.begin(), exact.end())));
  this->RecordProperty("order", std::to_string(order));
  EXPECT_GT(order, 1.7);
  EXPECT_LT(fine, 5e-4 * *std::max_element(exact.begin(), exact.end()));
}

// Forty thousand steps, of which each takes so little that a float's last place counts.
TEST_F(MediumRayCasterTest, VerySmallStepsAddUpToTheClosedForm)
{
  for (int components : { 1, 3 })
  {
    for (double thickness : { 0.3, 1.1, 7.0 })
    {
      Scene scene(GridOf(4, 4, 400));
      scene.settings.imageSize = { 5, 5 };
      scene.settings.stepSize = 0.01;
      scene.components = components;
      const double sigma = thickness / 400.0;
      scene.sigma_a.assign(components * scene.grid.VoxelCount(), static_cast<float>(sigma));
      scene.emission = scene.Everywhere(0.7 * sigma);
      if (components == 3)
      {
        scene.sigma_a[0] *= 1.001f; // coloured, if only at the bottom's corner
      }
      const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 5.0));
      const std::size_t middle = Middle(picture);
      EXPECT_NEAR(-std::expm1(-thickness), picture.alpha[middle], 5e-6) << components << " " << thickness;
      EXPECT_NEAR(-0.7 * std::expm1(-thickness), picture.radiance[3 * middle], 5e-6) << components << " " << thickness;
    }
  }
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
  ExpectSameInPackets(this->GetDevice(), scene, scene.Framed(), 1e-6, 1e-6);
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

// Steps of an optical length up to 2 are crossed another way than longer ones, if there are no longer ones: an opaque
// voxel that nobody sees decides.
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
    EXPECT_LT(LargestDifference(thin.alpha, thick.alpha), 1e-6);
    EXPECT_LT(LargestDifference(thin.radiance, thick.radiance), 2e-6);
    EXPECT_LT(LargestDifference(thin.depth, thick.depth), 1e-4);
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
  EXPECT_LT(LargestDifference(grey.radiance, same.radiance), 1e-6);
  EXPECT_LT(LargestDifference(grey.alpha, same.alpha), 1e-6);
  EXPECT_LT(LargestDifference(grey.depth, same.depth), 1e-3);

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
  EXPECT_LT(LargestDifference(whole.radiance, stopped.radiance), 1e-3);
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

// However wide the picture and small the steps, no part of the work between two reports is more than some million
// samples.
TEST_F(MediumRayCasterTest, ReportsOftenWhereRaysTakeManySteps)
{
  Scene scene(GridOf(40, 40, 40));
  scene.sigma_a = scene.Everywhere(0.01);
  scene.settings.stepSize = 0.01;
  scene.settings.imageSize = { 1600, 16 };
  const double longest = 40.0 * std::sqrt(3.0) / scene.settings.stepSize;
  const double samples = 1600.0 * 16.0 * longest;
  MediumRayCaster caster = scene.Caster(this->GetDevice());
  int reports = 0;
  caster.Render(scene.Framed(), [&](double) { return ++reports > 0; });
  std::printf("%.3g samples at most, %d reports\n", samples, reports);
  EXPECT_GT(reports, samples / 4.0e7);

  int asked = 0;
  EXPECT_THROW(caster.Render(scene.Framed(), [&](double done) { return ++asked < 2 || done < 0.1; }), Aborted);
  EXPECT_LT(asked, reports / 2);

  // Shadow rays of one row of slices.
  scene.grid = GridOf(160, 160, 1);
  scene.sigma_s = scene.sigma_a = scene.Everywhere(0.01);
  Light sun;
  sun.direction = { 1.0, 0.3, -0.01 };
  scene.illumination.lights = { sun };
  scene.settings.shadowRays = true;
  scene.settings.imageSize = { 2, 2 };
  MediumRayCaster flat = scene.Caster(this->GetDevice());
  reports = 0;
  flat.Render(FromAbove(scene.grid, 5.0), [&](double) { return ++reports > 0; });
  EXPECT_GT(reports, 160.0 * 160.0 * 160.0 * std::sqrt(2.0) / scene.settings.stepSize / 4.0e7);
}

TEST_F(MediumRayCasterTest, PartsOfARowGiveTheSamePictureAsRows)
{
  Scene scene = Blobs();
  scene.settings.imageSize = { 203, 37 };
  scene.settings.stepSize = 0.5;
  const Picture coarse = scene.Seen(this->GetDevice());
  scene.settings.stepSize = 0.01;
  const Picture fine = scene.Seen(this->GetDevice());
  EXPECT_LT(LargestDifference(coarse.radiance, fine.radiance), 0.02);
  EXPECT_LT(LargestDifference(coarse.alpha, fine.alpha), 0.01);
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
  for (double step : { 1e-30, 1e-9, 0.0099, 20.1, 1e300, static_cast<double>(INFINITY), static_cast<double>(NAN) })
  {
    refused([=](Scene& scene, Camera&) { scene.settings.stepSize = step; });
  }
  for (double colour : { -1.0, 1e39, 1e300, static_cast<double>(INFINITY), static_cast<double>(NAN) })
  {
    refused([=](Scene& scene, Camera&) { scene.settings.backgroundColor[1] = colour; });
  }
  refused([](Scene& scene, Camera&) { scene.settings.imageSize = { 40000, 40000 }; }); // beyond what indices reach
  refused([](Scene&, Camera& camera) { camera.position[0] = 1e60; });
  refused([](Scene& scene, Camera&) { scene.settings.imageSize[1] = 0; });
  refused([](Scene& scene, Camera&) { scene.settings.packetWidth = 3; });
  refused([](Scene& scene, Camera&) { // no fluence_direct
    scene.settings.shadowRays = true;
    scene.illumination.lights.resize(1);
  });
  refused([](Scene& scene, Camera&) { scene.settings.singleScatteringOnly = true; }); // no fluence_direct
  refused([](Scene& scene, Camera&) { scene.fluence[7] = INFINITY; });
  refused([](Scene& scene, Camera&) { scene.sigma_a[7] = -1.0f; });
}

/// What a refusal says.
std::string Refusal(Device& device, const Scene& scene, const Camera& camera)
{
  return ErrorWords([&] { scene.Seen(device, camera); });
}

TEST_F(MediumRayCasterTest, SaysWhichNumberIsOutOfWhichRange)
{
  Scene scene = Blobs();
  scene.settings.stepSize = 1e-30;
  const std::string step = Refusal(this->GetDevice(), scene, scene.Framed());
  EXPECT_NE(std::string::npos, step.find("1e-30")) << step;
  EXPECT_NE(std::string::npos, step.find("from 0.01 to 20")) << step;
  scene.settings.stepSize = 0.5;
  scene.settings.backgroundColor[2] = 1e39;
  const std::string background = Refusal(this->GetDevice(), scene, scene.Framed());
  EXPECT_NE(std::string::npos, background.find("1e+39")) << background;
  EXPECT_NE(std::string::npos, background.find("from 0 to 1e+37")) << background;
}

TEST_F(MediumRayCasterTest, SaysThatACameraIsTooFarAway)
{
  const Scene scene = Blobs();
  for (double far : { 1e30, 1e200, 1e308, -1e308 })
  {
    Camera camera = scene.Framed();
    camera.position = { far, 0.0, 0.0 };
    for (bool parallel : { false, true })
    {
      camera.parallelProjection = parallel;
      const std::string said = Refusal(this->GetDevice(), scene, camera);
      EXPECT_NE(std::string::npos, said.find("too far")) << far << " " << said;
      EXPECT_EQ(std::string::npos, said.find("view up")) << far << " " << said;
    }
  }
  Camera camera = scene.Framed();
  camera.parallelProjection = true;
  camera.parallelScale = 1e300;
  EXPECT_NE(std::string::npos, Refusal(this->GetDevice(), scene, camera).find("parallel scale"));
}
}
