// Scenes in which nothing varies along two axes: layers, solved in the cosine alone.

#include "DeviceTest.h"
#include "Difference.h"
#include "MediumScene.h"

#include "Device/Errors.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "LightPropagation/PlaneParallel/PlaneParallelPropagation.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Reference/ReferenceTable.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

using namespace tyndall;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

namespace
{
std::array<bool, 3> PeriodicBut(int axis)
{
  std::array<bool, 3> periodic = { true, true, true };
  periodic[axis] = false;
  return periodic;
}

/// Layers along z, of optical thickness tau in all, with a height of 1.
Scene Slab(double tau, double albedo, double g, int layers = 64)
{
  Scene scene({ 1, 1, layers }, static_cast<float>(tau * (1.0 - albedo)), static_cast<float>(tau * albedo));
  scene.medium.grid.spacing = { 1.0, 1.0, 1.0 / layers };
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
  scene.settings.periodic = PeriodicBut(2);
  return scene;
}

/// Of light that comes in through the lower face, 1 W.
struct Parts
{
  double reflected, transmitted;
};

Parts PartsOf(Device& device, Scene scene, double cosine)
{
  if (cosine > 0.0)
  {
    scene.ShineAlong({ std::sqrt(1.0 - cosine * cosine), 0.0, cosine }, 1.0 / cosine);
  }
  else
  {
    scene.light.faces[4] = { 1.0 / Pi, 1.0 / Pi, 1.0 / Pi };
  }
  const LightField light = scene.Solve(device);
  EXPECT_EQ(light.polarNodes > 0, true);
  EXPECT_NEAR(light.balance.entered[0], 1.0, 1e-12);
  EXPECT_LE(light.balance.RelativeError(1), 1e-6);
  return { light.facePowerOut[4][0], light.facePowerOut[5][0] };
}

/// Layers of their own density and albedo each along an axis, in columns that are all alike, in colour, which shine,
/// under two suns, lit through both faces, with ground behind both.
/// @param parts  into which each layer is cut, all alike
Scene ColumnsAlong(int axis, int across, const PhaseFunction& phase, unsigned seed, int parts = 1)
{
  constexpr int layers = 11;
  std::array<int, 3> size = { across, across, across };
  size[axis] = layers * parts;
  Scene scene(size);
  scene.medium.grid.spacing[axis] = 0.4 / parts;
  scene.sigma_a.clear();
  scene.sigma_s.clear();
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> part(0.0f, 1.0f);
  std::vector<float> values(layers * 7);
  std::generate(values.begin(), values.end(), [&] { return part(random); });
  for (std::size_t i = 0; i < scene.medium.grid.VoxelCount(); ++i)
  {
    const float* const of = &values[static_cast<std::size_t>(7 * (scene.medium.grid.VoxelAt(i)[axis] / parts))];
    for (int c = 0; c < 3; ++c)
    {
      scene.sigma_a.push_back(of[c]);
      scene.sigma_s.push_back(3.0f * of[3 + c]);
    }
    scene.emission.push_back(0.1f * of[6]);
  }
  scene.medium.phase = phase;
  std::array<double, 3> first = { 0.3, 0.3, 0.3 }, second = { -0.2, 0.1, -0.6 };
  first[axis] = 0.8;
  second[axis] = -0.5;
  scene.ShineAlong(first, 2.0);
  scene.ShineAlong(second, 1.0);
  scene.light.faces[2 * axis] = { 0.1, 0.2, 0.3 };
  scene.light.faceAlbedo[2 * axis] = { 0.5, 0.2, 0.1 };
  scene.light.faceAlbedo[2 * axis + 1] = { 0.3, 0.2, 0.9 };
  scene.light.sky = { 0.05, 0.05, 0.1 };
  scene.settings.periodic = PeriodicBut(axis);
  scene.settings.netFlux = true;
  scene.settings.facePower = true;
  return scene;
}

/// Means of `parts` voxels that follow each other, of `width` values each.
std::vector<float> MeansOf(const std::vector<float>& values, std::size_t parts, std::size_t width)
{
  std::vector<float> means(values.size() / parts, 0.0f);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    means[i / (parts * width) * width + i % width] += values[i] / static_cast<float>(parts);
  }
  return means;
}

}

class PlaneParallel : public DeviceTest
{
};

TEST_F(PlaneParallel, ReflectsAndTransmitsAsTheTableSays)
{
  for (const ReferenceRow& row : ReadReference("slab"))
  {
    const double tau = row["tau"], albedo = row["omega"];
    for (const auto& [cosine, name] : { std::pair(0.0, "diffuse"), std::pair(1.0, "mu1"), std::pair(0.5, "mu05") })
    {
      const Parts parts = PartsOf(this->GetDevice(), Slab(tau, albedo, 0.0), cosine);
      EXPECT_NEAR(parts.reflected, row[std::string("R_") + name], 1e-6) << tau << " " << albedo << " " << name;
      EXPECT_NEAR(parts.transmitted, row[std::string("T_") + name], 1e-6) << tau << " " << albedo << " " << name;
    }
  }
}

