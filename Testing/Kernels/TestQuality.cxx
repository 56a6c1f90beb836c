#include "DeviceTest.h"
#include "Difference.h"
#include "MediumScene.h"

#include "DiscreteOrdinates/OrdinatesSettings.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LightPropagation/Accuracy/ResampledScene.h"
#include "LightPropagation/Problem/PropagationQuality.h"
#include "Viewing/Scene/ViewSettings.h"

#include <string>

using namespace tyndall;

namespace
{
constexpr Quality Levels[] = { Quality::Draft, Quality::Default, Quality::Fine, Quality::Reference };

/// A cloud under one shining face and a slanted sun, no axis like another.
Scene Cloud(double thickest)
{
  Scene scene({ 13, 17, 10 });
  scene.Randomise(thickest, 1.5, 0.9, 8);
  scene.light.faces[3] = { 2.0, 2.0, 2.0 };
  scene.ShineAlong({ 0.2, -1.0, 0.4 });
  scene.Attach();
  return scene;
}

std::vector<float> FluenceOf(Device& device, const Scene& scene, const PropagationSettings& settings)
{
  return SolveConservative(device, scene.medium, scene.light, settings).fluence;
}
}

TEST(Quality, DefaultIsEveryNumberAsItStands)
{
  const Scene scene = Cloud(0.3);
  EXPECT_EQ(
    Words(AtQuality(Domain(scene.medium.grid), Quality::Default, PropagationSettings(), scene.medium, scene.light)),
    Words(PropagationSettings()));
  EXPECT_EQ(Words(AtQuality(Domain(scene.medium.grid), Quality::Default, OrdinatesSettings(), scene.medium, {})),
    Words(OrdinatesSettings()));
  EXPECT_EQ(Words(AtQuality(Quality::Default, LatticeSettings())), Words(LatticeSettings()));
  EXPECT_EQ(Words(AtQuality(Quality::Default, ViewSettings())), Words(ViewSettings()));
}

TEST(Quality, LeavesWhatWasChosen)
{
  const Scene scene = Cloud(0.3);
  PropagationSettings chosen;
  chosen.directionsPerFace = 36;
  chosen.tolerance = 3e-3;
  chosen.uncollidedDirections = 81;
  chosen.emissionError = 0.2;
  OrdinatesSettings ordinates;
  ordinates.terms = 4;
  LatticeSettings lattice;
  lattice.tolerance = 0.2;
  ViewSettings view;
  view.stepSize = 3.0;
  for (const Quality quality : Levels)
  {
    const PropagationSettings found = AtQuality(Domain(scene.medium.grid), quality, chosen, scene.medium, scene.light);
    EXPECT_EQ(Words(found), Words(chosen));
    EXPECT_EQ(AtQuality(Domain(scene.medium.grid), quality, ordinates, scene.medium, {}).terms, 4);
    EXPECT_EQ(AtQuality(quality, lattice).tolerance, 0.2);
    EXPECT_EQ(AtQuality(quality, view).stepSize, 3.0);
  }
}

TEST(Quality, LooksAtTheScene)
{
  const auto fine = [](const Scene& scene) {
    return AtQuality(Domain(scene.medium.grid), Quality::Fine, PropagationSettings(), scene.medium, scene.light);
  };
  Scene scene = Cloud(0.3);
  const PropagationSettings lit = fine(scene);
  EXPECT_GT(lit.uncollidedDirections, lit.directionsPerFace);
  EXPECT_LT(fine(Cloud(30.0)).directionsPerFace, lit.directionsPerFace) << "a thick box forgets directions";
  Scene forward = Cloud(30.0);
  forward.sigma_a.assign(forward.sigma_a.size(), 0.0f);
  forward.medium.phase = PhaseFunction::HenyeyGreenstein(0.999);
  forward.settings.angularDegree = 0;
  EXPECT_EQ(AtQuality(Domain(forward.medium.grid), Quality::Fine, forward.settings, forward.medium, forward.light)
              .directionsPerFace,
    lit.directionsPerFace)
    << "solved by similarity it is thin";
  scene.light.faces = {};
  EXPECT_EQ(fine(scene).uncollidedDirections, 0) << "no light comes in through faces";
  scene = Cloud(0.3);
  scene.sigma_s.assign(scene.sigma_s.size(), 0.0f);
  scene.Attach();
  EXPECT_EQ(fine(scene).directionsPerFace, lit.uncollidedDirections) << "all light is unscattered";
}

