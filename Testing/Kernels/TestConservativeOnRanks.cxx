// What the conservative solver chooses and computes otherwise for some scenes, on several ranks: the serial light.

#include "SolvedOnRanks.h"
#include "TransparentBox.h"

#include "Distribution/SharedMedium.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Emission/EmissionPeaks.h"
#include "LightPropagation/Problem/PropagationQuality.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

using namespace tyndall;

namespace
{
/// A scene and settings, on ranks.
struct ScenesCase
{
  MediumToCut medium;
  PropagationSettings settings;
  BlockPartition partition;
  double tolerance = ConservativeSolver::Tolerance;
};
struct NamedScene
{
  std::string name;
  std::function<ScenesCase()> make;
};
void PrintTo(const NamedScene& scene, std::ostream* out)
{
  *out << scene.name;
}

ScenesCase Of(MediumToCut medium, const PropagationSettings& settings)
{
  const BlockPartition partition = Uneven(medium.Grid());
  return { std::move(medium), settings, partition };
}

PropagationSettings Plain(int orders = 0)
{
  return ConservativeSolver::Plain(orders);
}

/// As users have it, with flux.
PropagationSettings Accelerated(PropagationSource source = PropagationSource::Automatic)
{
  PropagationSettings settings = Plain();
  settings.acceleration = PropagationAcceleration::Automatic;
  settings.source = source;
  return settings;
}

/// Everything, with extinction up to `densest` a length of which a part is scattered.
MediumToCut Thick(std::array<int, 3> size, double densest, double albedo, double decades = 2.0)
{
  MediumToCut medium = Everything(size);
  medium.scene.Randomise(densest, decades, albedo, 5);
  return medium;
}

void InColour(MediumToCut& medium)
{
  Scene& scene = medium.scene;
  const std::vector<float> grey = scene.sigma_s, tint = RandomValues(3 * grey.size(), 0.5, 1.0, 9);
  scene.sigma_s.resize(3 * grey.size());
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    scene.sigma_s[i] = grey[i / 3] * tint[i];
  }
  for (Light& light : scene.light.lights)
  {
    light.power = { 1.0, 0.0, 3.0 };
  }
}

void EmitFromOneVoxel(MediumToCut& medium)
{
  std::vector<float>& emission = medium.scene.emission;
  emission.assign(medium.Grid().VoxelCount(), 0.0f);
  emission[medium.Grid().IndexOf({ 3, 4, 4 })] = 100.0f;
}

/// Spots and points far off, a cone thinner than a voxel, and lamps on faces, on edges and on the border of a block;
/// rectangles larger than the box and in it.
void AddOddLamps(Scene& scene)
{
  std::vector<Light> lamps(7);
  for (Light& lamp : lamps)
  {
    lamp.type = LightType::Point;
    lamp.power = { 3.0, 3.0, 3.0 };
  }
  for (const int i : { 0, 1 })
  {
    const double distance = i == 0 ? 4e3 : 4e8;
    lamps[i].position = { 0.6 * distance, -0.2 * distance, -distance };
    lamps[i].power = Times(Rgb{ 3.0, 3.0, 3.0 }, distance * distance);
  }
  lamps[2].type = LightType::Spot;
  lamps[2].position = { 1.8 + 40.0, 3.1, 88.0 };
  lamps[2].direction = { -1.0, 0.0, -2.0 };
  lamps[2].angle = 1e-6;
  lamps[3].position = { 0.0, 1.7, 0.0 };
  lamps[4].position = { 2.0, 1.0, 4.0 };
  for (const int i : { 5, 6 })
  {
    lamps[i].type = LightType::Rectangle;
    lamps[i].direction = { 0.0, 0.1, -1.0 };
    lamps[i].position = { 3.0, 2.0, i == 5 ? 12.0 : 5.0 };
    lamps[i].size = { i == 5 ? 70.0 : 4.0, i == 5 ? 40.0 : 3.0 };
  }
  scene.light.lights.insert(scene.light.lights.end(), lamps.begin(), lamps.end());
}

