#include "VDBFile.h"

#include "Device/Errors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <sstream>

namespace tyndall
{
namespace
{
constexpr std::uint32_t OldestFormat = openvdb::OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION;
constexpr std::uint32_t NewestFormat = openvdb::OPENVDB_FILE_VERSION;

/// The bytes of a file, read through a window; nothing is ever read beyond the end.
class Bytes
{
public:
  Bytes(const std::string& path, std::uint64_t size)
    : Path(path)
    , Stream(path, std::ios::binary)
    , Size(size)
  {
  }

  std::uint64_t Position() const { return this->At; }
  std::uint64_t Left() const { return this->Size - this->At; }

  void Seek(std::uint64_t position, const char* what)
  {
    if (position > this->Size)
    {
      this->Fail(std::string(what) + " would lie beyond the end of the file");
    }
    this->At = position;
  }

  void Skip(std::uint64_t count, const char* what)
  {
    this->Need(count, what);
    this->At += count;
  }

  void Read(void* target, std::uint64_t count, const char* what)
  {
    this->Need(count, what);
    char* to = static_cast<char*>(target);
    while (count > 0)
    {
      if (this->At < this->WindowStart || this->At >= this->WindowStart + this->Window.size())
      {
        this->LoadWindow();
      }
      const std::uint64_t offset = this->At - this->WindowStart;
      const std::uint64_t part = std::min<std::uint64_t>(count, this->Window.size() - offset);
      std::memcpy(to, this->Window.data() + offset, part);
      to += part;
      count -= part;
      this->At += part;
    }
  }

  template <typename T>
  T Value(const char* what)
  {
    T value;
    this->Read(&value, sizeof(T), what);
    return value;
  }

  std::string Text(std::uint64_t length, const char* what)
  {
    this->Need(length, what);
    std::string text(length, '\0');
    this->Read(&text[0], length, what);
    return text;
  }

  /// A string as OpenVDB stores it: its length, then its bytes.
  std::string LengthAndText(const char* what) { return this->Text(this->Value<std::uint32_t>(what), what); }

  [[noreturn]] void Fail(const std::string& what) const
  {
    throw InvalidInput("\"" + this->Path + "\" is truncated or corrupt: " + what + " (byte " +
      std::to_string(this->At) + " of " + std::to_string(this->Size) + "). Copy or write the file again.");
  }

private:
  void Need(std::uint64_t count, const char* what) const
  {
    if (count > this->Left())
    {
      this->Fail(std::string("it ends within ") + what);
    }
  }

  void LoadWindow()
  {
    constexpr std::uint64_t windowSize = 1 << 18;
    this->WindowStart = this->At;
    this->Window.resize(std::min(windowSize, this->Left()));
    this->Stream.clear();
    this->Stream.seekg(static_cast<std::streamoff>(this->At));
    this->Stream.read(this->Window.data(), static_cast<std::streamsize>(this->Window.size()));
    if (!this->Stream)
    {
      this->Window.clear();
      throw InvalidInput("\"" + this->Path + "\" cannot be read at byte " + std::to_string(this->At) +
        ". Check the disk and the file's permissions.");
    }
  }

  std::string Path;
  std::ifstream Stream;
  std::uint64_t Size = 0;
  std::uint64_t At = 0;
  std::uint64_t WindowStart = 0;
  std::vector<char> Window;
};

/// How a type of grid lies in the file.
struct ValueType
{
  const char* Name;
  std::uint64_t Size;     ///< bytes of a value
  std::uint64_t HalfSize; ///< bytes of a value whose numbers are stored in 16 bits
  enum
  {
    Numbers,
    Bool,
    Mask
  } Leaves;

