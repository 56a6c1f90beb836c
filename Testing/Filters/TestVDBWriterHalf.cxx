#include "TestSupport.h"
#include "VDBScene.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVDBReader.h"
#include "vtkVDBWriter.h"

#include <cmath>
#include <limits>

using test::Path;
using test::ReadBytes;

namespace
{
constexpr vtkIdType Cell = 2 + 4 * (1 + 3 * 1); ///< voxel (12, 1, -1) of OneValue's image

/// 4 x 3 x 2 cells of 1, but `value` in one component of one of them.
template <typename Array>
vtkSmartPointer<vtkImageData> OneValue(double value, int components = 1)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(10, 14, 0, 3, -2, 0);
  vtkNew<Array> array;
  array->SetName("density");
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(image->GetNumberOfCells());
  array->Fill(1.0);
  array->SetComponent(Cell, components - 1, value);
  image->GetCellData()->AddArray(array);
  return image;
}

vtkSmartPointer<vtkImageData> ReadImage(const std::string& path)
{
  vtkNew<vtkVDBReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->DeepCopy(reader->GetOutput());
  return image;
}

/// Whether the first grid's numbers are stored in 16 bits.
bool IsHalf(const std::string& path)
{
  openvdb::io::File file(path);
  file.open();
  return (*file.getGrids())[0]->saveFloatAsHalf();
}

openvdb::FloatGrid::Ptr Fog(bool half)
{
  auto fog = test::SmallFog();
  fog->setSaveFloatAsHalf(half);
  return fog;
}

void ThePropertyAloneDecides(test::Claims& claims)
{
  vtkNew<vtkVDBWriter> writer;
  test::Errors errors(writer);
  writer->SetFileName(Path("out.vdb").c_str());

  test::WriteGrids(Path("half.vdb"), { Fog(true) });
  claims.That(IsHalf(Path("half.vdb")), "a file in 16 bits");
  auto image = ReadImage(Path("half.vdb"));
  auto* density = image->GetCellData()->GetArray("density");
  for (vtkIdType i = 0; i < density->GetNumberOfTuples(); ++i)
  {
    density->SetComponent(i, 0, density->GetComponent(i, 0) + 100000.0);
  }
  writer->SetInputData(image);
  writer->Write();
  claims.That(errors.None() && !IsHalf(Path("out.vdb")), "what was read in 16 bits is written in full");
  const auto written = ReadImage(Path("out.vdb"));
  auto* again = written->GetCellData()->GetArray("density");
  bool same = again && again->GetNumberOfTuples() == density->GetNumberOfTuples();
  for (vtkIdType i = 0; same && i < density->GetNumberOfTuples(); ++i)
  {
    same = again->GetComponent(i, 0) == density->GetComponent(i, 0);
  }
  claims.That(same, "100000 more than a half can hold comes back bit for bit");
  claims.That(!image->GetFieldData()->HasArray("vdb:density:is_saved_as_half_float"),
    "how a file stores its numbers is no property of the image");

  // An image that carries the note all the same, of an earlier version or from a user.
  for (int noted : { 0, 1 })
  {
    vtkNew<vtkUnsignedCharArray> note;
    note->SetName("vdb:density:is_saved_as_half_float");
    note->InsertNextValue(static_cast<unsigned char>(noted));
    auto small = OneValue<vtkFloatArray>(3.0);
    small->GetFieldData()->AddArray(note);
    writer->SetInputData(small);
    writer->SetSaveAsHalf(noted == 0);
    writer->Write();
    claims.That(errors.None() && IsHalf(Path("out.vdb")) == (noted == 0), "the property decides against a note");
  }

  test::WriteGrids(Path("full.vdb"), { Fog(false) });
  writer->SetInputData(ReadImage(Path("full.vdb")));
  writer->SetSaveAsHalf(true);
  writer->Write();
  claims.That(errors.None() && IsHalf(Path("out.vdb")), "what was read in full is written in 16 bits where asked");
}

struct Case
{
  double Value;
  bool Fits;
};

/// Of numbers in 16 bits: the largest is 65504, 65520 would become infinite, the smallest normal one is 2^-14, and
/// below that they are multiples of 2^-24.
const Case Cases[] = {
  { 65504.0, true },
  { -65504.0, true },
  { 65519.0, true },
  { 65520.0, false },
  { -65520.0, false },
  { 1e5, false },
  { -3e38, false },
  { 0.0, true },
  { -0.0, true },
  { 1.0 / 3.0, true },
  { -1e-4, true },
  { std::ldexp(1.0, -24), true },     // the smallest
  { std::ldexp(-3.0, -24), true },    // -3 of it
  { std::ldexp(900.25, -24), true },  // 0.03% is lost
  { std::ldexp(100.25, -24), false }, // 0.25%
  { std::ldexp(1.4, -24), false },    // 29%
  { std::ldexp(-0.4, -24), false },   // all of it
  { 1e-9, false },
  { std::numeric_limits<double>::infinity(), true },
  { std::numeric_limits<double>::quiet_NaN(), true },
};

