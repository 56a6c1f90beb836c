#include "TestSupport.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"
#include "vtkTestUtilities.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedLongLongArray.h"
#include "vtkVDBReader.h"
#include "vtkVDBWriter.h"
#include "vtksys/Directory.hxx"
#include "vtksys/SystemTools.hxx"

// Visible, as in Filters/OpenVDB.h, which says why.
#pragma GCC visibility push(default)
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/LevelSetSphere.h>
#pragma GCC visibility pop

#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <random>
#include <sys/resource.h>
#include <unistd.h>

namespace
{
std::string Folder;

std::string Path(const std::string& name)
{
  return Folder + "/" + name;
}

void WriteGrids(const std::string& path, const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata = {})
{
  openvdb::io::File file(path);
  file.write(grids, metadata);
  file.close();
}

std::string ReadBytes(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
}

void WriteBytes(const std::string& path, const std::string& bytes)
{
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// A small fog that starts at index (-5, 3, 1000).
openvdb::FloatGrid::Ptr SmallFog(const char* name = "density")
{
  auto grid = openvdb::FloatGrid::create(0.25f);
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  auto map = std::make_shared<openvdb::math::ScaleTranslateMap>(openvdb::Vec3d(0.5, 1.0, 2.0), openvdb::Vec3d(10, 20, 30));
  grid->setTransform(std::make_shared<openvdb::math::Transform>(map));
  for (int i = 0; i < 4; ++i)
  {
    grid->tree().setValue(openvdb::Coord(-5 + i, 3 + 2 * i, 1000 + 3 * i), float(i + 1));
  }
  grid->insertMeta("temperature", openvdb::FloatMetadata(300.5f));
  return grid;
}

bool IsEmpty(vtkImageData* image)
{
  return image->GetNumberOfCells() == 0 && image->GetCellData()->GetNumberOfArrays() == 0;
}

void VoxelsBecomeCells(test::Claims& claims)
{
  openvdb::MetaMap metadata;
  metadata.insertMeta("author", openvdb::StringMetadata("Tyndall"));
  WriteGrids(Path("fog.vdb"), { SmallFog() }, metadata);
  vtkNew<vtkVDBReader> reader;
  test::Errors errors(reader);
  claims.That(reader->CanReadFile(Path("fog.vdb").c_str()) == 1, "a .vdb file is known");
  reader->SetFileName(Path("fog.vdb").c_str());
  reader->Update();
  claims.That(errors.None(), "a sound file has no error");
  vtkImageData* image = reader->GetOutput();
  const int expected[6] = { -5, -1, 3, 10, 1000, 1010 };
  claims.That(std::equal(expected, expected + 6, image->GetExtent()), "the extent is the active box");
  claims.That(image->GetSpacing()[0] == 0.5 && image->GetSpacing()[2] == 2.0, "the spacing is the voxel size");
  claims.Near(image->GetOrigin()[0], 9.75, 1e-12, "origin x");
  claims.Near(image->GetOrigin()[2], 29.0, 1e-12, "origin z");
  vtkDataArray* density = image->GetCellData()->GetArray("density");
  if (!claims.That(density && density->GetDataType() == VTK_FLOAT, "there is a float array density"))
  {
    return;
  }
  double total = 0.0;
  for (vtkIdType cell = 0; cell < density->GetNumberOfTuples(); ++cell)
  {
    const double value = density->GetComponent(cell, 0);
    const int i = static_cast<int>(value) - 1;
    if (value == 0.25)
    {
      continue;
    }
    total += value;
    double bounds[6];
    image->GetCellBounds(cell, bounds);
    claims.Near(0.5 * (bounds[0] + bounds[1]), 10 + 0.5 * (-5 + i), 1e-12, "centre x of an active cell");
    claims.Near(0.5 * (bounds[4] + bounds[5]), 30 + 2.0 * (1000 + 3 * i), 1e-9, "centre z of an active cell");
  }
  claims.That(total == 10.0, "every active voxel is there, the others are background");
  vtkFieldData* field = image->GetFieldData();
  auto* author = vtkStringArray::SafeDownCast(field->GetAbstractArray("vdb::author"));
  claims.That(author && author->GetValue(0) == "Tyndall", "the file's metadata is field data");
  auto* kind = vtkStringArray::SafeDownCast(field->GetAbstractArray("vdb:density:class"));
  claims.That(kind && kind->GetValue(0) == "fog volume", "the grid's class is field data");
  vtkDataArray* temperature = field->GetArray("vdb:density:temperature");
  claims.That(temperature && temperature->GetComponent(0, 0) == 300.5, "the grid's metadata is field data");
  vtkDataArray* background = field->GetArray("vdb:density:background");
  claims.That(background && background->GetComponent(0, 0) == 0.25, "the background is field data");
  claims.That(std::string(reader->GetGridSummary()).find("density: float, 4 active voxels in [-5, 3, 1000] to [-2, 9, 1009]") == 0,
    std::string("the summary lists the grid, got ") + reader->GetGridSummary());

  // A part of it: only that part.
  const int part[6] = { -4, -2, 3, 8, 1002, 1006 };
  vtkNew<vtkVDBReader> partial;
  partial->SetFileName(Path("fog.vdb").c_str());
  partial->UpdateExtent(part);
  claims.That(std::equal(part, part + 6, partial->GetOutput()->GetExtent()), "a part has the extent asked for");
  bool same = true;
  for (int k = part[4]; k < part[5]; ++k)
  {
    for (int j = part[2]; j < part[3]; ++j)
    {
      for (int i = part[0]; i < part[1]; ++i)
      {
        int index[3] = { i, j, k };
        same = same && partial->GetOutput()->GetCellData()->GetArray("density")->GetComponent(
          partial->GetOutput()->ComputeCellId(index), 0) == density->GetComponent(image->ComputeCellId(index), 0);
      }
    }
  }
  claims.That(same, "a part has the whole's values");
}

void EveryTypeIsRead(test::Claims& claims)
{
  openvdb::GridPtrVec grids;
  const auto add = [&](auto grid, const char* name, auto value) {
    grid->setName(name);
    grid->tree().setValue(openvdb::Coord(1, 2, 3), value);
    grid->tree().setValueOn(openvdb::Coord(0, 0, 0));
    grids.push_back(grid);
  };
  add(openvdb::DoubleGrid::create(), "double", 1.0 / 3.0);
  add(openvdb::Int32Grid::create(), "int32", -7);
  add(openvdb::Int64Grid::create(), "int64", std::int64_t(1) << 40);
  add(openvdb::BoolGrid::create(), "bool", true);
  add(openvdb::Vec3IGrid::create(), "vec3i", openvdb::Vec3i(1, 2, 3));
  add(openvdb::Vec3SGrid::create(), "vec3s", openvdb::Vec3s(1, 2, 3));
  add(openvdb::Vec3DGrid::create(), "vec3d", openvdb::Vec3d(1, 2, 3));
  auto half = openvdb::FloatGrid::create();
  half->setSaveFloatAsHalf(true);
  add(half, "half", 0.5f);
  auto mask = openvdb::MaskGrid::create();
  mask->setName("mask");
  mask->tree().setValueOn(openvdb::Coord(1, 2, 3));
  grids.push_back(mask);
  auto tile = openvdb::FloatGrid::create();
  tile->setName("tile");
  tile->tree().addTile(1, openvdb::Coord(0, 0, 0), 3.0f, true);
  grids.push_back(tile);
  grids.push_back(tile->deepCopyGrid()); // of the same name
  auto shared = openvdb::FloatGrid::create(tile->treePtr());
  shared->setName("shared");
  grids.push_back(shared);
  WriteGrids(Path("types.vdb"), grids);

  vtkNew<vtkVDBReader> reader;
  test::Errors errors(reader);
  reader->SetFileName(Path("types.vdb").c_str());
  reader->Update();
  claims.That(errors.None(), "every type is read without an error");
  vtkImageData* image = reader->GetOutput();
  int index[3] = { 1, 2, 3 };
  const vtkIdType cell = image->ComputeCellId(index);
  const auto value = [&](const char* name, int component) {
    vtkDataArray* array = image->GetCellData()->GetArray(name);
    return array ? array->GetComponent(cell, component) : -1e9;
  };
  claims.That(value("double", 0) == 1.0 / 3.0, "double");
  claims.That(value("int32", 0) == -7, "int32");
  claims.That(value("int64", 0) == double(std::int64_t(1) << 40), "int64");
  claims.That(value("bool", 0) == 1 && value("mask", 0) == 1, "bool and mask");
  claims.That(value("vec3i", 2) == 3 && value("vec3s", 1) == 2 && value("vec3d", 0) == 1, "vectors");
  claims.That(value("half", 0) == 0.5, "half");
  claims.That(value("tile[0]", 0) == 3 && value("tile[1]", 0) == 3 && value("shared", 0) == 3, "tiles, same names, shared trees");
}

void TransformsThatFit(test::Claims& claims)
{
  auto rotated = SmallFog();
  auto transform = openvdb::math::Transform::createLinearTransform(0.1);
  transform->postRotate(0.7, openvdb::math::Z_AXIS);
  transform->postTranslate(openvdb::Vec3d(1, 2, 3));
  rotated->setTransform(transform);
  WriteGrids(Path("rotated.vdb"), { rotated });
  vtkNew<vtkVDBReader> reader;
  test::Errors errors(reader);
  reader->SetFileName(Path("rotated.vdb").c_str());
  reader->Update();
  claims.That(errors.None(), "a rotated grid is read");
  const double continuous[3] = { -5 + 0.5, 3 + 0.5, 1000 + 0.5 };
  double centre[3];
  reader->GetOutput()->TransformContinuousIndexToPhysicalPoint(continuous, centre);
  const openvdb::Vec3d expected = transform->indexToWorld(openvdb::Coord(-5, 3, 1000));
  claims.Near((openvdb::Vec3d(centre) - expected).length(), 0.0, 1e-10, "distance of a rotated voxel from its place");

  // Two grids that do not fit: by default the first one, both are an error.
  auto other = SmallFog("smoke");
  WriteGrids(Path("two.vdb"), { SmallFog(), rotated->deepCopyGrid(), other });
  reader->SetFileName(Path("two.vdb").c_str());
  reader->Update();
  claims.That(errors.None() && reader->GetOutput()->GetCellData()->GetNumberOfArrays() == 2,
    "grids on the first one's transform are read by default");
  reader->GetGridSelection()->EnableAllArrays();
  reader->Update();
  claims.That(errors.WasOneWith("different transforms"), "grids on two transforms are an error");
  claims.That(IsEmpty(reader->GetOutput()), "the output is empty then");

  auto sheared = SmallFog();
  auto shear = openvdb::math::Transform::createLinearTransform(1.0);
  shear->postShear(0.5, openvdb::math::X_AXIS, openvdb::math::Y_AXIS);
  sheared->setTransform(shear);
  auto frustum = SmallFog("frustum");
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
    openvdb::BBoxd(openvdb::Vec3d(0.0), openvdb::Vec3d(10.0)), 0.5, 10.0, 1.0));
  WriteGrids(Path("bent.vdb"), { sheared, frustum });
  vtkNew<vtkVDBReader> bent;
  test::Errors bentErrors(bent);
  bent->SetFileName(Path("bent.vdb").c_str());
  bent->SetGridName("density");
  bent->Update();
  claims.That(bentErrors.WasOneWith("shears"), "a sheared grid is an error");
  bent->SetGridName("frustum");
  bent->Update();
  claims.That(bentErrors.WasOneWith("not linear"), "a frustum is an error");
}

