#include "BlocksOfRanks.h"

#include "Ranks/ControllerCommunicator.h"
#include "Ranks/PieceBlocks.h"
#include "Viewing/Blocks/BlockOrder.h"
#include "Viewing/Scene/BlockOfScene.h"

#include "vtkImageData.h"
#include "vtkMultiProcessController.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int Tag = 745203; ///< of our messages
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
  const PieceBlocks pieces(*CommunicatorOf(ranks), nullptr, image);
  this->Tiled = pieces.MakeUpTheWhole();
  this->Parts = pieces.Partition();
  this->OfPieces = pieces.HeldByRanks();
  bool isFirst = true;                                                        // of those that have a block
  for (std::size_t rank = 0; rank < pieces.Partition().blocks.size(); ++rank) // of none where no rank has cells
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

/// Sends pixels to a rank, and receives as many as there is room for from it.
void BlocksOfRanks::Swap(int partner, const std::vector<BlockPixel>& mine, std::vector<BlockPixel>& theirs) const
{
  constexpr std::size_t floats = sizeof(BlockPixel) / sizeof(float);
  static_assert(floats == 17, "pixels are sent as floats");
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
