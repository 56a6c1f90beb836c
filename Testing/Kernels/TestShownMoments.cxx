// Pictures of media that scatter forwards, made of the angular moments of what is scattered.

#include "CloudPictures.h"
#include "DeviceTest.h"
#include "Difference.h"
#include "MediumScene.h"

#include "Numerics/Constants.h"
#include "Reference/ReferenceTable.h"
#include "Viewing/Sources/SeenSources.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

using namespace tyndall;

namespace
{
/// Densities of its own in every voxel, clear air at two sides.
Scene Cloudlet(std::array<int, 3> size, double g, double albedo = 1.0)
{
  Scene scene(size);
  scene.medium.grid.spacing = { 0.1, 0.1, 0.1 };
  scene.Randomise(6.0, 1.0, albedo);
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    if (static_cast<int>(i) % size[0] == 0)
    {
      scene.sigma_s[i] = scene.sigma_a[i] = 0.0f;
    }
  }
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
  scene.settings.angularDegree = 3;
  return scene;
}

SolvedLight Seen(const LightField& light, std::size_t voxels)
{
  SolvedLight seen;
  const auto field = [&](const std::vector<float>& values) {
    return Field{ values.empty() ? nullptr : values.data(), static_cast<int>(values.size() / voxels) };
  };
  seen.fluence = field(light.fluence);
  seen.fluenceDirect = field(light.fluenceDirect);
  seen.scatteredMoments = field(light.scatteredMoments);
  seen.straightOn = field(light.straightOn);
  seen.lampsApart = light.lampsApart;
  return seen;
}

Picture Look(Device& device, const Scene& scene, const LightField& light, const std::array<double, 3>& towards,
  const ViewSettings& settings = {})
{
  ViewSettings small = settings;
  small.imageSize = { 24, 20 };
  small.minimumTransmittance = 0.0;
  SolvedLight seen = Seen(light, scene.medium.grid.VoxelCount());
  seen.faceRadiance = scene.light.faces;
  MediumRayCaster caster(device, scene.medium, seen, scene.light, small);
  return caster.Render(FrameGrid(scene.medium.grid, 1.2, 30.0, towards));
}

}

using MomentsInPictures = DeviceTest;

TEST_F(MomentsInPictures, AreLeftOutWhereScatteringIsIsotropicOrTheyAreNotAskedFor)
{
  Scene scene = Cloudlet({ 7, 5, 6 }, 0.85);
  scene.ShineFromEverywhere(1.0);
  scene.settings.angularDegree = 0;
  EXPECT_TRUE(scene.Solve(this->GetDevice()).scatteredMoments.empty());
  scene.settings.angularDegree = 3;
  scene.settings.storeMoments = false;
  const LightField light = scene.Solve(this->GetDevice());
  EXPECT_TRUE(light.scatteredMoments.empty());
  EXPECT_THAT(light.leftOut, testing::Contains("angular moments for pictures: not asked for"));
}

/// The first moment is the fluence that was scattered and did not go straight on, those of degree 1 the net flux.
TEST_F(MomentsInPictures, AreThoseOfFluenceAndNetFlux)
{
  for (const double albedo : { 0.7, 1.0 }) // one order after the other, and accelerated
  {
    Scene scene = Cloudlet({ 9, 6, 7 }, 0.6, albedo);
    scene.medium.grid.spacing = { 0.5, 0.5, 0.5 };
    scene.light.faces[2] = { 1.0, 1.0, 1.0 };
    scene.light.sky = { 0.2, 0.2, 0.2 };
    scene.settings.netFlux = true;
    scene.settings.tolerance = 1e-6;
    scene.settings.source = albedo == 1.0 ? PropagationSource::Linear : PropagationSource::Constant; // as above
    const LightField light = scene.Solve(this->GetDevice());
    const std::size_t voxels = scene.medium.grid.VoxelCount(), harmonics = light.scatteredMoments.size() / voxels;
    ASSERT_EQ(harmonics, 16u);
    double square = 0.0, all = 0.0;
    for (std::size_t i = 0; i < voxels; ++i)
    {
      const float* moments = &light.scatteredMoments[i * harmonics];
      const double turned = 1.0 - light.straightOn[i];
      if (scene.sigma_s[i] == 0.0f)
      {
        EXPECT_EQ(moments[0], 0.0f);
        continue;
      }
      const double mean = turned * light.fluence[i] / (4.0 * Pi);
      EXPECT_NEAR(moments[0], mean, 2e-4 * mean);
      // Functions 1, 2, 3 are sqrt(3) times y, z, x; of what is scattered g less what goes straight on is left.
      const double perFlux = std::sqrt(3.0) * (0.6 - light.straightOn[i]) / (4.0 * Pi);
      const int function[] = { 3, 1, 2 };
      for (int axis = 0; axis < 3; ++axis)
      {
        square += std::pow(moments[function[axis]] - perFlux * light.netFlux[3 * i + axis], 2);
        all += std::pow(perFlux * light.netFlux[3 * i + axis], 2);
      }
    }
    EXPECT_LT(std::sqrt(square / all), 0.03) << albedo;
  }
}

