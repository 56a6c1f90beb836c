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
/// Gathers numbers from all ranks, in the order of ranks (allgather). Collective, with the same count of numbers on all
/// ranks.
/// @throws InvalidInput on all ranks, if the counts differ
std::vector<double> SaidByAll(Communicator& communicator, const std::vector<double>& own);

/// An image that is distributed over ranks. Each rank has a block of its voxels, and may have ghost cells, flagged as
/// duplicates. Constructor and Exchange are collective, also for ranks without a block.
class BlocksOfRanks
{
public:
  /// Pixels of the blocks that are in view.
  struct Seen
  {
    std::vector<BlockPixels> frontToBack;
    std::size_t own = 0; ///< index of this rank's block, if it has one
  };

  /// @param communicator  must outlive this object
  /// @param image  this rank's piece; null or without cells if it has no block
  BlocksOfRanks(Communicator& communicator, vtkImageData* image);

  /// Whether the blocks tile one grid: each of its voxels is in exactly one block. The same on all ranks.
  bool MakeUpTheWhole() const { return this->Tiled; }
  bool HasOwn() const { return this->Blocks[this->Rank].OwnVoxels() > 0; }
  const GridBlock& Own() const { return this->Blocks[this->Rank]; }
  const Grid& Whole() const { return this->Own().whole; } ///< only if MakeUpTheWhole; in Axes
  const OwnAxes& Axes() const { return this->AxesOfAll; }

  // Only if MakeUpTheWhole; in voxels of the whole grid.
  const BlockPartition& Partition() const { return this->Parts; }
  /// Voxels of each rank's input image, by rank: block and ghost cells.
  const std::vector<VoxelBox>& Given() const { return this->OfPieces; }
  /// Whether `held` equals Given.
  bool AreGiven(const std::vector<VoxelBox>& held) const;
  /// Voxels that each rank needs to render its block (HeldBox), by rank; Given, if that is enough on all ranks.
  std::vector<VoxelBox> HeldFor(const ViewSettings& settings, bool moments, bool surface) const;

  /// Exchanges pixels: this rank receives the other blocks' pixels within `wanted`. Each rank sends to each only the
  /// pixels that it wants. Collective.
  /// @param own     this block's pixels; empty if it is out of view, or this rank has no block
  /// @param wanted  the pixels that this rank needs
  /// @param failed  this rank failed to render its block
  /// @param camera  in the scene's coordinates
  /// @return nothing, on all ranks, if one of them failed
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
