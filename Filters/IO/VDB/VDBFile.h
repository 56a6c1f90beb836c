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
/// OpenVDB trusts its files: the sizes of strings, compressed blocks and masks that it reads decide how much it
/// allocates and how far it writes (a compressed block that claims to be longer than its node overruns the node), and a
/// buffer whose delayed load fails is freed twice. So io::File is not used. The file is walked here first, and every
/// number that OpenVDB would believe is held against the file's size and the node it belongs to; then OpenVDB reads the
/// trees from the checked places. Opening walks the topology, which says where there are active voxels, and no voxel
/// values; Read walks and loads the leaves of one grid, and only those that overlap the wanted box.
///
/// Limits: the format has no check sums, so a changed voxel value is not noticed (but where zlib's or Blosc's does). A
/// file that another process changes between walk and load is not defended against.
class VDBFile
{
public:
  /// Whether the file begins as a .vdb file does.
  static bool HasMagic(const std::string& path);

  /// Opens the file and checks its structure.
  /// @throws InvalidInput naming the file, what is wrong and where (byte)
  explicit VDBFile(const std::string& path);

  const std::string& Path() const { return this->FilePath; }
  std::uint64_t Size() const { return this->FileSize; }
  const openvdb::MetaMap& Metadata() const { return this->FileMetadata; }
  const std::vector<VDBGrid>& Grids() const { return this->AllGrids; }
  const VDBGrid* Find(const std::string& name) const;

  /// Checks every leaf of a grid, and loads those that overlap a box; outside the box the tree is background.
  /// @throws InvalidInput as above
  openvdb::GridBase::Ptr Read(const VDBGrid& grid, const openvdb::CoordBBox& box);

  /// Checks every leaf of a grid, but loads none.
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
