#pragma once

#include "Device/Buffer.h"
#include "Distribution/Domain.h"
#include "Distribution/GhostCells.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// A rank's block and its halo of one layer of ghost cells: what a balance of the block's voxels needs. Arrays are laid
/// out as VolumeLayout says, those of the block and those with ghosts each by its own grid. A serial domain has no
/// ghosts, not even round periodic axes.
class BlockWithGhosts
{
public:
  /// @param domain  must stay
  /// @param periodic  axes of the domain
  BlockWithGhosts(const Domain& domain, const std::array<bool, 3>& periodic, int channels, bool sharedExtinction);

  const Domain& TheDomain() const { return this->Of; }
  bool Has() const { return !this->Of.IsEmpty(); } ///< voxels
  bool HasGhosts() const { return this->Box.size != this->Of.Own().size; }
  /// In voxels of the whole grid, round periodic axes beyond its ends.
  const VoxelBox& Held() const { return this->Box; }
  /// Periodic axes that the block spans from end to end: along these it needs no ghosts, and arrays with ghosts are of
  /// a grid that is periodic.
  const std::array<bool, 3>& Periodic() const { return this->Alone; }
  const VolumeLayout& Own() const { return this->OfBlock; }
  const VolumeLayout& WithGhosts() const { return this->OfBox; }

  void FillGhosts(Buffer<float>& ofVoxels) const; ///< of one array without channels; collective

  std::size_t PlaceOf(std::size_t ownVoxel) const;          ///< of a voxel of the block, with ghosts
  bool IsOwn(const std::array<int, 3>& voxel) const;        ///< of the box with ghosts, from its first one
  std::size_t OwnAt(const std::array<int, 3>& voxel) const; ///< the same voxel in the block, which has it

private:
  friend class GhostedBuffer;
  /// `parts` arrays over the block as arrays with ghosts, which are `elsewhere`; and the other way.
  std::vector<float> Placed(const std::vector<float>& own, int parts, float elsewhere) const;
  std::vector<float> TakeOwn(const std::vector<float>& held, int parts) const;

  const Domain& Of;
  VoxelBox Box;
  std::array<bool, 3> Alone;
  VolumeLayout OfBlock, OfBox;
  std::unique_ptr<GhostCells> Ghosts;
};

/// Arrays over a rank's block as stencils read them: with ghost cells. Where the block has none they are the block's
/// own arrays, and nothing is copied. What is done with it is collective.
class GhostedBuffer
{
public:
  GhostedBuffer() = default;
  /// @param block, own  must stay
  /// @param parts  arrays of a stride each, the first of `own`
  GhostedBuffer(Device& device, const BlockWithGhosts& block, const Buffer<float>& own, int parts, const char* what);
  GhostedBuffer(Device& device, const BlockWithGhosts& block, Buffer<float>& own, int parts, const char* what)
    : GhostedBuffer(device, block, const_cast<const Buffer<float>&>(own), parts, what)
  {
    this->Target = &own;
  }

  const Buffer<float>& Values() const { return this->Held.Size() > 0 ? this->Held : *this->Own; }
  void Fill();                          ///< from the block's arrays and, in ghosts, from their owners'
  void FillOwn(float elsewhere = 0.0f); ///< from the block's arrays; ghosts become `elsewhere`
  void TakeOwn();                       ///< to the block's arrays, which must not be constant

private:
  const BlockWithGhosts* Block = nullptr;
  const Buffer<float>* Own = nullptr;
  Buffer<float>* Target = nullptr;
  int Parts = 0;
  Buffer<float> Held; ///< empty: there are no ghosts
};
}