/// Seven suns of other colours: in a grey medium channels share transmittance, and four beams are exact in angle.
ScenesCase ManySuns()
{
  MediumToCut medium = Everything({ 6, 9, 8 });
  medium.scene.medium.phase = PhaseFunction::DoubleHenyeyGreenstein(0.9, -0.4, 0.8);
  medium.scene.light = {};
  for (int i = 0; i < 7; ++i)
  {
    medium.scene.ShineAlong({ std::sin(1.0 + i), std::cos(2.0 * i), -0.4 + 0.2 * i });
    medium.scene.light.lights.back().power = { 1.0, 0.1 * i, 2.0 - 0.2 * i };
  }
  PropagationSettings settings = Plain(5);
  settings.angularDegree = 2;
  return Of(std::move(medium), settings);
}

/// The last block has no voxel thin enough for moments, the others have fewer than the first.
ScenesCase ThickBlocksInMoments()
{
  MediumToCut medium = Everything({ 12, 5, 5 });
  Scene& scene = medium.scene;
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    const int x = scene.medium.grid.VoxelAt(i)[0];
    scene.sigma_s[i] *= x < 3 ? 1.0f : x < 6 ? 8.0f : 100.0f;
    scene.sigma_a[i] += x < 6 ? 0.0f : 1.0f;
  }
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.7);
  PropagationSettings settings = Plain(6);
  settings.angularDegree = 2;
  ScenesCase made = Of(std::move(medium), settings);
  made.partition = Slices(made.medium.Grid(), { 4, 8 });
  return made;
}

/// Only one block absorbs anything, and no light leaves.
ScenesCase MirrorsAboutOneAbsorber()
{
  MediumToCut medium = Everything({ 6, 5, 4 });
  for (std::size_t i = 0; i < medium.scene.sigma_a.size(); ++i)
  {
    medium.scene.sigma_a[i] = i % 6 == 5 ? 0.5f : 0.0f;
  }
  medium.scene.light = {};
  medium.scene.light.faceAlbedo.fill({ 1.0, 1.0, 1.0 });
  return Of(std::move(medium), Plain(6));
}

ScenesCase Moments(std::array<int, 3> size, double g, int degree, int perFace = 9)
{
  MediumToCut medium = Everything(size);
  medium.scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
  PropagationSettings settings = Plain(3);
  settings.angularDegree = degree;
  settings.directionsPerFace = perFace;
  return Of(std::move(medium), settings);
}

/// Boundary light along finer directions.
ScenesCase Finer(int directions, double g, double albedo)
{
  MediumToCut medium = Everything({ 9, 7, 8 });
  medium.scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
  medium.scene.light.faceAlbedo[2].fill(albedo);
  PropagationSettings settings = Plain(4);
  settings.uncollidedDirections = directions;
  return Of(std::move(medium), settings);
}

ScenesCase Octants(MediumToCut medium, const std::function<void(Scene&, PropagationSettings&)>& change = {})
{
  PropagationSettings settings = Plain(4);
  settings.directionsPerFace = 4;
  settings.source = PropagationSource::Octants;
  if (change)
  {
    change(medium.scene, settings);
  }
  return Of(std::move(medium), settings);
}

/// Thick voxels, whose orders diffusion accelerates.
ScenesCase Dsa(MediumToCut medium, const std::function<void(MediumToCut&, PropagationSettings&)>& change = {})
{
  PropagationSettings settings = Accelerated(PropagationSource::Linear);
  settings.tolerance = 1e-6;
  if (change)
  {
    change(medium, settings);
  }
  ScenesCase made = Of(std::move(medium), settings);
  made.tolerance = 2e-5;
  return made;
}

