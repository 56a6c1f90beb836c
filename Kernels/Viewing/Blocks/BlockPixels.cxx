#include "Viewing/Blocks/BlockPixels.h"

#include "Viewing/Scene/BlockOfScene.h"

#include <utility>

namespace tyndall
{
namespace
{
constexpr float Half = 0.5f; ///< mean transmittance at which the depth of a pixel is defined

/// Calls act(column, row, number) for each pixel of a rectangle, row by row; `number` counts the pixels.
template <class Act>
void ForPixels(const PixelRect& rect, const Act& act)
{
  std::size_t number = 0;
  for (int row = rect.begin[1]; row < rect.end[1]; ++row)
  {
    for (int column = rect.begin[0]; column < rect.end[0]; ++column, ++number)
    {
      act(column, row, number);
    }
  }
}
}

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
    found.sharp[c] = picture.sharp.empty() ? 0.0f : picture.sharp[3 * pixel + c];
    found.missing[c] = picture.missing.empty() ? 0.0f : picture.missing[3 * pixel + c];
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
    const BlockPixel there = PixelOf(picture, pixel);
    const std::array<float, 3>& shines = there.radiance;
    const std::array<float, 3>& sharp = there.sharp;
    if (there.Hidden() > 0.0f || there.MostThrough() < 1.0f || std::max({ shines[0], shines[1], shines[2] }) > 0.0f ||
      std::max({ sharp[0], sharp[1], sharp[2] }) > 0.0f)
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
  ForPixels(seen.rect, [&](int column, int row, std::size_t) {
    seen.pixels.push_back(PixelOf(picture, static_cast<std::size_t>(row) * picture.width + column));
  });
  return seen;
}

BlockPixels PartIn(const PixelRect& rect, const BlockPixels& pixels)
{
  BlockPixels part;
  part.rect = Overlap(rect, pixels.rect);
  part.pixels.reserve(part.rect.Count());
  ForPixels(part.rect, [&](int column, int row, std::size_t) { part.pixels.push_back(pixels.At(column, row)); });
  return part;
}

Starts StartsBehind(
  const std::vector<BlockPixels>& frontToBack, std::size_t own, const std::array<int, 2>& size, double minimum)
{
  Starts starts;
  ForPixels(frontToBack[own].rect, [&](int column, int row, std::size_t) {
    BlockPixel before;
    for (std::size_t i = 0; i < own; ++i)
    {
      before.LayBefore(frontToBack[i].At(column, row));
    }
    BlockPixel behind = before;
    behind.LayBefore(frontToBack[own].At(column, row));
    const bool losesHalf = before.Left() > Half && behind.Left() <= Half;
    const bool ends = behind.MostLeft() <= minimum || behind.MostThrough() <= minimum;
    if (std::min(before.Left(), before.MostThrough()) < 1.0f && (losesHalf || ends))
    {
      const auto place = 3 * (static_cast<std::ptrdiff_t>(row) * size[0] + column);
      starts.seen.resize(3 * static_cast<std::size_t>(size[0]) * size[1], 0.0f);
      starts.transmittance.resize(starts.seen.size(), 0.0f);
      std::copy(before.seen.begin(), before.seen.end(), starts.seen.begin() + place);
      std::copy(before.transmittance.begin(), before.transmittance.end(), starts.transmittance.begin() + place);
    }
  });
  return starts;
}

void TakeFrom(const Picture& again, const Starts& starts, BlockPixels& pixels)
{
  ForPixels(pixels.rect, [&](int column, int row, std::size_t number) {
    const std::size_t pixel = static_cast<std::size_t>(row) * again.width + column;
    const float* const start = starts.seen.data() + 3 * pixel;
    const float before = (start[0] + start[1] + start[2]) / 3.0f;
    const float* const through = starts.transmittance.data() + 3 * pixel;
    if (before > 0.0f || std::max({ through[0], through[1], through[2] }) > 0.0f)
    {
      pixels.pixels[number] = PixelOf(again, pixel);
      if (before <= Half)
      {
        // The transmittance falls below 1/2 in a block in front of this one, and that block gives the depth.
        pixels.pixels[number].depth = BlockPixel::FarAway;
      }
    }
  });
}

std::vector<double> SaidByAll(Communicator& communicator, const std::vector<double>& own)
{
  std::vector<double> all(own.size() * static_cast<std::size_t>(communicator.Ranks()), 0.0);
  std::copy(own.begin(), own.end(), all.begin() + static_cast<std::ptrdiff_t>(own.size()) * communicator.Rank());
  return communicator.Sum(all);
}

