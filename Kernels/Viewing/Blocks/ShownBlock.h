#pragma once

#include "Viewing/Blocks/BlockPixels.h"
#include "Viewing/ToneMapping.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// What one of several blocks adds to a screen on which their pictures are laid over each other, eight bits a channel,
/// each dimmed by the alpha of those before it, so that together they show the picture of the whole.
///
/// A screen's values are not proportional to radiance: what a block adds depends on the light of the blocks before it.
/// With L_k, V_k the radiance of the first k blocks and what of the scene is seen through them, S the screen's value of
/// a radiance, block k adds
///
///   (S(L_k) - S(L_k-1)) / V'_k-1,  V'_k = max(V_k, largest of S(L_j) - S(L_j-1), j > k),
///
/// and dims what is behind by V'_k / V'_k-1. V' is V where the blocks behind are not brighter than a screen can be
/// behind these; else a block hides less, and one behind it hides more.
class ShownBlock
{
public:
  ShownBlock() = default; ///< there is none

  /// @param frontToBack  what is seen of the blocks where this one is, which is number `own` of them
  /// @param width        of the picture, pixels
  /// @param tones        its exposure is known
  ShownBlock(
    std::vector<BlockPixels> frontToBack, std::size_t own, const std::array<int, 2>& size, const ToneMapping& tones);

  const std::array<int, 2>& Size() const { return this->PictureSize; }

  /// Red, green, blue, multiplied by alpha, and alpha of each pixel of the picture.
  std::vector<std::uint8_t> Pixels() const;

  /// The same where opaque surfaces end rays in this block.
  /// @param ended    the block's picture up to there
  /// @param isEnded  by pixel
  std::vector<std::uint8_t> Pixels(const Picture& ended, const std::vector<bool>& isEnded) const;

private:
  struct Column; ///< the blocks behind a pixel

  std::array<std::uint8_t, 4> Share(Column& blocks, int column, int row, const BlockPixel* ended) const;
  void Fill(const PixelRect& rect, const Picture* ended, const std::vector<bool>& isEnded,
    std::vector<std::uint8_t>& pixels) const;

  std::vector<BlockPixels> Blocks;
  std::size_t Own = 0;
  std::array<int, 2> PictureSize = {};
  ToneMapping Tones;
};
}
