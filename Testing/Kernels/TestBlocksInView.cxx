// Pictures of one block of a medium, and how they are laid over each other.

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

const std::array<std::vector<int>, 3> Planes = { { { 10, 11, 20 }, { 11 }, { 4, 9 } } };
}

class BlocksInView : public DeviceTest
{
};

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
  ExpectSame(whole, SeenOf(this->GetDevice(), scene, Cut(scene.grid, Planes), camera, ends), 1e-5);
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