// Of 20 cosines: off by 2.7e-5 at g = 0.9, 1.6e-4 at 0.99, under a slanting beam.
TEST_F(PlaneParallel, ReflectsAndTransmitsAsTheTableSaysWhereLightIsScatteredForwards)
{
  for (const ReferenceRow& row : ReadReference("slab_forward"))
  {
    const double tau = row["tau"], albedo = row["omega"], g = row["g"];
    for (const auto& [cosine, name] : { std::pair(0.0, "diffuse"), std::pair(1.0, "mu1"), std::pair(0.5, "mu05") })
    {
      const double most = g > 0.9 ? 2e-4 : 4e-5;
      const Parts parts = PartsOf(this->GetDevice(), Slab(tau, albedo, g, 16), cosine);
      EXPECT_NEAR(parts.reflected, row[std::string("R_") + name], most) << tau << " " << albedo << " " << g;
      EXPECT_NEAR(parts.transmitted, row[std::string("T_") + name], most) << tau << " " << albedo << " " << g;
    }
  }
}

TEST_F(PlaneParallel, ReflectsAndTransmitsAboveGround)
{
  for (const ReferenceRow& row : ReadReference("slab_over_ground"))
  {
    Scene scene = Slab(row["tau"], row["albedo"], row["g"], 7);
    scene.light.faceAlbedo[5] = { row["ground"], row["ground"], row["ground"] };
    const Parts parts = PartsOf(this->GetDevice(), scene, row["cosine"]);
    EXPECT_NEAR(parts.reflected, row["reflected"], 2e-5);
    EXPECT_NEAR(parts.transmitted, row["taken"], 2e-5);
  }
}

// T = 4 / (3 (tau + 2 q)), where the table ends.
TEST_F(PlaneParallel, TransmitsThroughAMillionMeanFreePaths)
{
  for (const double tau : { 1e4, 1e6, 1e9 })
  {
    const double expected = 4.0 / (3.0 * (tau + 1.4208922));
    const Parts parts = PartsOf(this->GetDevice(), Slab(tau, 1.0, 0.0), 0.0);
    EXPECT_NEAR(parts.transmitted / expected, 1.0, 1e-4);
    EXPECT_NEAR(parts.reflected, 1.0 - expected, 1e-6);
  }
  EXPECT_NEAR(PartsOf(this->GetDevice(), Slab(1e6, 0.9, 0.0), 1.0).transmitted, 0.0, 1e-12);
  EXPECT_NEAR(PartsOf(this->GetDevice(), Slab(1e-4, 0.0, 0.0), 0.5).transmitted, std::exp(-2e-4), 1e-7);
  EXPECT_NEAR(PartsOf(this->GetDevice(), Slab(0.0, 0.0, 0.0), 0.5).transmitted, 1.0, 1e-12);
}

// An even sky, and layers that shine as they absorb: radiance 1 everywhere.
TEST_F(PlaneParallel, LeavesAFurnaceAsItIs)
{
  Scene scene({ 1, 23, 1 });
  scene.Randomise(1e4, 8.0, 0.7, 3);
  for (std::size_t i = 0; i < scene.sigma_a.size(); ++i)
  {
    scene.sigma_a[i] = i % 5 == 0 ? 0.0f : scene.sigma_a[i];
    scene.sigma_s[i] = i % 7 == 0 ? 0.0f : scene.sigma_s[i];
  }
  scene.emission = scene.sigma_a;
  scene.ShineFromEverywhere(1.0);
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(-0.6);
  scene.settings.periodic = PeriodicBut(1);
  scene.settings.netFlux = true;
  const LightField light = scene.Solve(this->GetDevice());
  for (std::size_t i = 0; i < scene.sigma_a.size(); ++i)
  {
    EXPECT_NEAR(light.fluence[i], 4.0 * Pi, 2e-6 * 4.0 * Pi) << i;
    EXPECT_NEAR(light.netFlux[3 * i + 1], 0.0, 1e-6);
  }
  EXPECT_NEAR(light.facePowerOut[2][0], Pi, 1e-6);
  EXPECT_NEAR(light.balance.entered[0], 2.0 * Pi * light.halfRangeFlux[0], 1e-6);
}

