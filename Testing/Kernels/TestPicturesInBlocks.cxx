// Pictures of a medium that is spread over ranks, which see it together: those of the whole.

#include "BlocksOfView.h"

#include "RanksInThreads.h"
#include "Viewing/Blocks/PictureInBlocks.h"
#include "Viewing/Scene/BlockOfScene.h"

#include <gmock/gmock.h>

#include <memory>
#include <mutex>
#include <numeric>

using namespace viewing;

namespace
{
using Cuts = std::array<std::vector<int>, 3>;

/// Two blocks, three that are uneven, eight, and slices of a voxel.
const std::vector<Cuts> SomeCuts = { { { { 13 }, {}, {} } }, { { {}, { 5, 16 }, {} } }, { { { 14 }, { 3 }, { 9 } } },
  { { { 10, 11, 12 }, {}, { 1 } } } };

struct Spread
{
  BlockPartition partition;
  std::vector<GridBlock> blocks;
  std::vector<VoxelBox> held, known;
};

/// @param nothing  a rank without voxels besides, the first
Spread SpreadOver(const Scene& scene, const Cuts& cuts, bool nothing)
{
  Spread spread;
  spread.partition.whole = scene.grid;
  spread.blocks = Cut(scene.grid, cuts);
  if (nothing)
  {
    GridBlock none;
    none.whole = scene.grid;
    spread.blocks.insert(spread.blocks.begin(), none);
  }
  for (GridBlock& block : spread.blocks)
  {
    VoxelBox own = { block.begin, {} };
    for (int axis = 0; axis < 3; ++axis)
    {
      own.size[axis] = block.end[axis] - block.begin[axis];
    }
    const bool empty = own.VoxelCount() == 0;
    const bool surface = !scene.surface.empty();
    spread.partition.blocks.push_back(own);
    spread.held.push_back(empty ? own : HeldBox(own, scene.grid, scene.settings, !scene.moments.empty(), surface));
    spread.known.push_back(empty ? own : KnownBox(own, spread.held.back(), scene.grid, scene.settings));
    block.first = spread.held.back().first;
  }
  return spread;
}

/// The picture that ranks make together, of which each gets a part: some rows.
Picture SeenBy(Device& device, const Scene& scene, const Spread& spread, const Camera& camera,
  std::size_t* handed = nullptr, const WorkAtOnce& atOnce = {})
{
  const auto ranks = static_cast<int>(spread.blocks.size());
  std::vector<Picture> parts(spread.blocks.size());
  std::vector<std::size_t> traffic(spread.blocks.size());
  std::mutex one;
  RunInThreads(ranks, [&](Communicator& communicator) {
    const auto rank = static_cast<std::size_t>(communicator.Rank());
    const Domain domain(communicator, spread.partition);
    const GridBlock& block = spread.blocks[rank];
    BlockOfScene ofScene = { block, spread.known[rank], {} };
    Scene part;
    SharedScene own;
    if (!domain.IsEmpty())
    {
      part = PartOf(scene, block, spread.held[rank], spread.known[rank]);
      Scene held = PartOf(scene, block, spread.held[rank], spread.held[rank]);
      own = SharedSceneOf(held.MediumSeen(), held.LightSeen(), Scene::See(held.ior, 1), scene.settings);
    }
    ofScene.shared = PictureInBlocks::Shared(domain, domain.IsEmpty() ? nullptr : &own);
    std::unique_ptr<MediumRayCaster> caster;
    domain.Collective([&] {
      const std::lock_guard<std::mutex> lock(one);
      caster.reset(domain.IsEmpty() ? nullptr : new MediumRayCaster(part.Caster(device, &ofScene)));
    });
    PictureInBlocks picture(domain, spread.held, caster.get(), atOnce);
    const std::array<int, 2>& size = scene.settings.imageSize;
    const auto row = [&](std::size_t n) { return size[1] * static_cast<int>(n) / ranks; };
    parts[rank] = picture.Take(camera, size, { { 0, row(rank) }, { size[0], row(rank + 1) } });
    traffic[rank] = picture.Traffic().handed;
  });
  if (handed)
  {
    *handed = std::accumulate(traffic.begin(), traffic.end(), std::size_t{ 0 });
  }
  Picture all;
  all.farDepth = parts[0].farDepth;
  for (const Picture& part : parts)
  {
    all.radiance.insert(all.radiance.end(), part.radiance.begin(), part.radiance.end());
    all.alpha.insert(all.alpha.end(), part.alpha.begin(), part.alpha.end());
    all.depth.insert(all.depth.end(), part.depth.begin(), part.depth.end());
  }
  return all;
}

void ExpectSame(const Picture& found, const Picture& whole)
{
  const double bright = Largest(whole.radiance);
  const double radiance = LargestDifference(found.radiance, whole.radiance) / bright;
  const double alpha = LargestDifference(found.alpha, whole.alpha);
  const double depth = LargestDifference(found.depth, whole.depth) / whole.farDepth;
  EXPECT_EQ(found.farDepth, whole.farDepth);
  EXPECT_LT(radiance, 1e-5);
  EXPECT_LT(alpha, 1e-5);
  EXPECT_LT(depth, 1e-5);
  EXPECT_GT(bright, 0.05);
  EXPECT_GT(Largest(whole.alpha), 0.3) << "there is nothing to compare";
}

std::vector<Camera> CamerasOf(const Scene& scene)
{
  Camera inside = scene.Framed();
  inside.position = { 2.0, 5.5, 6.0 };
  Camera along = FrameGrid(scene.grid, scene.Aspect(), 30.0, { 0.3, -1.0, 0.1 });
  along.parallelProjection = true;
  along.parallelScale = 6.0;
  return { scene.Framed(), inside, along };
}

/// Seen by ranks of each cut, as by one with the whole.
/// @return rays that were handed on
std::size_t ExpectPicturesOfWhole(Device& device, const Scene& scene, const char* what)
{
  std::size_t all = 0;
  int number = 0;
  for (const Camera& camera : CamerasOf(scene))
  {
    const Picture whole = scene.Seen(device, camera);
    for (const Cuts& cuts : SomeCuts)
    {
      SCOPED_TRACE(testing::Message() << what << ", from " << testing::PrintToString(camera.position) << ", cut at "
                                      << testing::PrintToString(cuts));
      std::size_t handed = 0;
      ExpectSame(SeenBy(device, scene, SpreadOver(scene, cuts, number++ % 3 == 1), camera, &handed), whole);
      all += handed;
    }
  }
  return all;
}

/// A lens in the cloud.
Scene Glass(int components)
{
  Scene scene = Cloud(components);
  scene.ior = AtCentres(scene.grid, [](double x, double y, double z) {
    return 1.0 + 0.4 * std::exp(-8.0 * ((x - 0.55) * (x - 0.55) + (y - 0.5) * (y - 0.5) + (z - 0.45) * (z - 0.45)));
  });
  scene.settings.showBackground = true;
  scene.illumination.environment = SmoothEnvironment();
  return scene;
}

std::vector<Light> Lamps()
{
  Light sun, bulb, panel;
  sun.type = LightType::Directional;
  sun.direction = { 0.4, 0.3, -1.0 };
  sun.power = { 3.0, 2.0, 1.0 };
  bulb.type = LightType::Point;
  bulb.position = { 3.0, 6.0, 7.0 }; // within
  bulb.power = { 20.0, 30.0, 60.0 };
  panel.type = LightType::Rectangle;
  panel.position = { -6.0, 4.0, 6.0 };
  panel.direction = { 1.0, 0.1, 0.0 };
  panel.size = { 2.0, 3.0 };
  panel.power = { 100.0, 100.0, 50.0 };
  return { sun, bulb, panel };
}

Scene ByMoments()
{
  Scene scene = Cloud(3);
  scene.phase.reset();
  scene.g = 0.7;
  const std::size_t voxels = scene.grid.VoxelCount();
  for (std::size_t i = 0; i < voxels; ++i)
  {
    const float x = 0.1f * static_cast<float>(i % 37);
    scene.moments.insert(scene.moments.end(), { 2.0f + x, 0.3f * x, -0.2f, 0.5f });
    scene.straightOn.push_back(0.49f);
    if (scene.grid.VoxelAt(i)[1] % 7 == 3) // some that absorb only, or do nothing
    {
      for (std::size_t c = 0; c < 3; ++c)
      {
        scene.sigma_s[3 * i + c] = 0.0f;
        scene.sigma_a[3 * i + c] *= i % 2 == 0 ? 1.0f : 0.0f;
      }
    }
  }
  scene.lampsApart = Lamps();
  scene.settings.showBackground = true;
  scene.settings.backgroundColor = { 0.1, 0.2, 0.3 };
  return scene;
}
}