void WrongQuestionsAreErrors(test::Claims& claims)
{
  vtkNew<vtkVDBReader> reader;
  test::Errors errors(reader);
  const auto fails = [&](const std::string& path, const char* part, const char* claim) {
    reader->SetFileName(path.c_str());
    reader->Update();
    claims.That(errors.WasOneWith(part) && IsEmpty(reader->GetOutput()), claim);
  };
  reader->Update();
  claims.That(errors.WasOneWith("FileName"), "no file name is an error");
  WriteBytes(Path("empty.vdb"), "");
  WriteBytes(Path("text.vdb"), "a text that is no grid at all");
  fails(Path("none.vdb"), "cannot be read", "a missing file is an error");
  fails(Path("empty.vdb"), "is empty", "an empty file is an error");
  fails(Folder, "cannot be read", "a folder is an error");
  fails(Path("text.vdb"), "not an OpenVDB file", "another file is an error");
  claims.That(!reader->CanReadFile(Path("text.vdb").c_str()), "another file is not taken for a .vdb file");

  WriteGrids(Path("fog.vdb"), { SmallFog(), SmallFog("smoke") });
  reader->SetGridName("temprature");
  fails(Path("fog.vdb"), "no grid \"temprature\". It has \"density\", \"smoke\"", "a grid that is not there is an error");
  reader->SetGridName("smoke");
  reader->Update();
  claims.That(errors.None() && reader->GetOutput()->GetCellData()->GetNumberOfArrays() == 1, "the reader recovers");

  auto sparse = openvdb::FloatGrid::create();
  sparse->setName("sparse");
  sparse->tree().setValue(openvdb::Coord(0), 1.0f);
  sparse->tree().setValue(openvdb::Coord(99999), 1.0f);
  WriteGrids(Path("sparse.vdb"), { sparse });
  vtkNew<vtkVDBReader> large;
  test::Errors largeErrors(large);
  large->SetFileName(Path("sparse.vdb").c_str());
  large->Update();
  claims.That(largeErrors.WasOneWith("bytes"), "two voxels far apart need more memory than there is");
  claims.That(IsEmpty(large->GetOutput()), "the output is empty then");
  sparse->tree().clear();
  sparse->tree().setValue(openvdb::Coord(0), 1.0f);
  sparse->tree().setValue(openvdb::Coord(99), 1.0f);
  WriteGrids(Path("cube.vdb"), { sparse });
  large->SetFileName(Path("cube.vdb").c_str());
  large->Update();
  claims.That(largeErrors.None() && large->GetOutput()->GetNumberOfCells() == 1000000, "less far apart they fit");
  large->SetMaximumMemory(1);
  large->Update();
  claims.That(largeErrors.WasOneWith("the limit is 1 MiB"), "the limit is one's own");

  auto edge = openvdb::FloatGrid::create();
  edge->setName("edge");
  edge->tree().setValue(openvdb::Coord(INT32_MAX), 1.0f);
  WriteGrids(Path("edge.vdb"), { edge });
  vtkNew<vtkVDBReader> far;
  test::Errors farErrors(far);
  far->SetFileName(Path("edge.vdb").c_str());
  far->Update();
  claims.That(farErrors.WasOneWith("further than VTK counts"), "a voxel at the last index is an error");

  auto points = openvdb::points::PointDataGrid::create();
  points->setName("points");
  WriteGrids(Path("points.vdb"), { points });
  vtkNew<vtkVDBReader> cloud;
  test::Errors cloudErrors(cloud);
  cloud->SetFileName(Path("points.vdb").c_str());
  cloud->Update();
  claims.That(cloudErrors.WasOneWith("points"), "a file of points only is an error that names them");
}

