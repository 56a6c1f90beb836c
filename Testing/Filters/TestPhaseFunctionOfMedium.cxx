#include "MediumScene.h"

#include "vtkDataSetAttributes.h"
#include "vtkDiscreteOrdinates.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLightPropagationMaps.h"
#include "vtkLightRig.h"
#include "vtkMediumRayCaster.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

/// What of an image says how it scatters: cells `g`, field data `g`, `phase_function` and its companions.
namespace
{
constexpr vtkIdType CellCount = 60;
const double NotANumber = std::numeric_limits<double>::quiet_NaN();

vtkSmartPointer<vtkImageData> Good()
{
  return test::MakeMedium({ { 3, 4, 5 } }, 0.05, 1.0);
}

void AddName(vtkImageData* medium, const char* name)
{
  vtkNew<vtkStringArray> text;
  text->SetName("phase_function");
  text->InsertNextValue(name);
  medium->GetFieldData()->AddArray(text);
}

void AddNumbers(vtkImageData* medium, const char* name, const std::vector<double>& values)
{
  test::AddValues<vtkDoubleArray>(medium->GetFieldData(), name, static_cast<vtkIdType>(values.size()), 1,
    [&](vtkIdType i, int) { return values[i]; });
}

void AddCellsOfG(vtkImageData* medium, int components, const test::Values& g)
{
  test::AddValues<vtkFloatArray>(medium->GetCellData(), "g", CellCount, components, g);
}

vtkSmartPointer<vtkImageData> With(const std::vector<double>& g, const char* name = nullptr)
{
  auto medium = Good();
  AddNumbers(medium, "g", g);
  if (name)
  {
    AddName(medium, name);
  }
  return medium;
}

vtkSmartPointer<vtkImageData> WithTable(const std::vector<double>& cosines, const std::vector<double>& values)
{
  auto medium = Good();
  AddName(medium, "tabulated");
  AddNumbers(medium, "phase_cosine", cosines);
  AddNumbers(medium, "phase_value", values);
  return medium;
}

/// Light of a medium under an even sky; empty where it was refused.
class Solver
{
public:
  Solver()
    : Seen(this->Maps)
  {
    this->Maps->SetSkyColor(1.0, 1.0, 1.0);
    this->Maps->SetTolerance(1e-6);
  }

  /// @param channel  of a fluence that has colour, else it is the only one
  std::vector<double> Fluence(vtkImageData* medium, int channel = 0)
  {
    this->Maps->SetInputDataObject(medium);
    this->Maps->Update();
    vtkDataArray* fluence = this->Maps->GetOutput()->GetCellData()->GetArray("fluence");
    std::vector<double> values;
    for (vtkIdType i = 0; fluence && i < fluence->GetNumberOfTuples(); ++i)
    {
      values.push_back(fluence->GetComponent(i, fluence->GetNumberOfComponents() == 3 ? channel : 0));
    }
    return values;
  }

  bool Refuses(vtkImageData* medium, const std::string& part)
  {
    this->Maps->SetInputDataObject(medium);
    this->Maps->Update();
    return this->Seen.WasOneWith(part) && this->Maps->GetOutput()->GetNumberOfCells() == 0;
  }

