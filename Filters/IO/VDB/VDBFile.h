#pragma once

#include "IO/VDB/VDBBytes.h"
#include "IO/VDB/VDBTreeWalk.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tyndall
{
class VDBBytes;

/// Position of a tree in its file, and its storage format.
struct VDBPlace
{
  /// Offsets in the file of the tree's topology, of its leaves and of its end, bytes.
  std::int64_t Topology = 0, Leaves = 0, End = 0;
  std::uint32_t Compression = 0; ///< OpenVDB's compression flags
  bool Half = false;             ///< whether numbers are stored in 16 bits
};

/// Description of one grid of a file: everything that is known without its voxel values.
struct VDBGrid
{
  std::string Name;     ///< name, unique in the file; grids of the same name are called name[0], name[1], ...
  std::string Type;     ///< type name that FindValueType accepts, or else OpenVDB's name of the type
  std::string Unusable; ///< why the grid cannot become an image; empty: it can
  /// Whether the axes are not at right angles, so that the grid becomes an image only if it is resampled.
  bool Shears = false;
  std::array<std::array<double, 3>, 3> Axes = {};  ///< world vectors of a step by one voxel along i, j, k
  std::array<double, 3> Translation = { 0, 0, 0 }; ///< world position of the centre of voxel (0, 0, 0)
  /// Metadata of the grid without the entries that describe the file (file_bbox_min, ...).
  openvdb::MetaMap Metadata;
  VDBTopology Tree;
  VDBPlace Place;
};

/// Whether metadata of this name describe how a file stores a grid (16-bit numbers, number of bytes), not the grid
/// itself. OpenVDB computes these metadata when it writes a file.
bool DescribesTheFile(const std::string& key);

/// Reads a list of metadata of types known to OpenVDB; skips other types, and metadata that describe the file.
/// @throws InvalidInput if there are no valid metadata at this position of the file
openvdb::MetaMap ReadMetadata(VDBBytes& bytes);

/// Reads a grid's linear map; if the grid cannot become an image, sets VDBGrid::Unusable.
/// @return whether the map is linear; if not, the length of the following data in the file is unknown
bool ReadTransform(VDBBytes& bytes, VDBGrid& grid);

/// Reads .vdb files that may be truncated or corrupt.
///
/// OpenVDB trusts its files: sizes of strings, compressed blocks and masks in the file determine how much it allocates
/// and how far it writes. A compressed block that claims to be longer than its node overruns the node, and a buffer
/// whose delayed load fails is freed twice. Therefore io::File is not used. This class first walks through the file and
/// checks every number that OpenVDB would trust against the file's size and the node it belongs to; then OpenVDB reads
/// the trees from the checked positions. Opening a file walks the topology, which tells where active voxels are, and
/// reads no voxel values; Read walks the leaves of one grid and loads only those that overlap the requested box.
///
/// Limits: the format has no check sums, so a changed voxel value is not detected (unless zlib or Blosc detects it).
/// Changes made by another process between walk and load are not detected.
class VDBFile
{
public:
  /// Whether the file starts like a .vdb file.
  static bool HasMagic(const std::string& path);

  /// Opens the file and checks its structure.
  /// @throws InvalidInput naming the file, the error and its position (byte)
  explicit VDBFile(const std::string& path);

  const std::string& Path() const { return this->FilePath; }
  std::uint64_t Size() const { return this->FileSize; }
  const openvdb::MetaMap& Metadata() const { return this->FileMetadata; }
  const std::vector<VDBGrid>& Grids() const { return this->AllGrids; }
  const VDBGrid* Find(const std::string& name) const;

  /// Checks all leaves of a grid and loads those that overlap a box; outside the box the tree is background.
  /// @throws InvalidInput naming the file, the error and its position (byte)
  openvdb::GridBase::Ptr Read(const VDBGrid& grid, const openvdb::CoordBBox& box);

  /// Checks all leaves of a grid without loading them.
  void CheckLeaves(const VDBGrid& grid);

private:
  void ReadHeader();
  void ReadDescriptors();
  void ReadGrid(VDBGrid& grid);
  void ShareTree(VDBGrid& grid, const VDBGrid& with);

  std::string FilePath;
  std::uint64_t FileSize = 0;
  std::uint32_t FormatVersion = 0;
  openvdb::VersionId LibraryVersion{ 0, 0 };
  std::uint64_t FirstDescriptor = 0;
  openvdb::MetaMap FileMetadata;
  std::vector<VDBGrid> AllGrids;
};
}
