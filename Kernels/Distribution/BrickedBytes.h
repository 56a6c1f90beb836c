#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// One byte per voxel of a grid, stored in bricks of 8^3 voxels. A uniform brick needs 4 bytes, any other brick 516.
/// Meant for data that are piecewise constant, such as octree levels, so that every rank can store the data of the
/// whole grid.
class BrickedBytes
{
public:
  static constexpr int Edge = 8;
  static constexpr std::size_t Voxels = Edge * Edge * Edge;

  explicit BrickedBytes(const std::array<int, 3>& size);

  /// Stores the bytes of the voxels of `part`. Each voxel must be stored once; the order of boxes does not matter.
  /// @param numbers  one byte per voxel of `box`, which contains `part`, x fastest
  void Put(const VoxelBox& part, const VoxelBox& box, const std::vector<std::uint8_t>& numbers);

  std::uint8_t At(const std::array<int, 3>& voxel) const
  {
    const std::int32_t brick = this->Bricks[this->BrickOf(voxel)];
    return static_cast<std::uint8_t>(brick >= 0 ? brick : this->Uneven[Begin(brick) + Within(voxel)]);
  }

  /// One entry per brick, x fastest. A uniform brick has its byte as entry. Any other brick has -1 - n, where n is the
  /// index of the brick in Dense().
  const std::vector<std::int32_t>& Table() const { return this->Bricks; }
  /// Bytes of the bricks that are not uniform, one per voxel, x fastest within a brick.
  const std::vector<std::uint8_t>& Dense() const { return this->Uneven; }

private:
  static std::size_t Begin(std::int32_t brick) { return static_cast<std::size_t>(-1 - brick) * Voxels; }
  static std::size_t Within(const std::array<int, 3>& voxel)
  {
    return static_cast<std::size_t>(((voxel[2] % Edge) * Edge + voxel[1] % Edge) * Edge + voxel[0] % Edge);
  }
  std::size_t BrickOf(const std::array<int, 3>& voxel) const
  {
    const auto at = [&](int axis) { return static_cast<std::size_t>(voxel[axis] / Edge); };
    return (at(2) * this->Count[1] + at(1)) * this->Count[0] + at(0);
  }
  void PutInBrick(const VoxelBox& part, const VoxelBox& box, const std::vector<std::uint8_t>& numbers);

  std::array<std::size_t, 3> Count; ///< number of bricks along each axis
  std::vector<std::int32_t> Bricks;
  std::vector<std::uint8_t> Uneven;
};

/// Gathers, on each rank, the bytes of the voxels in a box that may reach into other ranks' blocks. Voxels outside the
/// box have no byte. Messages are run-length encoded. Collective.
/// @param own  bytes of this rank's block, x fastest
/// @param wanted  by rank, the box whose bytes the rank needs, within the grid; may be empty
BrickedBytes BytesOfBoxes(Communicator& communicator, const BlockPartition& partition,
  const std::vector<std::uint8_t>& own, const std::vector<VoxelBox>& wanted);

/// Gathers the bytes of all voxels of the grid on every rank. Collective.
/// @param own  bytes of this rank's block, x fastest
BrickedBytes BytesOfAll(
  Communicator& communicator, const BlockPartition& partition, const std::vector<std::uint8_t>& own);
}