void LevelSetsKeepTheirInside(test::Claims& claims)
{
  auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(20.0f, openvdb::Vec3f(0.0f), 1.0f);
  sphere->setName("surface");
  WriteGrids(Path("sphere.vdb"), { sphere });
  vtkNew<vtkVDBReader> reader;
  reader->SetFileName(Path("sphere.vdb").c_str());
  reader->Update();
  int middle[3] = { 0, 0, 0 };
  claims.That(reader->GetOutput()->GetCellData()->GetArray("surface")->GetComponent(
                reader->GetOutput()->ComputeCellId(middle), 0) == -3.0,
    "the inside of a level set is its negative background");
}

/// An image whose every detail the round trip must keep.
vtkSmartPointer<vtkImageData> AwkwardImage()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(-13, 10, 5, 22, -4, 7);
  image->SetOrigin(0.1, -1234567.891, 1e-9);
  image->SetSpacing(0.3, 1.0 / 3.0, 1e-3);
  const vtkIdType cells = image->GetNumberOfCells();
  std::mt19937 random(7);
  vtkNew<vtkFloatArray> density;
  density->SetName("density");
  vtkNew<vtkDoubleArray> velocity;
  velocity->SetName("velocity");
  velocity->SetNumberOfComponents(3);
  vtkNew<vtkTypeInt64Array> id;
  id->SetName("id");
  vtkNew<vtkUnsignedCharArray> flag;
  flag->SetName("flag");
  vtkNew<vtkFloatArray> constant;
  constant->SetName("constant");
  for (vtkIdType i = 0; i < cells; ++i)
  {
    density->InsertNextValue(random() % 3 ? 0.0f : std::ldexp(float(random()), -int(random() % 60)));
    velocity->InsertNextTuple3(double(random()) / 3.0, -double(i), 1e300);
    id->InsertNextValue((vtkTypeInt64(random()) << 32) - i);
    flag->InsertNextValue(static_cast<unsigned char>(random() % 2));
    constant->InsertNextValue(2.5f);
  }
  density->SetValue(3, std::numeric_limits<float>::quiet_NaN());
  density->SetValue(4, -0.0f);
  density->SetValue(5, std::numeric_limits<float>::infinity());
  density->SetValue(6, std::numeric_limits<float>::denorm_min());
  for (vtkDataArray* array : std::initializer_list<vtkDataArray*>{ density, velocity, id, flag, constant })
  {
    image->GetCellData()->AddArray(array);
  }
  vtkNew<vtkStringArray> type;
  type->SetName("vdb:flag:type");
  type->InsertNextValue("bool");
  vtkNew<vtkStringArray> creator;
  creator->SetName("vdb:density:creator");
  creator->InsertNextValue("a test");
  vtkNew<vtkDoubleArray> matrix;
  matrix->SetName("vdb::camera");
  matrix->SetNumberOfComponents(3);
  matrix->InsertNextTuple3(1, 2, 1.0 / 3.0);
  vtkNew<vtkFloatArray> background;
  background->SetName("vdb:constant:background");
  background->InsertNextValue(2.5f);
  for (vtkAbstractArray* array : std::initializer_list<vtkAbstractArray*>{ type, creator, matrix, background })
  {
    image->GetFieldData()->AddArray(array);
  }
  return image;
}