  bool IsReal() const { return this->HalfSize < this->Size; }
  std::string GridType() const { return std::string("Tree_") + this->Name + "_5_4_3"; }
};

constexpr ValueType ValueTypes[] = {
  { "float", 4, 2, ValueType::Numbers },
  { "double", 8, 2, ValueType::Numbers },
  { "int32", 4, 4, ValueType::Numbers },
  { "int64", 8, 8, ValueType::Numbers },
  { "vec3i", 12, 12, ValueType::Numbers },
  { "vec3s", 12, 6, ValueType::Numbers },
  { "vec3d", 24, 6, ValueType::Numbers },
  { "bool", 1, 1, ValueType::Bool },
  { "mask", 1, 1, ValueType::Mask },
};

const ValueType* FindValueType(const std::string& name)
{
  for (const ValueType& type : ValueTypes)
  {
    if (name == type.Name)
    {
      return &type;
    }
  }
  return nullptr;
}

using Corner = std::array<std::int64_t, 3>;

/// One node's bits, x slowest, as OpenVDB's NodeMask.
template <int Log2Dim>
struct Mask
{
  static constexpr int Count = 1 << (3 * Log2Dim);
  std::array<std::uint64_t, Count / 64> Words = {};

  void Read(Bytes& bytes, const char* what) { bytes.Read(this->Words.data(), sizeof(this->Words), what); }
  bool Has(int bit) const { return (this->Words[bit >> 6] >> (bit & 63)) & 1; }
  int CountOn() const
  {
    int on = 0;
    for (std::uint64_t word : this->Words)
    {
      on += __builtin_popcountll(word);
    }
    return on;
  }
};

template <int Log2Dim>
Corner OffsetOf(int bit)
{
  constexpr int last = (1 << Log2Dim) - 1;
  return { bit >> (2 * Log2Dim), (bit >> Log2Dim) & last, bit & last };
}

using LeafMask = Mask<3>;
constexpr int LeafSize = 8, LowerSize = 128, UpperSize = 4096; ///< voxels an edge: 2^3, 2^(3+4), 2^(3+4+5)

VoxelBox BoxOf(const Corner& corner, std::int64_t size)
{
  return { corner, { corner[0] + size - 1, corner[1] + size - 1, corner[2] + size - 1 } };
}

/// Walks the trees of a file as OpenVDB will read them.
class TreeWalk
{
public:
  TreeWalk(Bytes& topology, const ValueType& type, bool half, std::uint32_t compression)
    : Topology(topology)
    , Type(type)
    , Half(half)
    , Compression(compression)
  {
  }

  VoxelBox ActiveBox;
  std::uint64_t ActiveVoxels = 0;
  std::uint64_t TreeBytes = 0;
  std::string Background;

  /// @param onLeaf  called with each leaf's corner and mask, in the order in which the leaves are stored
  template <typename OnLeaf>
  void Walk(OnLeaf&& onLeaf)
  {
    Bytes& bytes = this->Topology;
    if (bytes.Value<std::int32_t>("the number of buffers") != 1)
    {
      bytes.Fail("the tree's number of buffers is not 1");
    }
    this->Background = bytes.Text(this->Type.Size, "the background value");
    const auto tiles = bytes.Value<std::uint32_t>("the root's number of tiles");
    const auto children = bytes.Value<std::uint32_t>("the root's number of children");
    const std::uint64_t tileSize = 3 * sizeof(std::int32_t) + this->Type.Size + 1;
    if (tiles > bytes.Left() / tileSize || children > bytes.Left() / (2 * sizeof(Mask<5>)))
    {
      bytes.Fail("the root has more tiles or children than the file can hold");
    }
    std::set<Corner> corners;
    for (std::uint32_t tile = 0; tile < tiles; ++tile)
    {
      const Corner corner = this->RootCorner(corners);
      bytes.Skip(this->Type.Size, "a tile of the root");
      const auto active = bytes.Value<std::uint8_t>("a tile of the root");
      if (active > 1)
      {
        bytes.Fail("a tile of the root is neither active nor inactive");
      }
      if (active)
      {
        this->AddTile(corner, UpperSize);
      }
      this->TreeBytes += 100;
    }
    for (std::uint32_t child = 0; child < children; ++child)
    {
      this->WalkInternal<5, UpperSize>(this->RootCorner(corners), onLeaf);
    }
  }

