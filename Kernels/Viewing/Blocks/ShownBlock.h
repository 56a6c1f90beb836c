#pragma once

#include "Viewing/Blocks/BlockPixels.h"
#include "Viewing/ToneMapping.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// Share of one block in a display picture with eight bits per channel, for programs that composite the blocks'
/// pictures by alpha blending: the composite shows the picture of the whole domain.
///
/// Display values are not proportional to radiance, so the share of a block depends on the light of the blocks in front
/// of it. Let L_k be the radiance of the first k blocks, V_k the transmittance of these blocks for unscattered light
/// from behind, and S the display value of a radiance. Block k contributes
///
///   (S(L_k) - S(L_k-1)) / V'_k-1,  V'_k = max(V_k, largest of S(L_j) - S(L_j-1), j > k),
///
/// and attenuates what is behind it by V'_k / V'_k-1. V' equals V unless a block is brighter than the display can show
/// through the blocks in front of it. The blocks in front then hide less than V implies, and the bright block hides
/// more.
class ShownBlock
{
public:
  ShownBlock() = default; ///< for a rank that shows no block

  /// Takes the contributions of all blocks from which Pixels computes the share of this block.
  /// @param frontToBack  pixels of all blocks within this block's rectangle
  /// @param own          index of this block in `frontToBack`
  /// @param size         width and height of the picture, pixels
  /// @param tones        tone mapping with a fixed exposure, > 0
  ShownBlock(
    std::vector<BlockPixels> frontToBack, std::size_t own, const std::array<int, 2>& size, const ToneMapping& tones);

  /// RGBA of each pixel of the picture, row by row; colours are multiplied by alpha.
  /// @param ended    picture of this block in which opaque surfaces end rays; empty: no ray ends
  /// @param isEnded  whether a surface ends the pixel's ray in this block, one per pixel; empty: none does
  std::vector<std::uint8_t> Pixels(const Picture& ended = {}, const std::vector<bool>& isEnded = {}) const;

private:
  struct Column; ///< display values of all blocks at one pixel, from front to back

  std::array<std::uint8_t, 4> Share(Column& blocks, int column, int row, const BlockPixel* ended) const;

  std::vector<BlockPixels> Blocks;
  std::size_t Own = 0;
  std::array<int, 2> PictureSize = {};
  ToneMapping Tones;
};
}
