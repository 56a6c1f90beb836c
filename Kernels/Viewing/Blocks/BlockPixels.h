#pragma once

#include "Viewing/Rays/Picture.h"

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
  std::array<float, 3> seen = { 1.0f, 1.0f, 1.0f };          ///< of the scene behind

  /// Part of the scene behind that is not seen.
  float Hidden() const { return 1.0f - (this->seen[0] + this->seen[1] + this->seen[2]) / 3.0f; }

  /// Adds what is behind this.
  void LayBefore(const BlockPixel& behind)
  {
    for (int c = 0; c < 3; ++c)
    {
      this->radiance[c] += this->transmittance[c] * behind.radiance[c];
      this->transmittance[c] *= behind.transmittance[c];
      this->seen[c] *= behind.seen[c];
    }
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

/// The radiance of all blocks in a rectangle, 3 per pixel.
std::vector<float> RadianceOfAll(const std::vector<BlockPixels>& frontToBack, const PixelRect& rect);
}
