#include "DeviceTest.h"
#include "Difference.h"
#include "Medium/Grid.h"
#include "MediumScene.h"

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "Light/ChannelReduction.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Published/ParallelPropagation.h"
#include "LightPropagation/Published/SequentialPropagation.h"
#include "Medium/Traits.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <string>

using namespace tyndall;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

namespace
{
constexpr double Same = 1e-6; ///< of the largest
/// The same where orders are accelerated in a slab of 100 mean free paths: what rounding leaves in the power that
/// enters voxels counts many times there. 1.9e-6 was measured.
constexpr double SameInThickSlab = 5e-6;

/// A cloud in a box: its voxels are empty outside of [first, first + size).
Scene Cloud(std::array<int, 3> grid, std::array<int, 3> first, std::array<int, 3> size, double thickest = 1.0)
{
  Scene scene(grid);
  scene.Randomise(thickest, 1.0, 0.8);
  ForGridVoxels(grid, [&](std::size_t i, int x, int y, int z) {
    const std::array<int, 3> at = { x - first[0], y - first[1], z - first[2] };
    const bool inside = at[0] >= 0 && at[1] >= 0 && at[2] >= 0 && at[0] < size[0] && at[1] < size[1] && at[2] < size[2];
    scene.sigma_a[i] *= inside ? 1.0f : 0.0f;
    scene.sigma_s[i] *= inside ? 1.0f : 0.0f;
  });
  return scene;
}

Scene Cloud(double thickest = 1.0)
{
  return Cloud({ 13, 10, 11 }, { 0, 0, 0 }, { 13, 10, 11 }, thickest);
}

Light Lamp(const Rgb& power)
{
  Light lamp;
  lamp.type = LightType::Point;
  lamp.position = { 5.2, 4.1, 3.3 };
  lamp.power = power;
  return lamp;
}

/// Two cloudlets, and a bright vacuum voxel between them.
/// @param margin  empty voxels around their common box along y and z
Scene Cloudlets(int margin)
{
  const std::array<int, 3> grid = { 43, 10 + 2 * margin, 9 + 2 * margin };
  Scene scene = Cloud(grid, { 0, 0, 0 }, grid);
  scene.medium.grid.spacing = { 1.0, 1.2, 0.9 };
  scene.emission.assign(scene.sigma_a.size(), 0.0f);
  ForGridVoxels(grid, [&](std::size_t i, int x, int y, int z) {
    const int side = x < 21 ? 0 : 1, u = x - (side == 0 ? 4 : 30), v = y - margin, w = z - margin;
    const bool inside = u >= 0 && u < 9 && (side == 0 ? v >= 0 && v < 4 : v >= 6 && v < 10) && w >= 0 && w < 9;
    scene.sigma_a[i] *= inside ? 1.0f : 0.0f;
    scene.sigma_s[i] *= inside ? 1.0f : 0.0f;
    scene.emission[i] = x == 20 && v == 5 && w == 4 ? 0.3f : 0.0f;
  });
  scene.light.sky = { 0.3, 0.3, 0.3 };
  scene.light.faces[1] = { 2.0, 2.0, 2.0 };
  scene.light.lights = { Lamp({ 3.0, 3.0, 3.0 }) };
  return scene;
}

/// Each voxel's value three times, in these proportions.
std::vector<float> Coloured(const std::vector<float>& grey, const Rgb& colour)
{
  std::vector<float> rgb;
  for (const float value : grey)
  {
    for (const double part : colour)
    {
      rgb.push_back(static_cast<float>(value * part));
    }
  }
  return rgb;
}

void ExpectSamePower(const Rgb& a, const Rgb& b, double tolerance, const char* what)
{
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(a[c], b[c], tolerance) << what << ", channel " << c;
  }
}