/// Lamps' first scattering is left out, whatever adds up the orders: what remains of a lamp's light that is scattered
/// once only is nothing.
TEST_F(MomentsInPictures, LeaveOutLampsFirstScattering)
{
  Scene scene = Cloudlet({ 8, 7, 6 }, 0.85, 0.9);
  scene.ShineAlong({ 0.3, -0.5, -1.0 });
  scene.settings.maximumOrders = 1;
  scene.settings.acceleration = PropagationAcceleration::None;
  const LightField light = scene.Solve(this->GetDevice());
  double largest = 0.0;
  for (const float moment : light.scatteredMoments)
  {
    largest = std::max<double>(largest, std::abs(moment));
  }
  EXPECT_LT(largest, 1e-6);
  ASSERT_EQ(light.lampsApart.size(), 1u);
  EXPECT_EQ(light.lampsApart[0].power, scene.light.lights[0].power);
}

/// Between six faces of radiance 1, which pictures do not show, a white medium scatters as much light to the eye as it
/// hides of them.
TEST_F(MomentsInPictures, ShowWhatIsScatteredStraightOnFromFaces)
{
  Scene scene = Cloudlet({ 9, 8, 7 }, 0.85);
  scene.light.faces.fill({ 1.0, 1.0, 1.0 });
  const Picture picture = Look(this->GetDevice(), scene, scene.Solve(this->GetDevice()), { 1.0, 0.4, 0.3 });
  for (std::size_t i = 0; i < picture.alpha.size(); ++i)
  {
    EXPECT_NEAR(picture.radiance[3 * i], picture.alpha[i], 0.02) << i;
  }
}

/// A white medium under an even sky cannot be seen, however it scatters, from anywhere.
TEST_F(MomentsInPictures, ShowTheFurnaceRadiance)
{
  Scene scene = Cloudlet({ 9, 8, 7 }, 0.85);
  scene.ShineFromEverywhere(3.0);
  scene.settings.tolerance = 1e-6;
  const LightField light = scene.Solve(this->GetDevice());
  ASSERT_FALSE(light.scatteredMoments.empty());
  for (const std::array<double, 3>& towards :
    { std::array<double, 3>{ 1.0, 0.2, 0.3 }, { -0.2, -1.0, 0.1 }, { 0.3, 0.2, 1.0 } })
  {
    for (const float radiance : Look(this->GetDevice(), scene, light, towards).radiance)
    {
      EXPECT_NEAR(radiance, 3.0, 3.0 * 0.02); // directions of the set stand for the sky: their half-range flux is off
    }
  }
}

