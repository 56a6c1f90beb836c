#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace tyndall
{
class VDBBytes;

/// How the values of a type of grid lie in a file, and in an image.
struct VDBValueType
{
  const char* Name;
  std::uint64_t Size;     ///< bytes of a value
  std::uint64_t HalfSize; ///< bytes of a value whose numbers are stored in 16 bits
  enum
  {
    Numbers,
    Bool,
    Mask
  } Leaves; ///< what a leaf holds beside its mask

  bool IsReal() const { return this->HalfSize < this->Size; }
  std::string GridType() const { return std::string("Tree_") + this->Name + "_5_4_3"; } ///< OpenVDB's name of it
};

/// The types that become images: float, double, int32, int64, bool, mask, vec3i, vec3s, vec3d; else null.
const VDBValueType* FindValueType(const std::string& name);

/// Checks the values of a grid's nodes as they lie in its file, without keeping them.
class VDBValues
{
public:
  /// @param half         whether real numbers are stored in 16 bits
  /// @param compression  OpenVDB's flags
  VDBValues(const VDBValueType& type, bool half, std::uint32_t compression);

  /// The values of one node: a flag, up to two inactive values and the mask that selects them, then a block of numbers.
  /// @param active      values that are active
  /// @param all         values of the node
  /// @param decompress  whether to try the block: OpenVDB leaks an inner node whose values do not decompress
  /// @throws InvalidInput where the block is not what the node takes: OpenVDB would write beyond the node
  void Check(VDBBytes& bytes, std::uint64_t active, std::uint64_t all, bool decompress);

private:
  void CheckBlock(VDBBytes& bytes, std::uint64_t count, bool decompress);
  void Decompress(VDBBytes& bytes, std::uint64_t compressed, std::uint64_t expected);

  VDBValueType Type;
  bool Half;
  std::uint32_t Compression;
  std::vector<char> Scratch;
};

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
