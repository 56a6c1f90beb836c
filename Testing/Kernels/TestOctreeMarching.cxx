// Marching with an octree against marching voxel by voxel: what its tolerance promises. TyndallBenchPhotons has the
// table for a ball of glass.
#include "DeviceTest.h"
#include "PhotonScene.h"
#include "PhotonWays.h"

#include "Numerics/ChooseEvenly.h"
#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Marching/MarchShared.h"
#include "Refraction/Octree/RefractionOctree.h"

using namespace tyndall;

namespace
{
std::vector<Photon> Sunlight(const Grid& grid, std::size_t count)
{
  Illumination light;
  Light sun;
  sun.direction = { 0.2, 0.3, 1.0 };
  light.lights = { sun };
  return EmitPhotons(grid, light, { count, Sampler::Hammersley, 0 }).photons;
}

/// An index without a border, which varies everywhere by 0.1 in all.
PhotonScene Billows(int edge)
{
  PhotonScene scene(edge, 1.0, 0.1f);
  scene.SetIndex([](double x, double y, double z) {
    return 1.2 + 0.05 * std::sin(3.0 * x + 1.0) * std::cos(2.0 * y) * std::cos(4.0 * z + 0.5);
  });
  return scene;
}

struct Way
{
  PhotonLight light;
  std::vector<PhotonPath> paths;
};

Way Go(Device& device, PhotonScene& scene, const std::vector<Photon>& photons)
{
  PhotonMarcher marcher = scene.Marcher(device);
  return { marcher.March(photons), marcher.Paths(photons, ChooseEvenly(photons.size(), 1000)) };
}

/// Light that is in other voxels, as a part of all.
double Displaced(const PhotonLight& light, const PhotonLight& reference)
{
  double different = 0.0, all = 0.0;
  for (std::size_t i = 0; i < light.light.fluence.size(); ++i)
  {
    different += std::abs(light.light.fluence[i] - reference.light.fluence[i]);
    all += reference.light.fluence[i];
  }
  return different / all;
}

/// Largest difference of the directions in which photons leave, radians.
double LargestTurn(const std::vector<PhotonPath>& paths, const std::vector<PhotonPath>& reference)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < paths.size(); ++i)
  {
    const std::array<double, 3> a = LastDirection(paths[i]), b = LastDirection(reference[i]);
    largest = std::max(largest, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
  }
  return largest;
}
}

class OctreeMarching : public DeviceTest
{
};

TEST_F(OctreeMarching, ErrsByLessThanTheToleranceInFewerSteps)
{
  PhotonScene scene = Billows(64);
  const std::vector<Photon> photons = Sunlight(scene.medium.grid, 100000);
  const Way fine = Go(this->GetDevice(), scene, photons);
  double lastDisplaced = 1.0;
  std::size_t lastSteps = 0;
  for (double tolerance : { 0.05, 0.02, 0.01, 0.005 })
  {
    OctreeSettings settings;
    settings.tolerance = tolerance;
    scene.levels = BuildOctree(Domain(scene.medium.grid), scene.Medium(), scene.Index(), settings).levels;
    const Way coarse = Go(this->GetDevice(), scene, photons);
    const double displaced = Displaced(coarse.light, fine.light);
    std::printf("Tolerance %g: %.2f of the steps, %.5f of the light displaced, directions differ by %.5f at most\n",
      tolerance, static_cast<double>(coarse.light.steps) / fine.light.steps, displaced,
      LargestTurn(coarse.paths, fine.paths));
    EXPECT_LT(displaced, 0.5 * tolerance);
    EXPECT_LT(LargestTurn(coarse.paths, fine.paths), tolerance);
    EXPECT_GT(displaced, 0.0); // else nothing was compared
    EXPECT_LT(displaced, 0.7 * lastDisplaced);
    EXPECT_LT(coarse.light.steps, 0.9 * fine.light.steps);
    EXPECT_GT(coarse.light.steps, lastSteps);
    lastDisplaced = displaced;
    lastSteps = coarse.light.steps;
  }
}

TEST_F(OctreeMarching, WithoutAToleranceIsMarchingVoxelByVoxel)
{
  PhotonScene scene = Billows(32);
  const std::vector<Photon> photons = Sunlight(scene.medium.grid, 5000);
  const Way fine = Go(this->GetDevice(), scene, photons);
  OctreeSettings settings;
  settings.tolerance = 0.0;
  scene.levels = BuildOctree(Domain(scene.medium.grid), scene.Medium(), scene.Index(), settings).levels;
  EXPECT_EQ(Go(this->GetDevice(), scene, photons).light.light.fluence, fine.light.light.fluence);
}

/// Where one node is all of the grid.
TEST_F(OctreeMarching, CrossesCubesOfLargerNodesInStepsOfOrderFour)
{
  PhotonScene scene(64, 1.0, 0.1f);
  scene.SetIndex([](double x, double y, double z) {
    return 1.2 + 0.004 * std::sin(3.0 * x + 1.0) * std::cos(2.0 * y) * std::cos(4.0 * z + 0.5);
  });
  scene.settings.order = 4;
  const std::vector<Photon> photons = Sunlight(scene.medium.grid, 20000);
  const PhotonLight fine = scene.March(this->GetDevice(), photons);
  scene.levels.assign(scene.medium.grid.VoxelCount(), 6);
  const PhotonLight coarse = scene.March(this->GetDevice(), photons);
  std::printf("%.1f steps instead of %.1f a photon, %.5f of the light displaced\n", coarse.steps / 20000.0,
    fine.steps / 20000.0, Displaced(coarse, fine));
  EXPECT_LT(Displaced(coarse, fine), 0.004); // 0.03 by steps from end to end
  scene.levels.assign(scene.medium.grid.VoxelCount(), YoshidaLevel);
  ExpectSameLight(scene.March(this->GetDevice(), photons), coarse);
}