bool SameBits(vtkDataArray* a, vtkDataArray* b)
{
  return a && b && a->GetDataTypeSize() == b->GetDataTypeSize() && a->GetNumberOfValues() == b->GetNumberOfValues() &&
    a->GetNumberOfComponents() == b->GetNumberOfComponents() &&
    std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0), a->GetNumberOfValues() * a->GetDataTypeSize()) == 0;
}

void ARoundTripKeepsEveryBit(test::Claims& claims, int compression)
{
  const auto image = AwkwardImage();
  vtkNew<vtkVDBWriter> writer;
  test::Errors writeErrors(writer);
  writer->SetInputData(image);
  writer->SetFileName(Path("round.vdb").c_str());
  writer->SetCompression(compression);
  claims.That(writer->Write() == 1 && writeErrors.None(), "the image is written");
  vtkNew<vtkVDBReader> reader;
  test::Errors errors(reader);
  reader->SetFileName(Path("round.vdb").c_str());
  reader->Update();
  claims.That(errors.None(), "and read");
  vtkImageData* again = reader->GetOutput();
  claims.That(std::equal(image->GetExtent(), image->GetExtent() + 6, again->GetExtent()), "the same extent");
  claims.That(std::memcmp(image->GetOrigin(), again->GetOrigin(), 24) == 0, "the same origin");
  claims.That(std::memcmp(image->GetSpacing(), again->GetSpacing(), 24) == 0, "the same spacing");
  claims.That(again->GetDirectionMatrix()->IsIdentity(), "the same direction");
  for (const char* name : { "density", "velocity", "id", "flag", "constant" })
  {
    claims.That(SameBits(image->GetCellData()->GetArray(name), again->GetCellData()->GetArray(name)),
      std::string("every bit of ") + name);
  }
  vtkFieldData* field = again->GetFieldData();
  auto* creator = vtkStringArray::SafeDownCast(field->GetAbstractArray("vdb:density:creator"));
  claims.That(creator && creator->GetValue(0) == "a test", "the grid's metadata");
  claims.That(SameBits(image->GetFieldData()->GetArray("vdb::camera"), field->GetArray("vdb::camera")), "the file's");
  claims.That(SameBits(image->GetFieldData()->GetArray("vdb:constant:background"), field->GetArray("vdb:constant:background")),
    "the background");

  // Once more, from what was read: the same grids.
  writer->SetInputConnection(reader->GetOutputPort());
  writer->SetFileName(Path("again.vdb").c_str());
  writer->Write();
  claims.That(writeErrors.None(), "what was read is written");
  openvdb::io::File first(Path("round.vdb")), second(Path("again.vdb"));
  first.open();
  second.open();
  const auto a = first.getGrids(), b = second.getGrids();
  bool same = a->size() == b->size();
  for (std::size_t i = 0; same && i < a->size(); ++i)
  {
    same = a->at(i)->type() == b->at(i)->type() && a->at(i)->activeVoxelCount() == b->at(i)->activeVoxelCount() &&
      static_cast<openvdb::MetaMap&>(*a->at(i)).metaCount() == static_cast<openvdb::MetaMap&>(*b->at(i)).metaCount() &&
      a->at(i)->transform() == b->at(i)->transform();
  }
  claims.That(same, "a second round trip gives the same types, voxels, metadata and transforms");
}