std::vector<NamedScene> Scenes()
{
  const auto with = [](MediumToCut medium, const std::function<void(Scene&)>& change) {
    change(medium.scene);
    return medium;
  };
  return {
    { "Similarity",
      [] {
        ScenesCase made = Moments({ 6, 7, 5 }, 0.4, 0);
        InColour(made.medium);
        return made;
      } },
    { "Moments",
      [] {
        return Moments({ 19, 8, 7 }, 0.85, -1);
      } },
    { "MomentsInAFlatBox",
      [] {
        return Moments({ 28, 20, 2 }, 0.85, 2, 16);
      } },
    { "MomentsInSingleVoxels",
      [] {
        ScenesCase made = Moments({ 3, 2, 3 }, 0.6, 2);
        made.settings.storeMoments = made.settings.netFlux = false;
        made.partition = SingleVoxels(made.medium.Grid());
        return made;
      } },
    { "MomentsInThickBlocks", ThickBlocksInMoments },
    { "ManySuns", ManySuns },
    { "OddLamps",
      [&] {
        return Of(with(Everything({ 6, 5, 7 }), AddOddLamps), Plain(2));
      } },
    { "ColouredLampsInMoments",
      [] {
        ScenesCase made = Moments({ 7, 8, 6 }, 0.7, -1);
        AddNearLamps(made.medium.scene);
        InColour(made.medium);
        made.settings.facePower = true;
        return made;
      } },
    { "FacesInMoments",
      [] {
        ScenesCase made = Moments({ 6, 7, 5 }, 0.85, 1);
        InColour(made.medium);
        made.medium.scene.light.faceAlbedo = { Rgb{ 0.5, 0.5, 0.5 }, { 0.9, 0.1, 0.5 }, {}, { 0.9, 0.9, 0.9 },
          { 1.0, 1.0, 1.0 } };
        return made;
      } },
    { "FacesThroughEdges",
      [] { // some rays move both ways at once: past the edges of the grid, and of blocks
        ScenesCase made = Moments({ 8, 9, 10 }, 0.0, 0, 16);
        made.medium.scene.light.faceAlbedo.fill({ 0.8, 0.8, 0.8 });
        return made;
      } },
    { "MirrorsAboutOneAbsorber", MirrorsAboutOneAbsorber },
    { "PeriodicBetweenFacesInMoments",
      [] {
        ScenesCase made = Moments({ 5, 6, 4 }, 0.8, 1);
        made.medium.scene.Randomise(3.0, 0.5, 0.8, 5);
        made.medium.scene.light.faceAlbedo[4].fill(0.7);
        made.settings.periodic = { true, true, false };
        return made;
      } },
    { "FinerDirections", [] { return Finer(36, 0.0, 0.0); } },
    { "FinerDirectionsBetweenFaces", [] { return Finer(36, 0.0, 0.6); } },
    { "FinerDirectionsInMoments", [] { return Finer(36, 0.8, 0.0); } },
    { "ChosenDirections", [] { return Finer(-1, 0.0, 0.0); } },
    { "CoarseMeshDsa",
      [] { // thin voxels in which light is scattered many times
        MediumToCut medium = Thick({ 22, 19, 18 }, 0.5, 0.98, 1.0);
        InColour(medium);
        PropagationSettings settings = Accelerated();
        settings.tolerance = 1e-5;
        ScenesCase made = Of(std::move(medium), settings);
        made.tolerance = 1e-5;
        return made;
      } },
    { "GivenLightBySimilarity",
      [] {
        ScenesCase made = Moments({ 9, 7, 8 }, 0.7, 0);
        GiveLight(made.medium, false);
        return made;
      } },
    { "GivenLightInMoments",
      [] {
        ScenesCase made = Moments({ 9, 7, 8 }, 0.7, -1);
        GiveLight(made.medium, false);
        return made;
      } },
    { "GivenColouredLightBetweenFaces",
      [] {
        ScenesCase made = Moments({ 5, 6, 7 }, 0.0, 0);
        GiveLight(made.medium, true);
        made.medium.scene.light.faceAlbedo[3] = { 0.5, 0.7, 0.9 };
        return made;
      } },
    { "Octants",
      [] {
        MediumToCut medium = Thick({ 5, 6, 4 }, 4.0, 0.5, 1.0);
        AddNearLamps(medium.scene);
        InColour(medium);
        return Octants(std::move(medium));
      } },
    { "OctantsAroundAnAxis",
      [] {
        return Octants(Thick({ 9, 3, 4 }, 8.0, 0.5, 1.0), [](Scene& scene, PropagationSettings& settings) {
          scene.light.lights[0].direction = { 0.0, -0.5, -0.9 }; // across it: around it takes many laps
          settings.maximumOrders = 2;
          settings.periodic[0] = true;
        });
      } },
    { "OctantsFromFinerDirections",
      [] {
        return Octants(Thick({ 3, 4, 5 }, 4.0, 0.5, 1.0), [](Scene& scene, PropagationSettings& settings) {
          scene.light.lights.clear();
          settings.uncollidedDirections = 9;
        });
      } },
    { "OctantsBetweenFaces",
      [] {
        return Octants(Thick({ 3, 4, 5 }, 4.0, 0.5, 1.0), [](Scene& scene, PropagationSettings& settings) {
          scene.light.faceAlbedo[2] = { 0.8, 0.6, 0.4 };
          settings.maximumOrders = 2;
        });
      } },
    { "OctantsUnasked",
      [] { // many thick voxels that absorb so much that acceleration does not pay
        return Octants(Thick({ 5, 4, 3 }, 4.0, 0.2, 1.0), [](Scene&, PropagationSettings& settings) {
          settings.source = PropagationSource::Automatic;
          settings.acceleration = PropagationAcceleration::Automatic;
          settings.maximumOrders = 0;
        });
      } },
    { "OctantsBelowZero",
      [] { // what their sources leave below 0 is taken from the voxels beside
        return Octants(Thick({ 7, 8, 6 }, 1000.0, 0.6), [](Scene&, PropagationSettings& settings) {
          settings = {};
          settings.tolerance = 1e-6;
          settings.emissionError = 0.0;
        });
      } },
    { "DsaInAWhiteCube",
      [] {
        return Dsa(Thick({ 16, 16, 16 }, 6.0, 1.0, 0.0), [](MediumToCut& medium, PropagationSettings& settings) {
          medium.scene.emission.clear();
          medium.scene.light.lights.clear();
          settings.source = PropagationSource::Automatic;
        });
      } },
    { "DsaBesideOpaqueVoxels",
      [] { // in thin gas, where the systems' solution is negative
        return Dsa(Thick({ 9, 8, 7 }, 1e4, 0.8, 8.0));
      } },
    { "DsaOfNearLamps",
      [] {
        MediumToCut medium = Thick({ 8, 7, 9 }, 8.0, 0.999);
        AddNearLamps(medium.scene);
        InColour(medium);
        return Dsa(std::move(medium));
      } },
    { "DsaAlongFinerDirections",
      [] {
        return Dsa(Thick({ 8, 7, 9 }, 8.0, 0.999), [](MediumToCut& medium, PropagationSettings& settings) {
          medium.scene.light.lights.clear();
          settings.uncollidedDirections = -1;
        });
      } },
    { "DsaBetweenFaces",
      [] {
        return Dsa(Thick({ 7, 6, 5 }, 6.0, 0.9), [](MediumToCut& medium, PropagationSettings&) {
          InColour(medium);
          medium.scene.light.faceAlbedo = { Rgb{}, { 0.9, 0.1, 0.5 }, {}, { 0.6, 0.6, 0.6 }, { 1.0, 1.0, 1.0 } };
        });
      } },
    { "DsaAroundAnAxisInMoments",
      [] {
        return Dsa(Thick({ 4, 3, 5 }, 12.0, 0.9, 1.0), [](MediumToCut& medium, PropagationSettings& settings) {
          medium.scene.light.lights.clear();
          medium.scene.light.faceAlbedo[4].fill(0.7);
          medium.scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.7);
          settings.periodic[1] = true;
          settings.angularDegree = 1;
        });
      } },
    { "DsaAroundAllAxes",
      [] {
        ScenesCase made = Dsa(Thick({ 3, 2, 4 }, 12.0, 0.9, 1.0));
        made.medium.scene.light = {};
        made.settings.periodic.fill(true);
        made.settings.directionsPerFace = 4;
        made.settings.tolerance = made.tolerance = 1e-4;
        return made;
      } },
    { "DsaInMoments",
      [] {
        return Dsa(Thick({ 6, 5, 4 }, 6.0, 0.9), [](MediumToCut& medium, PropagationSettings& settings) {
          InColour(medium);
          medium.scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.7);
          settings.angularDegree = 2;
        });
      } },
    { "DsaOfGivenLight",
      [] {
        return Dsa(Thick({ 8, 7, 9 }, 8.0, 0.999), [](MediumToCut& medium, auto&) { GiveLight(medium, false); });
      } },
    { "DsaOfLocalisedEmission",
      [] {
        return Dsa(Thick({ 8, 7, 9 }, 3.0, 0.9), [](MediumToCut& medium, PropagationSettings& settings) {
          EmitFromOneVoxel(medium);
          settings.emissionError = 0.02;
        });
      } },
    { "DsaInSingleVoxelsBesideRanksWithout",
      [] {
        ScenesCase made = Dsa(Thick({ 2, 2, 1 }, 12.0, 0.9));
        made.partition = BlockPartition::Even(made.medium.Grid(), 6);
        return made;
      } },
  };
}
}