// The table of mean cosines by depth is that of a beam, of which all of what a layer loses is known.
TEST_F(PlaneParallel, KnowsUnscatteredLightOfEachLayer)
{
  Scene scene = Slab(3.0, 0.8, 0.0, 5);
  scene.ShineAlong({ 0.6, 0.0, 0.8 }, 2.0);
  const LightField light = scene.Solve(this->GetDevice());
  for (int i = 0; i < 5; ++i)
  {
    const double depth = 0.6 / 0.8;
    EXPECT_NEAR(light.fluenceDirect[i], 2.0 * std::exp(-depth * i) * -std::expm1(-depth) / depth, 1e-6);
    EXPECT_GT(light.fluence[i], light.fluenceDirect[i]);
  }
}

// Means over layers, and light between them, are found by ways of their own: a tenth of a layer is nearly its side.
TEST_F(PlaneParallel, FindsInLayersWhatItFindsInTheirTenths)
{
  const PhaseFunction phase = PhaseFunction::HenyeyGreenstein(0.4);
  const LightField light = ColumnsAlong(2, 1, phase, 20261124).Solve(this->GetDevice());
  const LightField inTenths = ColumnsAlong(2, 1, phase, 20261124, 10).Solve(this->GetDevice());
  EXPECT_LE(light.balance.RelativeError(3), 1e-6);
  EXPECT_LT(RelativeRmse(MeansOf(inTenths.fluence, 10, 3), light.fluence), 1e-5);
  EXPECT_LT(RelativeRmse(MeansOf(inTenths.fluenceDirect, 10, 3), light.fluenceDirect), 1e-5);
  EXPECT_LT(RelativeRmse(MeansOf(inTenths.netFlux, 10, 9), light.netFlux), 1e-5);
  EXPECT_LT(RelativeRmse(MeansOf(inTenths.scatteredMoments, 10, 300), light.scatteredMoments), 1e-5);
}

/// All that is found along rays through voxels, of many directions. A degree of moments keeps the solve to them.
class PlaneParallelBesideRays
  : public PlaneParallel
  , public testing::WithParamInterface<int>
{
};

// Rays through voxels need thin ones.
TEST_P(PlaneParallelBesideRays, FindsWhatTheyFind)
{
  const int axis = this->GetParam();
  const LightField light = ColumnsAlong(axis, 1, PhaseFunction::Rayleigh(), 7).Solve(this->GetDevice());
  ASSERT_GT(light.polarNodes, 0);
  Scene scene = ColumnsAlong(axis, 1, PhaseFunction::Rayleigh(), 7, 10);
  scene.settings.angularDegree = 2; // of Rayleigh's function nothing is beyond
  scene.settings.directionsPerFace = 900;
  const LightField along = scene.Solve(this->GetDevice());
  ASSERT_EQ(along.polarNodes, 0);
  EXPECT_LT(RelativeRmse(MeansOf(along.fluence, 10, 3), light.fluence), 0.004);
  EXPECT_LT(RelativeRmse(MeansOf(along.fluenceDirect, 10, 3), light.fluenceDirect), 0.004);
  EXPECT_LT(RelativeRmse(MeansOf(along.netFlux, 10, 9), light.netFlux), 0.004);
  EXPECT_EQ(light.lampsApart.size(), along.lampsApart.size());
  std::vector<float> moments; // rays keep 9 of them
  for (std::size_t layer = 0; layer < 11; ++layer)
  {
    const auto first = light.scatteredMoments.begin() + static_cast<std::ptrdiff_t>(layer * 300);
    moments.insert(moments.end(), first, first + 27);
  }
  EXPECT_LT(RelativeRmse(MeansOf(along.scatteredMoments, 10, 27), moments), 0.004);
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      EXPECT_NEAR(light.facePowerOut[face][c], along.facePowerOut[face][c], 0.005);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Along, PlaneParallelBesideRays, testing::Values(0, 1, 2));

TEST_F(PlaneParallel, FindsInEqualColumnsWhatItFindsInOne)
{
  const PhaseFunction phase = PhaseFunction::HenyeyGreenstein(0.6);
  const LightField one = ColumnsAlong(1, 1, phase, 3).Solve(this->GetDevice());
  Scene four = ColumnsAlong(1, 4, phase, 3);
  const LightField light = four.Solve(this->GetDevice());
  ASSERT_GT(light.polarNodes, 0);
  for (std::size_t i = 0; i < four.medium.grid.VoxelCount(); ++i)
  {
    const auto layer = static_cast<std::size_t>(four.medium.grid.VoxelAt(i)[1]);
    for (std::size_t c = 0; c < 3; ++c)
    {
      EXPECT_EQ(light.fluence[3 * i + c], one.fluence[3 * layer + c]);
    }
  }
  EXPECT_NEAR(light.balance.absorbed[1], 16.0 * one.balance.absorbed[1], 1e-9);
  EXPECT_NEAR(light.facePowerOut[2][2], 16.0 * one.facePowerOut[2][2], 1e-9);
  four.sigma_s[33] *= 1.01f;
  EXPECT_EQ(four.Solve(this->GetDevice()).polarNodes, 0) << "one voxel is not like the others";
}