void OtherImagesAreWritten(test::Claims& claims)
{
  // A flat one, with point data and many components.
  vtkNew<vtkImageData> flat;
  flat->SetExtent(2, 6, 3, 5, 4, 4);
  vtkNew<vtkFloatArray> points;
  points->SetName("height");
  points->SetNumberOfTuples(flat->GetNumberOfPoints());
  points->Fill(3.0);
  flat->GetPointData()->AddArray(points);
  vtkNew<vtkFloatArray> many;
  many->SetName("many");
  many->SetNumberOfComponents(2);
  many->SetNumberOfTuples(flat->GetNumberOfCells());
  many->FillComponent(0, 1.0);
  many->FillComponent(1, 2.0);
  flat->GetCellData()->AddArray(many);
  vtkNew<vtkVDBWriter> writer;
  test::Errors errors(writer);
  writer->SetInputData(flat);
  writer->SetFileName(Path("flat.vdb").c_str());
  writer->Write();
  claims.That(errors.None(), "a flat image is written");
  vtkNew<vtkVDBReader> reader;
  reader->SetFileName(Path("flat.vdb").c_str());
  reader->Update();
  vtkImageData* again = reader->GetOutput();
  claims.That(std::equal(flat->GetExtent(), flat->GetExtent() + 6, again->GetExtent()), "a flat image stays flat");
  vtkDataArray* height = again->GetCellData()->GetArray("height");
  claims.That(height && height->GetNumberOfTuples() == 8 && height->GetComponent(7, 0) == 3.0, "points are averaged to cells");
  vtkDataArray* second = again->GetCellData()->GetArray("many_1");
  claims.That(second && second->GetComponent(0, 0) == 2.0, "components become grids");

  // Tolerance and half change values, by no more than they say.
  vtkNew<vtkImageData> image;
  image->SetDimensions(33, 33, 33);
  vtkNew<vtkFloatArray> smooth;
  smooth->SetName("smooth");
  for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
  {
    smooth->InsertNextValue(1.0f + 0.001f * float(i % 10));
  }
  image->GetCellData()->AddArray(smooth);
  writer->SetInputData(image);
  writer->SetFileName(Path("smooth.vdb").c_str());
  writer->Write();
  const std::size_t exact = ReadBytes(Path("smooth.vdb")).size();
  writer->SetTolerance(0.01);
  writer->SetSaveAsHalf(true);
  writer->Write();
  claims.That(2 * ReadBytes(Path("smooth.vdb")).size() < exact, "a tolerance makes the file smaller");
  reader->SetFileName(Path("smooth.vdb").c_str());
  reader->Update();
  vtkDataArray* rough = reader->GetOutput()->GetCellData()->GetArray("smooth");
  double worst = 1.0;
  for (vtkIdType i = 0; rough && i < smooth->GetNumberOfTuples(); ++i)
  {
    worst = i == 0 ? 0.0 : worst;
    worst = std::max(worst, std::abs(rough->GetComponent(i, 0) - smooth->GetComponent(i, 0)));
  }
  claims.That(worst <= 0.0105 && worst > 0.0, "and changes values by no more than it says");

  vtkNew<vtkUnsignedLongLongArray> huge;
  huge->SetName("huge");
  huge->SetNumberOfTuples(image->GetNumberOfCells());
  huge->Fill(1);
  huge->SetValue(2, std::numeric_limits<unsigned long long>::max());
  image->GetCellData()->AddArray(huge);
  image->Modified();
  writer->Write();
  claims.That(errors.WasOneWith("\"huge\""), "an integer that does not fit is an error");
}

