#pragma once

#include "IO/VDB/OpenVDB.h"
#include "IO/VDB/VDBTreeWalk.h"

#include <array>
#include <cstdint>
#include <string>

namespace tyndall
{
class VDBBytes;

/// Position of a tree in its file, and its storage format.
struct VDBPlace
{
  std::int64_t Topology = 0, Leaves = 0, End = 0; ///< bytes from the file's start
  std::uint32_t Compression = 0;                  ///< OpenVDB's flags
  bool Half = false;                              ///< whether numbers are stored in 16 bits
};

/// One grid of a file: everything known without its voxel values.
struct VDBGrid
{
  std::string Name;     ///< unique in the file; grids of the same name are called name[0], name[1], ...
  std::string Type;     ///< a name accepted by FindValueType, or else OpenVDB's name of the type
  std::string Unusable; ///< why the grid cannot become an image; empty: it can
  bool Shears = false;  ///< the axes are not at right angles, so the grid becomes an image only if it is resampled
  std::array<std::array<double, 3>, 3> Axes = {};  ///< world vectors of a step of one voxel along i, j, k
  std::array<double, 3> Translation = { 0, 0, 0 }; ///< world position of index (0, 0, 0), the centre of that voxel
  openvdb::MetaMap Metadata;                       ///< without the entries that describe the file (file_bbox_min, ...)
  VDBTopology Tree;
  VDBPlace Place;
};

/// Whether the metadata of this name describe how a file stores a grid (in 16 bits, in how many bytes) rather than the
/// grid itself. OpenVDB writes them anew.
bool DescribesTheFile(const std::string& key);

/// Reads metadata of types known to OpenVDB; skips other types, and metadata that describe the file.
/// @throws InvalidInput if there are no valid metadata at this position of the file
openvdb::MetaMap ReadMetadata(VDBBytes& bytes);

/// Reads a grid's linear map, or sets Unusable.
/// @return whether the map is linear; if not, the length of the following data in the file is unknown
bool ReadTransform(VDBBytes& bytes, VDBGrid& grid);
}
