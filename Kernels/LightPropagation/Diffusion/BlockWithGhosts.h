#pragma once

#include "Device/Buffer.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/GhostCells.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// A rank's block and the layer of voxels beside it, which others have: what a balance of the block's voxels needs.
/// Arrays are laid out as VolumeLayout says, those of the block and those with ghosts each by its own grid.
class BlockWithGhosts
{
public:
  /// All ranks make one together.
  /// @param communicator  must stay
  /// @param periodic  axes whose two ends touch
  BlockWithGhosts(Communicator& communicator, const BlockPartition& partition, const std::array<bool, 3>& periodic,
    int channels, bool sharedExtinction);

  bool Has() const { return this->OfBlock.grid.VoxelCount() > 0; } ///< voxels
  /// In voxels of the whole grid, round periodic axes beyond its ends.
  const VoxelBox& Held() const { return this->Box; }
  /// Periodic axes that the block has from end to end: only there nothing of others is needed, and arrays with ghosts
  /// are of a grid that is periodic.
  const std::array<bool, 3>& Periodic() const { return this->Alone; }
  const VolumeLayout& Own() const { return this->OfBlock; }
  const VolumeLayout& WithGhosts() const { return this->OfBox; }

  /// Puts arrays over the block, `parts` of them, into those with ghosts, which become `elsewhere`.
  void Spread(const std::vector<float>& own, int parts, Buffer<float>& held, float elsewhere = 0.0f) const;
  /// The same, with what the others have there. All ranks call these.
  void SpreadWithGhosts(const std::vector<float>& own, int parts, Buffer<float>& held) const;
  void FillGhosts(Buffer<float>& ofVoxels) const; ///< of one array without channels
  /// Of arrays with ghosts what is over the block.
  std::vector<float> TakeOwn(const Buffer<float>& held, int parts) const;

  std::size_t PlaceOf(std::size_t ownVoxel) const;          ///< of a voxel of the block, with ghosts
  bool IsOwn(const std::array<int, 3>& voxel) const;        ///< of the box with ghosts, from its first one
  std::size_t OwnAt(const std::array<int, 3>& voxel) const; ///< the same voxel in the block, which has it

private:
  std::vector<float> Placed(const std::vector<float>& own, int parts, float elsewhere) const;

  Communicator& Comm;
  VoxelBox Block, Box;
  std::array<bool, 3> Alone;
  VolumeLayout OfBlock, OfBox;
  std::unique_ptr<GhostCells> Ghosts;
};
}
