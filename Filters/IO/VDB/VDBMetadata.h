#pragma once

#include "IO/VDB/OpenVDB.h"

#include <string>

class vtkDataObject;
class vtkFieldData;

/// Metadata of .vdb files as field data of images, and back.
namespace tyndall
{
/// Name of the field data that holds metadata `key` of a grid; of the file, if the grid's name is empty.
inline std::string FieldName(const std::string& grid, const std::string& key)
{
  return "vdb:" + grid + ":" + key;
}

/// Field data `<prefix><key>` for all metadata of types that VTK has too, but what an image says itself.
void AddMetadata(vtkDataObject* image, const std::string& prefix, const openvdb::MetaMap& map);

/// Metadata from field data whose names begin so, but a grid's type and background, and what
/// describes the file that it was in.
void RestoreMetadata(openvdb::MetaMap& map, vtkFieldData* field, const std::string& prefix);

/// Field data that define a medium beside its cells, `g`, `phase_function` and those that go with it, and what they are
/// in a file: metadata of the same names after `medium_`, the rows of a table as a text.
void AddMediumFacts(vtkDataObject* image, const openvdb::MetaMap& file);
void NoteMediumFacts(openvdb::MetaMap& file, vtkFieldData* field);
}
