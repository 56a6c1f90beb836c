#include "BlocksOfRanks.h"

#include "CasterProperties.h"
#include "Pieces/PieceBlocks.h"
#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/GridBlock.h"

#include "vtkImageData.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
std::vector<double> SaidByAll(Communicator& communicator, const std::vector<double>& own)
{
  std::vector<double> all(own.size() * static_cast<std::size_t>(communicator.Ranks()), 0.0);
  std::copy(own.begin(), own.end(), all.begin() + static_cast<std::ptrdiff_t>(own.size()) * communicator.Rank());
  return communicator.Sum(all);
}

namespace
{
/// Axes of the first rank that has a part of the image. Collective.
OwnAxes AxesOfFirst(Communicator& communicator, vtkImageData* image)
{
  std::vector<double> words = OwnAxesOf(image).Words();
  words.push_back(image && image->GetNumberOfPoints() > 0 ? 1.0 : 0.0);
  const std::vector<double> said = SaidByAll(communicator, words);
  for (auto rank = said.begin(); rank != said.end(); rank += static_cast<std::ptrdiff_t>(words.size()))
  {
    const std::vector<double> own(rank, rank + static_cast<std::ptrdiff_t>(words.size()));
    if (own.back() > 0.0)
    {
      return OwnAxes::From(own);
    }
  }
  return {};
}
}

BlocksOfRanks::BlocksOfRanks(Communicator& communicator, vtkImageData* image)
  : Comm(communicator)
  , Rank(static_cast<std::size_t>(communicator.Rank()))
  , Blocks(static_cast<std::size_t>(communicator.Ranks()))
  , AxesOfAll(AxesOfFirst(communicator, image))
{
  const PieceBlocks pieces(communicator, nullptr, image);
  this->Tiled = pieces.MakeUpTheWhole();
  this->Parts = pieces.Partition();
  this->OfPieces = pieces.HeldByRanks();
  bool isFirst = true;                                                        // first of the ranks with a block
  for (std::size_t rank = 0; rank < pieces.Partition().blocks.size(); ++rank) // no ranks are listed if none has cells
  {
    GridBlock& block = this->Blocks[rank];
    const VoxelBox& own = pieces.Partition().blocks[rank];
    const VoxelBox& held = pieces.HeldByRanks()[rank];
    block.whole = pieces.Partition().whole;
    block.first = held.first;
    block.begin = own.first;
    block.end = { EndOf(own, 0), EndOf(own, 1), EndOf(own, 2) };
    if (own.VoxelCount() > 0)
    {
      block.showsBackgroundBeside = isFirst;
      isFirst = false;
    }
  }
}

bool BlocksOfRanks::AreGiven(const std::vector<VoxelBox>& held) const
{
  return std::equal(held.begin(), held.end(), this->OfPieces.begin(), [](const VoxelBox& a, const VoxelBox& b) {
    return (a.VoxelCount() == 0 && b.VoxelCount() == 0) || (a.first == b.first && a.size == b.size);
  });
}

std::vector<VoxelBox> BlocksOfRanks::HeldFor(const ViewSettings& settings, bool moments, bool surface) const
{
  std::vector<VoxelBox> needed;
  bool enough = true;
  for (std::size_t rank = 0; rank < this->OfPieces.size(); ++rank)
  {
    const VoxelBox& own = this->Parts.blocks[rank];
    needed.push_back(own.VoxelCount() > 0 ? HeldBox(own, this->Parts.whole, settings, moments, surface) : VoxelBox());
    enough = enough && Common(needed[rank], this->OfPieces[rank]).VoxelCount() == needed[rank].VoxelCount();
  }
  return enough ? this->OfPieces : needed;
}

/// Sorts blocks front to back.
/// @param ranks  the rank of each element of `pixels`
BlocksOfRanks::Seen BlocksOfRanks::InOrder(
  const std::vector<std::size_t>& ranks, std::vector<BlockPixels> pixels, const Camera& camera) const
{
  std::vector<GridBlock> blocks;
  for (std::size_t rank : ranks)
  {
    blocks.push_back(this->Blocks[rank]);
  }
  Seen seen;
  for (int number : FrontToBack(blocks, InOwnAxes(camera, this->AxesOfAll)))
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
  const std::vector<double> said = SaidByAll(this->Comm,
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

  std::vector<int> partners;
  for (std::size_t rank = 0; rank < this->Blocks.size(); ++rank)
  {
    const bool gets = !Overlap(own.rect, rectOf(rank, 5)).IsEmpty();
    const bool gives = !Overlap(wanted, rectOf(rank, 1)).IsEmpty();
    if (rank != this->Rank && (gets || gives))
    {
      partners.push_back(static_cast<int>(rank));
    }
  }
  auto arrived = this->Comm.Exchange<BlockPixel>(partners, [&] {
    std::vector<std::vector<BlockPixel>> parcels;
    for (const int partner : partners)
    {
      parcels.push_back(PartIn(rectOf(static_cast<std::size_t>(partner), 5), own).pixels);
    }
    return parcels;
  });

  std::vector<std::size_t> from;
  std::vector<BlockPixels> pixels;
  if (this->HasOwn())
  {
    from.push_back(this->Rank);
    pixels.push_back(own);
  }
  for (std::size_t i = 0; i < partners.size(); ++i)
  {
    if (!arrived[i].empty())
    {
      from.push_back(static_cast<std::size_t>(partners[i]));
      pixels.push_back({ Overlap(wanted, rectOf(from.back(), 1)), std::move(arrived[i]) });
    }
  }
  return this->InOrder(from, std::move(pixels), camera);
}
}
