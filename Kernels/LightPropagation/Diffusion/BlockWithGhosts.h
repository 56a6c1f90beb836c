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
/// Geometry of a rank's block with a halo of one layer of ghost voxels, which the seven-point stencil of the diffusion
/// system needs. Arrays over the block have the layout Own(), arrays with ghosts the layout WithGhosts(). A serial
/// domain has no ghosts, not even on periodic axes.
class BlockWithGhosts
{
public:
  /// @param domain  must outlive this object
  /// @param periodic  which axes of the domain are periodic
  BlockWithGhosts(const Domain& domain, const std::array<bool, 3>& periodic, int channels, bool sharedExtinction);

  const Domain& TheDomain() const { return this->Of; }
  bool Has() const { return !this->Of.IsEmpty(); } ///< whether the block has any voxels
  bool HasGhosts() const { return this->Box.size != this->Of.Own().size; }
  /// The block with its ghosts, in voxels of the whole grid; on periodic axes it may extend beyond the grid's ends.
  const VoxelBox& Held() const { return this->Box; }
  /// Periodic axes that the block spans from end to end. Along these it needs no ghosts, and the grid of arrays with
  /// ghosts is periodic, too.
  const std::array<bool, 3>& Periodic() const { return this->Alone; }
  const VolumeLayout& Own() const { return this->OfBlock; }
  const VolumeLayout& WithGhosts() const { return this->OfBox; }

  /// Copies the values of ghost voxels from their owners, in one array with ghosts. Collective.
  void FillGhosts(Buffer<float>& ofVoxels) const;

  std::size_t PlaceOf(std::size_t ownVoxel) const; ///< index, in arrays with ghosts, of a voxel of the block
  /// Whether a voxel belongs to the block.
  /// @param voxel  indices relative to the first voxel of the box with ghosts
  bool IsOwn(const std::array<int, 3>& voxel) const;
  /// Index of a voxel of the block in arrays over the block (layout Own()).
  /// @param voxel  indices relative to the first voxel of the box with ghosts
  std::size_t OwnAt(const std::array<int, 3>& voxel) const;

private:
  friend class GhostedBuffer;
  /// Copies `parts` consecutive arrays over the block (`own`) to arrays with ghosts, and sets the ghost voxels to
  /// `elsewhere`. TakeOwn() is the inverse: it copies the block's values from arrays with ghosts.
  std::vector<float> Placed(const std::vector<float>& own, int parts, float elsewhere) const;
  std::vector<float> TakeOwn(const std::vector<float>& held, int parts) const;

  const Domain& Of;
  VoxelBox Box;
  std::array<bool, 3> Alone;
  VolumeLayout OfBlock, OfBox;
  std::unique_ptr<GhostCells> Ghosts;
};

/// Copy of arrays over a rank's block that includes the ghost voxels that stencils read. If the block has no ghosts,
/// Values() is the block's own buffer and nothing is copied. All operations are collective.
class GhostedBuffer
{
public:
  GhostedBuffer() = default;
  /// @param block, own  must outlive this object
  /// @param parts  number of arrays over the block that `own` holds one after another, at equal distances
  GhostedBuffer(Device& device, const BlockWithGhosts& block, const Buffer<float>& own, int parts, const char* what);
  GhostedBuffer(Device& device, const BlockWithGhosts& block, Buffer<float>& own, int parts, const char* what)
    : GhostedBuffer(device, block, const_cast<const Buffer<float>&>(own), parts, what)
  {
    this->Target = &own;
  }

  const Buffer<float>& Values() const { return this->Held.Size() > 0 ? this->Held : *this->Own; }
  void Fill();                          ///< copies the block's values, and the values of ghosts from their owners
  void FillOwn(float elsewhere = 0.0f); ///< copies the block's values, and sets ghost voxels to `elsewhere`
  void TakeOwn();                       ///< copies the block's values back to `own`, which must not be const

private:
  const BlockWithGhosts* Block = nullptr;
  const Buffer<float>* Own = nullptr;
  Buffer<float>* Target = nullptr;
  int Parts = 0;
  Buffer<float> Held; ///< the copy with ghosts; empty if the block has no ghosts
};
}
