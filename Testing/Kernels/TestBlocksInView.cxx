// Pictures of a medium that is spread over blocks: cast block by block, they are the picture of the whole.

#include "ViewScene.h"

#include "Viewing/Blocks/BlockFaces.h"
#include "Viewing/Blocks/BlockOrder.h"
#include "Viewing/Blocks/BlockPixels.h"
#include "Viewing/Blocks/ShownBlock.h"

using namespace viewing;

namespace
{
/// Blocks of a grid that is cut at these voxels of each axis.
std::vector<GridBlock> Cut(const Grid& whole, const std::array<std::vector<int>, 3>& cuts)
{
  std::array<std::vector<int>, 3> planes = cuts;
  for (int axis = 0; axis < 3; ++axis)
  {
    planes[axis].insert(planes[axis].begin(), 0);
    planes[axis].push_back(whole.size[axis]);
  }
  std::vector<GridBlock> blocks;
  for (std::size_t k = 1; k < planes[2].size(); ++k)
  {
    for (std::size_t j = 1; j < planes[1].size(); ++j)
    {
      for (std::size_t i = 1; i < planes[0].size(); ++i)
      {
        GridBlock block;
        block.whole = whole;
        block.begin = { planes[0][i - 1], planes[1][j - 1], planes[2][k - 1] };
        block.end = { planes[0][i], planes[1][j], planes[2][k] };
        block.showsBackgroundBeside = blocks.empty();
        for (int axis = 0; axis < 3; ++axis)
        {
          block.first[axis] = std::max(block.begin[axis] - 1, 0);
        }
        blocks.push_back(block);
      }
    }
  }
  return blocks;
}

/// The voxels of a block and a layer of its neighbours.
Scene PartOf(const Scene& scene, const GridBlock& block)
{
  Scene part = scene;
  for (int axis = 0; axis < 3; ++axis)
  {
    part.grid.size[axis] = std::min(block.end[axis] + 1, block.whole.size[axis]) - block.first[axis];
    part.grid.origin[axis] = block.whole.origin[axis] + block.first[axis] * block.whole.spacing[axis];
  }
  for (std::vector<float> Scene::*field :
    { &Scene::sigma_a, &Scene::sigma_s, &Scene::emission, &Scene::fluence, &Scene::meanDirection })
  {
    const std::vector<float>& from = scene.*field;
    const std::size_t components = from.size() / scene.grid.VoxelCount();
    (part.*field).resize(components * part.grid.VoxelCount());
    for (std::size_t i = 0; i < (part.*field).size(); ++i)
    {
      std::array<int, 3> voxel = part.grid.VoxelAt(i / std::max<std::size_t>(components, 1));
      std::transform(voxel.begin(), voxel.end(), block.first.begin(), voxel.begin(), std::plus<int>());
      (part.*field)[i] = from[components * scene.grid.IndexOf(voxel) + i % components];
    }
  }
  if (!scene.surface.empty())
  {
    const auto cosines = static_cast<int>(SurfaceCosines.size());
    part.surface = FacesOfBlock(scene.surface, cosines, block, part.grid.size);
  }
  return part;
}

/// Uneven, coloured where that is asked for, with empty bricks.
Scene Cloud(int components)
{
  Scene scene(GridOf(27, 22, 19, { 0.5, 0.4, 0.6 }, { -3.0, 2.0, 1.0 }));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> some(0.0f, 1.0f);
  scene.components = components;
  scene.settings.showBackground = false;
  for (std::size_t i = 0; i < components * scene.grid.VoxelCount(); ++i)
  {
    const bool empty = scene.grid.VoxelAt(i / components)[0] < 10;
    scene.sigma_a.push_back(empty ? 0.0f : 0.2f * some(random));
    scene.sigma_s.push_back(empty ? 0.0f : 0.5f * some(random));
    scene.fluence.push_back(some(random));
  }
  for (std::size_t i = 0; i < scene.grid.VoxelCount(); ++i)
  {
    scene.emission.push_back(scene.grid.VoxelAt(i)[0] < 10 ? 0.0f : 0.1f * some(random));
  }
  return scene;
}

std::vector<BlockPixels> SeenOf(Device& device, const Scene& scene, const std::vector<GridBlock>& blocks,
  const Camera& camera, const std::vector<float>& ends = {})
{
  std::vector<BlockPixels> seen;
  for (int number : FrontToBack(blocks, camera))
  {
    MediumRayCaster caster = PartOf(scene, blocks[number]).Caster(device);
    seen.push_back(SeenPart(caster.Render(camera, {}, ends, &blocks[number])));
  }
  return seen;
}

void ExpectSame(const Picture& whole, const std::vector<BlockPixels>& blocks, double tolerance)
{
  std::size_t pixel = 0;
  double lit = 0.0;
  for (int row = 0; row < whole.height; ++row)
  {
    for (int column = 0; column < whole.width; ++column, ++pixel)
    {
      BlockPixel all;
      for (const BlockPixels& block : blocks)
      {
        all.LayBefore(block.At(column, row));
      }
      for (int c = 0; c < 3; ++c)
      {
        ASSERT_NEAR(all.radiance[c], whole.radiance[3 * pixel + c], tolerance) << column << ", " << row;
        lit += all.radiance[c];
      }
      ASSERT_NEAR(all.Hidden(), whole.alpha[pixel], tolerance) << column << ", " << row;
    }
  }
  EXPECT_GT(lit, 0.02 * pixel) << "there is nothing to compare";
}

const std::vector<std::array<std::vector<int>, 3>> Cuts = { {}, { { { 13 }, {}, {} } }, { { {}, { 5, 16 }, {} } },
  { { { 14 }, { 1 }, { 9 } } }, { { { 10, 11, 20 }, { 11 }, { 4, 9 } } } };
}