void AFailedWriteLeavesNothing(test::Claims& claims)
{
  vtkNew<vtkVDBWriter> writer;
  test::Errors errors(writer);
  writer->SetInputData(AwkwardImage());
  writer->Write();
  claims.That(errors.WasOneWith("FileName"), "no file name is an error");
  writer->SetFileName(Path("no/such/folder/x.vdb").c_str());
  writer->Write();
  claims.That(errors.WasOneWith("cannot be written"), "a folder that is not there is an error");

  // A disk that is full after 4 kB.
  const std::string full = Path("full");
  vtksys::SystemTools::RemoveADirectory(full);
  vtksys::SystemTools::MakeDirectory(full);
  writer->SetFileName((full + "/x.vdb").c_str());
  struct rlimit before;
  getrlimit(RLIMIT_FSIZE, &before);
  struct rlimit small = before;
  small.rlim_cur = 4096;
  auto* handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  writer->Write();
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  claims.That(errors.WasOneWith("cannot be written"), "a full disk is an error");
  claims.That(vtksys::Directory::GetNumberOfFilesInDirectory(full) == 2, "and leaves no file (but . and ..)");
  claims.That(writer->Write() == 1 && errors.None(), "with room the same writer writes");

  vtkNew<vtkImageData> empty;
  vtkNew<vtkVDBWriter> nothing;
  test::Errors nothingErrors(nothing);
  nothing->SetInputData(empty);
  nothing->SetFileName(Path("nothing.vdb").c_str());
  nothing->Write();
  claims.That(nothingErrors.WasOneWith("no cells"), "an image without cells is an error");
}

