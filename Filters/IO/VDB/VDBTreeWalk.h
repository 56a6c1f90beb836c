#pragma once

#include "IO/VDB/VDBValues.h"

#include <array>
#include <cstdint>
#include <functional>
#include <set>

namespace tyndall
{
class VDBBytes;

/// Index of a voxel; wide enough for any corner that a file can name.
using VoxelCorner = std::array<std::int64_t, 3>;

/// Voxels of a .vdb, inclusive, of any size. Not the kernels' VoxelBox, which is a part of a grid.
struct VDBBox
{
  VoxelCorner Min = { INT64_MAX, INT64_MAX, INT64_MAX };
  VoxelCorner Max = { INT64_MIN, INT64_MIN, INT64_MIN };

  bool Empty() const { return this->Min[0] > this->Max[0]; }
  void Add(const VDBBox& other);
};

/// What a tree's topology says, without voxel values.
struct VDBTopology
{
  VDBBox ActiveBox;
  std::uint64_t ActiveVoxels = 0; ///< tiles counted by the voxels they stand for; saturates
  std::uint64_t TreeBytes = 0;    ///< memory that the tree takes with all its leaves loaded

  /// A cube of active voxels of one value.
  void AddTile(const VoxelCorner& corner, std::int64_t edge);
};

/// One node's bits, x slowest, as OpenVDB's NodeMask.
template <int Log2Dim>
struct VDBMask
{
  static constexpr int Count = 1 << (3 * Log2Dim);
  std::array<std::uint64_t, Count / 64> Words = {};

  bool Has(int bit) const { return (this->Words[bit >> 6] >> (bit & 63)) & 1; }
  int CountOn() const
  {
    int on = 0;
    for (const std::uint64_t word : this->Words)
    {
      on += __builtin_popcountll(word);
    }
    return on;
  }
};

using VDBLeafMask = VDBMask<3>;

/// Walks a tree's topology as OpenVDB will read it: a root, and under it nodes of 4096, 128 and 8 voxels per edge.
class VDBTreeWalk
{
public:
  /// Called with each leaf's corner and mask of active voxels, in the order in which the leaves are stored.
  using OnLeaf = std::function<void(const VoxelCorner&, const VDBLeafMask&)>;

  /// @param topology  stands where the tree begins
  /// @param values    checks the values of the inner nodes
  VDBTreeWalk(VDBBytes& topology, const VDBValueType& type, VDBValues& values, OnLeaf onLeaf = {});

  /// To the tree's end.
  /// @throws InvalidInput where the topology is none
  VDBTopology Walk();

private:
  void ReadTile();
  VoxelCorner ReadRootCorner();
  template <int Log2Dim, int Edge>
  void WalkNode(const VoxelCorner& corner);
  void WalkLeaf(const VoxelCorner& corner);

  VDBBytes& Topology;
  const VDBValueType& Type;
  VDBValues& Values;
  OnLeaf Leaf;
  VDBTopology Found;
  std::set<VoxelCorner> RootCorners;
};
}
