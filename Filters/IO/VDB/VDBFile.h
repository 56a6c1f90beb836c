#pragma once

#include "IO/VDB/VDBGrid.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tyndall
{
/// Reads .vdb files that may be truncated or corrupt.
///
/// OpenVDB trusts its files: sizes of strings, compressed blocks and masks in the file determine how much it allocates
/// and how far it writes (a compressed block that claims to be longer than its node overruns the node), and a buffer
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
  /// @throws InvalidInput as the constructor does
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
