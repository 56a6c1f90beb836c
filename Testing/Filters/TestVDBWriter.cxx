#include "TestSupport.h"
#include "VDBScene.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtksys/Directory.hxx"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedLongLongArray.h"
#include "vtkVDBReader.h"
#include "vtkVDBWriter.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>
#include <random>
#include <sys/resource.h>

using test::Path;
using test::ReadBytes;

namespace
{
/// A phase function that is a table, with what other functions take besides.
void AddPhaseFunction(vtkImageData* image)
{
  vtkNew<vtkDoubleArray> g;
  g->SetName("g");
  g->InsertNextValue(1.0 / 3.0);
  vtkNew<vtkStringArray> function;
  function->SetName("phase_function");
  function->InsertNextValue("tabulated");
  vtkNew<vtkDoubleArray> second; // of three channels
  second->SetName("phase_second_g");
  second->SetNumberOfComponents(3);
  second->InsertNextTuple3(0.1, 1.0 / 7.0, -0.3);
  vtkNew<vtkDoubleArray> cosines, values;
  cosines->SetName("phase_cosine");
  values->SetName("phase_value");
  for (int row = 0; row <= 180; ++row)
  {
    cosines->InsertNextValue(1.0 - row / 90.0);
    values->InsertNextValue(std::exp(-row / 7.0));
  }
  for (vtkAbstractArray* array : std::initializer_list<vtkAbstractArray*>{ g, function, second, cosines, values })
  {
    image->GetFieldData()->AddArray(array);
  }
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
  AddPhaseFunction(image);
  return image;
}

bool SameBits(vtkDataArray* a, vtkDataArray* b)
{
  return a && b && a->GetDataTypeSize() == b->GetDataTypeSize() && a->GetNumberOfValues() == b->GetNumberOfValues() &&
    a->GetNumberOfComponents() == b->GetNumberOfComponents() &&
    std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0), a->GetNumberOfValues() * a->GetDataTypeSize()) == 0;
}

void ThePhaseFunctionIsKept(test::Claims& claims, vtkImageData* image, vtkFieldData* field)
{
  claims.That(SameBits(image->GetFieldData()->GetArray("g"), field->GetArray("g")) && !field->HasArray("vdb::medium_g"),
    "the medium's mean cosine, under its name only");

  for (const char* name : { "phase_second_g", "phase_cosine", "phase_value" })
  {
    claims.That(SameBits(image->GetFieldData()->GetArray(name), field->GetArray(name)) &&
        !field->HasArray((std::string("vdb::medium_") + name).c_str()),
      std::string("the phase function's ") + name + ", under its name only");
  }
  auto* function = vtkStringArray::SafeDownCast(field->GetAbstractArray("phase_function"));
  claims.That(function && function->GetValue(0) == "tabulated", "the phase function's name");
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
  claims.That(
    SameBits(image->GetFieldData()->GetArray("vdb:constant:background"), field->GetArray("vdb:constant:background")),
    "the background");
  ThePhaseFunctionIsKept(claims, image, field);

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
  claims.That(
    height && height->GetNumberOfTuples() == 8 && height->GetComponent(7, 0) == 3.0, "points are averaged to cells");
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

/// Along an axis whose spacing is below 0, turned or not, cells come back where they were.
void ASpacingBelow0IsWritten(test::Claims& claims)
{
  const auto image = AwkwardImage();
  const double matrix[9] = { 0.0, 0.0, 1.0, 0.6, 0.8, 0.0, -0.8, 0.6, 0.0 };
  for (const bool isTurned : { false, true })
  {
    image->SetSpacing(0.3, -0.25, -1e-3);
    if (isTurned)
    {
      image->SetDirectionMatrix(matrix);
    }
    vtkNew<vtkVDBWriter> writer;
    test::Errors errors(writer);
    writer->SetInputData(image);
    writer->SetFileName(Path("down.vdb").c_str());
    writer->Write();
    claims.That(errors.None(), "a spacing below 0 is written");
    vtkNew<vtkVDBReader> reader;
    reader->SetFileName(Path("down.vdb").c_str());
    reader->Update();
    vtkImageData* const again = reader->GetOutput();
    const vtkIdType first = 0, last = again->GetNumberOfPoints() - 1;
    claims.That(again->GetNumberOfPoints() == image->GetNumberOfPoints(), "as many points");
    for (const vtkIdType point : { first, last })
    {
      double found[3], wanted[3];
      again->GetPoint(point, found);
      image->GetPoint(point, wanted);
      for (int axis = 0; axis < 3; ++axis)
      {
        claims.Near(found[axis], wanted[axis], 1e-11 * std::abs(wanted[axis]) + 1e-9, "a corner's place");
      }
    }
    claims.That(*std::min_element(again->GetSpacing(), again->GetSpacing() + 3) > 0.0, "spacings are above 0");
    claims.That(
      SameBits(image->GetCellData()->GetArray("density"), again->GetCellData()->GetArray("density")), "the same cells");
  }
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
}

int TestVDBWriter(int argc, char* argv[])
{
  test::UseFolder("VDBWriter", argc, argv);
  openvdb::initialize();

  test::Claims claims;
  for (int compression : { vtkVDBWriter::NONE, vtkVDBWriter::ZIP, vtkVDBWriter::BLOSC })
  {
    ARoundTripKeepsEveryBit(claims, compression);
  }
  OtherImagesAreWritten(claims);
  ASpacingBelow0IsWritten(claims);
  AFailedWriteLeavesNothing(claims);
  return claims.Result();
}
