#include "TestSupport.h"
#include "VDBScene.h"

#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkParticipatingMedium.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkVDBReader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

using test::Folder;
using test::IsEmpty;
using test::NewGrid;
using test::Path;
using test::SmallFog;
using test::WriteBytes;
using test::WriteGrids;

namespace
{
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
  claims.That(errors.None(), "a conservative file has no error");
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
  vtkDataArray* active = field->GetArray("active_part");
  claims.Near(active ? active->GetComponent(0, 0) : 0.0, 4.0 / 280.0, 1e-12, "the active part");
  auto* author = vtkStringArray::SafeDownCast(field->GetAbstractArray("vdb::author"));
  claims.That(author && author->GetValue(0) == "Tyndall", "the file's metadata is field data");
  auto* kind = vtkStringArray::SafeDownCast(field->GetAbstractArray("vdb:density:class"));
  claims.That(kind && kind->GetValue(0) == "fog volume", "the grid's class is field data");
  vtkDataArray* temperature = field->GetArray("vdb:density:temperature");
  claims.That(temperature && temperature->GetComponent(0, 0) == 300.5, "the grid's metadata is field data");
  vtkDataArray* background = field->GetArray("vdb:density:background");
  claims.That(background && background->GetComponent(0, 0) == 0.25, "the background is field data");
  claims.That(
    std::string(reader->GetGridSummary()).find("density: float, 4 active voxels in [-5, 3, 1000] to [-2, 9, 1009]") ==
      0,
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
        same = same &&
          partial->GetOutput()->GetCellData()->GetArray("density")->GetComponent(
            partial->GetOutput()->ComputeCellId(index), 0) == density->GetComponent(image->ComputeCellId(index), 0);
      }
    }
  }
  claims.That(same, "a part has the whole's values");
}