  /// The values of a node: a flag, up to two inactive values and the mask that selects them, then a block of numbers.
  /// @param decompress  whether to try the block: OpenVDB leaks the node if that fails while it reads the topology
  template <int Log2Dim>
  void CheckValues(Bytes& bytes, const Mask<Log2Dim>& active, bool decompress)
  {
    const auto flag = bytes.Value<std::int8_t>("the flag of a node's values");
    if (flag < openvdb::io::NO_MASK_OR_INACTIVE_VALS || flag > openvdb::io::NO_MASK_AND_ALL_VALS)
    {
      bytes.Fail("the flag of a node's values is unknown");
    }
    const bool one = flag == openvdb::io::NO_MASK_AND_ONE_INACTIVE_VAL || flag == openvdb::io::MASK_AND_ONE_INACTIVE_VAL;
    const bool two = flag == openvdb::io::MASK_AND_TWO_INACTIVE_VALS;
    bytes.Skip((one ? 1 : two ? 2 : 0) * this->Type.Size, "a node's inactive values");
    if (flag == openvdb::io::MASK_AND_NO_INACTIVE_VALS || flag == openvdb::io::MASK_AND_ONE_INACTIVE_VAL || two)
    {
      bytes.Skip(sizeof(active.Words), "the mask of a node's inactive values");
    }
    const bool onlyActive =
      (this->Compression & openvdb::io::COMPRESS_ACTIVE_MASK) && flag != openvdb::io::NO_MASK_AND_ALL_VALS;
    const std::uint64_t count = onlyActive ? active.CountOn() : Mask<Log2Dim>::Count;
    this->CheckBlock(bytes, count, decompress);
  }

private:
  void CheckBlock(Bytes& bytes, std::uint64_t count, bool decompress)
  {
    using namespace openvdb::io;
    const bool half = this->Half && this->Type.IsReal();
    if (half && count == 0)
    {
      return; // OpenVDB stores nothing then, not even a length.
    }
    const std::uint64_t expected = count * (half ? this->Type.HalfSize : this->Type.Size);
    const char* what = "a node's values";
    if (!(this->Compression & (COMPRESS_BLOSC | COMPRESS_ZIP)))
    {
      bytes.Skip(expected, what);
      return;
    }
    const std::uint64_t start = bytes.Position();
    const auto length = bytes.Value<std::int64_t>(what);
    if (length <= 0) // stored as they are
    {
      if (length != -static_cast<std::int64_t>(expected))
      {
        bytes.Fail("a node's values have the wrong length");
      }
      bytes.Skip(expected, what);
      return;
    }
    const std::uint64_t end = bytes.Position() + static_cast<std::uint64_t>(length);
    if (static_cast<std::uint64_t>(length) > bytes.Left())
    {
      bytes.Fail("it ends within a node's values");
    }
    if (this->Compression & COMPRESS_BLOSC)
    {
      // Blosc believes the sizes in its header.
      std::array<std::uint32_t, 4> header = {};
      if (length >= static_cast<std::int64_t>(sizeof(header)))
      {
        bytes.Read(header.data(), sizeof(header), what);
      }
      if (header[1] != expected || header[3] != length)
      {
        bytes.Fail("a node's compressed values have the wrong length");
      }
    }
    if (decompress)
    {
      bytes.Seek(start, what);
      std::istringstream block(bytes.Text(end - start, what));
      this->Scratch.resize(expected);
      try
      {
        if (this->Compression & COMPRESS_BLOSC)
        {
          bloscFromStream(block, this->Scratch.data(), expected);
        }
        else
        {
          unzipFromStream(block, this->Scratch.data(), expected);
        }
      }
      catch (const std::exception&)
      {
        bytes.Fail("a node's values do not decompress");
      }
    }
    bytes.Seek(end, what);
  }

