// Pictures of a medium that is spread over blocks: cast block by block, they are the picture of the whole.

#include "BlocksOfView.h"

#include "Viewing/Blocks/BlockPixels.h"
#include "Viewing/Blocks/ShownBlock.h"
#include "Viewing/Scene/BlockOfScene.h"

using namespace viewing;

namespace
{
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
    const std::vector<float> radiance =
      PictureOfAll(seen, { { 0, 0 }, { whole.width, whole.height } }, BlockPixel::FarAway).radiance;
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
Picture Collective(Device& device, const Scene& scene, const std::vector<GridBlock>& blocks, std::size_t& lookedAgain)
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
    const Starts starts = StartsBehind(first, i, { own.width, own.height }, scene.settings.minimumTransmittance);
    if (!starts.IsEmpty())
    {
      TakeFrom(caster.RenderBehind(camera, block, starts), starts, seen[i]);
    }
    lookedAgain += std::count_if(starts.seen.begin(), starts.seen.end(), [](float start) { return start > 0.0f; });
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
        const Picture together = Collective(this->GetDevice(), scene, Cut(scene.grid, cuts), lookedAgain);
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

TEST_F(BlocksInView, HaveToBeOfOneIndex)
{
  const Scene scene = Cloud(1);
  Scene lit = scene;
  lit.illumination.lights.emplace_back();
  lit.settings.shadowRays = true;
  lit.fluenceDirect = scene.Everywhere(0.1);
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