class ConservativeOnRanks : public SolvedOnRanks<ConservativeSolver>
{
protected:
  /// On one rank and on three.
  void ExpectOnRanks(
    MediumToCut& medium, const PropagationSettings& settings, const std::function<void(const LightField&)>& expect)
  {
    expect(this->Serial(medium, settings));
    expect(this->OnRanks(BlockPartition::Even(medium.Grid(), 3), medium, settings));
  }
};

class SceneOnRanks
  : public SolvedOnRanks<ConservativeSolver>
  , public testing::WithParamInterface<NamedScene>
{
};

TEST_P(SceneOnRanks, HasTheSerialLight)
{
  ScenesCase made = this->GetParam().make();
  this->ExpectSerialLight(made.medium, made.settings, made.partition, made.tolerance);
}

INSTANTIATE_TEST_SUITE_P(
  Of, SceneOnRanks, testing::ValuesIn(Scenes()), [](const auto& info) { return info.param.name; });

/// What beams deposit is in fixed point, whichever rank follows them. Only the factor that makes the entering power
/// that of the solid angle is a sum in floats, in the order of ranks.
TEST_F(ConservativeOnRanks, HasTheUncollidedLightOfLampsButForOneFactor)
{
  MediumToCut medium = Everything({ 4, 3, 2 });
  medium.scene.light = {};
  medium.scene.light.lights = { PointLamp({ -1.0, 4.4, -2.5 }, { 10.0, 4.0, 1.0 }) };
  medium.scene.emission.clear(); // which is swept
  const std::vector<float> expected = this->Serial(medium, Plain(2)).fluenceDirect;
  for (const int ranks : { 3, 26 }) // of which two have no voxels
  {
    const std::vector<float> found =
      this->OnRanks(BlockPartition::Even(medium.Grid(), ranks), medium, Plain(2)).fluenceDirect;
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      ASSERT_FLOAT_EQ(found[i], expected[i]) << i;
    }
  }
}