void ExpectSameLight(const LightField& less, const LightField& all, double same = Same)
{
  ASSERT_EQ(less.channels, all.channels);
  EXPECT_EQ(less.convergence.size(), all.convergence.size());
  EXPECT_LT(RelativeDifference(less.fluence, all.fluence), same);
  EXPECT_LT(RelativeDifference(less.fluenceDirect, all.fluenceDirect), same);
  EXPECT_LT(RelativeDifference(less.scatteredRadiance, all.scatteredRadiance), same);
  EXPECT_LT(RelativeDifference(less.netFlux, all.netFlux), same);
  const EnergyBalance& a = less.balance;
  const EnergyBalance& b = all.balance;
  const double of = same * (Sum(b.entered) + Sum(b.emitted));
  ExpectSamePower(a.entered, b.entered, of, "entered");
  ExpectSamePower(a.emitted, b.emitted, of, "emitted");
  ExpectSamePower(a.absorbed, b.absorbed, of, "absorbed");
  ExpectSamePower(a.escaped, b.escaped, of, "escaped");
  ExpectSamePower(a.leftOver, b.leftOver, of, "left over");
  for (int face = 0; face < 6; ++face)
  {
    ExpectSamePower(less.facePowerOut[face], all.facePowerOut[face], of, "through a face");
  }
  EXPECT_NEAR(less.convergence.back().absorbed, all.convergence.back().absorbed, of);
}
}

class Traits : public DeviceTest
{
protected:
  /// Solve with and without leaving out: the same light, and `word` is said in the first case only.
  LightField ExpectLeftOut(Scene& scene, const std::string& word, double same = Same)
  {
    const auto solve = [&](bool leaveOut) {
      scene.settings.leaveOut = leaveOut;
      return scene.Solve(this->GetDevice());
    };
    return this->ExpectLeftOutBy(solve, word, same);
  }

  LightField ExpectLeftOutBy(
    const std::function<LightField(bool leaveOut)>& solve, const std::string& word, double same = Same)
  {
    const LightField all = solve(false), less = solve(true);
    EXPECT_THAT(less.leftOut, Contains(HasSubstr(word)));
    EXPECT_THAT(all.leftOut, Not(Contains(HasSubstr(word))));
    ExpectSameLight(less, all, same);
    return less;
  }
};

TEST_F(Traits, AreFoundInOneScan)
{
  Scene scene = Cloud({ 9, 8, 7 }, { 2, 3, 1 }, { 4, 2, 5 });
  scene.medium.sigma_a = { scene.sigma_a.data(), 1 };
  scene.medium.sigma_s = { scene.sigma_s.data(), 1 };
  MediumTraits traits = TraitsOf(scene.medium);
  EXPECT_TRUE(traits.absorbs && traits.scatters && !traits.emits && traits.grey && traits.isotropic);
  EXPECT_EQ(traits.filled.first, (std::array<int, 3>{ 2, 3, 1 }));
  EXPECT_EQ(traits.filled.size, (std::array<int, 3>{ 4, 2, 5 }));
  const std::vector<float> grey = Coloured(scene.sigma_s, { 1.0, 1.0, 1.0 });
  scene.medium.sigma_s = { grey.data(), 3 };
  EXPECT_TRUE(TraitsOf(scene.medium).grey);
  const std::vector<float> bluish = Coloured(scene.sigma_s, { 1.0, 1.0, 1.001 });
  scene.medium.sigma_s = { bluish.data(), 3 };
  EXPECT_FALSE(TraitsOf(scene.medium).grey);
  EXPECT_FALSE(TraitsOf(scene.medium).greyExtinction);
  scene.medium.sigma_a = scene.medium.sigma_s = {};
  EXPECT_EQ(TraitsOf(scene.medium).filled.VoxelCount(), 0u);
}

TEST_F(Traits, OneColourIsThatOfAllThatShines)
{
  Illumination light;
  EXPECT_TRUE(ColourOf(light).IsGrey());
  light.sky = { 0.2, 0.4, 0.0 };
  light.lights = { Lamp({ 0.5, 1.0, 0.0 }), Lamp({ 0.0, 0.0, 0.0 }) };
  EXPECT_TRUE(ColourOf(light).IsOne());
  EXPECT_FALSE(ColourOf(light).IsGrey());
  EXPECT_EQ(ColourOf(light).Relative(), (Rgb{ 0.5, 1.0, 0.0 }));
  light.faces[3] = { 0.5, 1.0, 1e-5 };
  EXPECT_FALSE(ColourOf(light).IsOne());
}

