#include "IO/VDB/VDBTreeWalk.h"

#include "IO/VDB/VDBBytes.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <utility>

namespace tyndall
{
namespace
{
constexpr VDBValueType ValueTypes[] = {
  { "float", 4, 2, VDBValueType::Numbers },
  { "double", 8, 2, VDBValueType::Numbers },
  { "int32", 4, 4, VDBValueType::Numbers },
  { "int64", 8, 8, VDBValueType::Numbers },
  { "vec3i", 12, 12, VDBValueType::Numbers },
  { "vec3s", 12, 6, VDBValueType::Numbers },
  { "vec3d", 24, 6, VDBValueType::Numbers },
  { "bool", 1, 1, VDBValueType::Bool },
  { "mask", 1, 1, VDBValueType::Mask },
};

const char* const NodesValues = "a node's values";
}

const VDBValueType* FindValueType(const std::string& name)
{
  const auto found = std::find_if(
    std::begin(ValueTypes), std::end(ValueTypes), [&](const VDBValueType& type) { return name == type.Name; });
  return found == std::end(ValueTypes) ? nullptr : found;
}

VDBValues::VDBValues(const VDBValueType& type, bool half, std::uint32_t compression)
  : Type(type)
  , Half(half)
  , Compression(compression)
{
}

void VDBValues::Check(VDBBytes& bytes, std::uint64_t active, std::uint64_t all, bool decompress)
{
  using namespace openvdb::io;
  const auto flag = bytes.Value<std::int8_t>("the flag of a node's values");
  if (flag < NO_MASK_OR_INACTIVE_VALS || flag > NO_MASK_AND_ALL_VALS)
  {
    bytes.Fail("the flag of a node's values is unknown");
  }
  const bool one = flag == NO_MASK_AND_ONE_INACTIVE_VAL || flag == MASK_AND_ONE_INACTIVE_VAL;
  const bool two = flag == MASK_AND_TWO_INACTIVE_VALS;
  bytes.Skip((one ? 1 : two ? 2 : 0) * this->Type.Size, "a node's inactive values");
  if (flag == MASK_AND_NO_INACTIVE_VALS || flag == MASK_AND_ONE_INACTIVE_VAL || two)
  {
    bytes.Skip(all / 8, "the mask of a node's inactive values");
  }
  const bool onlyActive = (this->Compression & COMPRESS_ACTIVE_MASK) && flag != NO_MASK_AND_ALL_VALS;
  this->CheckBlock(bytes, onlyActive ? active : all, decompress);
}

void VDBValues::CheckBlock(VDBBytes& bytes, std::uint64_t count, bool decompress)
{
  using namespace openvdb::io;
  const bool half = this->Half && this->Type.IsReal();
  if (half && count == 0)
  {
    return; // OpenVDB stores nothing, not even a length, for a block without values in 16 bits
  }
  const std::uint64_t expected = count * (half ? this->Type.HalfSize : this->Type.Size);
  if (!(this->Compression & (COMPRESS_BLOSC | COMPRESS_ZIP)))
  {
    bytes.Skip(expected, NodesValues);
    return;
  }
  const std::uint64_t start = bytes.Position();
  const auto length = bytes.Value<std::int64_t>(NodesValues);
  if (length <= 0) // the values are stored uncompressed, in -length bytes
  {
    if (length != -static_cast<std::int64_t>(expected))
    {
      bytes.Fail("a node's values have the wrong length");
    }
    bytes.Skip(expected, NodesValues);
    return;
  }
  const std::uint64_t end = bytes.Position() + static_cast<std::uint64_t>(length);
  if (static_cast<std::uint64_t>(length) > bytes.Left())
  {
    bytes.Fail("it ends within a node's values");
  }
  if (this->Compression & COMPRESS_BLOSC)
  {
    // Checks the sizes in the header of a Blosc block, because Blosc itself does not check them.
    std::array<std::uint32_t, 4> header = {};
    if (length >= static_cast<std::int64_t>(sizeof(header)))
    {
      bytes.Read(header.data(), sizeof(header), NodesValues);
    }
    if (header[1] != expected || header[3] != length)
    {
      bytes.Fail("a node's compressed values have the wrong length");
    }
  }
  if (decompress)
  {
    bytes.Seek(start, NodesValues);
    this->Decompress(bytes, end - start, expected);
  }
  bytes.Seek(end, NodesValues);
}

void VDBValues::Decompress(VDBBytes& bytes, std::uint64_t compressed, std::uint64_t expected)
{
  std::istringstream block(bytes.Text(compressed, NodesValues));
  this->Scratch.resize(expected);
  try
  {
    if (this->Compression & openvdb::io::COMPRESS_BLOSC)
    {
      openvdb::io::bloscFromStream(block, this->Scratch.data(), expected);
    }
    else
    {
      openvdb::io::unzipFromStream(block, this->Scratch.data(), expected);
    }
  }
  catch (const std::exception&)
  {
    bytes.Fail("a node's values do not decompress");
  }
}

namespace
{
constexpr int LeafEdge = 8, UpperEdge = 4096; ///< voxels per edge of a leaf, 2^3, and of an upper node, 2^(3+4+5)

VDBBox BoxOf(const VoxelCorner& corner, std::int64_t edge)
{
  return { corner, { corner[0] + edge - 1, corner[1] + edge - 1, corner[2] + edge - 1 } };
}

template <int Log2Dim>
VDBMask<Log2Dim> ReadMask(VDBBytes& bytes, const char* what)
{
  VDBMask<Log2Dim> mask;
  bytes.Read(mask.Words.data(), sizeof(mask.Words), what);
  return mask;
}

/// Corner (lowest voxel index) of child number `bit` of a node.
template <int Log2Dim>
VoxelCorner ChildCorner(const VoxelCorner& corner, int bit, int childEdge)
{
  constexpr int last = (1 << Log2Dim) - 1;
  return { corner[0] + (bit >> (2 * Log2Dim)) * childEdge, corner[1] + ((bit >> Log2Dim) & last) * childEdge,
    corner[2] + (bit & last) * childEdge };
}

/// The bounding box of a leaf's active voxels; at least one voxel must be active.
VDBBox ActiveBoxOf(const VDBLeafMask& mask, const VoxelCorner& corner)
{
  // Voxel (x, y, z) is bit 64 x + 8 y + z of the mask: each 64-bit word has one x, each of its bytes one y.
  std::uint64_t yz = 0;
  int first = -1, last = -1;
  for (int x = 0; x < LeafEdge; ++x)
  {
    if (mask.Words[x] != 0)
    {
      yz |= mask.Words[x];
      first = first < 0 ? x : first;
      last = x;
    }
  }
  std::uint64_t z = yz | (yz >> 32);
  z |= z >> 16;
  z = (z | (z >> 8)) & 0xff;
  const int y0 = __builtin_ctzll(yz) / 8, y1 = (63 - __builtin_clzll(yz)) / 8;
  const int z0 = __builtin_ctzll(z), z1 = 63 - __builtin_clzll(z);
  return { { corner[0] + first, corner[1] + y0, corner[2] + z0 },
    { corner[0] + last, corner[1] + y1, corner[2] + z1 } };
}
}

void VDBBox::Add(const VDBBox& other)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Min[axis] = std::min(this->Min[axis], other.Min[axis]);
    this->Max[axis] = std::max(this->Max[axis], other.Max[axis]);
  }
}