/// A small file with every kind of thing in it.
std::string SmallFile(int compression)
{
  auto fog = SmallFog();
  fog->tree().addTile(2, openvdb::Coord(128, 0, 1024), 9.0f, true);
  auto velocity = openvdb::Vec3SGrid::create();
  velocity->setName("velocity");
  velocity->setTransform(fog->transformPtr());
  velocity->setSaveFloatAsHalf(true);
  auto inside = openvdb::BoolGrid::create();
  inside->setName("inside");
  inside->setTransform(fog->transformPtr());
  for (int i = 0; i < 12; ++i)
  {
    velocity->tree().setValue(openvdb::Coord(i, i, 1000), openvdb::Vec3s(float(i)));
    inside->tree().setValue(openvdb::Coord(i, 0, 1000), i % 2 == 0);
  }
  openvdb::io::File file(Path("small.vdb"));
  file.setCompression(static_cast<std::uint32_t>(compression) | openvdb::io::COMPRESS_ACTIVE_MASK);
  file.write({ fog, velocity, inside });
  file.close();
  return ReadBytes(Path("small.vdb"));
}

/// Damaged files: one error and no data, or data (what is damaged then is a value); and always a living application.
void DamagedFilesAreErrors(test::Claims& claims)
{
  vtkNew<vtkVDBReader> reader;
  reader->SetMaximumMemory(256);
  test::Errors errors(reader);
  const std::string path = Path("damaged.vdb");
  std::size_t truncations = 0, flips = 0, errorsOfFlips = 0;
  const auto readIt = [&] {
    reader->SetFileName(path.c_str());
    reader->Modified();
    reader->Update();
    const bool failed = !errors.None();
    return failed && errors.WasOneWith("damaged.vdb") && IsEmpty(reader->GetOutput()) ? 1 : failed ? -1 : 0;
  };
  const auto read = [&](const std::string& bytes) {
    WriteBytes(path, bytes);
    return readIt();
  };
  std::mt19937 random(20261121);
  for (int compression : { int(openvdb::io::COMPRESS_NONE), int(openvdb::io::COMPRESS_ZIP), int(openvdb::io::COMPRESS_BLOSC) })
  {
    const std::string whole = SmallFile(compression);
    claims.That(read(whole) == 0, "the whole file is read");
    bool allFound = true;
    const std::size_t step = compression == openvdb::io::COMPRESS_BLOSC ? 1 : 17;
    for (std::size_t cut = 1; cut <= whole.size(); cut += step, ++truncations)
    {
      allFound = truncate(path.c_str(), static_cast<off_t>(whole.size() - cut)) == 0 && readIt() == 1 && allFound;
    }
    claims.That(allFound, "every truncation is one error and no data");
    bool oneError = true;
    for (int seed = 0; seed < 1000; ++seed, ++flips)
    {
      std::string bytes = whole;
      for (int count = 1 + static_cast<int>(random() % 4); count > 0; --count)
      {
        bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
      }
      if (seed % 3 == 0)
      {
        bytes[random() % bytes.size()] = static_cast<char>(random());
      }
      const int result = read(bytes);
      oneError = oneError && result >= 0;
      errorsOfFlips += result == 1;
    }
    claims.That(oneError, "flipped bits are one error or other values");
  }
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  std::cout << truncations << " truncations, " << flips << " files with flipped bits (" << errorsOfFlips
            << " of them errors), peak memory " << usage.ru_maxrss / 1024 << " MiB\n";
  claims.That(usage.ru_maxrss < 1500L * 1024, "no damaged file makes the reader allocate wildly");
}
}

int TestVDBReader(int argc, char* argv[])
{
  char* folder = vtkTestUtilities::GetArgOrEnvOrDefault("-T", argc, argv, "TYNDALL_TEST_OUTPUT", ".");
  Folder = std::string(folder) + "/VDB";
  delete[] folder;
  vtksys::SystemTools::MakeDirectory(Folder);
  openvdb::initialize();

  test::Claims claims;
  VoxelsBecomeCells(claims);
  EveryTypeIsRead(claims);
  TransformsThatFit(claims);
  WrongQuestionsAreErrors(claims);
  LevelSetsKeepTheirInside(claims);
  for (int compression : { vtkVDBWriter::NONE, vtkVDBWriter::ZIP, vtkVDBWriter::BLOSC })
  {
    ARoundTripKeepsEveryBit(claims, compression);
  }
  OtherImagesAreWritten(claims);
  AFailedWriteLeavesNothing(claims);
  DamagedFilesAreErrors(claims);
  return claims.Result();
}
