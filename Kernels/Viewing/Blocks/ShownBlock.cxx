#include "Viewing/Blocks/ShownBlock.h"

#include "Device/HostThreads.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
/// Smallest number of picture rows per thread.
constexpr std::size_t RowsOfThread = 16;
/// Rounding error of a division followed by a multiplication of integers held as floats, in units of 1/255.
constexpr float RoundingOfByte = 1e-3f;

using Shown = std::array<float, 3>; ///< display value of red, green, blue, [0, 255]

Shown ShownOf(const std::array<float, 3>& radiance, const ToneMapping& tones)
{
  Shown shown;
  std::transform(radiance.begin(), radiance.end(), shown.begin(), [&](float value) {
    return std::floor(ShownValue(value * static_cast<float>(tones.exposure), tones.curve) + 0.5f);
  });
  return shown;
}

/// State of one pixel of the display while blocks are composited from front to back. The contribution of each block
/// behind the first is truncated to an integer, as ParaView's compositor IceT does.
struct Screen
{
  Shown shown = {};
  float open = 1.0f; ///< transmittance of the blocks composited so far

  /// Composites one more block behind those composited so far.
  /// @param wanted    display value of all blocks up to and including this one
  /// @param openThen  transmittance of all blocks up to and including this one
  /// @return RGBA that the block must contribute
  std::array<std::uint8_t, 4> Lay(const Shown& wanted, float openThen)
  {
    std::array<std::uint8_t, 4> share = {};
    for (int c = 0; c < 3 && this->open > 0.0f; ++c)
    {
      const float value = std::ceil((wanted[c] - this->shown[c]) / this->open - RoundingOfByte);
      share[c] = static_cast<std::uint8_t>(std::clamp(value, 0.0f, 255.0f));
      this->shown[c] += std::floor(share[c] * this->open + RoundingOfByte);
    }
    const float alpha = this->open > 0.0f ? 1.0f - std::min(openThen / this->open, 1.0f) : 0.0f;
    share[3] = static_cast<std::uint8_t>(255.0f * alpha + 0.5f);
    this->open *= (255 - share[3]) / 255.0f;
    return share;
  }
};
}

/// The blocks at one pixel, for k = 0, 1, ...: display value of the first k blocks together, and their transmittance.
struct ShownBlock::Column
{
  std::vector<Shown> shown;
  std::vector<float> open;

  void Find(const std::vector<BlockPixels>& blocks, int column, int row, const ToneMapping& tones)
  {
    this->shown.assign(1, {});
    this->open.clear();
    BlockPixel all;
    for (const BlockPixels& block : blocks)
    {
      all.LayBefore(block.At(column, row));
      this->shown.push_back(ShownOf(all.All(), tones));
      this->open.push_back(1.0f - all.Hidden());
    }
    float brightest = 0.0f; // largest display value that a block behind block i adds
    for (std::size_t i = blocks.size(); i-- > 0;)
    {
      this->open[i] = std::max(this->open[i], brightest / 255.0f);
      for (int c = 0; c < 3; ++c)
      {
        brightest = std::max(brightest, this->shown[i + 1][c] - this->shown[i][c]);
      }
    }
  }
};

ShownBlock::ShownBlock(
  std::vector<BlockPixels> frontToBack, std::size_t own, const std::array<int, 2>& size, const ToneMapping& tones)
  : Blocks(std::move(frontToBack))
  , Own(own)
  , PictureSize(size)
  , Tones(tones)
{
}

/// RGBA that this block must contribute to one pixel.
/// @param ended  contribution of this block if an opaque surface ends the ray inside it; null: no surface does
std::array<std::uint8_t, 4> ShownBlock::Share(Column& blocks, int column, int row, const BlockPixel* ended) const
{
  blocks.Find(this->Blocks, column, row, this->Tones);
  Screen screen;
  for (std::size_t i = 0; i < this->Own; ++i)
  {
    screen.Lay(blocks.shown[i + 1], blocks.open[i]);
  }
  if (!ended)
  {
    return screen.Lay(blocks.shown[this->Own + 1], blocks.open[this->Own]);
  }
  BlockPixel upToEnd;
  for (std::size_t i = 0; i < this->Own; ++i)
  {
    upToEnd.LayBefore(this->Blocks[i].At(column, row));
  }
  upToEnd.LayBefore(*ended);
  return screen.Lay(ShownOf(upToEnd.All(), this->Tones), 1.0f - upToEnd.Hidden());
}

std::vector<std::uint8_t> ShownBlock::Pixels(const Picture& ended, const std::vector<bool>& isEnded) const
{
  std::vector<std::uint8_t> pixels(4 * static_cast<std::size_t>(this->PictureSize[0]) * this->PictureSize[1]);
  const PixelRect& rect = this->Blocks[this->Own].rect;
  InThreads(static_cast<std::size_t>(rect.end[1] - rect.begin[1]), RowsOfThread, [&](std::size_t from, std::size_t to) {
    Column blocks;
    for (int row = rect.begin[1] + static_cast<int>(from); row < rect.begin[1] + static_cast<int>(to); ++row)
    {
      for (int column = rect.begin[0]; column < rect.end[0]; ++column)
      {
        const std::size_t pixel = static_cast<std::size_t>(row) * this->PictureSize[0] + column;
        const bool ends = !isEnded.empty() && isEnded[pixel];
        const BlockPixel upToEnd = ends ? PixelOf(ended, pixel) : BlockPixel();
        const auto share = this->Share(blocks, column, row, ends ? &upToEnd : nullptr);
        std::copy(share.begin(), share.end(), pixels.begin() + 4 * pixel);
      }
    }
  });
  return pixels;
}
}