void EveryTypeIsRead(test::Claims& claims)
{
  openvdb::GridPtrVec grids;
  const auto add = [&](auto grid, auto value) {
    grid->tree().setValue(openvdb::Coord(1, 2, 3), value);
    grid->tree().setValueOn(openvdb::Coord(0, 0, 0));
    grids.push_back(grid);
  };
  add(NewGrid<openvdb::DoubleGrid>("double", "double"), 1.0 / 3.0);
  add(NewGrid<openvdb::Int32Grid>("int32", "int32"), -7);
  add(NewGrid<openvdb::Int64Grid>("int64", "int64"), std::int64_t(1) << 40);
  add(NewGrid<openvdb::BoolGrid>("bool", "bool"), true);
  add(NewGrid<openvdb::Vec3IGrid>("vec3i", "vec3i"), openvdb::Vec3i(1, 2, 3));
  add(NewGrid<openvdb::Vec3SGrid>("vec3s", "vec3s"), openvdb::Vec3s(1, 2, 3));
  add(NewGrid<openvdb::Vec3DGrid>("vec3d", "vec3d"), openvdb::Vec3d(1, 2, 3));
  auto half = NewGrid<openvdb::FloatGrid>("float", "half");
  half->setSaveFloatAsHalf(true);
  add(half, 0.5f);
  auto mask = NewGrid<openvdb::MaskGrid>("mask", "mask");
  mask->tree().setValueOn(openvdb::Coord(1, 2, 3));
  grids.push_back(mask);
  auto tile = NewGrid<openvdb::FloatGrid>("float", "tile");
  tile->tree().addTile(1, openvdb::Coord(0, 0, 0), 3.0f, true);
  grids.push_back(tile);
  grids.push_back(tile->deepCopyGrid()); // of the same name
  auto shared = NewGrid<openvdb::FloatGrid>("float", "shared");
  shared->setTree(tile->baseTreePtr());
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
  claims.That(
    value("tile[0]", 0) == 3 && value("tile[1]", 0) == 3 && value("shared", 0) == 3, "tiles, same names, shared trees");
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
  bent->ResampleOn();
  bent->Update();
  claims.That(bentErrors.None() && bent->GetOutput()->GetDirectionMatrix()->IsIdentity(), "it is resampled on request");
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
  // Again past the pipeline, as ParaView's reader of series does.
  vtkNew<vtkInformation> request;
  request->Set(vtkDemandDrivenPipeline::REQUEST_INFORMATION());
  reader->ProcessRequest(request, nullptr, reader->GetExecutive()->GetOutputInformation());
  claims.That(errors.WasOneWith("FileName"), "no file name is an error, once");
  WriteBytes(Path("empty.vdb"), "");
  WriteBytes(Path("text.vdb"), "a text that is no grid at all");
  fails(Path("none.vdb"), "cannot be read", "a missing file is an error");
  fails(Path("empty.vdb"), "is empty", "an empty file is an error");
  fails(Folder, "cannot be read", "a folder is an error");
  mkfifo(Path("pipe.vdb").c_str(), 0600);
  alarm(20); // ends the test where the reader waits for someone who writes
  fails(Path("pipe.vdb"), "is not a file but a pipe", "a pipe is an error");
  claims.That(!reader->CanReadFile(Path("pipe.vdb").c_str()), "a pipe is not taken for a .vdb file");
  alarm(0);
  fails(Path("text.vdb"), "not an OpenVDB file", "another file is an error");
  claims.That(!reader->CanReadFile(Path("text.vdb").c_str()), "another file is not taken for a .vdb file");

  WriteGrids(Path("fog.vdb"), { SmallFog(), SmallFog("smoke") });
  reader->SetGridName("temprature");
  fails(
    Path("fog.vdb"), "no grid \"temprature\". It has \"density\", \"smoke\"", "a grid that is not there is an error");
  reader->SetGridName("smoke");
  reader->Update();
  claims.That(errors.None() && reader->GetOutput()->GetCellData()->GetNumberOfArrays() == 1, "the reader recovers");

  auto sparse = NewGrid<openvdb::FloatGrid>("float", "sparse");
  sparse->tree().setValue(openvdb::Coord(0), 1.0f);
  sparse->tree().setValue(openvdb::Coord(99999), 1.0f);
  WriteGrids(Path("sparse.vdb"), { sparse });
  vtkNew<vtkVDBReader> large;
  test::Errors largeErrors(large);
  large->SetFileName(Path("sparse.vdb").c_str());
  large->Update();
  claims.That(largeErrors.WasOneWith("bytes"), "two voxels far apart need more memory than there is");
  claims.That(IsEmpty(large->GetOutput()), "the output is empty then");
  sparse->clear();
  sparse->tree().setValue(openvdb::Coord(0), 1.0f);
  sparse->tree().setValue(openvdb::Coord(99), 1.0f);
  WriteGrids(Path("cube.vdb"), { sparse });
  large->SetFileName(Path("cube.vdb").c_str());
  large->Update();
  claims.That(largeErrors.None() && large->GetOutput()->GetNumberOfCells() == 1000000, "less far apart they fit");
  large->SetMaximumMemory(1);
  large->Update();
  claims.That(largeErrors.WasOneWith("the limit is 1 MiB"), "the limit is one's own");

  auto edge = NewGrid<openvdb::FloatGrid>("float", "edge");
  edge->tree().setValue(openvdb::Coord(INT32_MAX), 1.0f);
  WriteGrids(Path("edge.vdb"), { edge });
  vtkNew<vtkVDBReader> far;
  test::Errors farErrors(far);
  far->SetFileName(Path("edge.vdb").c_str());
  far->Update();
  claims.That(farErrors.WasOneWith("further than VTK counts"), "a voxel at the last index is an error");

  auto points = NewGrid<openvdb::GridBase>("ptdataidx32", "points");
  WriteGrids(Path("points.vdb"), { points });
  vtkNew<vtkVDBReader> cloud;
  test::Errors cloudErrors(cloud);
  cloud->SetFileName(Path("points.vdb").c_str());
  cloud->Update();
  claims.That(cloudErrors.WasOneWith("points"), "a file of points only is an error that names them");
}

