#include "ViewScene.h"

#include "Viewing/Samples/PackedSamples.h"
#include "Viewing/Scene/ViewTraits.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

using namespace viewing;

namespace
{
/// A cloudlet in one corner and a speck in the other of a box that is empty in between, and does not end with a brick.
Scene Cloudlets(int components = 1)
{
  Grid grid;
  grid.size = { 70, 66, 75 };
  Scene scene(grid);
  scene.components = components;
  const auto each = static_cast<std::size_t>(components);
  scene.sigma_a.assign(grid.VoxelCount() * each, 0.0f);
  scene.sigma_s.assign(grid.VoxelCount() * each, 0.0f);
  scene.fluence = scene.Everywhere(0.0);
  for (std::size_t voxel = 0; voxel < grid.VoxelCount(); ++voxel)
  {
    const std::array<int, 3> at = grid.VoxelAt(voxel);
    const double density = std::max(0.0, 1.0 - std::hypot(at[0] - 8, at[1] - 9, at[2] - 7) / 9.0);
    const bool speck = at == std::array<int, 3>{ 69, 64, 74 };
    for (std::size_t c = 0; c < each; ++c)
    {
      scene.sigma_a[voxel * each + c] = static_cast<float>(0.02 * density * (c + 1));
      scene.sigma_s[voxel * each + c] = static_cast<float>(speck ? 2.0 : 0.4 * density);
    }
    scene.fluence[voxel] = 1.0f + 0.01f * static_cast<float>(at[0] + 2 * at[1] + 3 * at[2]);
  }
  return scene;
}

/// New memory is no zeros, by which samples that nobody packed would look like packed ones.
class NewMemoryIsRubbish
{
public:
#ifdef __GLIBC__
  NewMemoryIsRubbish()
  {
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_PERTURB, 0x81); // floats of -3.8e38, or so
  }
  ~NewMemoryIsRubbish()
  {
    mallopt(M_PERTURB, 0);
    mallopt(M_MMAP_MAX, 65536);
  }
#endif
};
}

class SparseViewTest : public DeviceTest
{
protected:
  void ExpectThatSkippingChangesNothing(Scene scene, const std::string& what)
  {
    const NewMemoryIsRubbish rubbish;
    const Picture skipping = scene.Seen(this->GetDevice());
    scene.settings.skipEmptyBricks = false;
    const Picture marching = scene.Seen(this->GetDevice());
    EXPECT_EQ(LargestDifference(marching.radiance, skipping.radiance), 0.0) << what;
    EXPECT_EQ(LargestDifference(marching.alpha, skipping.alpha), 0.0) << what;
    EXPECT_EQ(LargestDifference(marching.depth, skipping.depth), 0.0) << what;
    EXPECT_GT(*std::max_element(skipping.alpha.begin(), skipping.alpha.end()), 0.5f) << what;
  }
};

TEST_F(SparseViewTest, BricksBesideFilledOnesAreSeen)
{
  Medium medium;
  medium.grid.size = { 41, 8, 16 };
  std::vector<float> values(medium.grid.VoxelCount(), 0.0f);
  medium.sigma_s = { values.data(), 1 };
  EXPECT_FALSE(SeenBricksOf(FindFilledBricks(medium), false).all);
  values[medium.grid.IndexOf({ 40, 0, 15 })] = 1.0f;
  const SeenBricks bricks = SeenBricksOf(FindFilledBricks(medium), false);
  EXPECT_EQ(bricks.count, (std::array<int, 3>{ 6, 1, 2 }));
  EXPECT_EQ(bricks.seen, (std::vector<unsigned char>{ 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1 }));
  EXPECT_FALSE(bricks.all);
  EXPECT_TRUE(SeenBricksOf(FindFilledBricks(medium), true).all);
  EXPECT_EQ(SeenBricksOf(FindFilledBricks(medium), true).seen, std::vector<unsigned char>(12, 1));
}

TEST_F(SparseViewTest, RecordsAreOfCellsThatTouchFilledBricks)
{
  Medium medium;
  medium.grid.size = { 41, 8, 16 };
  std::vector<float> values(medium.grid.VoxelCount(), 0.0f);
  medium.sigma_s = { values.data(), 1 };
  values[medium.grid.IndexOf({ 9, 0, 3 })] = 1.0f;
  const SampleBricks bricks = SampleBricksOf(FindFilledBricks(medium), medium.grid, false);
  EXPECT_EQ(bricks.count, (std::array<int, 3>{ 6, 2, 3 }));
  EXPECT_EQ(bricks.bricks, (std::vector<cl_int>{ -1, 1, 2, 7, 8, 13, 14, 19, 20 })); // and the next along each axis
  EXPECT_EQ(bricks.SamplesEach(), 729u);
  EXPECT_EQ(bricks.first[0], 0);
  EXPECT_EQ(bricks.first[20], 8 * 729);
  EXPECT_EQ(SampleBricksOf(FindFilledBricks(medium), medium.grid, true).SampleCount(), 9u * 648u);
}

TEST_F(SparseViewTest, PicturesAreTheSameToTheLastBit)
{
  this->ExpectThatSkippingChangesNothing(Cloudlets(), "grey");
  this->ExpectThatSkippingChangesNothing(Cloudlets(3), "coloured");

  Scene shining = Cloudlets();
  shining.emission = shining.Everywhere(0.0);
  shining.emission[shining.grid.IndexOf({ 30, 31, 32 })] = 5.0f; // where nothing extinguishes
  this->ExpectThatSkippingChangesNothing(shining, "emission");

  Scene forward = Cloudlets();
  forward.g = 0.6;
  forward.meanDirection.assign(3 * forward.grid.VoxelCount(), 0.3f);
  this->ExpectThatSkippingChangesNothing(forward, "directions of light");
}

TEST_F(SparseViewTest, ShadowRaysSeeTheSame)
{
  Scene scene = Cloudlets();
  Light sun;
  sun.direction = { 0.5, 0.4, -0.7 };
  scene.illumination.lights = { sun };
  scene.fluenceDirect = scene.fluence;
  scene.settings.shadowRays = true;
  this->ExpectThatSkippingChangesNothing(scene, "shadow rays");
}

TEST_F(SparseViewTest, ACasterThatLeapsIsNotOneThatMarches)
{
  Scene scene = Cloudlets();
  MediumRayCaster caster = scene.Caster(this->GetDevice());
  ViewSettings settings = scene.settings;
  EXPECT_TRUE(caster.Adopt(settings));
  settings.skipEmptyBricks = false;
  EXPECT_FALSE(caster.Adopt(settings));
}
