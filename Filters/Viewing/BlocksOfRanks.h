#pragma once

#include "Common/ImageInput.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Viewing/Blocks/BlockPixels.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/GridBlock.h"
#include "Viewing/Scene/ViewSettings.h"

#include <cstddef>
#include <optional>
#include <vector>

class vtkImageData;

namespace tyndall
{
/// What every rank says, one after the other. All ranks have to call it, with as many numbers.
/// @throws InvalidInput  on all ranks, where one says more than another
std::vector<double> SaidByAll(Communicator& communicator, const std::vector<double>& own);

/// An image that is spread over ranks, each of which has a block of its voxels, and may have some of its neighbours',
/// flagged as duplicates. All ranks have to construct it and to call Exchange, also those that have no block.
class BlocksOfRanks
{
public:
  /// What is seen of blocks.
  struct Seen
  {
    std::vector<BlockPixels> frontToBack;
    std::size_t own = 0; ///< which of them is this rank's, where it has one
  };

  /// @param communicator  must stay
  /// @param image  null or without cells: this rank has no block
  BlocksOfRanks(Communicator& communicator, vtkImageData* image);

  /// Whether the blocks are parts of one grid, and together each of its voxels once: the same on all ranks.
  bool MakeUpTheWhole() const { return this->Tiled; }
  bool HasOwn() const { return this->Blocks[this->Rank].OwnVoxels() > 0; }
  const GridBlock& Own() const { return this->Blocks[this->Rank]; }
  const Grid& Whole() const { return this->Own().whole; } ///< where MakeUpTheWhole, in its axes
  const OwnAxes& Axes() const { return this->AxesOfAll; }

  // Where MakeUpTheWhole, in voxels of the whole.
  const BlockPartition& Partition() const { return this->Parts; }
  /// What ranks have been given, by rank: their blocks are in these.
  const std::vector<VoxelBox>& Given() const { return this->OfPieces; }
  /// What ranks need to see their blocks (HeldBox): what they have been given, where that is enough for all.
  bool AreGiven(const std::vector<VoxelBox>& held) const;
  std::vector<VoxelBox> HeldFor(const ViewSettings& settings, bool moments, bool surface) const;

  /// What other blocks show where this rank wants it: each rank sends to each only what that one wants of it.
  /// @param own     this block's pixels; none where it is not seen, or there is none
  /// @param wanted  pixels
  /// @param failed  this rank has no picture, though it should
  /// @param camera  in the scene
  /// @return nothing, on all ranks, where one of them failed
  std::optional<Seen> Exchange(
    const BlockPixels& own, const PixelRect& wanted, bool failed, const Camera& camera) const;

private:
  Seen InOrder(const std::vector<std::size_t>& ranks, std::vector<BlockPixels> pixels, const Camera& camera) const;

  Communicator& Comm;
  std::size_t Rank;
  std::vector<GridBlock> Blocks; ///< by rank
  BlockPartition Parts;
  std::vector<VoxelBox> OfPieces;
  OwnAxes AxesOfAll;
  bool Tiled = false;
};
}