  Corner RootCorner(std::set<Corner>& corners)
  {
    Corner corner;
    for (std::int64_t& x : corner)
    {
      x = this->Topology.Value<std::int32_t>("a corner of the root");
      if (x % UpperSize != 0)
      {
        this->Topology.Fail("a node lies off the tree's lattice");
      }
    }
    if (!corners.insert(corner).second)
    {
      this->Topology.Fail("two nodes lie at one place");
    }
    return corner;
  }

  void AddTile(const Corner& corner, std::int64_t size)
  {
    this->ActiveBox.Add(BoxOf(corner, size));
    const auto voxels = static_cast<std::uint64_t>(size * size * size);
    this->ActiveVoxels = voxels > UINT64_MAX - this->ActiveVoxels ? UINT64_MAX : this->ActiveVoxels + voxels;
  }

  template <int Log2Dim, int Size, typename OnLeaf>
  void WalkInternal(const Corner& corner, OnLeaf&& onLeaf)
  {
    constexpr int childSize = Size >> Log2Dim;
    Bytes& bytes = this->Topology;
    Mask<Log2Dim> children, active;
    children.Read(bytes, "a node's mask of children");
    active.Read(bytes, "a node's mask of active tiles");
    for (std::size_t word = 0; word < children.Words.size(); ++word)
    {
      if (children.Words[word] & active.Words[word])
      {
        bytes.Fail("a node has a tile and a child at one place");
      }
    }
    this->CheckValues(bytes, active, true);
    this->TreeBytes += Mask<Log2Dim>::Count * (this->Type.Size <= 8 ? 8 : 40) + 2 * sizeof(active.Words);

    for (int bit = 0; bit < Mask<Log2Dim>::Count; ++bit)
    {
      if (!children.Has(bit) && !active.Has(bit))
      {
        continue;
      }
      const Corner offset = OffsetOf<Log2Dim>(bit);
      const Corner at = { corner[0] + offset[0] * childSize, corner[1] + offset[1] * childSize,
        corner[2] + offset[2] * childSize };
      if (active.Has(bit))
      {
        this->AddTile(at, childSize);
      }
      else if constexpr (childSize == LeafSize)
      {
        this->WalkLeaf(at, onLeaf);
      }
      else
      {
        this->WalkInternal<4, childSize>(at, onLeaf);
      }
    }
  }

  template <typename OnLeaf>
  void WalkLeaf(const Corner& corner, OnLeaf&& onLeaf)
  {
    LeafMask mask;
    mask.Read(this->Topology, "a leaf's mask");
    this->TreeBytes += 128 + (this->Type.Leaves == ValueType::Numbers ? LeafMask::Count * this->Type.Size : 64);

    // Bit 64 x + 8 y + z: a word is one x, its byte one y.
    std::uint64_t yz = 0;
    int first = -1, last = -1;
    for (int x = 0; x < LeafSize; ++x)
    {
      if (const std::uint64_t word = mask.Words[x])
      {
        yz |= word;
        first = first < 0 ? x : first;
        last = x;
        this->ActiveVoxels += __builtin_popcountll(word);
      }
    }
    if (yz != 0)
    {
      std::uint64_t z = yz | (yz >> 32);
      z |= z >> 16;
      z = (z | (z >> 8)) & 0xff;
      const int y0 = __builtin_ctzll(yz) / 8, y1 = (63 - __builtin_clzll(yz)) / 8;
      const int z0 = __builtin_ctzll(z), z1 = 63 - __builtin_clzll(z);
      this->ActiveBox.Add({ { corner[0] + first, corner[1] + y0, corner[2] + z0 },
        { corner[0] + last, corner[1] + y1, corner[2] + z1 } });
    }
    onLeaf(corner, mask);
  }

