#pragma once

#include "IO/VDB/VDBBytes.h"

#include <string>

class vtkDataObject;
class vtkFieldData;

/// Converts metadata of .vdb files to field data of images, and back.
namespace tyndall
{
/// Name of the field data that hold metadata `key` of a grid, or of the file if `grid` is empty.
inline std::string FieldName(const std::string& grid, const std::string& key)
{
  return "vdb:" + grid + ":" + key;
}

/// Adds metadata as field data `<prefix><key>`. Skips metadata of types that VTK lacks, the geometry (IsGeometry), and
/// properties of the medium (AddMediumFacts).
void AddMetadata(vtkDataObject* image, const std::string& prefix, const openvdb::MetaMap& map);

/// Restores metadata from field data whose names start with `prefix`. Skips a grid's type and background, and entries
/// that describe the file from which the grid was read.
void RestoreMetadata(openvdb::MetaMap& map, vtkFieldData* field, const std::string& prefix);

/// Adds the field data `g`, `phase_function` and its parameters, which define a medium in addition to its cell arrays.
/// In a file they are metadata of the same names with the prefix `medium_`; rows of a tabulated phase function are
/// stored as text.
void AddMediumFacts(vtkDataObject* image, const openvdb::MetaMap& file);
void NoteMediumFacts(openvdb::MetaMap& file, vtkFieldData* field);
}