/// In thin medium light is scattered once, by the whole phase function, not its moments: sigma_s p E along the ray.
TEST_F(MomentsInPictures, ShowFirstScatteringByTheWholePhaseFunction)
{
  constexpr double SigmaS = 1e-5, Irradiance = 5.0;
  for (const double g : { -0.7, 0.5, 0.9 })
  {
    Scene scene({ 8, 8, 8 }, 0.0f, SigmaS);
    scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
    scene.settings.angularDegree = 3;
    scene.ShineAlong({ 0.0, 1.0, 0.0 }, Irradiance);
    const LightField light = scene.Solve(this->GetDevice());
    for (const std::array<double, 3>& towards :
      { std::array<double, 3>{ 0.1, 1.0, 0.05 }, { 1.0, 0.0, 0.1 }, { 0.0, -1.0, 0.2 }, { 0.5, 0.8, 0.0 } })
    {
      Camera camera = FrameGrid(scene.medium.grid, 1.0, 30.0, towards);
      camera.parallelProjection = true;
      camera.parallelScale = 0.5;
      ViewSettings settings;
      settings.imageSize = { 1, 1 };
      MediumRayCaster caster(
        this->GetDevice(), scene.medium, Seen(light, scene.medium.grid.VoxelCount()), scene.light, settings);
      const double seen = caster.Render(camera).radiance[0];
      const double length = std::sqrt(towards[0] * towards[0] + towards[1] * towards[1] + towards[2] * towards[2]);
      double most = 0.0;
      for (const double component : towards)
      {
        most = std::max(most, std::abs(component) / length);
      }
      const double cosine = towards[1] / length;
      const double once = SigmaS * 8.0 / most * Irradiance * PhaseFunction::HenyeyGreenstein(g).Value(cosine);
      EXPECT_NEAR(seen, once, 0.02 * once) << "g " << g << ", cosine " << cosine;
    }
  }
}

/// Light of two lamps and a sky is the sum of each, and colours do not mix.
TEST_F(MomentsInPictures, AddUpOverLampsAndColours)
{
  const auto picture = [&](bool first, bool second, bool sky) {
    Scene scene = Cloudlet({ 10, 8, 9 }, 0.8, 0.95);
    scene.settings.tolerance = 1e-6;
    Light lamp;
    lamp.direction = { 0.2, 1.0, -0.3 };
    lamp.power = { 3.0, 2.0, 0.0 };
    if (first)
    {
      scene.light.lights.push_back(lamp);
    }
    lamp.type = LightType::Point;
    lamp.position = { 0.2, 0.3, 1.6 };
    lamp.power = { 0.0, 1.0, 5.0 };
    if (second)
    {
      scene.light.lights.push_back(lamp);
    }
    scene.light.sky = sky ? Rgb{ 0.1, 0.2, 0.4 } : Rgb{};
    return Look(this->GetDevice(), scene, scene.Solve(this->GetDevice()), { 0.8, 0.6, 0.3 }).radiance;
  };
  std::vector<float> sum = picture(true, false, false);
  for (const std::vector<float>& one : { picture(false, true, false), picture(false, false, true) })
  {
    std::transform(sum.begin(), sum.end(), one.begin(), sum.begin(), std::plus<float>());
  }
  const std::vector<float> all = picture(true, true, true);
  // The logarithm of all lamps' light is interpolated, not that of each.
  EXPECT_LT(LargestDifference(sum, all), 0.05 * *std::max_element(all.begin(), all.end()));
  const std::vector<float> lamp = picture(true, false, false);
  for (std::size_t i = 2; i < lamp.size(); i += 3)
  {
    EXPECT_LT(lamp[i], 1e-6);
  }
}

/// Alpha and depth tell of what is sharp behind the medium: of light that is not scattered at all.
TEST_F(MomentsInPictures, AlphaIsOfLightThatIsNotScatteredAtAll)
{
  Scene scene({ 6, 6, 6 }, 0.0f, 0.2f);
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.85);
  scene.settings.angularDegree = 3;
  scene.ShineAlong({ 0.0, 0.0, -1.0 });
  const LightField light = scene.Solve(this->GetDevice());
  Camera camera = FrameGrid(scene.medium.grid, 1.0, 30.0, { 1.0, 0.0, 0.0 });
  camera.parallelProjection = true;
  camera.parallelScale = 0.5;
  ViewSettings settings;
  settings.imageSize = { 1, 1 };
  settings.backgroundColor = { 7.0, 7.0, 7.0 };
  const auto look = [&](const ViewSettings& how) {
    MediumRayCaster caster(
      this->GetDevice(), scene.medium, Seen(light, scene.medium.grid.VoxelCount()), scene.light, how);
    return caster.Render(camera);
  };
  const Picture bright = look(settings);
  EXPECT_NEAR(bright.alpha[0], 1.0 - std::exp(-1.2), 1e-4);
  settings.backgroundColor = {};
  EXPECT_NEAR(bright.radiance[0] - look(settings).radiance[0], 7.0 * std::exp(-1.2), 1e-3);
}

