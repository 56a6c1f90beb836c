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
/// FaceBalance on a decomposed domain. Each rank holds the light of all cells of the box faces on the host, and the
/// light of the cells at its own voxels on the device, where its diffusion system reads it. Construct and call
/// collectively.
class FaceBalanceOfBlock
{
public:
  /// @param device, faces, block  must outlive this
  FaceBalanceOfBlock(Device& device, FaceLight& faces, const BlockWithGhosts& block);

  FaceBalance& OfBox() { return *this->Box; }
  void TakeSwept(); ///< as FaceBalance::TakeSwept; also writes Rows
  /// Rows in the layout of DiffusionSystem::Arrays, by cell of the faces of the block with ghost cells; 0 at ghost
  /// cells.
  const Buffer<float>& Rows(int channel) const { return this->OfBlock[channel]; }
  /// Reads the leaving power from the rows that the diffusion systems wrote.
  /// @param lit  channels that were solved, the same on all ranks
  void TakeLeaving(const std::vector<bool>& lit);
  /// As FaceBalance::LeftWithoutPattern.
  /// @param medium  of this rank's block
  std::vector<double> LeftByCell(const std::array<Rgb, 6>& incoming, const Medium& medium) const;

private:
  /// A cell of the box faces at a voxel of this rank: its index among the face cells of the block with ghost cells
  /// (held) and of the whole box (whole).
  struct Cell
  {
    std::size_t held, whole;
    std::size_t voxel; ///< index in the block
  };

  const Domain& TheDomain;
  const FaceLight& Faces;
  std::optional<FaceBalance> Box;
  std::vector<Cell> Cells;
  std::size_t HeldCells;
  std::vector<Buffer<float>> OfBlock; ///< by channel
};
}
