#include "BlocksOfRanks.h"

#include "Viewing/Blocks/BlockOrder.h"

#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkMultiProcessController.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int Tag = 745203; ///< of our messages

/// Voxels from begin on, before end, of the image's index space.
struct Voxels
{
  std::array<int, 3> begin = {}, end = {};
};

Voxels VoxelsOf(vtkImageData* image)
{
  const int* const extent = image->GetExtent();
  return { { extent[0], extent[2], extent[4] }, { extent[1], extent[3], extent[5] } };
}

/// Without those that are flagged as duplicates.
Voxels OwnVoxelsOf(vtkImageData* image)
{
  const Voxels all = VoxelsOf(image);
  vtkUnsignedCharArray* const ghosts = image->GetCellGhostArray();
  if (!ghosts)
  {
    return all;
  }
  Voxels own = { all.end, all.begin };
  vtkIdType cell = 0;
  for (int k = all.begin[2]; k < all.end[2]; ++k)
  {
    for (int j = all.begin[1]; j < all.end[1]; ++j)
    {
      for (int i = all.begin[0]; i < all.end[0]; ++i, ++cell)
      {
        const std::array<int, 3> at = { i, j, k };
        for (int axis = 0; axis < 3 && !(ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL); ++axis)
        {
          own.begin[axis] = std::min(own.begin[axis], at[axis]);
          own.end[axis] = std::max(own.end[axis], at[axis] + 1);
        }
      }
    }
  }
  return own.begin[0] < own.end[0] ? own : Voxels();
}

/// What a rank says of its block: own voxels, origin and spacing.
constexpr std::size_t WordsOfBlock = 12;

std::vector<double> Words(vtkImageData* image)
{
  std::vector<double> words(WordsOfBlock, 0.0);
  if (image && image->GetNumberOfCells() > 0)
  {
    const Voxels own = OwnVoxelsOf(image);
    std::copy(own.begin.begin(), own.begin.end(), words.begin());
    std::copy(own.end.begin(), own.end.end(), words.begin() + 3);
    std::copy_n(image->GetOrigin(), 3, words.begin() + 6);
    std::copy_n(image->GetSpacing(), 3, words.begin() + 9);
  }
  return words;
}

/// To rounding.
bool OfOneGrid(const double* a, const double* b)
{
  bool same = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double spacing = a[9 + axis];
    same &= std::abs(a[9 + axis] - b[9 + axis]) <= 1e-6 * spacing &&
      std::abs(a[6 + axis] - b[6 + axis]) <= 1e-6 * (spacing + std::abs(a[6 + axis]));
  }
  return same;
}
}

std::vector<double> SaidByAll(vtkMultiProcessController* ranks, const std::vector<double>& own)
{
  std::vector<double> all(own.size() * ranks->GetNumberOfProcesses());
  ranks->AllGather(own.data(), all.data(), static_cast<vtkIdType>(own.size()));
  return all;
}

BlocksOfRanks::BlocksOfRanks(vtkMultiProcessController* ranks, vtkImageData* image)
  : Ranks(ranks)
  , Rank(static_cast<std::size_t>(ranks->GetLocalProcessId()))
  , Blocks(static_cast<std::size_t>(ranks->GetNumberOfProcesses()))
{
  const std::vector<double> said = SaidByAll(ranks, Words(image));
  const double* one = nullptr; // of those that have a block
  bool alike = true;
  std::array<int, 3> least = {}, largest = {};
  for (std::size_t rank = 0; rank < this->Blocks.size(); ++rank)
  {
    GridBlock& block = this->Blocks[rank];
    const double* const words = said.data() + WordsOfBlock * rank;
    for (int axis = 0; axis < 3; ++axis)
    {
      block.begin[axis] = static_cast<int>(words[axis]);
      block.end[axis] = static_cast<int>(words[3 + axis]);
    }
    if (block.OwnVoxels() == 0)
    {
      continue;
    }
    alike &= !one || OfOneGrid(one, words);
    for (int axis = 0; axis < 3; ++axis)
    {
      least[axis] = one ? std::min(least[axis], block.begin[axis]) : block.begin[axis];
      largest[axis] = one ? std::max(largest[axis], block.end[axis]) : block.end[axis];
    }
    block.showsBackgroundBeside = !one;
    one = one ? one : words;
  }
  Grid whole;
  std::size_t voxels = 0;
  for (int axis = 0; axis < 3 && one; ++axis)
  {
    whole.size[axis] = largest[axis] - least[axis];
    whole.spacing[axis] = one[9 + axis];
    whole.origin[axis] = one[6 + axis] + least[axis] * one[9 + axis];
  }
  for (GridBlock& block : this->Blocks)
  {
    voxels += block.OwnVoxels();
    block.whole = whole;
    for (int axis = 0; axis < 3 && block.OwnVoxels() > 0; ++axis)
    {
      block.begin[axis] -= least[axis];
      block.end[axis] -= least[axis];
      block.first[axis] = block.begin[axis];
    }
  }
  if (this->HasOwn())
  {
    const Voxels all = VoxelsOf(image);
    std::transform(
      all.begin.begin(), all.begin.end(), least.begin(), this->Blocks[this->Rank].first.begin(), std::minus<int>());
  }
  this->Tiled = one && alike && voxels == whole.VoxelCount();
}

