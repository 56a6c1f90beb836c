#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// A number from 0 to 255 for each voxel of a grid, kept in bricks of 8^3 voxels: a brick of one number takes four
/// bytes, another one 516. For what is even but for some surfaces, as an octree's levels, so that a rank may have that
/// of all of a grid, of which it has a block.
class BrickedBytes
{
public:
  static constexpr int Edge = 8;
  static constexpr std::size_t Voxels = Edge * Edge * Edge;

  explicit BrickedBytes(const std::array<int, 3>& size);

  /// Numbers of a box, x fastest. Each voxel is to be in one box that is put in, in any order.
  void Put(const VoxelBox& box, const std::vector<std::uint8_t>& numbers);

  std::uint8_t At(const std::array<int, 3>& voxel) const
  {
    const std::int32_t brick = this->Bricks[this->BrickOf(voxel)];
    return static_cast<std::uint8_t>(brick >= 0 ? brick : this->Uneven[Begin(brick) + Within(voxel)]);
  }

  /// Of each brick, x fastest, its number; or, less than 0: -1 less than that of its part of Dense().
  const std::vector<std::int32_t>& Table() const { return this->Bricks; }
  /// Numbers of bricks that have several, Voxels each, x fastest.
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

  std::array<std::size_t, 3> Count; ///< of bricks
  std::vector<std::int32_t> Bricks;
  std::vector<std::uint8_t> Uneven;
};

/// Numbers of the voxels of a box that each rank wants, which may reach into the blocks of others, in a table of all of
/// the grid; outside nothing is put in. Runs of one number are sent as one. All ranks call it.
/// @param own  of this rank's block, x fastest
/// @param wanted  by rank, within the grid; of no voxels where a rank wants none
BrickedBytes BytesOfBoxes(Communicator& communicator, const BlockPartition& partition,
  const std::vector<std::uint8_t>& own, const std::vector<VoxelBox>& wanted);

/// The same of all voxels, on each rank.
BrickedBytes BytesOfAll(
  Communicator& communicator, const BlockPartition& partition, const std::vector<std::uint8_t>& own);
}