class BlocksInView : public DeviceTest
{
};

TEST_F(BlocksInView, MakeUpThePictureOfTheWhole)
{
  for (int components : { 1, 3 })
  {
    Scene scene = Cloud(components);
    for (double stepSize : { 0.5, 2.0 })
    {
      scene.settings.stepSize = stepSize;
      Camera inside = scene.Framed();
      inside.position = { 2.0, 5.5, 6.0 };
      Camera along = FrameGrid(scene.grid, scene.Aspect(), 30.0, { 0.0, -1.0, 0.0 });
      along.parallelProjection = true; // middles of steps of two voxels lie on planes between blocks
      along.parallelScale = 6.0;
      for (const Camera& camera : { scene.Framed(), inside, along })
      {
        const Picture whole = scene.Seen(this->GetDevice(), camera);
        for (const auto& cuts : Cuts)
        {
          SCOPED_TRACE(testing::Message()
            << components << " channels, steps of " << stepSize << ", from " << testing::PrintToString(camera.position)
            << ", cut at " << testing::PrintToString(cuts));
          ExpectSame(whole, SeenOf(this->GetDevice(), scene, Cut(scene.grid, cuts), camera), 1e-5);
        }
      }
    }
  }
}

TEST_F(BlocksInView, ShowWhatIsBehindOnce)
{
  Scene scene = Cloud(3);
  scene.settings.showBackground = true;
  scene.settings.backgroundColor = { 0.3, 0.2, 0.1 };
  const Picture whole = scene.Seen(this->GetDevice());
  for (const auto& cuts : Cuts)
  {
    const std::vector<BlockPixels> seen = SeenOf(this->GetDevice(), scene, Cut(scene.grid, cuts), scene.Framed());
    const std::vector<float> radiance = RadianceOfAll(seen, { { 0, 0 }, { whole.width, whole.height } });
    EXPECT_LT(LargestDifference(radiance, whole.radiance), 1e-5);
    for (int pixel : { 0, whole.width * whole.height / 2 })
    {
      BlockPixel all;
      for (const BlockPixels& block : seen)
      {
        all.LayBefore(block.At(pixel % whole.width, pixel / whole.width));
      }
      EXPECT_EQ(all.Hidden(), 1.0f);
    }
  }
}