/// Sends pixels to a rank, and receives as many as there is room for from it.
void BlocksOfRanks::Swap(int partner, const std::vector<BlockPixel>& mine, std::vector<BlockPixel>& theirs) const
{
  constexpr std::size_t floats = sizeof(BlockPixel) / sizeof(float);
  static_assert(floats == 9, "pixels are sent as floats");
  const auto send = [&] {
    if (!mine.empty())
    {
      this->Ranks->Send(
        reinterpret_cast<const float*>(mine.data()), static_cast<vtkIdType>(floats * mine.size()), partner, Tag);
    }
  };
  const bool first = static_cast<int>(this->Rank) < partner; // else both would wait
  if (first)
  {
    send();
  }
  if (!theirs.empty())
  {
    this->Ranks->Receive(
      reinterpret_cast<float*>(theirs.data()), static_cast<vtkIdType>(floats * theirs.size()), partner, Tag);
  }
  if (!first)
  {
    send();
  }
}

std::optional<BlocksOfRanks::Seen> BlocksOfRanks::Exchange(
  const BlockPixels& own, const PixelRect& wanted, bool failed, const Camera& camera) const
{
  constexpr std::size_t words = 9;
  const std::vector<double> said = SaidByAll(this->Ranks,
    { failed ? 1.0 : 0.0, 1.0 * own.rect.begin[0], 1.0 * own.rect.begin[1], 1.0 * own.rect.end[0],
      1.0 * own.rect.end[1], 1.0 * wanted.begin[0], 1.0 * wanted.begin[1], 1.0 * wanted.end[0], 1.0 * wanted.end[1] });
  const auto rectOf = [&](std::size_t rank, std::size_t from) {
    const double* const at = said.data() + words * rank + from;
    return PixelRect{ { static_cast<int>(at[0]), static_cast<int>(at[1]) },
      { static_cast<int>(at[2]), static_cast<int>(at[3]) } };
  };
  for (std::size_t rank = 0; rank < this->Blocks.size(); ++rank)
  {
    if (said[words * rank] > 0.0)
    {
      return std::nullopt;
    }
  }

  // In rounds in which each rank has one partner at most.
  std::vector<std::size_t> from;
  std::vector<BlockPixels> pixels;
  if (this->HasOwn())
  {
    from.push_back(this->Rank);
    pixels.push_back(own);
  }
  std::size_t rounds = 1;
  for (; rounds < this->Blocks.size(); rounds *= 2)
  {
  }
  for (std::size_t round = 1; round < rounds; ++round)
  {
    const std::size_t partner = this->Rank ^ round;
    if (partner >= this->Blocks.size())
    {
      continue;
    }
    BlockPixels theirs;
    theirs.rect = Overlap(wanted, rectOf(partner, 1));
    theirs.pixels.resize(theirs.rect.Count());
    this->Swap(static_cast<int>(partner), PartIn(rectOf(partner, 5), own).pixels, theirs.pixels);
    if (!theirs.rect.IsEmpty())
    {
      from.push_back(partner);
      pixels.push_back(std::move(theirs));
    }
  }
  std::vector<GridBlock> blocks;
  for (std::size_t rank : from)
  {
    blocks.push_back(this->Blocks[rank]);
  }
  Seen seen;
  for (int number : FrontToBack(blocks, camera))
  {
    seen.own = from[number] == this->Rank ? seen.frontToBack.size() : seen.own;
    seen.frontToBack.push_back(std::move(pixels[number]));
  }
  return seen;
}
}