// The second reduction took the first component: blue had the coefficients of red.
TEST_F(Traits, AChannelReducedOnceMoreIsTheSame)
{
  const std::vector<float> absorbs = { 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f },
                           emits = { 1.0f, 1.0f, 0.0f, 1.0f, 0.0f, 0.0f };
  Medium medium;
  medium.grid.size = { 2, 1, 1 };
  medium.sigma_a = { absorbs.data(), 3 };
  medium.emission = { emits.data(), 3 };
  const OneChannelScene blue(medium, {}, 2), again(blue.medium, blue.light, 0);
  EXPECT_EQ(again.medium.sigma_a.At(1, 0), 6.0f);
  const MediumTraits traits = TraitsOf(blue.medium);
  EXPECT_TRUE(traits.absorbs && traits.grey && traits.emission.IsOne());
  EXPECT_FALSE(traits.emits);
}

TEST_F(Traits, GreyIsOneChannel)
{
  Scene scene = Cloud();
  scene.ShineFromEverywhere(1.0);
  scene.light.lights = { Lamp({ 3.0, 3.0, 3.0 }) };
  scene.settings.netFlux = true;
  EXPECT_EQ(this->ExpectLeftOut(scene, "colour: medium and light are grey").channels, 1);
}

TEST_F(Traits, GreyInThreeComponentsIsOneChannelToo)
{
  Scene scene = Cloud();
  scene.sigma_a = Coloured(scene.sigma_a, { 1.0, 1.0, 1.0 });
  scene.sigma_s = Coloured(scene.sigma_s, { 1.0, 1.0, 1.0 });
  scene.ShineFromEverywhere(1.0);
  EXPECT_EQ(this->ExpectLeftOut(scene, "colour: medium and light are grey").channels, 3);
}

TEST_F(Traits, OneColourOfLightIsOneChannel)
{
  for (const bool emits : { false, true })
  {
    Scene scene = Cloud();
    scene.light.sky = { 0.2, 0.8, 0.1 };
    scene.light.lights = { Lamp({ 2.0, 8.0, 1.0 }) };
    scene.emission = emits ? Coloured(scene.sigma_a, { 0.1, 0.4, 0.05 }) : std::vector<float>();
    scene.settings.netFlux = true;
    EXPECT_EQ(this->ExpectLeftOut(scene, "all light has one colour").channels, 3);
  }
}

TEST_F(Traits, TwoColoursOfLightAreThreeChannels)
{
  Scene scene = Cloud();
  scene.light.sky = { 0.2, 0.8, 0.1 };
  scene.light.lights = { Lamp({ 2.0, 8.0, 1.5 }) };
  EXPECT_THAT(scene.Solve(this->GetDevice()).leftOut, Not(Contains(HasSubstr("colour:"))));
  this->ExpectLeftOut(scene, "sigma_t a channel");
}

TEST_F(Traits, ColouredAlbedoSharesTransmittance)
{
  Scene scene = Cloud();
  std::vector<float> absorption, scattering;
  for (const float s : scene.sigma_s)
  {
    for (const float albedo : { 0.75f, 0.5f, 0.25f })
    {
      absorption.push_back(s * (1.0f - albedo));
      scattering.push_back(s * albedo);
    }
  }
  scene.sigma_a = absorption;
  scene.sigma_s = scattering;
  scene.ShineFromEverywhere(1.0);
  this->ExpectLeftOut(scene, "sigma_t a channel");
}

TEST_F(Traits, NoScatteringNeedsNoSource)
{
  Scene scene = Cloud();
  std::fill(scene.sigma_s.begin(), scene.sigma_s.end(), 0.0f);
  scene.ShineFromEverywhere(1.0);
  scene.light.lights = { Lamp({ 3.0, 3.0, 3.0 }) };
  this->ExpectLeftOut(scene, "scattering: sigma_s is zero");
  scene.emission = scene.sigma_a;
  this->ExpectLeftOut(scene, "scattering: sigma_s is zero");
}

TEST_F(Traits, NoAbsorptionNeedsNoSecondCoefficient)
{
  Scene scene = Cloud();
  std::fill(scene.sigma_a.begin(), scene.sigma_a.end(), 0.0f);
  scene.ShineFromEverywhere(1.0);
  this->ExpectLeftOut(scene, "absorption: sigma_a is zero");
}