namespace
{
/// The picture that ranks make together: each looks again where what is before its block changes what it sees.
Picture Together(Device& device, const Scene& scene, const std::vector<GridBlock>& blocks, std::size_t& lookedAgain)
{
  const Camera camera = scene.Framed();
  const std::vector<int> order = FrontToBack(blocks, camera);
  const std::vector<BlockPixels> first = SeenOf(device, scene, blocks, camera);
  std::vector<BlockPixels> seen = first;
  Picture own;
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const GridBlock& block = blocks[order[i]];
    MediumRayCaster caster = PartOf(scene, block).Caster(device);
    own = caster.Render(camera, {}, {}, &block);
    const std::vector<float> starts =
      StartsBehind(first, i, { own.width, own.height }, scene.settings.minimumTransmittance);
    if (!starts.empty())
    {
      TakeFrom(caster.RenderBehind(camera, block, starts), starts, seen[i]);
    }
    lookedAgain += std::count_if(starts.begin(), starts.end(), [](float start) { return start > 0.0f; });
  }
  return PictureOfAll(seen, { { 0, 0 }, { own.width, own.height } }, own.farDepth);
}
}

TEST_F(BlocksInView, HaveTheAlphaAndDepthOfTheWhole)
{
  for (int components : { 1, 3 })
  {
    for (double minimum : { 0.0, 0.05 }) // rays end early: so do they in the whole
    {
      Scene scene = Cloud(components);
      scene.settings.showBackground = components == 3;
      scene.settings.minimumTransmittance = minimum;
      const Picture whole = scene.Seen(this->GetDevice());
      std::size_t lookedAgain = 0;
      for (const auto& cuts : Cuts)
      {
        SCOPED_TRACE(testing::Message() << components << ", " << minimum << ", " << testing::PrintToString(cuts));
        const Picture together = Together(this->GetDevice(), scene, Cut(scene.grid, cuts), lookedAgain);
        EXPECT_EQ(together.farDepth, whole.farDepth);
        EXPECT_LT(LargestDifference(together.radiance, whole.radiance), 1e-5);
        EXPECT_LT(LargestDifference(together.alpha, whole.alpha), 1e-5);
        EXPECT_LT(LargestDifference(together.depth, whole.depth), 1e-5 * whole.farDepth);
      }
      EXPECT_GT(lookedAgain, 100u);
      const auto lost =
        std::count_if(whole.depth.begin(), whole.depth.end(), [&](float depth) { return depth < whole.farDepth; });
      EXPECT_GT(lost, 100);
    }
  }
}

TEST_F(BlocksInView, AreExactWhereNothingCrossesThem)
{
  Scene scene = Cloud(1);
  EXPECT_TRUE(scene.Caster(this->GetDevice()).CastsBlocksExactly());
  Scene lit = scene;
  lit.illumination.lights.emplace_back();
  lit.settings.shadowRays = true;
  lit.fluenceDirect = scene.Everywhere(0.1);
  EXPECT_FALSE(lit.Caster(this->GetDevice()).CastsBlocksExactly());
  Scene thick = scene;
  thick.surface.resize(BoxFaceCellCount(scene.grid) * SurfaceCosines.size(), 0.2f);
  EXPECT_FALSE(thick.Caster(this->GetDevice()).CastsBlocksExactly());
  EXPECT_EQ(scene.Caster(this->GetDevice()).SharedByBlocks(), lit.Caster(this->GetDevice()).SharedByBlocks());
  Scene other = scene;
  other.ior = scene.Everywhere(1.5);
  EXPECT_NE(scene.Caster(this->GetDevice()).SharedByBlocks(), other.Caster(this->GetDevice()).SharedByBlocks());
}