  Bytes& Topology;
  const ValueType& Type;
  bool Half;
  std::uint32_t Compression;
  std::vector<char> Scratch;
};

/// What OpenVDB writes about the file rather than the grid; it writes it anew.
bool DescribesTheFile(const std::string& key)
{
  using Grid = openvdb::GridBase;
  return key == Grid::META_FILE_BBOX_MIN || key == Grid::META_FILE_BBOX_MAX || key == Grid::META_FILE_COMPRESSION ||
    key == Grid::META_FILE_MEM_BYTES || key == Grid::META_FILE_VOXEL_COUNT || key == Grid::META_FILE_DELAYED_LOAD;
}

/// Metadata of types that OpenVDB knows; others (and what describes the file) are passed over.
openvdb::MetaMap ReadMetadata(Bytes& bytes)
{
  openvdb::MetaMap map;
  const auto count = bytes.Value<std::uint32_t>("the number of metadata");
  for (std::uint32_t i = 0; i < count; ++i)
  {
    const std::string key = bytes.LengthAndText("the name of metadata");
    const std::string type = bytes.LengthAndText("the type of metadata");
    std::string value = bytes.LengthAndText("the value of metadata");
    if (key.empty())
    {
      bytes.Fail("metadata has no name");
    }
    if (DescribesTheFile(key) || type == "__delayedload" || !openvdb::Metadata::isRegisteredType(type))
    {
      continue;
    }
    const openvdb::Metadata::Ptr metadata = openvdb::Metadata::createMetadata(type);
    if (type != "string" && metadata->size() != value.size())
    {
      bytes.Fail("metadata \"" + key + "\" of type " + type + " has the wrong length");
    }
    if (type == "bool")
    {
      value[0] = value[0] != 0;
    }
    const auto length = static_cast<std::uint32_t>(value.size());
    std::istringstream stream(std::string(reinterpret_cast<const char*>(&length), sizeof(length)) + value);
    metadata->read(stream);
    map.removeMeta(key);
    map.insertMeta(key, *metadata);
  }
  return map;
}

/// Fills in the linear map of a grid.
/// @return whether it is one; if not, what follows in the file is of unknown length
bool ReadTransform(Bytes& bytes, VDBGrid& grid)
{
  const std::string type = bytes.LengthAndText("the type of the transform");
  const auto vector = [&] { return bytes.Value<std::array<double, 3>>("the transform"); };
  const auto diagonal = [&](const std::array<double, 3>& scale) {
    for (int axis = 0; axis < 3; ++axis)
    {
      grid.Axes[axis][axis] = scale[axis];
    }
  };
  if (type == "AffineMap" || type == "UnitaryMap") // a matrix that multiplies row vectors from the right
  {
    for (int row = 0; row < 4; ++row)
    {
      (row < 3 ? grid.Axes[row] : grid.Translation) = vector();
      bytes.Skip(sizeof(double), "the transform");
    }
  }
  else if (type == "ScaleMap" || type == "UniformScaleMap") // followed by numbers that are computed from it
  {
    diagonal(vector());
    bytes.Skip(4 * 3 * sizeof(double), "the transform");
  }
  else if (type == "ScaleTranslateMap" || type == "UniformScaleTranslateMap")
  {
    grid.Translation = vector();
    diagonal(vector());
    bytes.Skip(4 * 3 * sizeof(double), "the transform");
  }
  else if (type == "TranslationMap")
  {
    grid.Translation = vector();
    diagonal({ 1.0, 1.0, 1.0 });
  }
  else
  {
    grid.Unusable = "its transform (" + type + ") is not linear; an image needs one. Resample the grid, for example with "
                                               "OpenVDB's resampleToMatch";
    return false;
  }

  double lengths[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto& a = grid.Axes[axis];
    lengths[axis] = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    if (!std::isfinite(lengths[axis]) || lengths[axis] <= 0.0 || !std::isfinite(grid.Translation[axis]))
    {
      grid.Unusable = "its transform gives voxels no size";
      return true;
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto &a = grid.Axes[axis], &b = grid.Axes[(axis + 1) % 3];
    const double cosine =
      (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / lengths[axis] / lengths[(axis + 1) % 3];
    if (!(std::abs(cosine) < 1e-6))
    {
      grid.Unusable = "its transform shears; an image needs axes at right angles. Resample the grid, for example with "
                      "OpenVDB's resampleToMatch";
    }
  }
  return true;
}

std::uint64_t SizeOf(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = stream ? static_cast<std::streamoff>(stream.tellg()) : -1;
  stream.seekg(0);
  // A folder opens, and has a size, but nothing can be read from it.
  if (size < 0 || (size > 0 && stream.peek() == std::ifstream::traits_type::eof()))
  {
    throw InvalidInput("\"" + path + "\" cannot be read. Check that it is a file, is there and may be read.");
  }
  return static_cast<std::uint64_t>(size);
}
}

void VoxelBox::Add(const VoxelBox& other)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Min[axis] = std::min(this->Min[axis], other.Min[axis]);
    this->Max[axis] = std::max(this->Max[axis], other.Max[axis]);
  }
}

bool VDBFile::HasMagic(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  std::int64_t magic = 0;
  stream.read(reinterpret_cast<char*>(&magic), sizeof(magic));
  return stream && magic == openvdb::OPENVDB_MAGIC;
}

VDBFile::VDBFile(const std::string& path)
  : FilePath(path)
  , FileSize(SizeOf(path))
{
  openvdb::initialize();
  this->ReadHeader();
  this->ReadDescriptors();
}

const VDBGrid* VDBFile::Find(const std::string& name) const
{
  const auto found = std::find_if(
    this->AllGrids.begin(), this->AllGrids.end(), [&](const VDBGrid& grid) { return grid.Name == name; });
  return found == this->AllGrids.end() ? nullptr : &*found;
}

void VDBFile::ReadHeader()
{
  if (this->FileSize == 0)
  {
    throw InvalidInput("\"" + this->FilePath + "\" is empty. Copy or write the file again.");
  }
  Bytes bytes(this->FilePath, this->FileSize);
  if (this->FileSize < sizeof(std::int64_t) || bytes.Value<std::int64_t>("the header") != openvdb::OPENVDB_MAGIC)
  {
    throw InvalidInput("\"" + this->FilePath + "\" is not an OpenVDB file: it does not begin as one.");
  }
  this->FormatVersion = bytes.Value<std::uint32_t>("the header");
  if (this->FormatVersion < OldestFormat || this->FormatVersion > NewestFormat)
  {
    throw InvalidInput("\"" + this->FilePath + "\" has format version " + std::to_string(this->FormatVersion) +
      "; versions " + std::to_string(OldestFormat) + " to " + std::to_string(NewestFormat) +
      " can be read. Write it again with OpenVDB 3 to 10.");
  }
  this->LibraryVersion.first = bytes.Value<std::uint32_t>("the header");
  this->LibraryVersion.second = bytes.Value<std::uint32_t>("the header");
  if (bytes.Value<std::uint8_t>("the header") != 1)
  {
    throw InvalidInput("\"" + this->FilePath +
      "\" was written as a stream, without the places of its grids. Write it again with OpenVDB's io::File.");
  }
  bytes.Skip(36, "the header"); // a UUID
  this->FileMetadata = ReadMetadata(bytes);
  this->FirstDescriptor = bytes.Position();
}

void VDBFile::ReadDescriptors()
{
  Bytes bytes(this->FilePath, this->FileSize);
  bytes.Seek(this->FirstDescriptor, "the list of grids");
  const auto count = bytes.Value<std::int32_t>("the number of grids");
  if (count < 0)
  {
    bytes.Fail("it has a negative number of grids");
  }
  const std::string half = "_HalfFloat", prefix = "Tree_", suffix = "_5_4_3";
  std::map<std::string, std::size_t> known;
  for (std::int32_t i = 0; i < count; ++i)
  {
    VDBGrid grid;
    const std::string uniqueName = bytes.LengthAndText("the name of a grid");
    grid.Name = openvdb::io::GridDescriptor::nameAsString(uniqueName);
    std::string type = bytes.LengthAndText("the type of a grid");
    grid.Half = type.size() > half.size() && type.compare(type.size() - half.size(), half.size(), half) == 0;
    type.resize(type.size() - (grid.Half ? half.size() : 0));
    const bool dense = type.size() > prefix.size() + suffix.size() && type.compare(0, prefix.size(), prefix) == 0 &&
      type.compare(type.size() - suffix.size(), suffix.size(), suffix) == 0;
    grid.Type = dense ? type.substr(prefix.size(), type.size() - prefix.size() - suffix.size()) : type;
    const std::string sharedWith = bytes.LengthAndText("the parent of a grid");

    const std::uint64_t afterNames = bytes.Position() + 3 * sizeof(std::int64_t);
    const auto start = bytes.Value<std::int64_t>("the place of a grid");
    grid.BufferPosition = bytes.Value<std::int64_t>("the place of a grid");
    grid.EndPosition = bytes.Value<std::int64_t>("the place of a grid");
    const bool hasTree = sharedWith.empty(); // without a tree, a grid has no leaves to have a place
    const bool inOrder = start == static_cast<std::int64_t>(afterNames) && grid.EndPosition >= start &&
      (!hasTree || (grid.BufferPosition >= start && grid.EndPosition >= grid.BufferPosition));
    if (!inOrder || grid.EndPosition > static_cast<std::int64_t>(this->FileSize))
    {
      bytes.Fail("grid \"" + grid.Name + "\" does not lie where the list of grids says");
    }
    if (known.count(uniqueName))
    {
      bytes.Fail("two grids are named \"" + grid.Name + "\"");
    }

    grid.TopologyPosition = start;
    if (!hasTree)
    {
      // Metadata and transform of its own, the tree of a grid before it.
      const auto parent = known.find(sharedWith);
      if (parent == known.end() || this->AllGrids[parent->second].Type != grid.Type)
      {
        bytes.Fail("grid \"" + grid.Name + "\" shares the tree of a grid that is not there");
      }
      const VDBGrid& shared = this->AllGrids[parent->second];
      Bytes own(this->FilePath, this->FileSize);
      own.Seek(static_cast<std::uint64_t>(start), "a grid");
      own.Skip(sizeof(std::uint32_t), "a grid");
      grid.Metadata = ReadMetadata(own);
      ReadTransform(own, grid);
      grid.Unusable = grid.Unusable.empty() ? shared.Unusable : grid.Unusable;
      grid.Half = shared.Half;
      grid.Background = shared.Background;
      grid.ActiveBox = shared.ActiveBox;
      grid.ActiveVoxels = shared.ActiveVoxels;
      grid.TreeBytes = shared.TreeBytes;
      grid.Compression = shared.Compression;
      grid.TopologyPosition = shared.TopologyPosition;
      grid.BufferPosition = shared.BufferPosition;
      bytes.Seek(static_cast<std::uint64_t>(grid.EndPosition), "the next grid");
      grid.EndPosition = shared.EndPosition;
    }
    else
    {
      this->ReadGrid(grid);
      bytes.Seek(static_cast<std::uint64_t>(grid.EndPosition), "the next grid");
    }
    known[uniqueName] = this->AllGrids.size();
    this->AllGrids.push_back(std::move(grid));
  }
}

void VDBFile::ReadGrid(VDBGrid& grid)
{
  Bytes bytes(this->FilePath, this->FileSize);
  bytes.Seek(static_cast<std::uint64_t>(grid.TopologyPosition), "a grid");
  grid.Compression = bytes.Value<std::uint32_t>("a grid's compression");
  const std::uint32_t knownFlags =
    openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_BLOSC;
  if (grid.Compression & ~knownFlags)
  {
    bytes.Fail("grid \"" + grid.Name + "\" has an unknown compression");
  }
  grid.Metadata = ReadMetadata(bytes);
  const bool linear = ReadTransform(bytes, grid);
  const ValueType* type = FindValueType(grid.Type);
  if (type == nullptr)
  {
    grid.Unusable = "its type (" + grid.Type + ") is not one of float, double, int32, int64, bool, mask, vec3i, vec3s, vec3d";
  }
  if (type == nullptr || !linear)
  {
    return;
  }

  grid.TopologyPosition = static_cast<std::int64_t>(bytes.Position());
  TreeWalk tree(bytes, *type, grid.Half, grid.Compression);
  tree.Walk([](const Corner&, const LeafMask&) {});
  if (bytes.Position() != static_cast<std::uint64_t>(grid.BufferPosition))
  {
    bytes.Fail("the tree of grid \"" + grid.Name + "\" does not end where its leaves begin");
  }
  grid.Background = tree.Background;
  grid.ActiveBox = tree.ActiveBox;
  grid.ActiveVoxels = tree.ActiveVoxels;
  grid.TreeBytes = tree.TreeBytes;
}

void VDBFile::CheckLeaves(const VDBGrid& grid)
{
  const ValueType& type = *FindValueType(grid.Type);
  Bytes topology(this->FilePath, this->FileSize);
  Bytes leaves(this->FilePath, this->FileSize);
  topology.Seek(static_cast<std::uint64_t>(grid.TopologyPosition), "a grid");
  leaves.Seek(static_cast<std::uint64_t>(grid.BufferPosition), "a grid's leaves");
  TreeWalk tree(topology, type, grid.Half, grid.Compression);
  tree.Walk([&](const Corner& corner, const LeafMask& mask) {
    LeafMask again;
    again.Read(leaves, "a leaf's mask");
    if (again.Words != mask.Words)
    {
      leaves.Fail("a leaf's active voxels differ from those of the tree");
    }
    if (type.Leaves == ValueType::Numbers)
    {
      tree.CheckValues(leaves, mask, false);
      return;
    }
    for (std::int64_t x : corner)
    {
      if (leaves.Value<std::int32_t>("a leaf's corner") != x)
      {
        leaves.Fail("a leaf lies elsewhere than in the tree");
      }
    }
    if (type.Leaves == ValueType::Bool)
    {
      leaves.Skip(sizeof(mask.Words), "a leaf's values");
    }
  });
  if (leaves.Position() != static_cast<std::uint64_t>(grid.EndPosition))
  {
    leaves.Fail("the leaves of grid \"" + grid.Name + "\" do not end where the grid does");
  }
}

openvdb::GridBase::Ptr VDBFile::Read(const VDBGrid& grid, const openvdb::CoordBBox& box)
{
  this->CheckLeaves(grid);

  const auto metadata = std::make_shared<openvdb::io::StreamMetadata>();
  metadata->setSeekable(true); // so that leaves outside the box are passed over
  metadata->setFileVersion(this->FormatVersion);
  metadata->setLibraryVersion(this->LibraryVersion);
  metadata->setCompression(grid.Compression);
  metadata->setHalfFloat(grid.Half);
  openvdb::io::StreamMetadata::Ptr shared = metadata;
  std::ifstream stream(this->FilePath, std::ios::binary);
  openvdb::io::setStreamMetadataPtr(stream, shared, /*transfer=*/true);

  const openvdb::GridBase::Ptr loaded = openvdb::GridBase::createGrid(FindValueType(grid.Type)->GridType());
  loaded->setSaveFloatAsHalf(grid.Half);
  try
  {
    stream.seekg(grid.TopologyPosition);
    loaded->readTopology(stream);
    stream.seekg(grid.BufferPosition);
    loaded->readBuffers(stream, box);
  }
  catch (const std::exception& error)
  {
    throw InvalidInput("\"" + this->FilePath + "\" is corrupt: the values of grid \"" + grid.Name +
      "\" cannot be read (" + error.what() + "). Copy or write the file again.");
  }
  if (!stream)
  {
    throw InvalidInput("\"" + this->FilePath + "\" changed or could not be read while it was loaded. Try again.");
  }
  return loaded;
}
}
