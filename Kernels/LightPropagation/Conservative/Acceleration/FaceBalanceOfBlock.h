#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Conservative/Acceleration/FaceBalance.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"
#include "Medium/Medium.h"

#include <array>
#include <optional>
#include <vector>

namespace tyndall
{
/// FaceBalance.h on a domain: each rank has the light of all cells of the box's faces on the host, and that of its own
/// voxels' cells on the device, where its diffusion system reads it. Made and called collectively.
class FaceBalanceOfBlock
{
public:
  /// @param device, faces, block  must stay
  FaceBalanceOfBlock(Device& device, FaceLight& faces, const BlockWithGhosts& block);

  FaceBalance& OfBox() { return *this->Box; }
  void TakeSwept(); ///< as FaceBalance, and writes Rows.
  /// As DiffusionSystem::Arrays has it, by cells of the faces of the block with ghosts; those of ghosts are dark.
  const Buffer<float>& Rows(int channel) const { return this->OfBlock[channel]; }
  /// From rows that the systems wrote.
  /// @param lit  channels that were solved for, the same on all
  void TakeLeaving(const std::vector<bool>& lit);
  /// As FaceBalance::LeftWithoutPattern.
  /// @param medium  of the block
  std::vector<double> LeftByCell(const std::array<Rgb, 6>& incoming, const Medium& medium) const;

private:
  /// A cell of the box's faces at a voxel of this rank, among those of the faces of its block with ghosts.
  struct Cell
  {
    std::size_t held, whole;
    std::size_t voxel; ///< of the block
  };

  const Domain& TheDomain;
  const FaceLight& Faces;
  std::optional<FaceBalance> Box;
  std::vector<Cell> Cells;
  std::size_t HeldCells;
  std::vector<Buffer<float>> OfBlock; ///< by channel
};
}
