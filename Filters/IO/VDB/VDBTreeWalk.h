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

/// Storage of a grid type's values in a file and in an image.
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
  } Leaves; ///< what a leaf stores besides its mask

  bool IsReal() const { return this->HalfSize < this->Size; }
  std::string GridType() const { return std::string("Tree_") + this->Name + "_5_4_3"; } ///< OpenVDB's name of it
};

/// Finds a type that can become an image: float, double, int32, int64, bool, mask, vec3i, vec3s, vec3d. Else null.
const VDBValueType* FindValueType(const std::string& name);

/// Checks the stored values of a grid's nodes without keeping them.
class VDBValues
{
public:
  /// @param half         whether real numbers are stored in 16 bits
  /// @param compression  OpenVDB's flags
  VDBValues(const VDBValueType& type, bool half, std::uint32_t compression);

  /// Checks the values of one node: a flag, up to two inactive values and the mask that selects between them, then a
  /// block of numbers.
  /// @param active      number of active values
  /// @param all         number of values of the node
  /// @param decompress  whether to decompress the block as a test: OpenVDB leaks an inner node whose values do not
  ///   decompress
  /// @throws InvalidInput if the block does not match the node: OpenVDB would write beyond the node
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

/// Index of a voxel; 64 bits hold any corner that a file can specify.
using VoxelCorner = std::array<std::int64_t, 3>;

/// A box of voxels, inclusive, of any size. Not the kernels' VoxelBox, which is part of a grid.
struct VDBBox
{
  VoxelCorner Min = { INT64_MAX, INT64_MAX, INT64_MAX };
  VoxelCorner Max = { INT64_MIN, INT64_MIN, INT64_MIN };

  bool Empty() const { return this->Min[0] > this->Max[0]; }
  void Add(const VDBBox& other);
};

/// Statistics of a tree's topology, without voxel values.
struct VDBTopology
{
  VDBBox ActiveBox;
  std::uint64_t ActiveVoxels = 0; ///< a tile counts as the voxels that it covers; saturates
  std::uint64_t TreeBytes = 0;    ///< memory of the tree with all its leaves loaded

  /// Adds a cube of active voxels that share one value.
  void AddTile(const VoxelCorner& corner, std::int64_t edge);
};

/// The bit mask of one node, x slowest, as OpenVDB's NodeMask.
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

/// Walks a tree's topology in OpenVDB's order: a root, then nodes of 4096, 128 and 8 voxels per edge.
class VDBTreeWalk
{
public:
  /// Called with the corner and the active mask of each leaf, in the order in which leaves are stored.
  using OnLeaf = std::function<void(const VoxelCorner&, const VDBLeafMask&)>;

  /// @param topology  positioned at the start of the tree
  /// @param values    checks the values of inner nodes
  VDBTreeWalk(VDBBytes& topology, const VDBValueType& type, VDBValues& values, OnLeaf onLeaf = {});

  /// Walks to the end of the tree.
  /// @throws InvalidInput if the topology is invalid
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
