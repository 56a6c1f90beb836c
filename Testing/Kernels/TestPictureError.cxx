#include "ViewScene.h"

#include "Viewing/PictureError.h"

using namespace tyndall;
using namespace viewing;

namespace
{
class PictureErrorTest : public DeviceTest
{
protected:
  /// @param fluenceError  of every voxel, of one channel; empty: not known
  Picture SeenWithError(const Scene& scene, const Camera& camera, const std::vector<float>& fluenceError = {},
    std::string* leftOut = nullptr)
  {
    Device& device = this->GetDevice();
    SolvedLight light = scene.LightSeen();
    light.fluenceError = Scene::See(fluenceError, 1);
    light.surfaceError = Scene::See(this->SurfaceError, 4);
    light.errorLength = this->ErrorLength;
    const PictureErrorCasters others(
      device, scene.MediumSeen(), light, scene.illumination, scene.settings, Scene::See(scene.ior, 1));
    Picture picture = scene.Seen(device, camera);
    others.Estimate(picture, camera);
    if (leftOut)
    {
      *leftOut = others.lightLeftOut;
    }
    return picture;
  }

  double ErrorLength = 0.0;        ///< SolvedLight::errorLength of the next pictures
  std::vector<float> SurfaceError; ///< SolvedLight::surfaceError of the next pictures
};

/// Radiance that a slab of voxels of extinction `sigma` sends back, in closed form: its emission, from the front to the
/// back, is linear between the voxels' centres.
double RadianceInClosedForm(const std::vector<float>& emission, double sigma)
{
  double radiance = 0.0, depth = 0.0;
  // adds the integral of exp(-sigma t) (from + (to - from) t / d) over [0, d]
  const auto add = [&](double from, double to, double d) {
    const double slope = (to - from) / d, left = std::exp(-sigma * d);
    radiance += std::exp(-sigma * depth) * ((from + slope / sigma) * (1.0 - left) / sigma - slope / sigma * d * left);
    depth += d;
  };
  add(emission.front(), emission.front(), 0.5);
  for (std::size_t i = 1; i < emission.size(); ++i)
  {
    add(emission[i - 1], emission[i], 1.0);
  }
  add(emission.back(), emission.back(), 0.5);
  return radiance;
}

TEST_F(PictureErrorTest, ErrorOfCoarseStepsIsThatAgainstTheClosedForm)
{
  Scene scene(GridOf(8, 8, 24));
  const double sigma = 0.12;
  std::vector<float> column;
  for (int k = 0; k < 24; ++k)
  {
    column.push_back(static_cast<float>(1.0 + 2.0 * std::pow(std::sin(Pi * (k + 0.5) / 24.0), 2.0)));
  }
  scene.sigma_a = scene.Everywhere(sigma);
  scene.emission =
    AtCentres(scene.grid, [&](double, double, double z) { return column[static_cast<std::size_t>(24.0 * z)]; });
  for (const std::array<int, 2> size : { std::array<int, 2>{ 12, 10 }, { 13, 7 }, { 1, 1 } })
  {
    scene.settings.imageSize = size;
    for (const double step : { 2.0, 1.0 })
    {
      scene.settings.stepSize = step;
      Camera camera = FromAbove(scene.grid, 5.0);
      camera.parallelScale = 2.0;
      const Picture picture = this->SeenWithError(scene, camera);
      const double exact = RadianceInClosedForm(column, sigma), error = std::abs(picture.radiance[0] - exact);
      ASSERT_EQ(picture.radiance.size(), picture.error.size());
      EXPECT_GT(error, 1e-4 * exact); // coarse enough to tell
      EXPECT_GT(picture.error[0], 0.8 * error) << size[0] << " " << step;
      EXPECT_LT(picture.error[0], 2.2 * error) << size[0] << " " << step;
      EXPECT_NEAR(picture.relativeError, picture.error[0] / picture.radiance[0], 0.02 * picture.relativeError);
    }
  }
}

TEST_F(PictureErrorTest, EveryEstimateIsOfTheRayOfItsPixel)
{
  // Steps that are exact, so that any difference would be that of other rays; odd pixels, a shifted camera.
  Scene scene(GridOf(9, 10, 11));
  scene.sigma_a = scene.Everywhere(0.3);
  scene.emission = scene.Everywhere(0.7);
  scene.illumination.sky = { 0.2, 0.3, 0.4 };
  scene.settings.imageSize = { 61, 44 };
  for (const bool parallel : { false, true })
  {
    Camera camera = scene.Framed();
    camera.shift = { 0.1, -0.2 };
    camera.parallelProjection = parallel;
    camera.parallelScale = 9.0;
    camera.mirrored = parallel;
    const Picture picture = this->SeenWithError(scene, camera);
    EXPECT_LT(Largest(picture.error), 1e-4);
    EXPECT_GT(Largest(picture.radiance), 1.0);
  }
}

TEST_F(PictureErrorTest, LightThatIsOffByATenthMakesAPictureOffByNoMore)
{
  Scene scene(GridOf(12, 13, 14));
  scene.sigma_a = scene.Everywhere(0.02);
  scene.sigma_s = scene.Everywhere(0.2);
  scene.fluence = Random(scene.grid.VoxelCount(), 2.0f, 5);
  std::vector<float> error = scene.fluence;
  for (float& value : error)
  {
    value *= 0.1f;
  }
  scene.settings.stepSize = 0.1; // no error of its own
  std::string leftOut;
  const Picture without = this->SeenWithError(scene, scene.Framed(), {}, &leftOut);
  EXPECT_NE(std::string::npos, leftOut.find("fluence_error")) << leftOut;
  const Picture with = this->SeenWithError(scene, scene.Framed(), error, &leftOut);
  EXPECT_EQ("", leftOut);
  EXPECT_LT(without.relativeError, 0.005);
  EXPECT_GT(with.relativeError, 0.02);
  EXPECT_LT(with.relativeError, 0.101);
}

TEST_F(PictureErrorTest, ErrorsOfShortLengthCancelAlongARay)
{
  Scene scene(GridOf(8, 8, 36));
  Camera camera = FromAbove(scene.grid, 5.0);
  camera.parallelScale = 2.0;
  scene.sigma_a = scene.Everywhere(0.0);
  for (const double power : { 1.0, 1e-25, 1e25 })
  {
    scene.fluence = scene.Everywhere(power);
    const std::vector<float> error = scene.Everywhere(0.1 * power);
    const auto relative = [&](double sigma, double length) {
      scene.sigma_s = scene.Everywhere(sigma);
      this->ErrorLength = length;
      return this->SeenWithError(scene, camera, error).relativeError;
    };
    // 36 voxels of independent errors over 4 voxels each
    EXPECT_NEAR(relative(1e-3, 4.0), 0.1 / 3.0, 0.001) << power;
    EXPECT_NEAR(relative(1e-3, 1e3), 0.1, 0.001) << power;
    EXPECT_NEAR(relative(1e-3, 0.0), 0.1, 0.001) << power;
    // an eye sees errors of one sign where it sees less than their length
    EXPECT_NEAR(relative(2.0, 20.0), 0.1, 0.005) << power;
  }
}

TEST_F(PictureErrorTest, ThickVoxelsShowTheErrorOfTheirSurface)
{
  Scene scene(GridOf(8, 8, 8));
  Camera camera = FromAbove(scene.grid, 5.0);
  camera.parallelScale = 2.0;
  scene.sigma_a = scene.Everywhere(0.5);
  scene.sigma_s = scene.Everywhere(2.5);
  scene.fluence = scene.Everywhere(4.0 * Pi);
  scene.surface.assign(4 * BoxFaceCellCount(scene.grid), 1.0f);
  const std::vector<float> error = scene.Everywhere(0.05 * 4.0 * Pi);
  scene.settings.stepSize = 0.1;
  for (const double length : { 0.0, 2.0 })
  {
    this->ErrorLength = length;
    this->SurfaceError.assign(scene.surface.size(), 0.2f);
    EXPECT_NEAR(this->SeenWithError(scene, camera, error).relativeError, 0.2, 0.01) << length;
    this->SurfaceError.clear();
    EXPECT_LT(this->SeenWithError(scene, camera, error).relativeError, 0.06) << length;
  }
}

TEST_F(PictureErrorTest, LightByMomentsHasTheErrorOfItsFluence)
{
  // The same isotropic light as fluence and as moments of degree 1, and the same error.
  Scene scene(GridOf(8, 8, 8));
  scene.sigma_s = scene.Everywhere(0.3);
  scene.fluence = scene.Everywhere(4.0 * Pi);
  const std::vector<float> error = scene.Everywhere(0.05 * 4.0 * Pi);
  scene.settings.stepSize = 0.25;
  const Picture byFluence = this->SeenWithError(scene, scene.Framed(), error);
  for (std::size_t voxel = 0; voxel < scene.grid.VoxelCount(); ++voxel)
  {
    scene.moments.insert(scene.moments.end(), { 1.0f, 0.0f, 0.0f, 0.0f });
  }
  scene.straightOn = scene.Everywhere(0.0);
  const Picture byMoments = this->SeenWithError(scene, scene.Framed(), error);
  EXPECT_GT(byFluence.relativeError, 0.01);
  EXPECT_NEAR(1.0, byMoments.relativeError / byFluence.relativeError, 1e-3);
}

TEST_F(PictureErrorTest, DegreesThatAreMissingAreASeries)
{
  // Towards the eye the light of each degree is 0.64 of that of the one before.
  constexpr double ratio = 0.8;
  Scene scene(GridOf(6, 6, 6));
  scene.sigma_s = scene.Everywhere(0.2);
  scene.fluence = scene.Everywhere(1.0);
  scene.straightOn = scene.Everywhere(std::pow(ratio, 4.0));
  scene.settings.stepSize = 0.25;
  const auto showUpTo = [&](int degree) {
    std::vector<float> ofVoxel((degree + 1) * (degree + 1));
    for (int l = 0; l <= degree; ++l)
    {
      ofVoxel[l * l + l] = static_cast<float>(std::pow(ratio, 2.0 * l) / std::sqrt(2.0 * l + 1.0));
    }
    scene.moments.clear();
    for (std::size_t voxel = 0; voxel < scene.grid.VoxelCount(); ++voxel)
    {
      scene.moments.insert(scene.moments.end(), ofVoxel.begin(), ofVoxel.end());
    }
  };
  Camera camera = FromAbove(scene.grid, 5.0);
  camera.parallelScale = 1.5;
  showUpTo(3);
  const Picture picture = this->SeenWithError(scene, camera);
  showUpTo(15);
  const double missing = scene.Seen(this->GetDevice(), camera).radiance[0] - picture.radiance[0];
  EXPECT_GT(missing, 0.1 * picture.radiance[0]);
  EXPECT_NEAR(picture.error[0], missing, 0.03 * missing);
}

// Rays that end where a thousandth of the light is left would hide what small steps gain.
TEST_F(PictureErrorTest, EveryQualityIsBetterThanTheOneBefore)
{
  Scene scene(GridOf(32, 32, 32));
  scene.sigma_s = AtCentres(scene.grid,
    [](double x, double y, double z) { return 0.8 + 0.4 * std::sin(7.0 * x) * std::sin(6.0 * y) * std::cos(5.0 * z); });
  scene.fluence = AtCentres(scene.grid, [](double x, double y, double z) { return 1.0 + x + y * y + z; });
  scene.settings.stepSize = 0.05;
  const std::vector<float> exact = scene.Seen(this->GetDevice()).radiance;
  double before = 1.0;
  for (const Quality quality : { Quality::Draft, Quality::Default, Quality::Fine, Quality::Reference })
  {
    ViewSettings settings;
    settings.imageSize = scene.settings.imageSize;
    scene.settings = AtQuality(quality, settings);
    const double error = MeanDistance(exact, scene.Seen(this->GetDevice()).radiance);
    std::printf("quality %d: mean error %.2g\n", static_cast<int>(quality), error);
    EXPECT_LT(error, (quality < Quality::Fine ? 0.9 : 0.5) * before) << static_cast<int>(quality);
    before = error;
  }
}

TEST_F(PictureErrorTest, TheLongestStepsAreDoubled)
{
  Scene scene(GridOf(40, 40, 40));
  scene.sigma_a = scene.Everywhere(0.02);
  scene.emission =
    AtCentres(scene.grid, [](double x, double y, double z) { return x * y * (1.1 + std::sin(9.0 * z)); });
  scene.settings.stepSize = 0.1;
  const std::vector<float> exact = scene.Seen(this->GetDevice()).radiance;
  scene.settings.stepSize = 10.0; // the filter's largest
  const Picture picture = this->SeenWithError(scene, scene.Framed());
  const std::vector<float> none(exact.size());
  EXPECT_GT(MeanDistance(picture.error, none), 0.5 * MeanDistance(exact, picture.radiance));
}
}
