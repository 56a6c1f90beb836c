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

/// A type of voxel values: its storage in a file and in an image.
struct VDBValueType
{
  const char* Name;
  std::uint64_t Size;     ///< size of a value, bytes
  std::uint64_t HalfSize; ///< size of a value whose numbers are stored in 16 bits, bytes
  enum
  {
    Numbers,
    Bool,
    Mask
  } Leaves; ///< data of a leaf in addition to its active mask: numbers, bits of bools, or none

  bool IsReal() const { return this->HalfSize < this->Size; }
  /// OpenVDB's name of the grid type.
  std::string GridType() const { return std::string("Tree_") + this->Name + "_5_4_3"; }
};

/// Finds the type of values with this name, if such grids can become images: float, double, int32, int64, bool, mask,
/// vec3i, vec3s, vec3d. Null for other names.
const VDBValueType* FindValueType(const std::string& name);

/// Checks the stored values of a tree's nodes without keeping them.
class VDBValues
{
public:
  /// Prepares the check of values of a type, as they are stored in a file.
  /// @param half         whether real numbers are stored in 16 bits
  /// @param compression  OpenVDB's compression flags
  VDBValues(const VDBValueType& type, bool half, std::uint32_t compression);

  /// Checks the values of one node, which are stored as a flag, up to two inactive values, the mask that selects
  /// between these, and a block of numbers.
  /// @param active      number of active values
  /// @param all         number of values of the node
  /// @param decompress  whether to decompress the block as a test; needed for inner nodes, because OpenVDB leaks an
  ///   inner node whose values do not decompress
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

/// Lowest voxel index of a node; 64 bits hold any corner that a file can specify.
using VoxelCorner = std::array<std::int64_t, 3>;

/// A box of voxels with inclusive bounds, anywhere in index space. (The kernels' VoxelBox lies within a grid.)
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
  /// Number of active voxels, where a tile counts as the voxels that it covers; saturates at the largest number.
  std::uint64_t ActiveVoxels = 0;
  std::uint64_t TreeBytes = 0; ///< memory of the tree with all its leaves loaded, bytes

  /// Adds to the statistics a cube of active voxels that share one value.
  void AddTile(const VoxelCorner& corner, std::int64_t edge);
};

/// The bit mask of one node, x slowest, in the order of OpenVDB's NodeMask.
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

  /// Prepares the walk through one tree of a file.
  /// @param topology  positioned at the start of the tree in the file
  /// @param values    checks the values of inner nodes
  VDBTreeWalk(VDBBytes& topology, const VDBValueType& type, VDBValues& values, OnLeaf onLeaf = {});

  /// Walks from the start to the end of the tree, and returns its statistics.
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
