#pragma once

#include "IO/VDB/OpenVDB.h"
#include "IO/VDB/VDBTreeWalk.h"

#include <array>
#include <cstdint>
#include <string>

namespace tyndall
{
class VDBBytes;

/// Where a tree is in its file, and how it is stored.
struct VDBPlace
{
  std::int64_t Topology = 0, Leaves = 0, End = 0; ///< bytes from the file's start
  std::uint32_t Compression = 0;                  ///< OpenVDB's flags
  bool Half = false;                              ///< its numbers are stored in 16 bits
};

/// One grid of a file, as known without its voxel values.
struct VDBGrid
{
  std::string Name;     ///< unique in the file: grids of the same name are called name[0], name[1], ...
  std::string Type;     ///< a name of FindValueType, or else OpenVDB's name of it
  std::string Unusable; ///< why the grid cannot become an image; empty: it can
  bool Shears = false;  ///< it can, but only resampled: its axes are not at right angles
  std::array<std::array<double, 3>, 3> Axes = {};  ///< world vectors of a step of one voxel along i, j, k
  std::array<double, 3> Translation = { 0, 0, 0 }; ///< world position of index (0, 0, 0), the centre of that voxel
  openvdb::MetaMap Metadata;                       ///< without what describes the file (file_bbox_min, ...)
  VDBTopology Tree;
  VDBPlace Place;
};

/// Whether metadata of this name describes how a file stores a grid (in 16 bits, in how many bytes), rather than the
/// grid; OpenVDB writes it anew.
bool DescribesTheFile(const std::string& key);

/// Metadata of types that OpenVDB knows; others (and what describes the file) are passed over.
/// @throws InvalidInput where there are none at this place of the file
openvdb::MetaMap ReadMetadata(VDBBytes& bytes);

/// Fills in a grid's linear map, or why it is Unusable.
/// @return whether it is linear; if not, what follows in the file is of unknown length
bool ReadTransform(VDBBytes& bytes, VDBGrid& grid);
}