class PicturesInBlocks : public DeviceTest
{
};

/// Each looks again where what is before its block changes what it sees; rays may end early, as in the whole.
TEST_F(PicturesInBlocks, LieOverEachOther)
{
  for (int components : { 1, 3 })
  {
    Scene scene = Cloud(components);
    scene.settings.showBackground = components == 3;
    scene.settings.backgroundColor = { 0.3, 0.2, 0.1 };
    for (double minimum : { 0.0, 0.05 })
    {
      scene.settings.minimumTransmittance = minimum;
      ExpectPicturesOfWhole(this->GetDevice(), scene, "cloud");
    }
  }
  Scene scene = Cloud(1);
  scene.settings.stepSize = 2.0;
  Camera along = FrameGrid(scene.grid, scene.Aspect(), 30.0, { 0.0, -1.0, 0.0 });
  along.parallelProjection = true; // middles of steps of two voxels lie on planes between blocks
  along.parallelScale = 6.0;
  for (const Cuts& cuts : SomeCuts)
  {
    ExpectSame(
      SeenBy(this->GetDevice(), scene, SpreadOver(scene, cuts, false), along), scene.Seen(this->GetDevice(), along));
  }
}

TEST_F(PicturesInBlocks, FollowRaysThatBend)
{
  EXPECT_GT(ExpectPicturesOfWhole(this->GetDevice(), Glass(3), "glass"), 10000u);
}