TEST_F(ConservativeOnRanks, LosesNothingOfALampInABoxWithoutFaces)
{
  for (const double densest : { 0.05, 0.7 })
  {
    MediumToCut medium({ 12, 9, 10 });
    medium.scene.Randomise(densest, 1.0, 0.0);
    AddNearLamps(medium.scene);
    medium.scene.light.lights.resize(1);
    PropagationSettings settings = Plain(1);
    settings.periodic = { true, true, true };
    this->ExpectOnRanks(medium, settings, [](const LightField& light) {
      EXPECT_NEAR(light.balance.absorbed[0], light.balance.entered[0], 5e-5 * light.balance.entered[0]);
    });
  }
}

namespace
{
MediumToCut Glow(std::array<int, 3> size)
{
  MediumToCut glow(size);
  glow.scene.emission.assign(glow.scene.sigma_a.size(), 1.0f);
  return glow;
}
}

/// An odd number of directions along the edge of a cube's face has one along an axis: its light never ends, and is left
/// over.
TEST_F(ConservativeOnRanks, EndsWhereLightAlongAPeriodicAxisDoesNot)
{
  MediumToCut medium = Glow({ 4, 3, 3 });
  medium.scene.sigma_a[3] = 0.5f;
  PropagationSettings settings = Plain();
  settings.adaptDirections = false; // else no direction is along the axis
  settings.periodic = { true, false, false };
  this->ExpectOnRanks(medium, settings, [](const LightField& light) {
    EXPECT_LT(light.convergence.size(), 20u);
    EXPECT_LT(light.balance.RelativeError(1), 1e-5);
    EXPECT_GT(light.balance.leftOver[0], 0.01 * light.balance.emitted[0]);
    EXPECT_THAT(
      light.doubts, testing::ElementsAre(testing::HasSubstr("left over: its rays still go round periodic axes")));
  });
}

/// What empty voxels emit has directions of its own, none along such an axis: the light is that of a rod without ends.
TEST_F(ConservativeOnRanks, HasTheLightOfAnEmittingVacuumAlongAPeriodicAxis)
{
  MediumToCut medium = Glow({ 4, 4, 4 });
  PropagationSettings settings;
  settings.periodic = { true, false, false };
  settings.directionsPerFace = 9;
  this->ExpectOnRanks(medium, settings, [](const LightField& light) {
    const double mean = std::accumulate(light.fluence.begin(), light.fluence.end(), 0.0) / 64.0;
    const double rod = MeanFluenceOfTransparentBox({ std::numeric_limits<double>::infinity(), 4.0, 4.0 });
    EXPECT_NEAR(mean / rod, 1.0, 0.08);
    EXPECT_LT(light.balance.leftOver[0], 1e-6 * light.balance.emitted[0]);
  });
}