void LevelSetsKeepTheirInside(test::Claims& claims)
{
  // A block of the inside between two voxels of the surface.
  auto sphere = NewGrid<openvdb::FloatGrid>("float", "surface");
  sphere->setGridClass(openvdb::GRID_LEVEL_SET);
  sphere->tree().root().setBackground(3.0f, false);
  sphere->tree().addTile(1, openvdb::Coord(0, 0, 0), -3.0f, false);
  sphere->tree().setValue(openvdb::Coord(-1, 0, 0), 1.0f);
  sphere->tree().setValue(openvdb::Coord(8, 7, 7), 1.0f);
  WriteGrids(Path("sphere.vdb"), { sphere });
  vtkNew<vtkVDBReader> reader;
  reader->SetFileName(Path("sphere.vdb").c_str());
  reader->Update();
  int middle[3] = { 4, 4, 4 };
  claims.That(reader->GetOutput()->GetCellData()->GetArray("surface")->GetComponent(
                reader->GetOutput()->ComputeCellId(middle), 0) == -3.0,
    "the inside of a level set is its negative background");

  reader->LevelSetsAsFogOn();
  reader->Update();
  vtkDataArray* const fog = reader->GetOutput()->GetCellData()->GetArray("surface");
  int corner[3] = { -1, 7, 7 };
  double range[2];
  fog->GetRange(range);
  claims.That(fog->GetComponent(reader->GetOutput()->ComputeCellId(middle), 0) == 1.0 &&
      fog->GetComponent(reader->GetOutput()->ComputeCellId(corner), 0) == 0.0 && range[0] == 0.0 && range[1] == 1.0,
    "fog is inside of the surface");
  auto* const kind =
    vtkStringArray::SafeDownCast(reader->GetOutput()->GetFieldData()->GetAbstractArray("vdb:surface:class"));
  claims.That(kind && kind->GetValue(0) == "fog volume", "it is a fog volume then");
  auto plain = SmallFog();
  WriteGrids(Path("plain.vdb"), { plain });
  reader->SetFileName(Path("plain.vdb").c_str());
  reader->Update();
  claims.That(reader->GetOutput()->GetCellData()->GetArray("density")->GetRange()[1] == 4.0, "a fog stays as it is");
}