/// Beyond the first order, in light that goes nearly straight on: by the moments of small angles, e^(-d (1 - chi)).
TEST(Aureole, MakesUpForWhatIsTakenToGoStraightOn)
{
  const PhaseFunction function = PhaseFunction::HenyeyGreenstein(0.85);
  const std::vector<double> moments = function.Moments(40);
  const double straightOn = moments[6];
  const std::vector<float> table = AureoleTable(function, straightOn, 5);
  const int row = AureoleRows / 4;
  const double depth = AureoleDepth / 16.0;
  // Its moment of degree l, by the trapezoidal rule along the columns.
  for (const int l : { 0, 3, 5, 6, 9 })
  {
    double sum = 0.0, lastCosine = 1.0, last = 0.0;
    for (int column = 0; column <= AureoleColumns; ++column)
    {
      const double aside = 2.0 * std::min(column, AureoleColumns - column) / AureoleColumns;
      const double cosine = 2 * column < AureoleColumns ? 1.0 - aside * aside : aside * aside - 1.0;
      const double value = 2.0 * Pi * depth * table[row * (AureoleColumns + 2) + column] * std::legendre(l, cosine);
      sum += column > 0 ? 0.5 * (value + last) * (lastCosine - cosine) : 0.0;
      last = value;
      lastCosine = cosine;
    }
    // What is needed, less first scattering along what comes straight on, over that.
    const double chi = moments[l];
    const double needed = l <= 5 ? straightOn : chi * std::exp(depth * (chi - straightOn));
    const double shown = (l <= 5 ? straightOn : chi) * (1.0 + straightOn * depth);
    EXPECT_NEAR(sum, needed - shown, 2e-3 * std::abs(needed - shown)) << l;
  }
}

TEST_F(MomentsInPictures, AreRefusedWhereTheyHaveTheWrongShape)
{
  Scene scene({ 4, 4, 4 }, 0.1f, 0.5f);
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.8);
  scene.settings.angularDegree = 1;
  scene.ShineFromEverywhere(1.0);
  const LightField light = scene.Solve(this->GetDevice());
  SolvedLight seen = Seen(light, 64);
  seen.scatteredMoments.components = 5;
  EXPECT_THROW(MediumRayCaster(this->GetDevice(), scene.medium, seen, scene.light, {}), InvalidInput);
  seen = Seen(light, 64);
  seen.straightOn = {};
  EXPECT_THROW(MediumRayCaster(this->GetDevice(), scene.medium, seen, scene.light, {}), InvalidInput);
}

/// A small cloud with voxels of a third of a mean free path on average, from three sides: Data/Reference/
/// cloud_pictures.csv by PictureMonteCarlo.h.
TEST_F(MomentsInPictures, AgreeWithMonteCarlo)
{
  cloud_pictures::Setup setup = cloud_pictures::SmallCloud();
  cloud_pictures::LitCloud cloud(setup, { "degree 5", setup.g, 5, 25 });
  cloud.Solve(this->GetDevice());
  const std::vector<ReferenceRow> rows = ReadReference("cloud_pictures");
  for (std::size_t v = 0; v < std::size(cloud_pictures::Views); ++v)
  {
    std::vector<double> first, second;
    for (const ReferenceRow& row : rows)
    {
      if (row["view"] == static_cast<double>(v))
      {
        first.push_back(row["first"]);
        second.push_back(row["second"]);
      }
    }
    const std::vector<double> picture = cloud.Picture(this->GetDevice(), cloud_pictures::Views[v]);
    ASSERT_EQ(first.size(), picture.size());
    const cloud_pictures::Errors errors = cloud_pictures::ErrorsOf(picture, first, second);
    EXPECT_LT(errors.rms, v < 2 ? 0.02 : 0.06) << cloud_pictures::Views[v].name;
    EXPECT_NEAR(errors.mean, 0.0, 0.015) << cloud_pictures::Views[v].name;
  }
}