/// One value is written in 16 bits, or is one error and the file that was there stays.
void FitsOrIsAnError(
  test::Claims& claims, vtkImageData* image, double value, bool fits, double error, const std::string& what)
{
  vtkNew<vtkVDBWriter> writer;
  test::Errors errors(writer);
  writer->SetInputData(image);
  writer->SetFileName(Path("value.vdb").c_str());
  writer->SetSaveAsHalf(true);
  test::WriteBytes(Path("value.vdb"), "what was there");
  const std::string name = what + " of " + std::to_string(value);
  const bool written = writer->Write() == 1;
  claims.That(written == fits, name + (fits ? " is written" : " is not written"));
  if (!fits)
  {
    claims.That(errors.WasOneWith("\"density\""), name + ": the error names the array");
    claims.That(ReadBytes(Path("value.vdb")) == "what was there", name + ": the file stays");
    return;
  }
  claims.That(errors.None(), name + ": no error");
  const auto again = ReadImage(Path("value.vdb"));
  auto* array = again->GetCellData()->GetArray("density");
  const double back = array->GetComponent(Cell, array->GetNumberOfComponents() - 1);
  claims.That(std::isnan(value) ? std::isnan(back) : back == value || std::abs(back - value) <= error * std::abs(value),
    name + ": it comes back as " + std::to_string(back));
}

void WhatDoesNotFitIsAnError(test::Claims& claims)
{
  for (const Case& one : Cases)
  {
    FitsOrIsAnError(claims, OneValue<vtkFloatArray>(one.Value), one.Value, one.Fits, 1e-3, "a float");
    FitsOrIsAnError(claims, OneValue<vtkDoubleArray>(one.Value), one.Value, one.Fits, 1e-3, "a double");
    FitsOrIsAnError(claims, OneValue<vtkFloatArray>(one.Value, 3), one.Value, one.Fits, 1e-3, "a vec3s");
    FitsOrIsAnError(claims, OneValue<vtkDoubleArray>(one.Value, 3), one.Value, one.Fits, 1e-3, "a vec3d");
  }
  FitsOrIsAnError(claims, OneValue<vtkDoubleArray>(1e-300), 1e-300, false, 0.0, "a double");
  FitsOrIsAnError(
    claims, OneValue<vtkDoubleArray>(65519.9999999), 65519.9999999, false, 0.0, "a double"); // as float 65520

  // The error tells where and what.
  vtkNew<vtkVDBWriter> writer;
  test::Errors errors(writer);
  writer->SetFileName(Path("value.vdb").c_str());
  writer->SetSaveAsHalf(true);
  for (const char* part : { "voxel (12, 1, -1)", "-70000.5", "SaveAsHalf" })
  {
    writer->SetInputData(OneValue<vtkDoubleArray>(-70000.5, 3));
    writer->Write();
    claims.That(errors.WasOneWith(part), std::string("the error says ") + part);
  }
  // A component that becomes a grid of its own.
  writer->SetInputData(OneValue<vtkFloatArray>(1e5, 2));
  writer->Write();
  claims.That(errors.WasOneWith("100000"), "each component is looked at");

  writer->SetInputData(OneValue<vtkFloatArray>(2.0));
  writer->SetBackground(1e6);
  writer->Write();
  claims.That(errors.WasOneWith("background"), "the background is looked at");
  writer->SetBackground(1e-9);
  writer->Write();
  claims.That(errors.WasOneWith("background"), "also where it would become 0");
  // A cell that is background is none that is written, and one beyond the tolerance neither.
  writer->SetBackground(0.0);
  writer->SetTolerance(1e-6);
  writer->SetInputData(OneValue<vtkFloatArray>(1e-9));
  writer->Write();
  claims.That(errors.None(), "what a tolerance makes background fits");
  writer->SetTolerance(0.0);
  writer->SetSaveAsHalf(false);
  writer->SetBackground(1e6);
  writer->Write();
  claims.That(errors.None(), "32 bits hold all");
}
}

int TestVDBWriterHalf(int argc, char* argv[])
{
  test::UseFolder("VDBWriterHalf", argc, argv);
  openvdb::initialize();

  test::Claims claims;
  ThePropertyAloneDecides(claims);
  WhatDoesNotFitIsAnError(claims);
  return claims.Result();
}