TEST_F(PicturesInBlocks, FollowRaysByLongSteps)
{
  Scene scene = Glass(1);
  scene.settings.stepSize = 1.7;
  scene.settings.tableFace = 4;
  ExpectPicturesOfWhole(this->GetDevice(), scene, "long steps");
  // Rays that go straight on meet the table as far from the middle of their last step as that is long; those that bend
  // come to it by short ones. The block in which they do knows its light there.
  scene.ior.clear();
  scene.settings.stepSize = 4.0;
  ExpectPicturesOfWhole(this->GetDevice(), scene, "longer steps");
}

TEST_F(PicturesInBlocks, FollowWhatASurfaceReflects)
{
  Scene scene = Glass(3);
  scene.ior = Ball(scene.grid, 0.3, 1.5);
  scene.settings.surfaceReflection = SurfaceReflection::Fresnel;
  ExpectPicturesOfWhole(this->GetDevice(), scene, "surface");
}

TEST_F(PicturesInBlocks, FollowWhatATableMirrors)
{
  for (const bool bends : { false, true })
  {
    Scene scene = Glass(1);
    scene.ior = bends ? scene.ior : std::vector<float>();
    scene.settings.tableFace = 4;
    scene.settings.tableReflectance = 0.3;
    ExpectPicturesOfWhole(this->GetDevice(), scene, "table");
  }
}

TEST_F(PicturesInBlocks, ThrowShadowsOnEachOther)
{
  Scene scene = Cloud(3);
  scene.g = 0.4;
  scene.illumination.lights = Lamps();
  scene.settings.shadowRays = true;
  scene.fluenceDirect = scene.Everywhere(0.05);
  ExpectPicturesOfWhole(this->GetDevice(), scene, "shadows");
}

TEST_F(PicturesInBlocks, ShowLightByItsMoments)
{
  Scene scene = ByMoments();
  ExpectPicturesOfWhole(this->GetDevice(), scene, "moments");
  scene.settings.minimumTransmittance = 0.05;
  ExpectPicturesOfWhole(this->GetDevice(), scene, "moments of rays that end early");
  scene.ior = Glass(1).ior;
  scene.settings.minimumTransmittance = 0.0;
  ExpectPicturesOfWhole(this->GetDevice(), scene, "moments in glass");
}