  bool None() const { return this->Seen.None(); }

private:
  vtkNew<vtkLightPropagationMaps> Maps;
  test::Errors Seen;
};

double LargestRatio(const std::vector<double>& a, const std::vector<double>& b)
{
  double largest = a.size() == CellCount && b.size() == CellCount ? 0.0 : VTK_DOUBLE_MAX;
  for (std::size_t i = 0; largest != VTK_DOUBLE_MAX && i < a.size(); ++i)
  {
    largest = std::max(largest, std::abs(a[i] / b[i] - 1.0));
  }
  return largest;
}

void CellsCountBeforeFieldData(test::Claims& claims, Solver& solver)
{
  const std::vector<double> isotropic = solver.Fluence(Good());
  const std::vector<double> forwards = solver.Fluence(With({ 0.75 }));
  claims.That(isotropic.size() == CellCount && isotropic != forwards, "g makes a difference");
  auto medium = With({ 0.75 });
  AddCellsOfG(medium, 1, [](vtkIdType, int) { return 0.0; });
  claims.That(solver.Fluence(medium) == isotropic, "cells g of 0 count before field data of 0.75");
  medium = With({ 0.1 });
  AddCellsOfG(medium, 3, [](vtkIdType, int) { return 0.75; });
  claims.That(solver.Fluence(medium) == forwards, "even cells g of three channels are one g, to the bit");
  medium = Good();
  test::AddPoints(medium, "g", 0.75);
  claims.That(solver.Fluence(medium) == forwards, "points g are averaged to cells");
  medium = Good();
  AddCellsOfG(medium, 1, [](vtkIdType i, int) { return i < 30 ? 0.75 : 0.0; });
  const std::vector<double> half = solver.Fluence(medium);
  claims.That(half != isotropic && half != forwards, "g varies by voxel");
}

void HiddenCellsDoNotMatter(test::Claims& claims, Solver& solver)
{
  const auto hidden = [](vtkImageData* medium) {
    test::AddValues<vtkUnsignedCharArray>(medium->GetCellData(), vtkDataSetAttributes::GhostArrayName(), CellCount, 1,
      [](vtkIdType i, int) { return i == 7 ? vtkDataSetAttributes::HIDDENCELL : 0; });
    return medium;
  };
  auto medium = With({ 0.75 });
  const std::vector<double> byField = solver.Fluence(hidden(medium));
  medium = Good();
  AddCellsOfG(medium, 1, [](vtkIdType i, int) { return i == 7 ? NotANumber : 0.75; });
  claims.That(byField.size() == CellCount && solver.Fluence(hidden(medium)) == byField && solver.None(),
    "g of a hidden cell may be anything");
}

/// All filters that read g: their values for a medium, or none where they refused it.
class ReadersOfG
{
public:
  ReadersOfG()
  {
    vtkNew<vtkLightRig> rig;
    this->Emitter->SetLightsConnection(rig->GetOutputPort());
    this->Emitter->SetPhotonCount(100);
    vtkNew<vtkMediumRayCaster> caster;
    caster->SetImageSize(8, 6);
    caster->SetCameraPosition(9.0, 8.0, 12.0);
    caster->SetCameraFocalPoint(1.5, 2.0, 2.5);
    caster->SetLightsConnection(rig->GetOutputPort());
    caster->SetShadowRays(true);
    vtkNew<vtkPhotonMarcher> marcher;
    marcher->SetPhotonsConnection(this->Emitter->GetOutputPort());
    marcher->SetMaximumOrders(3);
    this->Add("photons", marcher);
    this->Add("the ray caster", caster);
    this->AddSolver<vtkLightPropagationMaps>("maps");
    this->AddSolver<vtkDiscreteOrdinates>("ordinates");
    this->AddSolver<vtkLatticeBoltzmannLighting>("a lattice");
    this->AddSolver<vtkLatticeBoltzmannLighting>("a lattice as published")->SetScheme(0);
  }

  std::size_t Count() const { return this->Readers.size(); }
  const std::string& Name(std::size_t i) const { return this->Readers[i].first; }
  std::vector<double> Values(std::size_t i, vtkImageData* medium)
  {
    vtkAlgorithm* const reader = this->Readers[i].second;
    const test::Errors quiet(reader);
    this->Emitter->SetInputDataObject(medium);
    reader->SetInputDataObject(medium);
    reader->Update();
    auto* const output = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
    vtkDataArray* array = output->GetCellData()->GetArray("fluence");
    array = array ? array : output->GetPointData()->GetArray("radiance");
    std::vector<double> values;
    for (vtkIdType k = 0; array && k < array->GetNumberOfValues(); ++k)
    {
      const int components = array->GetNumberOfComponents();
      values.push_back(array->GetComponent(k / components, static_cast<int>(k % components)));
    }
    return values;
  }

private:
  void Add(const char* name, vtkAlgorithm* reader) { this->Readers.emplace_back(name, reader); }
  template <class Solver>
  Solver* AddSolver(const char* name)
  {
    vtkNew<Solver> solver;
    solver->SetSkyColor(1.0, 1.0, 1.0);
    solver->SetMaximumOrders(3);
    this->Add(name, solver);
    return solver;
  }