void VDBTopology::AddTile(const VoxelCorner& corner, std::int64_t edge)
{
  this->ActiveBox.Add(BoxOf(corner, edge));
  const auto voxels = static_cast<std::uint64_t>(edge * edge * edge);
  this->ActiveVoxels = voxels > UINT64_MAX - this->ActiveVoxels ? UINT64_MAX : this->ActiveVoxels + voxels;
}

VDBTreeWalk::VDBTreeWalk(VDBBytes& topology, const VDBValueType& type, VDBValues& values, OnLeaf onLeaf)
  : Topology(topology)
  , Type(type)
  , Values(values)
  , Leaf(std::move(onLeaf))
{
}

VDBTopology VDBTreeWalk::Walk()
{
  VDBBytes& bytes = this->Topology;
  if (bytes.Value<std::int32_t>("the number of buffers") != 1)
  {
    bytes.Fail("the tree's number of buffers is not 1");
  }
  bytes.Skip(this->Type.Size, "the background value");
  const auto tiles = bytes.Value<std::uint32_t>("the root's number of tiles");
  const auto children = bytes.Value<std::uint32_t>("the root's number of children");
  const std::uint64_t tileSize = 3 * sizeof(std::int32_t) + this->Type.Size + 1;
  if (tiles > bytes.Left() / tileSize || children > bytes.Left() / (2 * sizeof(VDBMask<5>)))
  {
    bytes.Fail("the root has more tiles or children than the file can hold");
  }
  for (std::uint32_t tile = 0; tile < tiles; ++tile)
  {
    this->ReadTile();
  }
  for (std::uint32_t child = 0; child < children; ++child)
  {
    this->WalkNode<5, UpperEdge>(this->ReadRootCorner());
  }
  return this->Found;
}

