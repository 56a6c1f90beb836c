#include "BlocksOfRanks.h"

#include "Viewing/Blocks/BlockOrder.h"

#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkMultiProcessController.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
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

/// What a rank says of its block: own voxels, origin and spacing, all voxels.
constexpr std::size_t WordsOfBlock = 18;

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
    const Voxels all = VoxelsOf(image);
    std::copy(all.begin.begin(), all.begin.end(), words.begin() + 12);
    std::copy(all.end.begin(), all.end.end(), words.begin() + 15);
  }
  return words;
}

Voxels VoxelsIn(const double* words)
{
  Voxels voxels;
  std::transform(words, words + 3, voxels.begin.begin(), [](double word) { return static_cast<int>(word); });
  std::transform(words + 3, words + 6, voxels.end.begin(), [](double word) { return static_cast<int>(word); });
  return voxels;
}

std::array<int, 3> Less(const std::array<int, 3>& a, const std::array<int, 3>& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

/// The least box around both.
Voxels Around(const Voxels& a, const Voxels& b)
{
  Voxels around;
  for (int axis = 0; axis < 3; ++axis)
  {
    around.begin[axis] = std::min(a.begin[axis], b.begin[axis]);
    around.end[axis] = std::max(a.end[axis], b.end[axis]);
  }
  return around;
}

/// @param words  of one of its blocks
Grid GridOfVoxels(const Voxels& voxels, const double* words)
{
  Grid grid;
  grid.size = Less(voxels.end, voxels.begin);
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.spacing[axis] = words[9 + axis];
    grid.origin[axis] = words[6 + axis] + voxels.begin[axis] * grid.spacing[axis];
  }
  return grid;
}

/// Whether a block's arrays hold a layer around its own voxels, as far as there are any.
/// @param whole  all voxels of the grid
bool HasLayer(const double* words, const Voxels& whole)
{
  const Voxels own = VoxelsIn(words), all = VoxelsIn(words + 12);
  bool has = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    has &= all.begin[axis] <= std::max(own.begin[axis] - 1, whole.begin[axis]) &&
      all.end[axis] >= std::min(own.end[axis] + 1, whole.end[axis]);
  }
  return has;
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

bool OnAnyRank(vtkMultiProcessController* ranks, bool own)
{
  const std::vector<double> said = SaidByAll(ranks, { own ? 1.0 : 0.0 });
  return std::any_of(said.begin(), said.end(), [](double rank) { return rank > 0.0; });
}

BlocksOfRanks::BlocksOfRanks(vtkMultiProcessController* ranks, vtkImageData* image)
  : Ranks(ranks)
  , Rank(static_cast<std::size_t>(ranks->GetLocalProcessId()))
  , Blocks(static_cast<std::size_t>(ranks->GetNumberOfProcesses()))
{
  const std::vector<double> said = SaidByAll(ranks, Words(image));
  const double* first = nullptr; // of those that have a block
  bool alike = true;
  std::size_t voxels = 0;
  Voxels all;
  for (std::size_t rank = 0; rank < this->Blocks.size(); ++rank)
  {
    const double* const words = said.data() + WordsOfBlock * rank;
    GridBlock& block = this->Blocks[rank];
    const Voxels own = VoxelsIn(words);
    block.begin = own.begin;
    block.end = own.end;
    if (block.OwnVoxels() > 0)
    {
      block.showsBackgroundBeside = !first;
      all = first ? Around(all, own) : own;
      first = first ? first : words;
      alike &= OfOneGrid(first, words);
      voxels += block.OwnVoxels();
    }
  }
  this->Surrounded = true;
  for (std::size_t rank = 0; rank < this->Blocks.size(); ++rank)
  {
    this->Surrounded &= this->Blocks[rank].OwnVoxels() == 0 || HasLayer(said.data() + WordsOfBlock * rank, all);
  }
  const Grid whole = first ? GridOfVoxels(all, first) : Grid();
  for (GridBlock& block : this->Blocks)
  {
    block.whole = whole;
    block.begin = Less(block.begin, all.begin);
    block.end = Less(block.end, all.begin);
    block.first = block.begin;
  }
  if (this->HasOwn())
  {
    this->Blocks[this->Rank].first = Less(VoxelsOf(image).begin, all.begin);
  }
  this->Tiled = first && alike && voxels == whole.VoxelCount();
}

/// Sends pixels to a rank, and receives as many as there is room for from it.
void BlocksOfRanks::Swap(int partner, const std::vector<BlockPixel>& mine, std::vector<BlockPixel>& theirs) const
{
  constexpr std::size_t floats = sizeof(BlockPixel) / sizeof(float);
  static_assert(floats == 11, "pixels are sent as floats");
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

/// @param ranks  whose pixels these are
BlocksOfRanks::Seen BlocksOfRanks::InOrder(
  const std::vector<std::size_t>& ranks, std::vector<BlockPixels> pixels, const Camera& camera) const
{
  std::vector<GridBlock> blocks;
  for (std::size_t rank : ranks)
  {
    blocks.push_back(this->Blocks[rank]);
  }
  Seen seen;
  for (int number : FrontToBack(blocks, camera))
  {
    seen.own = ranks[number] == this->Rank ? seen.frontToBack.size() : seen.own;
    seen.frontToBack.push_back(std::move(pixels[number]));
  }
  return seen;
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
  return this->InOrder(from, std::move(pixels), camera);
}
}