TEST_F(PicturesInBlocks, ShowLightAtTheSurfaceOfThickVoxels)
{
  Scene scene = Cloud(1);
  std::fill(scene.sigma_s.begin(), scene.sigma_s.end(), 2.5f); // what is behind the next voxels counts as well
  const Picture without = scene.Seen(this->GetDevice());
  ForBoxFaceCells(scene.grid, [&](const BoxFaceCell& cell) {
    scene.surface.insert(scene.surface.end(), SurfaceCosines.size(), 0.2f + 0.01f * (cell.u + cell.v));
  });
  EXPECT_GT(LargestDifference(without.radiance, scene.Seen(this->GetDevice()).radiance), 0.05);
  ExpectPicturesOfWhole(this->GetDevice(), scene, "surface light");

  // A thick skin: how opaque it is with what is behind follows from six voxels, which a block at a face has few of.
  for (std::size_t i = 0; i < scene.grid.VoxelCount(); ++i)
  {
    const std::array<int, 3> voxel = scene.grid.VoxelAt(i);
    bool skin = false;
    for (int axis = 0; axis < 3; ++axis)
    {
      skin = skin || voxel[axis] == 0 || voxel[axis] == scene.grid.size[axis] - 1;
    }
    scene.sigma_a[i] = 0.0f;
    scene.sigma_s[i] = skin ? 2.0f : 0.5f;
  }
  for (const Cuts& cuts : { Cuts{ { { 1 }, { 1 }, { 1 } } }, Cuts{ { { 26 }, { 21 }, { 18 } } } })
  {
    for (const Camera& camera : CamerasOf(scene))
    {
      ExpectSame(SeenBy(this->GetDevice(), scene, SpreadOver(scene, cuts, false), camera),
        scene.Seen(this->GetDevice(), camera));
    }
  }
}

namespace
{
void ExpectEqual(const Picture& found, const Picture& expected)
{
  EXPECT_EQ(found.radiance, expected.radiance);
  EXPECT_EQ(found.alpha, expected.alpha);
  EXPECT_EQ(found.depth, expected.depth);
  EXPECT_GT(Largest(expected.radiance), 0.05) << "there is nothing to compare";
}
}

TEST_F(PicturesInBlocks, ThrowTheSameShadowsByPortions)
{
  Scene scene = Cloud(3);
  scene.illumination.lights = { Lamps()[0], Lamps()[1] };
  scene.settings.shadowRays = true;
  scene.fluenceDirect = scene.Everywhere(0.05);
  const Spread spread = SpreadOver(scene, SomeCuts[2], true);
  const Picture atOnce = SeenBy(this->GetDevice(), scene, spread, scene.Framed());
  for (const std::size_t voxels : { 1, 100, 700 }) // a row, some rows, some slices
  {
    WorkAtOnce portions;
    portions.voxels = voxels;
    SCOPED_TRACE(voxels);
    ExpectEqual(SeenBy(this->GetDevice(), scene, spread, scene.Framed(), nullptr, portions), atOnce);
  }
}

TEST_F(PicturesInBlocks, FollowRaysOfSomeRowsAtATime)
{
  Scene scene = Glass(1);
  scene.ior = Ball(scene.grid, 0.3, 1.5);
  scene.settings.surfaceReflection = SurfaceReflection::Fresnel;
  scene.settings.tableFace = 4;
  scene.settings.tableReflectance = 0.3;
  for (const Cuts& cuts : SomeCuts)
  {
    const Spread spread = SpreadOver(scene, cuts, true);
    const Picture atOnce = SeenBy(this->GetDevice(), scene, spread, scene.Framed());
    for (const std::size_t rays : { 1, 700 })
    {
      WorkAtOnce portions;
      portions.rays = rays;
      SCOPED_TRACE(testing::Message() << rays << " rays, cut at " << testing::PrintToString(cuts));
      ExpectEqual(SeenBy(this->GetDevice(), scene, spread, scene.Framed(), nullptr, portions), atOnce);
    }
  }
}