TEST_F(Traits, NoEmissionAndADarkOutside)
{
  Scene scene = Cloud();
  scene.light.lights = { Lamp({ 3.0, 3.0, 3.0 }) };
  this->ExpectLeftOut(scene, "emission: the medium does not shine");
  this->ExpectLeftOut(scene, "boundary radiance: no environment");
}

TEST_F(Traits, EmptySlabsAreSweptOnce)
{
  for (const int resolution : { 1, 2 })
  {
    for (const bool emits : { false, true })
    {
      Scene scene = Cloud({ 21, 24, 19 }, { 4, 9, 2 }, { 9, 8, 12 });
      scene.medium.grid.spacing = { 1.0, 1.2, 0.9 };
      scene.light.sky = { 0.3, 0.3, 0.3 };
      scene.light.faces[1] = { 2.0, 2.0, 2.0 };
      scene.light.lights = { Lamp({ 3.0, 3.0, 3.0 }) };
      scene.emission = emits ? scene.sigma_a : std::vector<float>();
      scene.settings.netFlux = true;
      scene.settings.mapResolution = resolution;
      scene.settings.source = PropagationSource::Constant; // thick voxels by octant are swept everywhere
      const LightField light = this->ExpectLeftOut(scene, "empty slabs");
      EXPECT_GT(light.convergence.size(), 3u);
      EXPECT_LT(light.balance.RelativeError(1), 1e-5);
    }
  }
}

TEST_F(Traits, MomentsAreNotSweptInEmptyRows)
{
  for (const bool flux : { false, true })
  {
    Scene scene = Cloudlets(3);
    scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
    scene.settings.angularDegree = 3;
    scene.settings.maximumOrders = 4;
    scene.settings.netFlux = flux; // it is computed from moments
    scene.settings.periodic = { false, true, false };
    const LightField light = this->ExpectLeftOut(scene, "colour: medium and light are grey", 1e-5);
    const bool says = !flux && this->GetDevice().IsCpu();
    EXPECT_EQ(says, testing::Value(light.leftOut, Contains(HasSubstr("angular moments in empty voxels: 9"))));
  }
}

TEST_F(Traits, EmptySlabsInColour)
{
  Scene scene = Cloud({ 21, 24, 19 }, { 4, 9, 2 }, { 9, 8, 12 });
  scene.sigma_s = Coloured(scene.sigma_s, { 1.0, 0.5, 0.1 });
  scene.ShineFromEverywhere(1.0);
  scene.settings.source = PropagationSource::Constant;
  this->ExpectLeftOut(scene, "empty slabs");
}

TEST_F(Traits, DarkDirectionsAreNotSwept)
{
  Scene scene = Cloud();
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  scene.settings.netFlux = true;
  scene.settings.uncollidedDirections = 0; // else light comes in along those
  this->ExpectLeftOut(scene, "dark directions");
  scene.light.faces[4] = {};
  scene.light.environment = { 8, 4, {} };
  for (int j = 0; j < 4; ++j) // the top of the sky, brighter towards +x
  {
    for (int i = 0; i < 8; ++i)
    {
      const float radiance = j < 3 ? 0.0f : i < 2 ? 1.0f : 0.5f;
      scene.light.environment.radiance.insert(scene.light.environment.radiance.end(), 3, radiance);
    }
  }
  this->ExpectLeftOut(scene, "dark directions");
}

class TraitsOfOrdinates : public Traits
{
protected:
  LightField ExpectLeftOut(Scene& scene, OrdinatesSettings settings, const std::string& word)
  {
    scene.Attach();
    settings.directionsPerFace = 9;
    settings.netFlux = true;
    const auto solve = [&](bool leaveOut) {
      settings.leaveOut = leaveOut;
      const Domain domain(scene.medium.grid);
      return SolveDiscreteOrdinates(this->GetDevice(), domain, scene.medium, scene.light, settings);
    };
    return this->ExpectLeftOutBy(solve, word, 1e-5);
  }
};