TEST_F(BlocksInView, EndWhereRaysEnd)
{
  const Scene scene = Cloud(1);
  const Camera camera = scene.Framed();
  const Picture open = scene.Seen(this->GetDevice());
  std::vector<float> ends = open.depth;
  for (std::size_t i = 0; i < ends.size(); i += 3)
  {
    ends[i] = 1e30f;
  }
  MediumRayCaster caster = scene.Caster(this->GetDevice());
  const Picture whole = caster.Render(camera, {}, ends);
  ExpectSame(whole, SeenOf(this->GetDevice(), scene, Cut(scene.grid, Cuts.back()), camera, ends), 1e-5);
}

TEST_F(BlocksInView, ShowLightAtTheSurfaceOfThickVoxels)
{
  Scene scene = Cloud(1);
  std::fill(scene.sigma_s.begin(), scene.sigma_s.end(), 8.0f);
  const Picture without = scene.Seen(this->GetDevice());
  ForBoxFaceCells(scene.grid, [&](const BoxFaceCell& cell) {
    scene.surface.insert(scene.surface.end(), SurfaceCosines.size(), 0.2f + 0.01f * (cell.u + cell.v));
  });
  const Picture whole = scene.Seen(this->GetDevice());
  EXPECT_GT(LargestDifference(without.radiance, whole.radiance), 0.05);
  for (const auto& cuts : Cuts)
  {
    const std::vector<BlockPixels> seen = SeenOf(this->GetDevice(), scene, Cut(scene.grid, cuts), scene.Framed());
    const std::vector<float> radiance = RadianceOfAll(seen, { { 0, 0 }, { whole.width, whole.height } });
    EXPECT_LT(LargestDifference(radiance, whole.radiance), 5e-3); // not all that is behind a thick block is thick
  }
}

TEST_F(BlocksInView, DoNotBendRays)
{
  Scene scene = Cloud(1);
  for (std::size_t i = 0; i < scene.grid.VoxelCount(); ++i)
  {
    scene.ior.push_back(1.0f + 0.01f * scene.grid.VoxelAt(i)[0]);
  }
  MediumRayCaster caster = scene.Caster(this->GetDevice());
  EXPECT_FALSE(caster.CastsBlocks());
  const GridBlock block = Cut(scene.grid, {})[0];
  EXPECT_THROW(caster.Render(scene.Framed(), {}, {}, &block), InvalidInput);
}

namespace
{
/// One pixel of blocks in front of each other.
std::vector<BlockPixels> PixelOfBlocks(const std::vector<BlockPixel>& frontToBack)
{
  std::vector<BlockPixels> blocks;
  for (const BlockPixel& pixel : frontToBack)
  {
    blocks.push_back({ { { 0, 0 }, { 1, 1 } }, { pixel } });
  }
  return blocks;
}

BlockPixel Grey(float radiance, float transmittance)
{
  BlockPixel pixel;
  pixel.radiance.fill(radiance);
  pixel.transmittance.fill(transmittance);
  pixel.seen.fill(transmittance);
  return pixel;
}

/// As IceT lays pictures over each other.
std::array<int, 4> Over(const std::vector<std::uint8_t>& front, const std::array<int, 4>& back)
{
  std::array<int, 4> all;
  for (int c = 0; c < 4; ++c)
  {
    all[c] = front[c] + back[c] * (255 - front[3]) / 255;
  }
  return all;
}

/// What a screen shows of blocks over a background.
std::array<int, 4> ShownOver(
  const std::array<int, 4>& background, const std::vector<BlockPixel>& frontToBack, const ToneMapping& tones)
{
  std::array<int, 4> screen = background;
  for (std::size_t i = frontToBack.size(); i-- > 0;)
  {
    screen = Over(ShownBlock(PixelOfBlocks(frontToBack), i, { 1, 1 }, tones).Pixels(), screen);
  }
  return screen;
}

/// What one rank with the whole draws.
std::array<int, 4> ShownOfWhole(
  const std::array<int, 4>& background, const std::vector<BlockPixel>& frontToBack, const ToneMapping& tones)
{
  BlockPixel all;
  for (const BlockPixel& pixel : frontToBack)
  {
    all.LayBefore(pixel);
  }
  std::vector<std::uint8_t> front = ToneMap({ all.radiance.begin(), all.radiance.end() }, {}, tones);
  front[3] = static_cast<std::uint8_t>(255.0f * all.Hidden() + 0.5f);
  return Over(front, background);
}

const std::vector<std::vector<BlockPixel>> Columns = { { Grey(0.1f, 0.7f), Grey(0.3f, 0.2f) },
  { Grey(0.0f, 0.05f), Grey(20.0f, 0.0f) }, // dark before bright
  { Grey(0.02f, 0.9f), Grey(0.0f, 1.0f), Grey(0.3f, 0.9f), Grey(0.2f, 0.5f) }, { Grey(50.0f, 0.0f), Grey(1.0f, 0.3f) },
  { Grey(0.0f, 1.0f), Grey(0.0f, 1.0f) } };
}