/// An emitting medium and a beam: each by itself, and both.
TEST_F(ConservativeOnRanks, AddsUpSourcesInMoments)
{
  ScenesCase both = Moments({ 8, 7, 6 }, 0.85, 2);
  Illumination beam;
  beam.lights = both.medium.scene.light.lights;
  both.medium.scene.light = beam;
  MediumToCut dark = both.medium, cold = both.medium;
  dark.scene.light = {};
  cold.scene.emission.clear();
  for (const BlockPartition& partition : { BlockPartition::Even(dark.Grid(), 1), BlockPartition::Even(dark.Grid(), 3) })
  {
    std::vector<float> sum = this->OnRanks(partition, dark, both.settings).fluence;
    const std::vector<float> ofBeam = this->OnRanks(partition, cold, both.settings).fluence;
    std::transform(sum.begin(), sum.end(), ofBeam.begin(), sum.begin(), std::plus<>());
    EXPECT_LT(RelativeRmse(this->OnRanks(partition, both.medium, both.settings).fluence, sum), 1e-6);
  }
}

/// Traced from voxel to voxel, as far as it goes through vacuum.
TEST_F(ConservativeOnRanks, HasTheEmissionOfVacuum)
{
  MediumToCut medium = Everything({ 4, 3, 5 });
  for (std::size_t i = 0; i < medium.scene.sigma_a.size(); i += 7)
  {
    medium.scene.sigma_a[i] = medium.scene.sigma_s[i] = 0.0f;
  }
  PropagationSettings settings = Plain(2);
  settings.emissionError = 0.02;
  const LightField apart = this->ExpectSerialLight(medium, settings);
  settings.emissionError = 0.0;
  EXPECT_GT(RelativeDifference(this->Serial(medium, settings).fluence, apart.fluence), 1e-4);
}

/// Each rank traces its rays through the whole domain; they were swept, 0.6% off in vacuum.
TEST_F(ConservativeOnRanks, HasTheRaysOfLocalisedEmission)
{
  for (const double g : { 0.0, 0.7 })
  {
    MediumToCut medium = Thick({ 6, 9, 8 }, 0.3, 0.8);
    InColour(medium);
    EmitFromOneVoxel(medium);
    medium.scene.light.faceAlbedo[0] = { 0.5, 0.5, 0.5 };
    medium.scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
    PropagationSettings settings = Plain(3);
    settings.angularDegree = g > 0.0 ? 2 : 0;
    settings.emissionError = 0.02;
    const LightField traced = this->ExpectSerialLight(medium, settings);
    settings.emissionError = 0.0;
    EXPECT_GT(RelativeDifference(this->Serial(medium, settings).fluence, traced.fluence), 1e-3);
  }
}

// A lamp within an opaque block in vacuum, more than floats can carry.
TEST_F(ConservativeOnRanks, RefusesLightThatDoesNotBalance)
{
  MediumToCut medium({ 9, 9, 9 });
  for (int i = 0; i < 27; ++i)
  {
    medium.scene.sigma_s[medium.Grid().IndexOf({ 3 + i % 3, 3 + i / 3 % 3, 3 + i / 9 })] = 1e30f;
  }
  medium.scene.light.lights = { PointLamp({ 4.5, 4.5, 4.5 }) };
  for (const int ranks : { 1, 3 })
  {
    const auto errors = ErrorsOnRanks(BlockPartition::Even(medium.Grid(), ranks),
      [&](const Domain& domain) { ConservativeSolver::Solve(this->GetDevice(), domain, medium.Part(domain), {}); });
    EXPECT_THAT(
      errors, testing::Each(testing::HasSubstr("Its thickest voxel, (3, 3, 3), has optical thickness 1e+30")));
  }
}

TEST_F(ConservativeOnRanks, IsStoppedInTheLightOfLampsAndInSweeps)
{
  for (const double until : { 0.1, 0.7 })
  {
    this->ExpectErrors("aborted", [&](int rank, auto&, PropagationSettings& settings, Monitor& monitor) {
      settings = Accelerated(PropagationSource::Linear);
      monitor = rank == 2 ? Monitor([until](double done) { return done < until; }) : Monitor();
    });
  }
}