TEST(Quality, OfOrdinatesFitsTheDevice)
{
  const Scene scene = Cloud(0.3);
  const OrdinatesSettings best =
    AtQuality(Domain(scene.medium.grid), Quality::Reference, OrdinatesSettings(), scene.medium, {});
  DeviceMemory little;
  little.all = 6 * sizeof(float) * scene.medium.grid.VoxelCount() * best.directionsPerFace; // twice the half
  const OrdinatesSettings fitting =
    AtQuality(Domain(scene.medium.grid), Quality::Reference, OrdinatesSettings(), scene.medium, little);
  EXPECT_LT(fitting.directionsPerFace, best.directionsPerFace);
  EXPECT_LE(2 * fitting.directionsPerFace, best.directionsPerFace);
  EXPECT_GT(fitting.directionsPerFace, 25);
}

class QualityOfLight : public DeviceTest
{
};

TEST_F(QualityOfLight, GrowsFromLevelToLevel)
{
  for (const double thickest : { 0.3, 3.0 })
  {
    const Scene scene = Cloud(thickest);
    PropagationSettings exact;
    exact.directionsPerFace = 400;
    exact.uncollidedDirections = 3600;
    exact.staggeredRays = true;
    exact.tolerance = 1e-6;
    const std::vector<float> light = FluenceOf(this->GetDevice(), scene, exact);
    double last = 1.0;
    for (const Quality quality : Levels)
    {
      const double error =
        RelativeRmse(FluenceOf(this->GetDevice(), scene,
                       AtQuality(Domain(scene.medium.grid), quality, PropagationSettings(), scene.medium, scene.light)),
          light);
      EXPECT_LT(error, last) << "quality " << static_cast<int>(quality) << ", thickest " << thickest;
      this->RecordProperty(
        "thickest " + std::to_string(thickest) + " level " + std::to_string(static_cast<int>(quality)),
        std::to_string(error));
      last = error;
    }
    EXPECT_LT(last, 0.005);
  }
}

class LightInDividedVoxels : public DeviceTest
{
};

TEST_F(LightInDividedVoxels, IsThatOfTheScene)
{
  Scene scene = Cloud(1.0);
  scene.emission.assign(scene.sigma_a.size(), 0.01f);
  scene.Attach();
  PropagationSettings settings;
  settings.netFlux = settings.facePower = true;
  const LightField whole = SolveConservative(this->GetDevice(), scene.medium, scene.light, settings);
  const Grid& grid = scene.medium.grid;
  const DividedScene divided(
    { Domain(grid), scene.medium, scene.light }, DividedScene::Halves(grid, settings.periodic));
  EXPECT_EQ(divided.Scene().medium.grid.VoxelCount(), 8 * grid.VoxelCount());
  LightField light =
    SolveConservative(this->GetDevice(), divided.Scene().medium, divided.Scene().illumination, settings);
  divided.Undo(light);
  ASSERT_EQ(light.fluence.size(), whole.fluence.size());
  ASSERT_EQ(light.netFlux.size(), whole.netFlux.size());
  ASSERT_EQ(light.facePower.size(), whole.facePower.size());
  EXPECT_LT(RelativeRmse(light.fluence, whole.fluence), 0.1);
  EXPECT_LT(RelativeRmse(light.fluenceDirect, whole.fluenceDirect), 0.1);
  EXPECT_LT(RelativeRmse(light.netFlux, whole.netFlux), 0.15);
  EXPECT_LT(RelativeRmse(light.facePower, whole.facePower), 0.15);
  EXPECT_NEAR(light.balance.absorbed[0], whole.balance.absorbed[0], 0.05 * whole.balance.absorbed[0]);
  double absorbed = 0.0;
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    absorbed += static_cast<double>(light.fluence[i]) * scene.sigma_a[i];
  }
  EXPECT_NEAR(absorbed, light.balance.absorbed[0], 1e-3 * absorbed);
}