/// Values that are linear in the world, in a box of voxels by any transform, are found where they are.
void AslantGridsAreResampled(test::Claims& claims)
{
  auto aslant = openvdb::math::Transform::createLinearTransform(0.5);
  aslant->postRotate(0.7, openvdb::math::Z_AXIS);
  aslant->postRotate(0.3, openvdb::math::X_AXIS);
  aslant->postTranslate(openvdb::Vec3d(1, -2, 3));
  auto sheared = openvdb::math::Transform::createLinearTransform(0.5);
  sheared->postShear(0.5, openvdb::math::X_AXIS, openvdb::math::Y_AXIS);
  const auto linear = [](const openvdb::Vec3d& at) { return 10.0 + 0.5 * at[0] - 0.25 * at[1] + at[2]; };
  for (const auto& transform : { aslant, sheared })
  {
    auto grid = NewGrid<openvdb::FloatGrid>("float", "linear");
    auto near = NewGrid<openvdb::Int32Grid>("int32", "near");
    for (int i = 0; i < 12 * 10 * 8; ++i)
    {
      const openvdb::Coord voxel(3 + i % 12, i / 12 % 10, i / 120 - 4);
      grid->tree().setValue(voxel, static_cast<float>(linear(transform->indexToWorld(voxel))));
      near->tree().setValue(voxel, 7);
    }
    grid->setTransform(transform);
    near->setTransform(transform);
    WriteGrids(Path("aslant.vdb"), { grid, near });
    vtkNew<vtkVDBReader> reader;
    test::Errors errors(reader);
    reader->SetFileName(Path("aslant.vdb").c_str());
    reader->ResampleOn();
    reader->Update();
    vtkImageData* const image = reader->GetOutput();
    claims.That(errors.None() && image->GetDirectionMatrix()->IsIdentity(), "a grid is resampled to the world's axes");
    claims.Near(image->GetSpacing()[0], 0.5, 1e-12, "the shortest edge");
    vtkDataArray* const values = image->GetCellData()->GetArray("linear");
    vtkDataArray* const integers = image->GetCellData()->GetArray("near");
    double worst = 0.0, inside = 0.0, filled = 0.0;
    for (vtkIdType cell = 0; cell < image->GetNumberOfCells(); ++cell)
    {
      double bounds[6];
      image->GetCellBounds(cell, bounds);
      const openvdb::Vec3d middle(
        0.5 * (bounds[0] + bounds[1]), 0.5 * (bounds[2] + bounds[3]), 0.5 * (bounds[4] + bounds[5]));
      const openvdb::Vec3d at = transform->worldToIndex(middle);
      const bool within = at[0] > 3 && at[0] < 14 && at[1] > 0 && at[1] < 9 && at[2] > -4 && at[2] < 3;
      worst = within ? std::max(worst, std::abs(values->GetComponent(cell, 0) - linear(middle))) : worst;
      inside += within ? 1.0 : 0.0;
      filled += integers->GetComponent(cell, 0) == 7.0 ? 1.0 : 0.0;
    }
    claims.That(inside > 200.0, "there are voxels within");
    claims.Near(worst, 0.0, 1e-5, "distance of a resampled value from the linear one");
    claims.Near(filled * std::pow(image->GetSpacing()[0], 3) / (960.0 * transform->voxelVolume()), 1.0, 0.03,
      "volume of what is filled");
    if (transform == aslant)
    {
      reader->ResampleOff();
      vtkNew<vtkParticipatingMedium> medium;
      test::Errors ofMedium(medium);
      medium->SetInputConnection(reader->GetOutputPort());
      medium->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "linear");
      medium->Update();
      const double* const direction = image->GetDirectionMatrix()->GetData();
      claims.That(ofMedium.None() && !image->GetDirectionMatrix()->IsIdentity() &&
          std::equal(direction, direction + 9, medium->GetOutput()->GetDirectionMatrix()->GetData()),
        "what is not resampled is a medium in its own axes");
    }
  }
}

/// Gives the reader's first choice of grids back to it as a choice of the user's, as ParaView does.
void GiveGridsBack(vtkVDBReader* reader)
{
  reader->UpdateInformation();
  for (int i = 0; i < reader->GetNumberOfGridArrays(); ++i)
  {
    const std::string name = reader->GetGridArrayName(i);
    reader->SetGridArrayStatus(name.c_str(), reader->GetGridArrayStatus(name.c_str()));
  }
}