/// g by voxel that is the same in all voxels of one block that scatter and varies in another, or is the same in all
/// blocks or all but one. In voxels that do not scatter it is any number.
TEST_F(ConservativeOnRanks, AgreesOnWhetherTheMeanCosineVaries)
{
  const PhaseFunction kind = PhaseFunction::Schlick(0.0);
  for (const std::array<float, 2>& g : { std::array<float, 2>{ 0.3f, -0.2f }, { 0.5f, 0.5f }, { 0.5f, 0.8f } })
  {
    SCOPED_TRACE(testing::PrintToString(g));
    MediumToCut medium = Everything({ 12, 5, 4 });
    std::vector<float> cosines;
    for (std::size_t i = 0; i < medium.scene.sigma_s.size(); ++i)
    {
      const int x = medium.Grid().VoxelAt(i)[0];
      medium.scene.sigma_s[i] *= x == 5 || (x >= 8 && g[0] == g[1]) ? 0.0f : 1.0f; // the last block does not scatter
      const float of = x < 4 ? g[0] : x < 8 ? 0.5f : g[1];
      cosines.push_back(medium.scene.sigma_s[i] > 0.0f ? of : 0.01f * static_cast<float>(x));
    }
    // As filters read their piece.
    const auto solve = [&](const Domain& domain, MediumToCut& part) {
      const std::vector<float> own = BlockOf(domain, cosines);
      const Field field = { own.data(), 1 };
      Medium& read = part.scene.medium;
      read.phase = PhaseByVoxel(kind, field, MeanCosineRange(field, read.sigma_s, own.size()));
      AgreeOnMeanCosine(domain.Comm(), true, field, read);
      EXPECT_EQ(read.phase.Varies(), g[1] != 0.5f || g[0] != 0.5f);
      return ConservativeSolver::Solve(this->GetDevice(), domain, part, Plain(6));
    };
    ExpectSameLight(LightOnRanks(BlockPartition::Even(medium.Grid(), 3), medium, solve),
      LightOnRanks(BlockPartition::Even(medium.Grid(), 1), medium, solve), 2e-6);
  }
}

/// Blocks of which the first alone is thick, the last alone scatters: what matters is the whole.
TEST_F(ConservativeOnRanks, HasTheSettingsOfAQualityForTheWhole)
{
  for (const float thick : { 0.5f, 3.0f })
  {
    MediumToCut medium({ 16, 12, 12 });
    medium.scene.Randomise(0.01, 1.0, 0.5);
    medium.scene.ShineFromEverywhere(0.2);
    std::fill_n(medium.scene.sigma_a.begin(), 16 * 12 * 6, thick);
    std::fill_n(medium.scene.sigma_s.begin(), 16 * 12 * 11, 0.0f);
    for (const int ranks : { 1, 3 })
    {
      ErrorsOnRanks(BlockPartition::Even(medium.Grid(), ranks), [&](const Domain& domain) {
        const MediumToCut part = medium.Part(domain);
        EXPECT_EQ(AtQuality(domain, Quality::Fine, {}, part.scene.medium, part.scene.light).directionsPerFace,
          thick > 1.0f ? 49 : 64);
      });
    }
  }
}

/// Bit for bit, of light of all kinds; on a GPU in slices of the blocks, with copies. Without a budget of the user's:
/// nine tenths of what is left of a device with memory of its own.
TEST_F(ConservativeOnRanks, HasTheSameLightInHostMemory)
{
  setenv("TYNDALL_WITHOUT", "host_memory", 1);
  for (const NamedScene& scene : Scenes())
  {
    const std::vector<std::string> some = { "Similarity", "Moments", "OctantsAroundAnAxis", "DsaBetweenFaces" };
    if (std::find(some.begin(), some.end(), scene.name) == some.end())
    {
      continue;
    }
    SCOPED_TRACE(scene.name);
    ScenesCase made = scene.make();
    const LightField expected = this->OnRanks(made.partition, made.medium, made.settings);
    made.settings.memoryBudget = 10000;
    const LightField found = this->OnRanks(made.partition, made.medium, made.settings);
    EXPECT_EQ(found.fluence, expected.fluence);
    EXPECT_EQ(found.netFlux, expected.netFlux);
    EXPECT_EQ(found.facePowerOut, expected.facePowerOut);
    EXPECT_NE(found.device.find("host memory"), std::string::npos) << found.device;
    EXPECT_EQ(expected.device.find("host memory"), std::string::npos) << expected.device;
  }
  MediumToCut medium = Everything({ 12, 11, 13 });
  const LightField expected = this->Serial(medium, Plain(3));
  Device small(this->GetDevice(), { 100000, false, MemoryBudget::NoLimit });
  const LightField found = ConservativeSolver::Solve(small, Domain(medium.Grid()), medium, Plain(3));
  EXPECT_EQ(found.fluence, expected.fluence);
  EXPECT_NE(found.device.find("from host memory"), std::string::npos) << found.device;
  unsetenv("TYNDALL_WITHOUT");
}

