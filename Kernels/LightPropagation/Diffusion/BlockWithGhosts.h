#pragma once

#include "Device/Buffer.h"
#include "Distribution/Domain.h"
#include "Distribution/Halo.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// A rank's block and its halo of one layer of ghost cells, as the stencil of the block's voxels needs it. Arrays over
/// the block, and arrays with ghosts, are each laid out by a VolumeLayout of their own grid. A serial domain has no
/// ghosts, not even on periodic axes.
class BlockWithGhosts
{
public:
  /// @param domain  must outlive this object
  /// @param periodic  which axes of the domain are periodic
  BlockWithGhosts(const Domain& domain, const std::array<bool, 3>& periodic, int channels, bool sharedExtinction);

  const Domain& TheDomain() const { return this->Of; }
  bool Has() const { return !this->Of.IsEmpty(); } ///< whether it has any voxels
  bool HasGhosts() const { return this->Box.size != this->Of.Own().size; }
  /// The block with its ghosts, in voxels of the whole grid; on periodic axes it may extend beyond the grid's ends.
  const VoxelBox& Held() const { return this->Box; }
  /// Periodic axes that the block spans from end to end. Along these it needs no ghosts, and the grid of arrays with
  /// ghosts is periodic, too.
  const std::array<bool, 3>& Periodic() const { return this->Alone; }
  const VolumeLayout& Own() const { return this->OfBlock; }
  const VolumeLayout& WithGhosts() const { return this->OfBox; }

  void FillGhosts(
    Buffer<float>& ofVoxels) const; ///< fetches them from their owners, for one array without channels; collective

  std::size_t PlaceOf(std::size_t ownVoxel) const; ///< index in arrays with ghosts of a voxel of the block
  /// Whether a voxel, counted from the first one of the box with ghosts, belongs to the block.
  bool IsOwn(const std::array<int, 3>& voxel) const;
  /// Index in the block of a voxel, counted likewise, that belongs to it.
  std::size_t OwnAt(const std::array<int, 3>& voxel) const;

private:
  friend class GhostedBuffer;
  /// Copies `parts` arrays over the block to arrays with ghosts, whose ghosts are set to `elsewhere`; TakeOwn() copies
  /// back.
  std::vector<float> Placed(const std::vector<float>& own, int parts, float elsewhere) const;
  std::vector<float> TakeOwn(const std::vector<float>& held, int parts) const;

  const Domain& Of;
  VoxelBox Box;
  std::array<bool, 3> Alone;
  VolumeLayout OfBlock, OfBox;
  std::unique_ptr<GhostCells> Ghosts;
};

/// Arrays over a rank's block with the ghost cells that stencils read. If the block has no ghosts these are the block's
/// own arrays and nothing is copied. All operations are collective.
class GhostedBuffer
{
public:
  GhostedBuffer() = default;
  /// @param block, own  must outlive this object
  /// @param parts  number of arrays of one stride each; `own` is the first
  GhostedBuffer(Device& device, const BlockWithGhosts& block, const Buffer<float>& own, int parts, const char* what);
  GhostedBuffer(Device& device, const BlockWithGhosts& block, Buffer<float>& own, int parts, const char* what)
    : GhostedBuffer(device, block, const_cast<const Buffer<float>&>(own), parts, what)
  {
    this->Target = &own;
  }

  const Buffer<float>& Values() const { return this->Held.Size() > 0 ? this->Held : *this->Own; }
  void Fill();                          ///< copies the block's arrays, and fetches ghosts from their owners
  void FillOwn(float elsewhere = 0.0f); ///< copies the block's arrays; ghosts become `elsewhere`
  void TakeOwn();                       ///< copies back to the block's arrays, which must not be constant

private:
  const BlockWithGhosts* Block = nullptr;
  const Buffer<float>* Own = nullptr;
  Buffer<float>* Target = nullptr;
  int Parts = 0;
  Buffer<float> Held; ///< empty: there are no ghosts
};
}
