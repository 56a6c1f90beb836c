#pragma once

#include "OpenVDB.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

/// Reads .vdb files that may be truncated or corrupt.
///
/// OpenVDB trusts its files: the sizes of strings, compressed blocks and masks that it reads decide how much it allocates
/// and how far it writes (a compressed block that claims to be longer than its node overruns the node), and a buffer whose
/// delayed load fails is freed twice. So io::File is not used. The file is walked here first, and every number that OpenVDB
/// would believe is held against the file's size and the node it belongs to; then OpenVDB reads the trees from the checked
/// places. Opening walks the topology, which says where there are active voxels, and no voxel values; Read walks and loads
/// the leaves of one grid, and only those that overlap the wanted box.
///
/// Limits: the format has no check sums, so a changed voxel value is not noticed (but where zlib's or Blosc's does). A file
/// that another process changes between walk and load is not defended against.
namespace tyndall
{
/// Voxels, inclusive; wide enough for any corner that a file can name.
struct VoxelBox
{
  std::array<std::int64_t, 3> Min = { INT64_MAX, INT64_MAX, INT64_MAX };
  std::array<std::int64_t, 3> Max = { INT64_MIN, INT64_MIN, INT64_MIN };

  bool Empty() const { return this->Min[0] > this->Max[0]; }
  void Add(const VoxelBox& other);
};

/// One grid of a file, as known without its voxel values.
struct VDBGrid
{
  std::string Name;      ///< unique in the file: grids of the same name are called name[0], name[1], ...
  std::string Type;      ///< float, double, int32, int64, bool, mask, vec3i, vec3s, vec3d; else OpenVDB's name of it
  std::string Unusable;  ///< why the grid cannot become an image; empty: it can
  bool Half = false;     ///< its numbers are stored in 16 bits
  std::string Background; ///< the background value, its bytes
  std::array<std::array<double, 3>, 3> Axes = {};   ///< world vectors of a step of one voxel along i, j, k
  std::array<double, 3> Translation = { 0, 0, 0 };  ///< world position of index (0, 0, 0), the centre of that voxel
  VoxelBox ActiveBox;
  std::uint64_t ActiveVoxels = 0; ///< tiles counted by the voxels they stand for; saturates
  std::uint64_t TreeBytes = 0;    ///< memory that the tree takes with all its leaves loaded
  openvdb::MetaMap Metadata;      ///< without what describes the file (file_bbox_min, ...)

  // Where it is in the file.
  std::int64_t TopologyPosition = 0, BufferPosition = 0, EndPosition = 0;
  std::uint32_t Compression = 0;
};

class VDBFile
{
public:
  /// Whether the file begins as a .vdb file does.
  static bool HasMagic(const std::string& path);

  /// Opens the file and checks its structure.
  /// @throws InvalidInput naming the file, what is wrong and where (byte)
  explicit VDBFile(const std::string& path);

  const std::string& Path() const { return this->FilePath; }
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

  std::string FilePath;
  std::uint64_t FileSize = 0;
  std::uint32_t FormatVersion = 0;
  openvdb::VersionId LibraryVersion{ 0, 0 };
  std::uint64_t FirstDescriptor = 0;
  openvdb::MetaMap FileMetadata;
  std::vector<VDBGrid> AllGrids;
};
}