TEST_F(PicturesInBlocks, AreOnOneRankThoseOfTheCaster)
{
  const Scene scene = Glass(3);
  const Picture whole = scene.Seen(this->GetDevice());
  const Domain domain(scene.grid);
  const std::vector<VoxelBox> held = domain.Partition().blocks;
  MediumRayCaster caster = scene.Caster(this->GetDevice());
  PictureInBlocks picture(domain, held, &caster);
  const std::array<int, 2>& size = scene.settings.imageSize;
  ExpectEqual(picture.Take(scene.Framed(), size, { { 0, 0 }, size }), whole);
  const Picture part = picture.Take(scene.Framed(), size, { { 7, 20 }, { 9, 21 } });
  const std::size_t pixel = 20 * static_cast<std::size_t>(size[0]) + 7;
  EXPECT_EQ(part.width, 2);
  EXPECT_EQ(part.height, 1);
  EXPECT_EQ(part.depth, std::vector<float>({ whole.depth[pixel], whole.depth[pixel + 1] }));
  EXPECT_EQ(part.radiance[5], whole.radiance[3 * pixel + 5]);
}

TEST_F(PicturesInBlocks, FailTogether)
{
  const Scene scene = Glass(1);
  const Spread spread = SpreadOver(scene, SomeCuts[1], false);
  std::vector<int> aborted(3);
  RunInThreads(3, [&](Communicator& communicator) {
    const auto rank = static_cast<std::size_t>(communicator.Rank());
    const Domain domain(communicator, spread.partition);
    const Scene held = PartOf(scene, spread.blocks[rank], spread.held[rank], spread.held[rank]);
    const SharedScene own = SharedSceneOf(held.MediumSeen(), held.LightSeen(), Scene::See(held.ior, 1), scene.settings);
    const BlockOfScene block = { spread.blocks[rank], spread.known[rank], PictureInBlocks::Shared(domain, &own) };
    MediumRayCaster caster =
      PartOf(scene, spread.blocks[rank], spread.held[rank], spread.known[rank]).Caster(this->GetDevice(), &block);
    PictureInBlocks picture(domain, spread.held, &caster);
    try
    {
      picture.Take(scene.Framed(), scene.settings.imageSize, {}, [&](double) { return rank != 1; });
    }
    catch (const Aborted&)
    {
      aborted[rank] = 1;
    }
  });
  EXPECT_EQ(aborted, std::vector<int>({ 1, 1, 1 }));
}

TEST_F(PicturesInBlocks, SayThatRanksHaveOtherLights)
{
  Scene scene = Cloud(1);
  scene.settings.shadowRays = true;
  scene.fluenceDirect = scene.Everywhere(0.05);
  const Spread spread = SpreadOver(scene, SomeCuts[1], true);
  for (const std::vector<Light>& others : { std::vector<Light>(2, Lamps()[0]), std::vector<Light>(1, Lamps()[1]) })
  {
    std::vector<std::string> said(4);
    RunInThreads(4, [&](Communicator& communicator) {
      const auto rank = static_cast<std::size_t>(communicator.Rank());
      std::optional<MediumRayCaster> caster;
      if (rank > 0) // else it has no voxels
      {
        Scene part = PartOf(scene, spread.blocks[rank], spread.held[rank], spread.known[rank]);
        part.illumination.lights = rank == 2 ? others : std::vector<Light>(1, Lamps()[0]);
        const BlockOfScene block = { spread.blocks[rank], spread.known[rank], {} };
        caster.emplace(
          this->GetDevice(), part.MediumSeen(), part.LightSeen(), part.illumination, part.settings, Field{}, &block);
      }
      try
      {
        const Domain domain(communicator, spread.partition);
        PictureInBlocks picture(domain, spread.held, caster ? &*caster : nullptr);
      }
      catch (const InvalidInput& error)
      {
        said[rank] = error.what();
      }
    });
    for (const std::string& words : said)
    {
      EXPECT_THAT(words, testing::HasSubstr("other lights"));
    }
  }
}