void ResampleMayBeSetAtAnyTime(test::Claims& claims)
{
  auto sheared = openvdb::math::Transform::createLinearTransform(1.0);
  sheared->postShear(0.5, openvdb::math::X_AXIS, openvdb::math::Y_AXIS);
  auto first = SmallFog(), second = SmallFog("smoke");
  first->setTransform(sheared);
  second->setTransform(sheared);
  WriteGrids(Path("sheared.vdb"), { first, second });
  WriteGrids(Path("mixed.vdb"), { first, SmallFog("straight") });

  vtkNew<vtkVDBReader> before;
  before->ResampleOn();
  before->SetFileName(Path("sheared.vdb").c_str());
  before->Update();
  const std::vector<int> expected(before->GetOutput()->GetExtent(), before->GetOutput()->GetExtent() + 6);
  const auto isRead = [&](vtkImageData* image) {
    return image->GetCellData()->GetNumberOfArrays() == 2 &&
      std::equal(expected.begin(), expected.end(), image->GetExtent());
  };
  claims.That(isRead(before->GetOutput()), "Resample before the file reads all of its grids");

  vtkNew<vtkVDBReader> after;
  test::Errors errors(after);
  after->SetFileName(Path("sheared.vdb").c_str());
  GiveGridsBack(after);
  claims.That(errors.None(), "that a grid shears is no error before it is read");
  after->ResampleOn();
  after->Update();
  claims.That(errors.None() && isRead(after->GetOutput()), "Resample after the file reads the same");
  after->ResampleOff();
  after->Update();
  claims.That(errors.WasOneWith("Switch Resample on") && IsEmpty(after->GetOutput()), "without it they are an error");
  after->ResampleOn();
  after->Update();
  claims.That(errors.None() && isRead(after->GetOutput()), "Resample after the error reads the same");

  for (const bool isFirst : { true, false })
  {
    vtkNew<vtkVDBReader> reader;
    reader->SetResample(isFirst);
    reader->SetFileName(Path("mixed.vdb").c_str());
    GiveGridsBack(reader);
    reader->ResampleOn();
    reader->Update();
    vtkCellData* const cells = reader->GetOutput()->GetCellData();
    claims.That(cells->GetNumberOfArrays() == 1 && cells->HasArray("straight"),
      "grids that need no Resample are chosen at first, whether or not it is on");
  }
}

/// A cube of `edge` voxels, each with its edge as value, from index `edge` on; 0: a grid without active voxels, -1:
/// none.
void WriteCube(const std::string& name, int edge)
{
  auto grid = NewGrid<openvdb::FloatGrid>("float", "density");
  for (int i = 0; i < edge * edge * edge; ++i)
  {
    grid->tree().setValue(
      openvdb::Coord(edge + i % edge, edge + i / edge % edge, edge + i / edge / edge), static_cast<float>(edge));
  }
  WriteGrids(Path(name), edge < 0 ? openvdb::GridPtrVec() : openvdb::GridPtrVec{ grid });
}

/// That an image has the extent and the values of a cube.
void IsCube(test::Claims& claims, vtkImageData* image, const char* array, int edge, const std::string& where)
{
  const int cells = std::max(edge * edge * edge, 0);
  const int expected[6] = { edge, 2 * edge, edge, 2 * edge, edge, 2 * edge };
  vtkDataArray* const values = image->GetCellData()->GetArray(array);
  claims.That(image->GetNumberOfCells() == cells, where + " has the cells of its file");
  if (cells > 0 && claims.That(values != nullptr, where + " has values"))
  {
    double range[2];
    values->GetRange(range);
    claims.That(std::equal(expected, expected + 6, image->GetExtent()), where + " lies where its file says");
    claims.That(range[0] == edge && range[1] == edge, where + " has its file's values");
  }
}

void EachTimeOfASeriesIsItsFile(test::Claims& claims)
{
  const std::vector<int> edges = { 5, 0, 6, 10, -1, 7 };
  for (const std::size_t first : { 0u, 1u, 4u }) // of them an empty one, and one without grids
  {
    vtkNew<vtkVDBReader> reader;
    std::vector<int> frames;
    for (std::size_t i = first; i < edges.size(); ++i)
    {
      frames.push_back(edges[i]);
      const std::string name = "cube_" + std::to_string(edges[i]) + ".vdb";
      WriteCube(name, edges[i]);
      reader->AddFileName(Path(name).c_str());
    }
    vtkNew<vtkParticipatingMedium> medium; // each through another one, as pipelines have several filters
    vtkNew<vtkParticipatingMedium> after;
    medium->SetInputConnection(reader->GetOutputPort());
    medium->SetAlbedo(0.0, 0.0, 0.0);
    after->SetInputConnection(medium->GetOutputPort());
    after->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "density");
    after->SetAlbedo(0.0, 0.0, 0.0);
    test::Errors ofReader(reader), ofMedium(medium), ofAfter(after);
    const int last = static_cast<int>(frames.size()) - 1;
    for (const int time : { 0, last, 1, 0, last / 2, 1, 1, last })
    {
      const std::string where = "time " + std::to_string(time) + " of " + std::to_string(last + 1);
      after->UpdateTimeStep(time);
      IsCube(claims, after->GetOutput(), "sigma_a", frames[time], where + " after two filters");
      reader->UpdateTimeStep(time);
      IsCube(claims, reader->GetOutput(), "density", frames[time], where);
    }
    claims.That(ofReader.None() && ofMedium.None() && ofAfter.None(), "no file of a series is an error");
    after->UpdateTimeStep(last, 1, 2, 0);
    claims.That(after->GetOutput()->GetNumberOfCells() < 7 * 7 * 7 && after->GetOutput()->GetNumberOfCells() > 0,
      "a piece of another time is a piece");
    medium->Update();
    claims.That(medium->GetOutput()->GetNumberOfCells() == 7 * 7 * 7, "the last time stays where none is asked for");
  }
}

