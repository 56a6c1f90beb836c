#pragma once

#include "Distribution/Domain.h"
#include "Viewing/Rays/Picture.h"
#include "Viewing/Scene/Camera.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace tyndall
{
/// A rectangle of pixels: columns and rows in [begin, end).
struct PixelRect
{
  std::array<int, 2> begin = {}, end = {};

  bool IsEmpty() const { return this->end[0] <= this->begin[0] || this->end[1] <= this->begin[1]; }
  std::size_t Count() const
  {
    return this->IsEmpty() ? 0
                           : static_cast<std::size_t>(this->end[0] - this->begin[0]) * (this->end[1] - this->begin[1]);
  }
  bool Has(int column, int row) const
  {
    return column >= this->begin[0] && column < this->end[0] && row >= this->begin[1] && row < this->end[1];
  }
};

PixelRect Overlap(const PixelRect& a, const PixelRect& b);

/// Contribution of a block of a larger grid, or of several blocks one behind the other, to one pixel.
struct BlockPixel
{
  std::array<float, 3> radiance = {};                        ///< accumulated radiance, W / (length^2 sr)
  std::array<float, 3> transmittance = { 1.0f, 1.0f, 1.0f }; ///< transmittance of the block for radiance from behind it
  /// transmittance for light from behind that is not scattered at all (Picture::sceneTransmittance)
  std::array<float, 3> seen = { 1.0f, 1.0f, 1.0f };
  /// Radiance that reaches the eye without being scattered; not included in `radiance`. Blocks in front attenuate it by
  /// their `seen`.
  std::array<float, 3> sharp = {};
  std::array<float, 3> missing = {}; ///< correction for light at the surface, as Picture::missing
  float open = 1.0f;     ///< 0 if the pixel includes the background, which hides everything behind it; else 1
  float depth = FarAway; ///< depth as Picture::depth; FarAway or more: the transmittance stays above 1/2

  static constexpr float FarAway = 1e30f;

  /// Transmittance of the medium for unscattered light, averaged over the channels.
  float Left() const { return (this->seen[0] + this->seen[1] + this->seen[2]) / 3.0f; }

  /// Largest transmittance over the channels: of unscattered light (MostLeft), or of the radiance of blocks behind
  /// (MostThrough).
  float MostLeft() const { return std::max({ this->seen[0], this->seen[1], this->seen[2] }); }
  float MostThrough() const
  {
    return std::max({ this->transmittance[0], this->transmittance[1], this->transmittance[2] });
  }

  /// Total radiance of the pixel if no block is in front, W / (length^2 sr).
  std::array<float, 3> All() const
  {
    std::array<float, 3> all;
    for (int c = 0; c < 3; ++c)
    {
      all[c] = this->radiance[c] + this->sharp[c];
      if (this->missing[c] != 0.0f)
      {
        all[c] = std::max(all[c] + this->missing[c] * (1.0f - this->transmittance[c]), 0.0f);
      }
    }
    return all;
  }

  /// Fraction in [0, 1] of the light from behind that the pixel hides, by the medium or by the background that it
  /// shows.
  float Hidden() const { return 1.0f - this->open * this->Left(); }

  /// Composites this pixel over `behind`, the contribution to the same pixel of the blocks behind this one.
  void LayBefore(const BlockPixel& behind)
  {
    for (int c = 0; c < 3; ++c)
    {
      this->radiance[c] += this->transmittance[c] * behind.radiance[c];
      this->transmittance[c] *= behind.transmittance[c];
      this->sharp[c] += this->seen[c] * behind.sharp[c];
      this->missing[c] += behind.missing[c];
      this->seen[c] *= behind.seen[c];
    }
    this->open *= behind.open;
    this->depth = std::min(this->depth, behind.depth);
  }
};

/// Pixels of the rectangle in which a block contributes to a picture. Ranks exchange the array `pixels`.
struct BlockPixels
{
  PixelRect rect;
  std::vector<BlockPixel> pixels; ///< pixels of the rectangle, row by row, from bottom to top

  /// The block's contribution to a pixel of the picture; an empty pixel outside the rectangle.
  BlockPixel At(int column, int row) const
  {
    const int width = this->rect.end[0] - this->rect.begin[0];
    return this->rect.Has(column, row)
      ? this->pixels[static_cast<std::size_t>(row - this->rect.begin[1]) * width + (column - this->rect.begin[0])]
      : BlockPixel();
  }
};

/// Extracts the contribution of a block to one pixel from its picture.
/// @param pixel  index of the pixel, row by row
BlockPixel PixelOf(const Picture& picture, std::size_t pixel);

/// Crops a block's picture to the smallest rectangle that contains all pixels to which the block contributes.
BlockPixels SeenPart(const Picture& picture);

/// Crops pixels of a block to a rectangle.
BlockPixels PartIn(const PixelRect& rect, const BlockPixels& pixels);

/// Transmittances of the blocks in front of a block, for those pixels that the block must render again. There are two
/// kinds. In some pixels the transmittance, accumulated over all blocks, falls below 1/2 in this block, whose own depth
/// is then wrong. In others it falls below `minimum` in this block or in front of it.
/// @param own      index of the block in `frontToBack`
/// @param size     width and height of the picture, pixels
/// @param minimum  transmittance at which rays end
Starts StartsBehind(
  const std::vector<BlockPixels>& frontToBack, std::size_t own, const std::array<int, 2>& size, double minimum);

/// Replaces pixels of a block by those of the picture `again`, which the block rendered with the transmittances
/// `starts` of the blocks in front. Only pixels where `starts` is above 0 are replaced.
void TakeFrom(const Picture& again, const Starts& starts, BlockPixels& pixels);

/// Pixels of all blocks in view of the camera, from the front block to the rearmost.
struct SeenBlocks
{
  std::vector<BlockPixels> frontToBack;
  std::size_t own = 0; ///< index of this rank's block in frontToBack; without meaning if the rank has no block
};

/// Exchanges pixels: this rank receives the pixels of all blocks within `wanted`. Each rank sends to each other rank
/// only the pixels that the other rank wants. Collective.
/// @param own     pixels of this rank's block; empty if it is out of view, or if the rank has no block
/// @param wanted  rectangle of the pixels that this rank needs
/// @param failed  whether this rank failed to render its block
/// @return nothing on all ranks if `failed` is true on any
std::optional<SeenBlocks> ExchangePixels(
  const Domain& domain, const BlockPixels& own, const PixelRect& wanted, bool failed, const Camera& camera);

/// Gathers numbers from all ranks (allgather), in rank order. Collective, with the same count of numbers on all ranks.
/// @throws InvalidInput on all ranks, if the counts differ
std::vector<double> SaidByAll(Communicator& communicator, const std::vector<double>& own);

/// Crops radiance, alpha and depth of a picture to a rectangle of pixels.
Picture PartOf(Picture&& picture, const PixelRect& rect);

/// Composites the pixels of all blocks in a rectangle to a picture: radiance, alpha (of the medium, without the
/// background) and depth.
/// @param farDepth  Picture::farDepth of the blocks' pictures
Picture PictureOfAll(const std::vector<BlockPixels>& frontToBack, const PixelRect& rect, float farDepth);
}