TEST_F(ConservativeOnRanks, SaysWhereThickVoxelsHaveNoSourcesByOctant)
{
  for (const double densest : { 0.1, 3e4 })
  {
    ScenesCase made = Octants(Thick({ 3, 2, 2 }, densest, 0.5, 1.0));
    this->ExpectOnRanks(made.medium, made.settings, [&](const LightField& light) {
      EXPECT_THAT(
        light.leftOut, testing::Contains(std::string(densest < 1.0 ? left_out::ThinVoxels : left_out::NotByOctant)));
    });
  }
  MediumToCut cells = Thick({ 22, 19, 18 }, 0.5, 0.98, 1.0);
  PropagationSettings settings = Accelerated(PropagationSource::Octants);
  this->ExpectOnRanks(cells, settings, [&](const LightField& light) {
    EXPECT_THAT(light.leftOut, testing::Contains(std::string(left_out::NotByOctant)));
    EXPECT_THAT(light.leftOut, testing::Not(testing::Contains(std::string("acceleration: few scattering orders do"))));
  });
}

/// What a serial solve has beyond several ranks is one sentence, the same on all, whatever the blocks.
TEST_F(ConservativeOnRanks, SaysWhatASerialSolveWouldDoBetter)
{
  const auto even = [](float absorbed, float scattered, std::array<int, 3> size = { 12, 11, 13 }) {
    MediumToCut medium(size);
    medium.scene = Scene(size, absorbed, scattered);
    medium.scene.ShineFromEverywhere(1.0);
    return medium;
  };
  const auto expect = [&](const std::string& words, const MediumToCut& medium, std::array<bool, 3> periodic = {}) {
    PropagationSettings settings;
    settings.periodic = periodic;
    for (const int ranks : { 3, 8 })
    {
      ErrorsOnRanks(BlockPartition::Even(medium.Grid(), ranks), [&](const Domain& domain) {
        const MediumToCut part = medium.Part(domain);
        const std::string told =
          ReasonNotToDecompose(this->GetDevice(), domain, part.scene.medium, part.scene.light, settings);
        EXPECT_EQ(told.substr(0, words.size()), words);
        EXPECT_EQ(told.empty(), words.empty()) << told;
      });
    }
  };
  expect("", Thick({ 12, 9, 7 }, 0.1, 0.5));
  expect("", Thick({ 12, 9, 7 }, 5.0, 0.2)); // by octant, as in a serial solve
  MediumToCut white = even(0.001f, 4.0f), orders = even(0.001f, 0.4f), layers = even(0.1f, 0.1f, { 4, 5, 6 });
  expect("", white);
  white.scene.light.faceAlbedo[0] = { 0.5, 0.5, 0.5 };
  expect("", white);
  expect("", orders);
  expect("layers", layers, { true, false, true });
  layers.scene.sigma_a[7] = 0.2f; // none any more
  expect("", layers, { true, false, true });
  orders.scene.sigma_a[7] = 0.002f;
  expect("", orders, { true, true, false }); // coarse-mesh DSA wraps around on several ranks, too
  MediumToCut dark = even(0.05f, 0.05f);
  dark.scene.light = {};
  dark.scene.emission = RandomValues(dark.scene.sigma_a.size(), 0.0, 0.01, 7);
  expect("", dark);
  dark.scene.emission[dark.Grid().IndexOf({ 6, 5, 6 })] = 100.0f;
  dark.Attach();
  ASSERT_FALSE(Split(dark.scene.medium).peaks.empty());
  expect("", dark); // each rank traces its rays
}