/// A filter that asks for time only when all others know the extent.
void ATimeThatNobodyWasToldOfIsItsFile(test::Claims& claims)
{
  vtkNew<vtkVDBReader> reader;
  for (const int edge : { 5, 10 })
  {
    const std::string name = "probed_" + std::to_string(edge) + ".vdb";
    WriteCube(name, edge);
    reader->AddFileName(Path(name).c_str());
  }
  test::Errors errors(reader);
  reader->UpdateTimeStep(0.0);
  vtkInformation* const output = reader->GetExecutive()->GetOutputInformation(0);
  vtkNew<vtkInformation> request;
  request->Set(vtkDemandDrivenPipeline::REQUEST_DATA());
  output->Set(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP(), 1.0);
  reader->ProcessRequest(request, nullptr, reader->GetExecutive()->GetOutputInformation());
  IsCube(claims, reader->GetOutput(), "density", 10, "a time that was not told of");
  claims.That(errors.None(), "that is no error");
}

void GridsOfASeriesAreKept(test::Claims& claims)
{
  WriteGrids(Path("both.vdb"), { SmallFog("density"), SmallFog("heat") });
  WriteGrids(Path("one.vdb"), { SmallFog("density") });
  vtkNew<vtkVDBReader> reader;
  test::Errors errors(reader);
  reader->AddFileName(Path("both.vdb").c_str());
  reader->AddFileName(Path("one.vdb").c_str());
  reader->AddFileName(Path("both.vdb").c_str());
  const auto arraysAt = [&](double time) {
    reader->UpdateTimeStep(time);
    return reader->GetOutput()->GetCellData()->GetNumberOfArrays();
  };
  claims.That(arraysAt(0.0) == 2 && arraysAt(1.0) == 1 && arraysAt(2.0) == 2, "each file has the grids that it has");
  reader->SetGridArrayStatus("heat", 0);
  claims.That(arraysAt(1.0) == 1 && arraysAt(2.0) == 1, "a grid that is switched off stays off");
  reader->SetGridArrayStatus("density", 0);
  reader->SetGridArrayStatus("heat", 1);
  claims.That(arraysAt(0.0) == 1 && arraysAt(1.0) == 0 && errors.None(), "a time without a chosen grid is empty");
}
}

int TestVDBReader(int argc, char* argv[])
{
  test::UseFolder("VDBReader", argc, argv);
  openvdb::initialize();

  test::Claims claims;
  VoxelsBecomeCells(claims);
  EveryTypeIsRead(claims);
  TransformsThatFit(claims);
  WrongQuestionsAreErrors(claims);
  LevelSetsKeepTheirInside(claims);
  AslantGridsAreResampled(claims);
  ResampleMayBeSetAtAnyTime(claims);
  EachTimeOfASeriesIsItsFile(claims);
  ATimeThatNobodyWasToldOfIsItsFile(claims);
  GridsOfASeriesAreKept(claims);
  return claims.Result();
}