// A ray caster shows the ground by it.
TEST_F(PlaneParallel, KeepsPowerByCellsWhereAFaceReflects)
{
  Scene scene = Slab(0.0, 0.0, 0.0, 3);
  scene.light.faces[5] = { 1.0, 1.0, 1.0 };
  EXPECT_TRUE(scene.Solve(this->GetDevice()).facePower.empty());
  scene.light.faceAlbedo[4] = { 0.25, 0.25, 0.25 };
  const LightField light = scene.Solve(this->GetDevice());
  ASSERT_EQ(light.facePower.size(), BoxFaceCellCount(scene.medium.grid));
  EXPECT_NEAR(light.facePower[LayoutOfFace(scene.medium.grid, 4).first], Pi, 1e-5);
  EXPECT_NEAR(light.facePower[LayoutOfFace(scene.medium.grid, 5).first], 0.25 * Pi, 1e-5);
  EXPECT_NEAR(light.facePowerOut[4][0], 0.75 * Pi, 1e-5);
  EXPECT_EQ(light.facePower[0], 0.0f);
}

TEST_F(PlaneParallel, EstimatesItsErrorByFewerCosines)
{
  Scene scene = Slab(2.0, 0.9, 0.0, 6);
  scene.light.faces[5] = { 1.0, 1.0, 1.0 };
  scene.Attach();
  const PropagationSolver solve = [&](const SceneBlock& block, const PropagationSettings& settings,
                                    const Monitor& monitor) {
    return SolveConservative(this->GetDevice(), block.domain, block.medium, block.illumination, settings, monitor);
  };
  const LightField light =
    SolveWithErrorEstimate({ Domain(scene.medium.grid), scene.medium, scene.light }, scene.settings, {}, solve);
  ASSERT_EQ(light.fluenceError.size(), 6u);
  EXPECT_GT(light.relativeError, 0.0);
  EXPECT_LT(light.relativeError, 1e-4);
  scene.settings.polarNodes = 4;
  const LightField rough =
    SolveWithErrorEstimate({ Domain(scene.medium.grid), scene.medium, scene.light }, scene.settings, {}, solve);
  EXPECT_GT(rough.relativeError, 10.0 * light.relativeError);
  EXPECT_GT(rough.relativeError, RelativeRmse(rough.fluence, light.fluence));
  scene.settings.polarNodes = 65;
  EXPECT_THROW(scene.Solve(this->GetDevice()), InvalidInput);
}

TEST_F(PlaneParallel, SaysSo)
{
  Scene scene = Slab(1.0, 0.9, 0.0, 8);
  scene.ShineFromEverywhere(1.0);
  const LightField light = scene.Solve(this->GetDevice());
  EXPECT_THAT(light.leftOut, Contains(AllOf(HasSubstr("two axes"), HasSubstr("16 cosines"))));
  EXPECT_TRUE(light.converged);
  EXPECT_EQ(light.convergence.size(), 1u);
}

TEST_F(PlaneParallel, IsNotTakenWhereMoreIsAskedFor)
{
  const Scene slab = Slab(1.0, 0.9, 0.5, 8);
  const auto taken = [](Scene scene) {
    scene.Attach();
    return IsPlaneParallel(scene.medium, scene.light, scene.settings);
  };
  EXPECT_TRUE(taken(slab));
  const auto not_taken = [&](const auto& change) {
    Scene scene = slab;
    change(scene);
    return !taken(scene);
  };
  EXPECT_TRUE(not_taken([](Scene& s) { s.settings.periodic[0] = false; }));
  EXPECT_TRUE(not_taken([](Scene& s) { s.settings.periodic[2] = true; }));
  EXPECT_TRUE(not_taken([](Scene& s) { s.settings.maximumOrders = 3; }));
  EXPECT_TRUE(not_taken([](Scene& s) { s.settings.angularDegree = 3; }));
  EXPECT_TRUE(not_taken([](Scene& s) { s.settings.source = PropagationSource::Constant; }));
  EXPECT_FALSE(taken(Slab(1.0, 0.9, 0.5, 8193)));
  EXPECT_TRUE(not_taken([](Scene& s) { s.settings.adaptDirections = false; }));
  EXPECT_TRUE(not_taken([](Scene& s) { s.settings.leaveOut = false; }));
  EXPECT_TRUE(not_taken([](Scene& s) {
    s.ShineAlong({ 0.0, 0.0, 1.0 });
    s.light.lights.back().type = LightType::Point;
  }));
  EXPECT_TRUE(not_taken([](Scene& s) { s.light.environment = { 2, 1, std::vector<float>(6, 1.0f) }; }));
}