TEST_F(TraitsOfOrdinates, EmptySlabsAreSweptOnce)
{
  for (const double g : { 0.0, 0.6 })
  {
    for (const std::array<int, 3>& first : { std::array<int, 3>{ 4, 9, 2 }, { 0, 16, 7 } })
    {
      Scene scene = Cloud({ 21, 24, 19 }, first, { 9, 8, 12 });
      scene.medium.grid.spacing = { 1.0, 1.2, 0.9 };
      scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
      scene.light.sky = { 0.3, 0.3, 0.3 };
      scene.light.faces[1] = { 2.0, 2.0, 2.0 };
      scene.light.lights = { Lamp({ 3.0, 3.0, 3.0 }) };
      scene.emission = g > 0.0 ? scene.sigma_a : std::vector<float>();
      const LightField light = this->ExpectLeftOut(scene, {}, "empty slabs");
      EXPECT_GT(light.convergence.size(), 3u);
      EXPECT_LT(light.balance.RelativeError(1), 1e-5);
    }
  }
}

TEST_F(TraitsOfOrdinates, EmptyVoxelsAreOnlySummed)
{
  for (const int margin : { 0, 4 }) // 4: empty slabs are left out, too
  {
    for (const OrdinatesScattering scattering :
      { OrdinatesScattering::SphericalHarmonics, OrdinatesScattering::Matrix })
    {
      Scene scene = Cloudlets(margin);
      scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
      OrdinatesSettings settings;
      settings.scattering = scattering;
      settings.maximumOrders = 5;
      settings.periodic = { false, margin == 0, false };
      this->ExpectLeftOut(scene, settings, "scattering in empty voxels");
    }
  }
}

/// The first channel scatters everywhere, and leaves out nothing.
TEST_F(TraitsOfOrdinates, AreThoseOfAllChannels)
{
  Scene scene = Cloudlets(0);
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  scene.sigma_s = Coloured(scene.sigma_s, { 1.0, 0.5, 0.1 });
  for (std::size_t i = 0; i < scene.sigma_s.size(); i += 3)
  {
    scene.sigma_s[i] = 0.2f;
  }
  OrdinatesSettings settings;
  settings.maximumOrders = 3;
  this->ExpectLeftOut(scene, settings, "scattering in empty voxels");
}

TEST_F(TraitsOfOrdinates, DarkDirectionsAreNotSwept)
{
  Scene scene = Cloud(), forward = Cloud();
  Environment& above = scene.light.environment;
  above.width = 16;
  above.height = 8;
  above.radiance.assign(3 * 16 * 8, 0.0f);
  std::fill_n(above.radiance.begin(), 3 * 16 * 4, 1.0f);
  this->ExpectLeftOut(scene, {}, "dark directions");
  forward.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  forward.light.faces[4] = { 1.0, 1.0, 1.0 };
  OrdinatesSettings byMatrix; // else light of faces comes in along rays
  byMatrix.scattering = OrdinatesScattering::Matrix;
  this->ExpectLeftOut(forward, byMatrix, "dark directions");
}

TEST_F(TraitsOfOrdinates, AreTheSameByMatrixBesideEmptyVoxels)
{
  Scene scene = Cloud({ 21, 24, 19 }, { 4, 9, 2 }, { 9, 8, 12 });
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  OrdinatesSettings settings;
  settings.scattering = OrdinatesScattering::Matrix;
  this->ExpectLeftOut(scene, settings, "dark directions");
  this->ExpectLeftOut(scene, settings, "scattering in empty voxels");
}

TEST_F(Traits, LatticesSolveOneChannelAndNoDarkOnes)
{
  Scene scene = Cloud();
  scene.Attach();
  LatticeSettings settings;
  settings.netFlux = true;
  const auto solve = [&](bool leaveOut) {
    settings.leaveOut = leaveOut;
    return SolveLatticeBoltzmann(this->GetDevice(), Domain(scene.medium.grid), scene.medium, {}, scene.light, settings);
  };
  scene.light.sky = { 0.5, 1.0, 0.25 };
  this->ExpectLeftOutBy(solve, "one channel stands for three", 1e-5);
  const std::vector<float> bluish = Coloured(scene.sigma_s, { 1.0, 0.9, 0.8 });
  scene.medium.sigma_s = { bluish.data(), 3 };
  scene.light.sky = { 1.0, 0.0, 0.5 };
  this->ExpectLeftOutBy(solve, "in 1 of 3", 1e-5);
}

