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

/// Adds metadata as field data `<prefix><key>`, if VTK has their type, except metadata that the image itself expresses.
void AddMetadata(vtkDataObject* image, const std::string& prefix, const openvdb::MetaMap& map);

/// Restores metadata from field data whose names start with `prefix`, except a grid's type and background and the
/// entries that describe the file it was read from.
void RestoreMetadata(openvdb::MetaMap& map, vtkFieldData* field, const std::string& prefix);

/// Adds field data that define a medium in addition to its cell arrays (`g`, `phase_function` and its parameters). In a
/// file they are metadata of the same names with the prefix `medium_`; rows of a table are stored as text.
void AddMediumFacts(vtkDataObject* image, const openvdb::MetaMap& file);
void NoteMediumFacts(openvdb::MetaMap& file, vtkFieldData* field);
}
