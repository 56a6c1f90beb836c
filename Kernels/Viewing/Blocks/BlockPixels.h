#pragma once

#include "Viewing/Rays/Picture.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// A rectangle of a picture's pixels: columns and rows from begin on, before end.
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

/// What a camera's ray finds in a block of a larger grid, or in several, one behind the other.
struct BlockPixel
{
  std::array<float, 3> radiance = {};                        ///< W / (length^2 sr)
  std::array<float, 3> transmittance = { 1.0f, 1.0f, 1.0f }; ///< of the radiance behind
  std::array<float, 3> seen = { 1.0f, 1.0f, 1.0f };          ///< of the scene behind, through the medium
  std::array<float, 3> sharp = {};                           ///< radiance that is dimmed by `seen` of what is before
  std::array<float, 3> missing = {};                         ///< see Picture
  float open = 1.0f;                                         ///< 0 where the background is seen behind that
  float depth = FarAway;                                     ///< as Picture::depth; there or farther: nowhere

  static constexpr float FarAway = 1e30f;

  /// Part of what is behind that the medium lets through.
  float Left() const { return (this->seen[0] + this->seen[1] + this->seen[2]) / 3.0f; }

  float MostLeft() const { return std::max({ this->seen[0], this->seen[1], this->seen[2] }); } ///< of any channel
  float MostThrough() const
  {
    return std::max({ this->transmittance[0], this->transmittance[1], this->transmittance[2] });
  }

  /// What is seen where nothing is before this.
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

  /// Part of the scene behind that is not seen, background and all.
  float Hidden() const { return 1.0f - this->open * this->Left(); }

  /// Adds what is behind this.
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

/// The part of a picture in which a block is seen. Numbers of pixels are what is sent from rank to rank.
struct BlockPixels
{
  PixelRect rect;
  std::vector<BlockPixel> pixels; ///< row by row

  /// Of a pixel outside of the rectangle: nothing.
  BlockPixel At(int column, int row) const
  {
    const int width = this->rect.end[0] - this->rect.begin[0];
    return this->rect.Has(column, row)
      ? this->pixels[static_cast<std::size_t>(row - this->rect.begin[1]) * width + (column - this->rect.begin[0])]
      : BlockPixel();
  }
};

/// A pixel of a block's picture.
BlockPixel PixelOf(const Picture& picture, std::size_t pixel);

/// The least rectangle outside of which a block's picture is empty.
BlockPixels SeenPart(const Picture& picture);

/// Their common part.
BlockPixels PartIn(const PixelRect& rect, const BlockPixels& pixels);

/// Where a block has to be looked at again, because of those before it: where rays lose half of their light in it but
/// not in it alone (its own depth is not theirs), and where in it, or before, they have lost so much that they end.
/// @param own      which of the blocks it is
/// @param size     of the picture, pixels
/// @param minimum  part of their light at which rays end
Starts StartsBehind(
  const std::vector<BlockPixels>& frontToBack, std::size_t own, const std::array<int, 2>& size, double minimum);

/// Takes those pixels from a picture that was made so.
void TakeFrom(const Picture& again, const Starts& starts, BlockPixels& pixels);

/// What all blocks show in a rectangle: radiance, alpha (of the medium, without the background) and depth.
/// @param farDepth  of the pictures of blocks
Picture PictureOfAll(const std::vector<BlockPixels>& frontToBack, const PixelRect& rect, float farDepth);
}