TEST_F(Traits, MirrorImagesAreOneDirection)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 1, 1, 24 }, { 1, 12, 9 }, { 12, 1, 9 } })
  {
    for (const std::string light : { "face", "environment", "sun" })
    {
      Scene scene = Cloud(size, { 0, 0, 0 }, size);
      if (light == "face")
      {
        scene.light.faces[4] = { 1.0, 1.0, 1.0 };
      }
      else if (light == "environment") // not the same on both sides
      {
        std::vector<float> pixels(24, 0.1f);
        std::fill_n(pixels.begin() + 3, 3, 0.3f);
        scene.light.environment = { 4, 2, pixels };
      }
      else
      {
        scene.ShineAlong({ 0.2, 0.3, 0.8 });
      }
      scene.settings.maximumOrders = 4;
      for (int a = 0; a < 3; ++a)
      {
        scene.settings.periodic[a] = size[a] == 1;
      }
      this->ExpectLeftOut(scene, "mirror images");
    }
  }
}

TEST_F(Traits, NetFluxTellsMirrorImagesApart)
{
  Scene scene({ 1, 1, 12 }, 0.1f, 0.4f);
  scene.ShineAlong({ 0.2, 0.3, 0.8 });
  scene.settings.periodic = { true, true, false };
  scene.settings.netFlux = true;
  scene.settings.maximumOrders = 2;
  this->ExpectLeftOut(scene, "emission");
  EXPECT_THAT(scene.Solve(this->GetDevice()).leftOut, Not(Contains(HasSubstr("mirror images"))));
}

TEST_F(Traits, MirrorImagesAreOneDirectionWhereOrdersAreAccelerated)
{
  Scene scene({ 1, 1, 20 }, 0.001f, 5.0f);
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  scene.settings.periodic = { true, true, false };
  scene.settings.source = PropagationSource::Linear; // along rays
  this->ExpectLeftOut(scene, "mirror images", SameInThickSlab);
}

TEST_F(Traits, AcceleratedColourIsOneChannel)
{
  Scene scene({ 8, 8, 8 }, 0.0f, 10.0f);
  scene.light.sky = { 0.2, 0.8, 0.1 };
  this->ExpectLeftOut(scene, "all light has one colour");
}

TEST_F(Traits, AsPublishedOneChannelStandsForThree)
{
  Scene scene = Cloud();
  scene.light.sky = { 0.2, 0.8, 0.1 };
  scene.ShineAlong({ 0.2, 0.3, 0.8 });
  scene.light.lights[0].power = { 0.2, 0.8, 0.1 };
  scene.emission = Coloured(scene.sigma_a, { 0.1, 0.4, 0.05 });
  scene.settings.netFlux = true;
  scene.settings.storedDirections = 6;
  scene.settings.maximumOrders = 3;
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.3);
  scene.medium.sigma_a.values = scene.sigma_a.data();
  scene.medium.sigma_s.values = scene.sigma_s.data();
  scene.medium.emission = { scene.emission.data(), 3 };
  using Solve = std::function<LightField()>;
  const Solve sequential = [&] { return SolveSequential(scene.medium, scene.light, scene.settings); };
  const Solve parallel = [&] { return SolveParallel(this->GetDevice(), scene.medium, scene.light, scene.settings); };
  for (const Solve& solve : { sequential, parallel })
  {
    scene.settings.leaveOut = false;
    const LightField all = solve();
    scene.settings.leaveOut = true;
    const LightField less = solve();
    EXPECT_THAT(less.leftOut, Contains(HasSubstr("all light has one colour")));
    EXPECT_THAT(all.leftOut, Not(Contains(HasSubstr("colour"))));
    ExpectSameLight(less, all);
  }
}

TEST_F(Traits, AsPublishedSaysWhatIsLeftOut)
{
  Scene scene = Cloud();
  scene.medium.sigma_a.values = scene.sigma_a.data();
  scene.settings.maximumOrders = 1;
  scene.ShineFromEverywhere(1.0);
  for (const LightField& light : { SolveSequential(scene.medium, scene.light, scene.settings),
         SolveParallel(this->GetDevice(), scene.medium, scene.light, scene.settings) })
  {
    EXPECT_THAT(light.leftOut, Contains(left_out::Grey));
    EXPECT_THAT(light.leftOut, Contains(left_out::NoScattering));
    EXPECT_THAT(light.leftOut, Contains(left_out::NoEmission));
  }
}