void VDBTreeWalk::ReadTile()
{
  const VoxelCorner corner = this->ReadRootCorner();
  this->Topology.Skip(this->Type.Size, "a tile of the root");
  const auto active = this->Topology.Value<std::uint8_t>("a tile of the root");
  if (active > 1)
  {
    this->Topology.Fail("a tile of the root is neither active nor inactive");
  }
  if (active)
  {
    this->Found.AddTile(corner, UpperEdge);
  }
  this->Found.TreeBytes += 100;
}

VoxelCorner VDBTreeWalk::ReadRootCorner()
{
  VoxelCorner corner;
  for (std::int64_t& x : corner)
  {
    x = this->Topology.Value<std::int32_t>("a corner of the root");
    if (x % UpperEdge != 0)
    {
      this->Topology.Fail("a node lies off the tree's lattice");
    }
  }
  if (!this->RootCorners.insert(corner).second)
  {
    this->Topology.Fail("two nodes lie at one place");
  }
  return corner;
}

template <int Log2Dim, int Edge>
void VDBTreeWalk::WalkNode(const VoxelCorner& corner)
{
  constexpr int childEdge = Edge >> Log2Dim;
  VDBBytes& bytes = this->Topology;
  const auto children = ReadMask<Log2Dim>(bytes, "a node's mask of children");
  const auto active = ReadMask<Log2Dim>(bytes, "a node's mask of active tiles");
  for (std::size_t word = 0; word < children.Words.size(); ++word)
  {
    if (children.Words[word] & active.Words[word])
    {
      bytes.Fail("a node has a tile and a child at one place");
    }
  }
  this->Values.Check(bytes, active.CountOn(), active.Count, true);
  this->Found.TreeBytes += active.Count * (this->Type.Size <= 8 ? 8 : 40) + 2 * sizeof(active.Words);

  for (int bit = 0; bit < active.Count; ++bit)
  {
    if (active.Has(bit))
    {
      this->Found.AddTile(ChildCorner<Log2Dim>(corner, bit, childEdge), childEdge);
    }
    else if (children.Has(bit))
    {
      const VoxelCorner at = ChildCorner<Log2Dim>(corner, bit, childEdge);
      if constexpr (childEdge == LeafEdge)
      {
        this->WalkLeaf(at);
      }
      else
      {
        this->WalkNode<4, childEdge>(at);
      }
    }
  }
}

void VDBTreeWalk::WalkLeaf(const VoxelCorner& corner)
{
  const auto mask = ReadMask<3>(this->Topology, "a leaf's mask");
  this->Found.TreeBytes += 128 + (this->Type.Leaves == VDBValueType::Numbers ? mask.Count * this->Type.Size : 64);
  if (const int on = mask.CountOn())
  {
    this->Found.ActiveVoxels += static_cast<std::uint64_t>(on);
    this->Found.ActiveBox.Add(ActiveBoxOf(mask, corner));
  }
  if (this->Leaf)
  {
    this->Leaf(corner, mask);
  }
}
}