std::optional<SeenBlocks> ExchangePixels(
  const Domain& domain, const BlockPixels& own, const PixelRect& wanted, bool failed, const Camera& camera)
{
  // Each rank sends eight numbers: the corners of the rectangle that it rendered, and those of the rectangle that it
  // wants.
  constexpr std::size_t words = 8;
  if (domain.Any(failed))
  {
    return std::nullopt;
  }
  const std::vector<double> said = SaidByAll(domain.Comm(),
    { 1.0 * own.rect.begin[0], 1.0 * own.rect.begin[1], 1.0 * own.rect.end[0], 1.0 * own.rect.end[1],
      1.0 * wanted.begin[0], 1.0 * wanted.begin[1], 1.0 * wanted.end[0], 1.0 * wanted.end[1] });
  const auto rectOf = [&](int rank, std::size_t from) {
    const double* const at = said.data() + words * static_cast<std::size_t>(rank) + from;
    return PixelRect{ { static_cast<int>(at[0]), static_cast<int>(at[1]) },
      { static_cast<int>(at[2]), static_cast<int>(at[3]) } };
  };
  std::vector<int> partners;
  for (int rank = 0; rank < domain.Comm().Ranks(); ++rank)
  {
    const bool gets = !Overlap(own.rect, rectOf(rank, 4)).IsEmpty();
    const bool gives = !Overlap(wanted, rectOf(rank, 0)).IsEmpty();
    if (rank != domain.Rank() && (gets || gives))
    {
      partners.push_back(rank);
    }
  }
  auto arrived = domain.Comm().Exchange<BlockPixel>(partners, [&] {
    std::vector<std::vector<BlockPixel>> parcels;
    for (const int partner : partners)
    {
      parcels.push_back(PartIn(rectOf(partner, 4), own).pixels);
    }
    return parcels;
  });

  std::vector<GridBlock> blocks;
  std::vector<BlockPixels> pixels;
  std::optional<std::size_t> ownNumber;
  if (!domain.IsEmpty())
  {
    ownNumber = 0;
    blocks.push_back(BlockOfRank(domain.Partition(), domain.Rank()));
    pixels.push_back(own);
  }
  for (std::size_t i = 0; i < partners.size(); ++i)
  {
    if (!arrived[i].empty())
    {
      blocks.push_back(BlockOfRank(domain.Partition(), partners[i]));
      pixels.push_back({ Overlap(wanted, rectOf(partners[i], 0)), std::move(arrived[i]) });
    }
  }
  SeenBlocks seen;
  for (const int number : FrontToBack(blocks, camera))
  {
    seen.own = ownNumber && number == 0 ? seen.frontToBack.size() : seen.own;
    seen.frontToBack.push_back(std::move(pixels[number]));
  }
  return seen;
}

Picture PartOf(Picture&& picture, const PixelRect& rect)
{
  if (rect.begin == std::array<int, 2>{ 0, 0 } && rect.end == std::array<int, 2>{ picture.width, picture.height })
  {
    return std::move(picture);
  }
  Picture part;
  part.width = rect.IsEmpty() ? 0 : rect.end[0] - rect.begin[0];
  part.height = rect.IsEmpty() ? 0 : rect.end[1] - rect.begin[1];
  part.farDepth = picture.farDepth;
  ForPixels(rect, [&](int column, int row, std::size_t) {
    const auto pixel = static_cast<std::ptrdiff_t>(row) * picture.width + column;
    const auto radiance = picture.radiance.begin() + 3 * pixel;
    part.radiance.insert(part.radiance.end(), radiance, radiance + 3);
    part.alpha.push_back(picture.alpha[pixel]);
    part.depth.push_back(picture.depth[pixel]);
  });
  return part;
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
  ForPixels(rect, [&](int column, int row, std::size_t) {
    BlockPixel all;
    for (const BlockPixels& block : frontToBack)
    {
      all.LayBefore(block.At(column, row));
    }
    const std::array<float, 3> radiance = all.All();
    picture.radiance.insert(picture.radiance.end(), radiance.begin(), radiance.end());
    picture.alpha.push_back(1.0f - all.Left());
    picture.depth.push_back(std::min(all.depth, farDepth));
  });
  return picture;
}
}