  vtkNew<vtkPhotonEmitter> Emitter;
  std::vector<std::pair<std::string, vtkSmartPointer<vtkAlgorithm>>> Readers;
};

void NothingIsReadWhereNothingScatters(test::Claims& claims)
{
  constexpr vtkIdType hole = 16;
  const auto medium = [](double elsewhere, double there) {
    auto image = test::MakeMedium({ { 3, 4, 5 } }, 0.05, 0.3);
    image->GetCellData()->GetArray("sigma_s")->SetComponent(hole, 0, 0.0);
    AddCellsOfG(image, 1, [=](vtkIdType i, int) { return i == hole ? there : i < 30 ? 0.75 : elsewhere; });
    return image;
  };
  ReadersOfG readers;
  for (std::size_t i = 0; i < readers.Count(); ++i)
  {
    for (const double elsewhere : { 0.75, 0.25 })
    {
      const std::vector<double> usual = readers.Values(i, medium(elsewhere, 0.0));
      claims.That(!usual.empty(), readers.Name(i) + " take cells g");
      for (const double there : { 1.0, -7.0, NotANumber })
      {
        claims.That(!usual.empty() && readers.Values(i, medium(elsewhere, there)) == usual,
          readers.Name(i) + ": g is " + std::to_string(there) + " where nothing scatters");
      }
    }
  }
}

void NamesChooseTheFunction(test::Claims& claims, Solver& solver)
{
  const std::vector<double> isotropic = solver.Fluence(Good());
  auto named = Good();
  AddName(named, "isotropic");
  claims.That(solver.Fluence(named) == isotropic, "isotropic is g 0");
  claims.That(solver.Fluence(With({ 0.5 }, "henyey_greenstein")) == solver.Fluence(With({ 0.5 })),
    "without a name it is Henyey and Greenstein's");
  auto one = With({ 0.5 }, "double_henyey_greenstein");
  AddNumbers(one, "phase_second_g", { -0.5 });
  AddNumbers(one, "phase_first_part", { 1.0 });
  claims.That(LargestRatio(solver.Fluence(one), solver.Fluence(With({ 0.5 }))) < 1e-4, "double of one part");
  claims.That(solver.Fluence(WithTable({ 1.0, -1.0 }, { 1.0, 0.2 })).size() == CellCount, "a table is taken");
  for (const char* name : { "rayleigh", "schlick" })
  {
    claims.That(solver.Fluence(With({ 0.0 }, name)).size() == CellCount, std::string(name) + " is taken");
  }
  claims.That(solver.None(), "there is nothing wrong with all functions");
}

void BadFunctionsAreOneError(test::Claims& claims, Solver& solver)
{
  const auto refused = [&](vtkImageData* medium, const std::string& part) {
    claims.That(solver.Refuses(medium, part), "refused: " + part);
  };
  for (const double g : { 1.0, -1.0, 1.5, NotANumber })
  {
    refused(With({ g }), "mean cosine g");
    refused(With({ 0.1, g, 0.2 }), "Of green: The mean cosine g");
    auto medium = Good();
    AddCellsOfG(medium, 1, [g](vtkIdType i, int) { return i == 16 ? g : 0.5; });
    refused(medium, "in voxel (1, 1, 1) (the first such voxel)");
  }
  refused(With({ 0.1, 0.2 }), "'g' has 2 numbers; it must have 1, or 3");
  refused(With({ 0.1 }, "mie"), "'phase_function' is 'mie'; it must be isotropic, henyey_greenstein");
  refused(With({ 0.5 }, "rayleigh"), "'g' is 0.5, but the phase function 'rayleigh' has the mean cosine 0");
  auto medium = Good();
  AddCellsOfG(medium, 1, [](vtkIdType i, int) { return 0.01 * i; });
  AddName(medium, "tabulated");
  refused(medium, "'tabulated' has no mean cosine that could vary by voxel");
  medium = Good();
  AddNumbers(medium, "phase_function", { 3.0 });
  refused(medium, "'phase_function' must be one text");
  medium = Good();
  AddCellsOfG(medium, 2, [](vtkIdType, int) { return 0.1; });
  refused(medium, "'g' has 2 components");
  medium = With({ 0.5 }, "double_henyey_greenstein");
  AddNumbers(medium, "phase_first_part", { 1.5 });
  refused(medium, "first part");
}

void BadTablesNameTheRow(test::Claims& claims, Solver& solver)
{
  const auto refused = [&](vtkImageData* medium, const std::string& part) {
    claims.That(solver.Refuses(medium, part), "refused: " + part);
  };
  refused(WithTable({ -1.0, 0.0, 1.0 }, { 1.0, -2.0, 1.0 }), "Row 1 of the table");
  refused(WithTable({ -1.0, 0.0, 1.0 }, { 1.0, 1.0, NotANumber }), "Row 2 of the table");
  refused(WithTable({ -1.0, 0.5, 0.0, 1.0 }, { 1.0, 1.0, 1.0, 1.0 }), "Row 2 of the table");
  refused(WithTable({ 0.0, 90.0, 180.0 }, { 1.0, 1.0, 1.0 }), "Row 1 of the table");
  refused(WithTable({ 1.0 }, { 1.0 }), "has 1 row;");
  refused(WithTable({ -1.0, 1.0 }, { 0.0, 0.0 }), "does not integrate");
  refused(WithTable({ -1.0, 0.0, 1.0 }, { 1.0, 1.0 }), "3 cosines and 2 values");
  auto medium = Good();
  AddName(medium, "tabulated");
  refused(medium, "has 0 rows");
}
}

int TestPhaseFunctionOfMedium(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    Solver solver;
    CellsCountBeforeFieldData(claims, solver);
    HiddenCellsDoNotMatter(claims, solver);
    NothingIsReadWhereNothingScatters(claims);
    NamesChooseTheFunction(claims, solver);
    BadFunctionsAreOneError(claims, solver);
    BadTablesNameTheRow(claims, solver);
  });
}