TEST(ShownBlock, TogetherShowTheWhole)
{
  ToneMapping tones;
  for (tones.exposure = 0.1; tones.exposure < 10.0; tones.exposure *= 1.3)
  {
    for (const auto& column : Columns)
    {
      for (const std::array<int, 4>& background : { std::array<int, 4>{ 0, 0, 0, 255 }, { 200, 100, 255, 255 } })
      {
        const auto found = ShownOver(background, column, tones);
        const auto expected = ShownOfWhole(background, column, tones);
        for (int c = 0; c < 3; ++c)
        {
          EXPECT_NEAR(found[c], expected[c], column.size() > 2 ? 2 : 1) << tones.exposure;
        }
      }
    }
  }
}

TEST(ShownBlock, ShowsWhatIsBeforeAnOpaqueSurfaceInIt)
{
  ToneMapping tones;
  tones.exposure = 2.0;
  const std::vector<BlockPixel> column = { Grey(0.1f, 0.4f), Grey(0.5f, 0.2f), Grey(9.0f, 0.1f) };
  const BlockPixel ended = Grey(0.2f, 0.6f);
  const std::array<int, 4> surface = { 30, 200, 250, 255 };
  Picture picture;
  picture.radiance = { 0.2f, 0.2f, 0.2f };
  picture.transmittance = { 0.6f, 0.6f, 0.6f };
  picture.sceneTransmittance = picture.transmittance;
  picture.alpha = { 0.4f };
  picture.depth = { 1.0f };
  const auto blocks = PixelOfBlocks(column);
  const auto second = Over(ShownBlock(blocks, 1, { 1, 1 }, tones).Pixels(picture, { true }), surface);
  const auto found = Over(ShownBlock(blocks, 0, { 1, 1 }, tones).Pixels(), second);
  const auto expected = ShownOfWhole(surface, { column[0], ended }, tones);
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(found[c], expected[c], 1);
  }
}

TEST(BlockOrder, IsFromFrontToBack)
{
  const Grid grid = GridOf(8, 8, 8);
  const std::vector<GridBlock> blocks = Cut(grid, { { { 4 }, {}, { 2, 5 } } });
  Camera camera;
  camera.position = { -20.0, 4.0, 4.0 };
  camera.focalPoint = { 4.0, 4.0, 4.0 };
  const std::vector<int> order = FrontToBack(blocks, camera);
  const auto place = [&](int block) { return std::find(order.begin(), order.end(), block) - order.begin(); };
  EXPECT_LT(place(2), place(3));
  EXPECT_LT(place(2), place(0)); // the eye is between the planes of 2
  EXPECT_LT(place(2), place(4));
  camera.parallelProjection = true;
  camera.focalPoint = { -20.0, 4.0, 20.0 };
  const std::vector<int> upwards = FrontToBack(blocks, camera);
  EXPECT_LT(std::max(upwards[0], upwards[1]), 2);
  EXPECT_GT(std::min(upwards[4], upwards[5]), 3);
}
