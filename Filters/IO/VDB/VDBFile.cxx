#include "IO/VDB/VDBFile.h"

#include "Device/Errors.h"
#include "IO/Files.h"
#include "IO/VDB/VDBBytes.h"

#include <algorithm>
#include <fstream>
#include <memory>

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

/// Sets type and storage format of a grid from the type name in its file.
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
  if (this->FileSize == 0)
  {
    throw InvalidInput("\"" + this->FilePath + "\" is empty. Copy or write the file again.");
  }
  VDBBytes bytes(this->FilePath, this->FileSize);
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
  bytes.Skip(sizeof(std::uint32_t), "a grid"); // its compression
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
  metadata->setSeekable(true); // so that leaves outside the box are skipped
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
  if (!stream)
  {
    throw InvalidInput("\"" + this->FilePath + "\" changed or could not be read while it was loaded. Try again.");
  }
  return loaded;
}
}
