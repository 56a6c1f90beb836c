#include "Viewing/Blocks/BlockPixels.h"

#include <algorithm>

namespace tyndall
{
PixelRect Overlap(const PixelRect& a, const PixelRect& b)
{
  PixelRect common;
  for (int axis = 0; axis < 2; ++axis)
  {
    common.begin[axis] = std::max(a.begin[axis], b.begin[axis]);
    common.end[axis] = std::min(a.end[axis], b.end[axis]);
  }
  return common.IsEmpty() ? PixelRect() : common;
}

BlockPixel PixelOf(const Picture& picture, std::size_t pixel)
{
  BlockPixel found;
  for (int c = 0; c < 3; ++c)
  {
    found.radiance[c] = picture.radiance[3 * pixel + c];
    found.transmittance[c] = picture.transmittance[3 * pixel + c];
    found.seen[c] = picture.sceneTransmittance[3 * pixel + c];
  }
  found.open = picture.alpha[pixel] < 1.0f ? 1.0f : 0.0f;
  found.depth = picture.depth[pixel];
  return found;
}

BlockPixels SeenPart(const Picture& picture)
{
  PixelRect rect = { { picture.width, picture.height }, { 0, 0 } };
  for (std::size_t pixel = 0; pixel < picture.alpha.size(); ++pixel)
  {
    const float* const radiance = picture.radiance.data() + 3 * pixel;
    if (picture.alpha[pixel] > 0.0f || radiance[0] > 0.0f || radiance[1] > 0.0f || radiance[2] > 0.0f)
    {
      const int at[2] = { static_cast<int>(pixel % picture.width), static_cast<int>(pixel / picture.width) };
      for (int axis = 0; axis < 2; ++axis)
      {
        rect.begin[axis] = std::min(rect.begin[axis], at[axis]);
        rect.end[axis] = std::max(rect.end[axis], at[axis] + 1);
      }
    }
  }
  BlockPixels seen;
  seen.rect = rect.IsEmpty() ? PixelRect() : rect;
  seen.pixels.reserve(seen.rect.Count());
  for (int row = seen.rect.begin[1]; row < seen.rect.end[1]; ++row)
  {
    for (int column = seen.rect.begin[0]; column < seen.rect.end[0]; ++column)
    {
      seen.pixels.push_back(PixelOf(picture, static_cast<std::size_t>(row) * picture.width + column));
    }
  }
  return seen;
}

BlockPixels PartIn(const PixelRect& rect, const BlockPixels& pixels)
{
  BlockPixels part;
  part.rect = Overlap(rect, pixels.rect);
  part.pixels.reserve(part.rect.Count());
  for (int row = part.rect.begin[1]; row < part.rect.end[1]; ++row)
  {
    for (int column = part.rect.begin[0]; column < part.rect.end[0]; ++column)
    {
      part.pixels.push_back(pixels.At(column, row));
    }
  }
  return part;
}

std::vector<float> StartsOfDepth(
  const std::vector<BlockPixels>& frontToBack, std::size_t own, const std::array<int, 2>& size)
{
  constexpr float half = 0.5f;
  std::vector<float> starts;
  const PixelRect& rect = frontToBack[own].rect;
  for (int row = rect.begin[1]; row < rect.end[1]; ++row)
  {
    for (int column = rect.begin[0]; column < rect.end[0]; ++column)
    {
      BlockPixel before;
      for (std::size_t i = 0; i < own; ++i)
      {
        before.LayBefore(frontToBack[i].At(column, row));
      }
      BlockPixel behind = before;
      behind.LayBefore(frontToBack[own].At(column, row));
      if (before.Left() < 1.0f && before.Left() > half && behind.Left() <= half)
      {
        starts.resize(3 * static_cast<std::size_t>(size[0]) * size[1], 0.0f);
        std::copy(before.seen.begin(), before.seen.end(),
          starts.begin() + 3 * (static_cast<std::ptrdiff_t>(row) * size[0] + column));
      }
    }
  }
  return starts;
}

Picture PictureOfAll(const std::vector<BlockPixels>& frontToBack, const PixelRect& rect, float farDepth)
{
  Picture picture;
  picture.width = rect.IsEmpty() ? 0 : rect.end[0] - rect.begin[0];
  picture.height = rect.IsEmpty() ? 0 : rect.end[1] - rect.begin[1];
  picture.farDepth = farDepth;
  picture.radiance.reserve(3 * rect.Count());
  picture.alpha.reserve(rect.Count());
  picture.depth.reserve(rect.Count());
  for (int row = rect.begin[1]; row < rect.end[1]; ++row)
  {
    for (int column = rect.begin[0]; column < rect.end[0]; ++column)
    {
      BlockPixel all;
      for (const BlockPixels& block : frontToBack)
      {
        all.LayBefore(block.At(column, row));
      }
      picture.radiance.insert(picture.radiance.end(), all.radiance.begin(), all.radiance.end());
      picture.alpha.push_back(1.0f - all.Left());
      picture.depth.push_back(std::min(all.depth, farDepth));
    }
  }
  return picture;
}

std::vector<float> RadianceOfAll(const std::vector<BlockPixels>& frontToBack, const PixelRect& rect)
{
  return PictureOfAll(frontToBack, rect, BlockPixel::FarAway).radiance;
}
}
