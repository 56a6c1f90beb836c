#pragma once

#include "vtkCellData.h"
#include "vtkImageData.h"
#include "vtksys/SystemTools.hxx"
#include "vtkTestUtilities.h"

// Visible, as in Filters/IO/VDB/VDBBytes.h, which says why.
#pragma GCC visibility push(default)
#include <openvdb/openvdb.h>
#pragma GCC visibility pop

#include <fstream>
#include <iterator>
#include <memory>
#include <string>

/// Grids and files for the tests of what reads and writes .vdb files.
namespace test
{
/// Where a test's files are, a folder of its own.
inline std::string Folder;

/// Makes that folder, of that name, in the one that the test was given.
inline void UseFolder(const char* name, int argc, char* argv[])
{
  char* output = vtkTestUtilities::GetArgOrEnvOrDefault("-T", argc, argv, "TYNDALL_TEST_OUTPUT", ".");
  Folder = std::string(output) + "/" + name;
  delete[] output;
  vtksys::SystemTools::MakeDirectory(Folder);
}

inline std::string Path(const std::string& name)
{
  return Folder + "/" + name;
}

/// An empty grid. Its constructor stays in OpenVDB's library (see Filters/VDBCells.h).
/// @param type  of its tree, as OpenVDB names it: float, vec3s, ...
template <typename GridT>
typename GridT::Ptr NewGrid(const std::string& type, const std::string& name)
{
  auto grid = std::static_pointer_cast<GridT>(openvdb::GridBase::createGrid("Tree_" + type + "_5_4_3"));
  grid->setName(name);
  return grid;
}

inline void WriteGrids(const std::string& path, const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata = {})
{
  openvdb::io::File file(path);
  file.write(grids, metadata);
  file.close();
}

inline std::string ReadBytes(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
}

inline void WriteBytes(const std::string& path, const std::string& bytes)
{
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// A small fog that starts at index (-5, 3, 1000).
inline openvdb::FloatGrid::Ptr SmallFog(const char* name = "density")
{
  auto grid = NewGrid<openvdb::FloatGrid>("float", name);
  grid->tree().root().setBackground(0.25f, false);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  auto map =
    std::make_shared<openvdb::math::ScaleTranslateMap>(openvdb::Vec3d(0.5, 1.0, 2.0), openvdb::Vec3d(10, 20, 30));
  grid->setTransform(std::make_shared<openvdb::math::Transform>(map));
  for (int i = 0; i < 4; ++i)
  {
    grid->tree().setValue(openvdb::Coord(-5 + i, 3 + 2 * i, 1000 + 3 * i), float(i + 1));
  }
  grid->insertMeta("temperature", openvdb::FloatMetadata(300.5f));
  return grid;
}

inline bool IsEmpty(vtkImageData* image)
{
  return image->GetNumberOfCells() == 0 && image->GetCellData()->GetNumberOfArrays() == 0;
}
}
