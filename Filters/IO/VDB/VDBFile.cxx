#include "IO/VDB/VDBFile.h"

#include "Device/Errors.h"
#include "IO/Files.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>

namespace tyndall
{
namespace
{
constexpr std::uint32_t OldestFormat = openvdb::OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION;
constexpr std::uint32_t NewestFormat = openvdb::OPENVDB_FILE_VERSION;

bool EndsWith(const std::string& text, const std::string& end)
{
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Sets value type and storage format of a grid from the name of its type in the file.
void SetType(VDBGrid& grid, std::string type)
{
  const std::string half = "_HalfFloat", prefix = "Tree_", suffix = "_5_4_3";
  grid.Place.Half = EndsWith(type, half);
  type.resize(type.size() - (grid.Place.Half ? half.size() : 0));
  const bool usual = EndsWith(type, suffix) && type.size() > prefix.size() + suffix.size() &&
    type.compare(0, prefix.size(), prefix) == 0;
  grid.Type = usual ? type.substr(prefix.size(), type.size() - prefix.size() - suffix.size()) : type;
}
}

bool VDBFile::HasMagic(const std::string& path)
{
  if (!HasAnEnd(path))
  {
    return false;
  }
  std::ifstream stream(path, std::ios::binary);
  std::int64_t magic = 0;
  stream.read(reinterpret_cast<char*>(&magic), sizeof(magic));
  return stream && magic == openvdb::OPENVDB_MAGIC;
}

VDBFile::VDBFile(const std::string& path)
  : FilePath(path)
  , FileSize(ReadableSize(path))
{
  openvdb::initialize();
  this->ReadHeader();
  this->ReadDescriptors();
}

const VDBGrid* VDBFile::Find(const std::string& name) const
{
  const auto found =
    std::find_if(this->AllGrids.begin(), this->AllGrids.end(), [&](const VDBGrid& grid) { return grid.Name == name; });
  return found == this->AllGrids.end() ? nullptr : &*found;
}

void VDBFile::ReadHeader()
{
  Require(this->FileSize != 0, "\"" + this->FilePath + "\" is empty. Copy or write the file again.");
  VDBBytes bytes(this->FilePath, this->FileSize);
  Require(this->FileSize >= sizeof(std::int64_t) && bytes.Value<std::int64_t>("the header") == openvdb::OPENVDB_MAGIC,
    "\"" + this->FilePath + "\" is not an OpenVDB file: it does not begin as one.");
  this->FormatVersion = bytes.Value<std::uint32_t>("the header");
  if (this->FormatVersion < OldestFormat || this->FormatVersion > NewestFormat)
  {
    throw InvalidInput("\"" + this->FilePath + "\" has format version " + std::to_string(this->FormatVersion) +
      "; versions " + std::to_string(OldestFormat) + " to " + std::to_string(NewestFormat) +
      " can be read. Write it again with OpenVDB 3 to 10.");
  }
  this->LibraryVersion.first = bytes.Value<std::uint32_t>("the header");
  this->LibraryVersion.second = bytes.Value<std::uint32_t>("the header");
  Require(bytes.Value<std::uint8_t>("the header") == 1,
    "\"" + this->FilePath +
      "\" was written as a stream, without the places of its grids. Write it again with OpenVDB's io::File.");
  bytes.Skip(36, "the header"); // skips the UUID of the file
  this->FileMetadata = ReadMetadata(bytes);
  this->FirstDescriptor = bytes.Position();
}

void VDBFile::ReadDescriptors()
{
  VDBBytes bytes(this->FilePath, this->FileSize);
  bytes.Seek(this->FirstDescriptor, "the list of grids");
  const auto count = bytes.Value<std::int32_t>("the number of grids");
  if (count < 0)
  {
    bytes.Fail("it has a negative number of grids");
  }
  std::map<std::string, std::size_t> known;
  for (std::int32_t i = 0; i < count; ++i)
  {
    VDBGrid grid;
    const std::string uniqueName = bytes.LengthAndText("the name of a grid");
    grid.Name = openvdb::io::GridDescriptor::nameAsString(uniqueName);
    SetType(grid, bytes.LengthAndText("the type of a grid"));
    const std::string sharedWith = bytes.LengthAndText("the parent of a grid");
    const bool hasTree = sharedWith.empty(); // a grid that shares a tree has no leaves of its own

    VDBPlace& place = grid.Place;
    const auto afterNames = static_cast<std::int64_t>(bytes.Position() + 3 * sizeof(std::int64_t));
    place.Topology = bytes.Value<std::int64_t>("the place of a grid");
    place.Leaves = bytes.Value<std::int64_t>("the place of a grid");
    place.End = bytes.Value<std::int64_t>("the place of a grid");
    const bool inOrder = place.Topology == afterNames && place.End >= place.Topology &&
      (!hasTree || (place.Leaves >= place.Topology && place.End >= place.Leaves));
    if (!inOrder || place.End > static_cast<std::int64_t>(this->FileSize))
    {
      bytes.Fail("grid \"" + grid.Name + "\" does not lie where the list of grids says");
    }
    if (known.count(uniqueName))
    {
      bytes.Fail("two grids are named \"" + grid.Name + "\"");
    }
    const auto next = static_cast<std::uint64_t>(place.End);

    if (hasTree)
    {
      this->ReadGrid(grid);
    }
    else
    {
      const auto parent = known.find(sharedWith);
      if (parent == known.end() || this->AllGrids[parent->second].Type != grid.Type)
      {
        bytes.Fail("grid \"" + grid.Name + "\" shares the tree of a grid that is not there");
      }
      this->ShareTree(grid, this->AllGrids[parent->second]);
    }
    bytes.Seek(next, "the next grid");
    known[uniqueName] = this->AllGrids.size();
    this->AllGrids.push_back(std::move(grid));
  }
}

/// Reads a grid that has its own metadata and transform, but shares the tree of an earlier grid.
void VDBFile::ShareTree(VDBGrid& grid, const VDBGrid& with)
{
  VDBBytes bytes(this->FilePath, this->FileSize);
  bytes.Seek(static_cast<std::uint64_t>(grid.Place.Topology), "a grid");
  bytes.Skip(sizeof(std::uint32_t), "a grid"); // skips the compression flags of the grid
  grid.Metadata = ReadMetadata(bytes);
  ReadTransform(bytes, grid);
  grid.Unusable = grid.Unusable.empty() ? with.Unusable : grid.Unusable;
  grid.Tree = with.Tree;
  grid.Place = with.Place;
}

void VDBFile::ReadGrid(VDBGrid& grid)
{
  VDBPlace& place = grid.Place;
  VDBBytes bytes(this->FilePath, this->FileSize);
  bytes.Seek(static_cast<std::uint64_t>(place.Topology), "a grid");
  place.Compression = bytes.Value<std::uint32_t>("a grid's compression");
  const std::uint32_t knownFlags =
    openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_BLOSC;
  if (place.Compression & ~knownFlags)
  {
    bytes.Fail("grid \"" + grid.Name + "\" has an unknown compression");
  }
  grid.Metadata = ReadMetadata(bytes);
  const bool linear = ReadTransform(bytes, grid);
  const VDBValueType* type = FindValueType(grid.Type);
  if (type == nullptr)
  {
    grid.Unusable =
      "its type (" + grid.Type + ") is not one of float, double, int32, int64, bool, mask, vec3i, vec3s, vec3d";
  }
  if (type == nullptr || !linear)
  {
    return;
  }

  place.Topology = static_cast<std::int64_t>(bytes.Position());
  VDBValues values(*type, place.Half, place.Compression);
  grid.Tree = VDBTreeWalk(bytes, *type, values).Walk();
  if (bytes.Position() != static_cast<std::uint64_t>(place.Leaves))
  {
    bytes.Fail("the tree of grid \"" + grid.Name + "\" does not end where its leaves begin");
  }
}

void VDBFile::CheckLeaves(const VDBGrid& grid)
{
  const VDBValueType& type = *FindValueType(grid.Type);
  VDBBytes topology(this->FilePath, this->FileSize);
  VDBBytes leaves(this->FilePath, this->FileSize);
  topology.Seek(static_cast<std::uint64_t>(grid.Place.Topology), "a grid");
  leaves.Seek(static_cast<std::uint64_t>(grid.Place.Leaves), "a grid's leaves");
  VDBValues values(type, grid.Place.Half, grid.Place.Compression);
  const auto checkLeaf = [&](const VoxelCorner& corner, const VDBLeafMask& mask) {
    if (leaves.Value<decltype(mask.Words)>("a leaf's mask") != mask.Words)
    {
      leaves.Fail("a leaf's active voxels differ from those of the tree");
    }
    if (type.Leaves == VDBValueType::Numbers)
    {
      values.Check(leaves, mask.CountOn(), mask.Count, false);
      return;
    }
    for (std::int64_t x : corner)
    {
      if (leaves.Value<std::int32_t>("a leaf's corner") != x)
      {
        leaves.Fail("a leaf lies elsewhere than in the tree");
      }
    }
    if (type.Leaves == VDBValueType::Bool)
    {
      leaves.Skip(sizeof(mask.Words), "a leaf's values");
    }
  };
  VDBTreeWalk(topology, type, values, checkLeaf).Walk();
  if (leaves.Position() != static_cast<std::uint64_t>(grid.Place.End))
  {
    leaves.Fail("the leaves of grid \"" + grid.Name + "\" do not end where the grid does");
  }
}

openvdb::GridBase::Ptr VDBFile::Read(const VDBGrid& grid, const openvdb::CoordBBox& box)
{
  this->CheckLeaves(grid);

  const auto metadata = std::make_shared<openvdb::io::StreamMetadata>();
  metadata->setSeekable(true); // required to skip leaves outside of the box
  metadata->setFileVersion(this->FormatVersion);
  metadata->setLibraryVersion(this->LibraryVersion);
  metadata->setCompression(grid.Place.Compression);
  metadata->setHalfFloat(grid.Place.Half);
  openvdb::io::StreamMetadata::Ptr shared = metadata;
  std::ifstream stream(this->FilePath, std::ios::binary);
  openvdb::io::setStreamMetadataPtr(stream, shared, /*transfer=*/true);

  const openvdb::GridBase::Ptr loaded = openvdb::GridBase::createGrid(FindValueType(grid.Type)->GridType());
  loaded->setSaveFloatAsHalf(grid.Place.Half);
  try
  {
    stream.seekg(grid.Place.Topology);
    loaded->readTopology(stream);
    stream.seekg(grid.Place.Leaves);
    loaded->readBuffers(stream, box);
  }
  catch (const std::exception& error)
  {
    throw InvalidInput("\"" + this->FilePath + "\" is corrupt: the values of grid \"" + grid.Name +
      "\" cannot be read (" + error.what() + "). Copy or write the file again.");
  }
  Require(!stream.fail(), "\"" + this->FilePath + "\" changed or could not be read while it was loaded. Try again.");
  return loaded;
}

bool DescribesTheFile(const std::string& key)
{
  using Grid = openvdb::GridBase;
  return key == Grid::META_SAVE_HALF_FLOAT || key == Grid::META_FILE_BBOX_MIN || key == Grid::META_FILE_BBOX_MAX ||
    key == Grid::META_FILE_COMPRESSION || key == Grid::META_FILE_MEM_BYTES || key == Grid::META_FILE_VOXEL_COUNT ||
    key == Grid::META_FILE_DELAYED_LOAD;
}

namespace
{
/// Reads a grid's map from index to world space if it is one of OpenVDB's linear maps.
/// @return whether `type` is a linear map
bool ReadLinearMap(VDBBytes& bytes, const std::string& type, VDBGrid& grid)
{
  const auto vector = [&] { return bytes.Value<std::array<double, 3>>("the transform"); };
  const auto diagonal = [&](const std::array<double, 3>& scale) {
    for (int axis = 0; axis < 3; ++axis)
    {
      grid.Axes[axis][axis] = scale[axis];
    }
  };
  if (type == "AffineMap" || type == "UnitaryMap") // the 4 x 4 matrix multiplies row vectors from the right
  {
    for (int row = 0; row < 4; ++row)
    {
      (row < 3 ? grid.Axes[row] : grid.Translation) = vector();
      bytes.Skip(sizeof(double), "the transform");
    }
  }
  else if (type == "ScaleMap" || type == "UniformScaleMap") // the scale, then four vectors that follow from it
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
    return false;
  }
  return true;
}

double TripleProduct(const std::array<std::array<double, 3>, 3>& v)
{
  return v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) + v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
    v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
}

/// Reason why an image cannot represent the grid's map from index to world space; empty if it can. Also sets
/// VDBGrid::Shears.
std::string FaultOfMap(VDBGrid& grid)
{
  const auto dot = [&](int i, int j) {
    const auto &a = grid.Axes[i], &b = grid.Axes[j];
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  double lengths[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    lengths[axis] = std::sqrt(dot(axis, axis));
    if (!std::isfinite(lengths[axis]) || lengths[axis] <= 0.0 || !std::isfinite(grid.Translation[axis]))
    {
      return "its transform gives voxels no size";
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const int next = (axis + 1) % 3;
    const double volume = TripleProduct(grid.Axes);
    if (!(std::abs(volume) > 1e-9 * lengths[0] * lengths[1] * lengths[2]))
    {
      return "its transform gives voxels no volume";
    }
    grid.Shears = grid.Shears || !(std::abs(dot(axis, next) / lengths[axis] / lengths[next]) < 1e-6);
  }
  return {};
}
}

openvdb::MetaMap ReadMetadata(VDBBytes& bytes)
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

bool ReadTransform(VDBBytes& bytes, VDBGrid& grid)
{
  const std::string type = bytes.LengthAndText("the type of the transform");
  if (!ReadLinearMap(bytes, type, grid))
  {
    grid.Unusable = "its transform (" + type +
      ") is not linear; an image needs one. Resample the grid, for example with OpenVDB's resampleToMatch";
    return false;
  }
  grid.Unusable = FaultOfMap(grid);
  return true;
}
}
