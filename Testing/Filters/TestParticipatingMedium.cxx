#include "MediumScene.h"

#include "vtkLightPropagationMaps.h"
#include "vtkParticipatingMedium.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace
{
double At(vtkParticipatingMedium* filter, const char* name, vtkIdType cell, int component = 0)
{
  vtkDataArray* array = filter->GetOutput()->GetCellData()->GetArray(name);
  const bool isThere = array && component < array->GetNumberOfComponents();
  return isThere ? array->GetComponent(cell, component) : std::numeric_limits<double>::quiet_NaN();
}

int ComponentsOf(vtkParticipatingMedium* filter, const char* name)
{
  vtkDataArray* array = filter->GetOutput()->GetCellData()->GetArray(name);
  return array ? array->GetNumberOfComponents() : 0;
}

double FactOf(vtkParticipatingMedium* filter, const char* name, int number = 0)
{
  vtkDataArray* fact = filter->GetOutput()->GetFieldData()->GetArray(name);
  const bool isThere = fact && number < fact->GetNumberOfValues();
  const int components = fact ? fact->GetNumberOfComponents() : 1;
  return isThere ? fact->GetComponent(number / components, number % components)
                 : std::numeric_limits<double>::quiet_NaN();
}

double MeanCosineOf(vtkParticipatingMedium* filter)
{
  return FactOf(filter, "g");
}

std::string PhaseFunctionOf(vtkParticipatingMedium* filter)
{
  auto* name =
    vtkArrayDownCast<vtkStringArray>(filter->GetOutput()->GetFieldData()->GetAbstractArray("phase_function"));
  return name ? name->GetValue(0) : "";
}

vtkSmartPointer<vtkTable> TableOf(
  const char* first, const std::vector<double>& cosines, const char* second, const std::vector<double>& values)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  for (const auto& [name, numbers] : { std::pair(first, &cosines), std::pair(second, &values) })
  {
    vtkNew<vtkDoubleArray> column;
    column->SetName(name);
    for (const double number : *numbers)
    {
      column->InsertNextValue(number);
    }
    table->AddColumn(column);
  }
  return table;
}

/// Four cells in a row with density -1, 0, 1, 2.
vtkSmartPointer<vtkImageData> Ramp()
{
  auto image = test::MakeImage({ { 4, 1, 1 } });
  test::AddValues<vtkFloatArray>(image->GetCellData(), "density", 4, 1, [](vtkIdType i, int) { return i - 1.0; });
  image->GetCellData()->SetActiveScalars("density");
  return image;
}

void DensityIsARamp(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> filter;
  const auto image = Ramp();
  filter->SetInputDataObject(image);
  filter->Update();
  const double untouched[4] = { 0.0, 0.0, 1.0, 2.0 };
  for (int i = 0; i < 4; ++i)
  {
    claims.Near(At(filter, "sigma_s", i), 0.9 * untouched[i], 1e-6, "sigma_s of an untouched filter");
    claims.Near(At(filter, "sigma_a", i), 0.1 * untouched[i], 1e-6, "sigma_a of an untouched filter");
  }
  claims.Near(MeanCosineOf(filter), 0.0, 0.0, "g of an untouched filter");
  claims.That(ComponentsOf(filter, "sigma_s") == 1, "a grey medium has one component");
  claims.That(ComponentsOf(filter, "emission") == 0, "an untouched filter does not emit");
  claims.That(ComponentsOf(filter, "density") == 1, "the density is passed on");
  claims.That(image->GetCellData()->GetNumberOfArrays() == 1 && !image->GetFieldData()->GetArray("g"),
    "the input stays as it is");

  filter->SetMinimumDensity(-1.0);
  filter->SetMaximumDensity(1.0);
  filter->SetExtinctionScale(10.0);
  filter->Update();
  for (int i = 0; i < 4; ++i)
  {
    claims.Near(At(filter, "sigma_s", i), 0.9 * 10.0 * i / 2.0, 1e-5, "sigma_s of a ramp from -1 to 1");
  }

  filter->SetMinimumDensity(0.5);
  filter->SetMaximumDensity(0.5);
  filter->Update();
  for (int i = 0; i < 4; ++i)
  {
    claims.Near(At(filter, "sigma_s", i), i < 2 ? 0.0 : 9.0, 1e-5, "sigma_s of a step at 0.5");
  }
}

void ColourMakesThreeComponents(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> filter;
  filter->SetInputDataObject(Ramp());
  filter->SetAlbedo(1.0, 0.5, 0.25);
  filter->SetEmissionScale(4.0);
  filter->SetEmissionColor(1.0, 2.0, 0.0);
  filter->SetMeanCosine(-0.5);
  filter->Update();
  const double albedo[3] = { 1.0, 0.5, 0.25 };
  const double emission[3] = { 4.0, 8.0, 0.0 };
  for (int c = 0; c < 3; ++c)
  {
    claims.Near(At(filter, "sigma_s", 3, c), 2.0 * albedo[c], 1e-6, "sigma_s of a colour");
    claims.Near(At(filter, "sigma_a", 3, c), 2.0 * (1.0 - albedo[c]), 1e-6, "sigma_a of a colour");
    claims.Near(At(filter, "emission", 3, c), 2.0 * emission[c], 1e-6, "emission of a colour");
  }
  claims.Near(MeanCosineOf(filter), -0.5, 0.0, "g");
}

void PresetsAreRealMedia(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> filter;
  filter->SetInputDataObject(Ramp());
  filter->SetPreset(vtkParticipatingMedium::WHOLE_MILK);
  filter->SetMillimetresPerUnit(1000.0); // metres
  filter->Update();
  const double scattering[3] = { 2550.0, 3210.0, 3770.0 };
  const double absorption[3] = { 1.1, 2.4, 14.0 };
  for (int c = 0; c < 3; ++c)
  {
    claims.Near(At(filter, "sigma_s", 2, c), scattering[c], 1e-3, "sigma_s of whole milk, 1/m");
    claims.Near(At(filter, "sigma_a", 2, c), absorption[c], 1e-5, "sigma_a of whole milk, 1/m");
  }

  filter->SetPreset(vtkParticipatingMedium::CLOUD);
  filter->SetExtinctionScale(0.5);
  filter->Update();
  claims.Near(At(filter, "sigma_s", 2), 0.5 * 0.15867, 1e-6, "sigma_s of half a cloud, 1/m");
  claims.Near(MeanCosineOf(filter), 0.85382, 1e-9, "g of a cloud");

  filter->SetPreset(vtkParticipatingMedium::ESPRESSO);
  filter->SetExtinctionScale(1.0);
  filter->SetMillimetresPerUnit(1.0);
  filter->Update();
  const double espresso[3] = { 7.78262, 8.13050, 8.53875 }, g[3] = { 0.907, 0.896, 0.880 };
  for (int c = 0; c < 3; ++c)
  {
    claims.Near(At(filter, "sigma_s", 2, c), espresso[c], 1e-5, "sigma_s of espresso as it was measured, 1/mm");
    claims.Near(FactOf(filter, "g", c), g[c], 1e-12, "g of espresso in each colour");
  }

  for (int preset = vtkParticipatingMedium::CLOUD; preset <= vtkParticipatingMedium::SKIN_2; ++preset)
  {
    filter->SetPreset(preset);
    filter->Update();
    const std::string name = vtkParticipatingMedium::GetPresetName(preset);
    claims.That(!name.empty() && vtkParticipatingMedium::GetPresetSource(preset)[0] != '\0', "a preset has a source");
    claims.That(At(filter, "sigma_s", 2) > 0.0 && At(filter, "sigma_a", 2) > 0.0, name + " scatters and absorbs");
    claims.That(std::abs(MeanCosineOf(filter)) < 1.0, name + " has a mean cosine");
  }
  claims.That(std::string(vtkParticipatingMedium::GetPresetName(vtkParticipatingMedium::SKIN_2)) == "Skin 2",
    "presets are numbered as in the table");
  claims.That(std::string(vtkParticipatingMedium::GetPresetName(99)).empty(), "there is no preset 99");
}

void UnitsOfLengthHaveNames(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> filter;
  const auto image = test::MakeImage({ { 4, 3, 2 }, { 25.0, 25.0, 25.0 } });
  test::AddCells(image, "density", 1.0);
  image->GetCellData()->SetActiveScalars("density");
  filter->SetInputDataObject(image);
  filter->SetPreset(vtkParticipatingMedium::CLOUD);
  const auto scattering = [&](int unit) {
    filter->SetLengthUnit(unit);
    filter->Update();
    return At(filter, "sigma_s", 0);
  };
  const double inMetres = scattering(vtkParticipatingMedium::METRES);
  claims.Near(inMetres, 0.15867, 1e-6, "sigma_s of a cloud, 1/m");
  claims.That(filter->GetPhysicalExtent() == std::string("100 x 75 x 50 m"), "a cloud of a hundred metres");
  claims.Near(filter->GetOpticalThickness(), 100.0 * 0.15867, 1e-3, "its optical thickness along x");
  claims.Near(filter->GetMeanFreePath(), 1.0 / 0.15867, 1e-4, "its mean free path in metres");
  claims.That(filter->GetSeconds() > 0.0, "its run time");
  claims.That(std::string(filter->GetLeftOut()).find("emission") != std::string::npos, "and what it left out");

  claims.Near(scattering(vtkParticipatingMedium::KILOMETRES), 1e3 * inMetres, 1e-3, "1/km");
  claims.Near(scattering(vtkParticipatingMedium::CENTIMETRES), 1e-2 * inMetres, 1e-8, "1/cm");
  claims.That(filter->GetPhysicalExtent() == std::string("1 x 0.75 x 0.5 m"), "in the unit that fits");
  filter->SetMillimetresPerUnit(1000.0);
  claims.Near(scattering(vtkParticipatingMedium::AS_GIVEN), inMetres, 0.0, "as MillimetresPerUnit says");
}

void WhatIsNotNeededCanBeWrittenAllTheSame(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> filter;
  filter->SetInputDataObject(Ramp());
  filter->SetMaximumDensity(2.0);
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputConnection(filter->GetOutputPort());
  maps->SetSkyColor(1.0, 1.0, 1.0);
  const auto fluence = [&] {
    maps->Update();
    std::vector<double> values;
    for (vtkIdType cell = 0; cell < 4; ++cell)
    {
      values.push_back(maps->GetOutput()->GetCellData()->GetArray("fluence")->GetComponent(cell, 0));
    }
    return values;
  };
  const std::vector<double> less = fluence();
  claims.Near(ComponentsOf(filter, "sigma_s"), 1, 0, "components of a grey medium");
  claims.Near(ComponentsOf(filter, "emission"), 0, 0, "emission of a medium that does not emit");
  filter->LeaveOutOff();
  const std::vector<double> all = fluence();
  for (const char* name : { "sigma_a", "sigma_s", "emission" })
  {
    claims.Near(ComponentsOf(filter, name), 3, 0, std::string("components where all is to be written: ") + name);
  }
  claims.Near(At(filter, "emission", 3, 2), 0.0, 0.0, "emission");
  claims.That(std::string(filter->GetLeftOut()).empty(), "nothing is left out");
  for (std::size_t cell = 0; cell < 4; ++cell)
  {
    claims.Near(all[cell] / less[cell], 1.0, 1e-5, "the same light");
  }
  const auto image = Ramp();
  test::AddCells(image, "emission", 2.0);
  image->GetCellData()->SetActiveScalars("density");
  filter->SetInputDataObject(image);
  filter->Update();
  claims.Near(At(filter, "emission", 3), 2.0, 0.0, "the input's own emission");
}

void WarnsWhereItIsTooThinOrTooThick(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(Ramp()); // of relative densities 0, 0, 1, 2
  filter->SetMaximumDensity(1.0);
  filter->Update();
  claims.That(errors.None(), "no word of a medium that is neither");
  filter->SetExtinctionScale(0.003);
  filter->Update();
  claims.That(errors.WasOneWith("optical thickness is 0.009 at most"), "a thin one");
  filter->SetExtinctionScale(4e5);
  filter->Update();
  claims.That(errors.WasOneWith("optical thickness is 1.2e+06 at most"), "a thick one");
  filter->SetExtinctionScale(0.0);
  filter->Update();
  claims.That(errors.None() && filter->GetMeanFreePath() == 0.0, "vacuum may be meant");
  filter->SetExtinctionScale(1.0);
  filter->SetPreset(vtkParticipatingMedium::CLOUD);
  filter->Update();
  claims.That(errors.WasOneWith("the dataset is 4 x 1 x 1 mm large"), "a cloud of millimetres");
}

void TheOutputSaysHowItScatters(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(Ramp());
  filter->SetMeanCosine(0.6);
  filter->Update();
  claims.That(PhaseFunctionOf(filter) == "henyey_greenstein", "Henyey and Greenstein's by default");
  claims.That(!filter->GetOutput()->GetFieldData()->HasArray("phase_second_g"), "what is not needed is not written");

  filter->SetChannelMeanCosines(0.1, 0.2, -0.3);
  filter->SetPhaseFunction(vtkParticipatingMedium::SCHLICK);
  filter->Update();
  claims.That(PhaseFunctionOf(filter) == "schlick", "Schlick's, where asked for");
  claims.Near(FactOf(filter, "g", 0), 0.1, 0.0, "g of red");
  claims.Near(FactOf(filter, "g", 2), -0.3, 0.0, "g of blue");
  filter->RemoveAllChannelMeanCosines();

  filter->SetPhaseFunction(vtkParticipatingMedium::DOUBLE_HENYEY_GREENSTEIN);
  filter->SetSecondMeanCosine(-0.4);
  filter->SetFirstPart(0.75);
  filter->Update();
  claims.That(PhaseFunctionOf(filter) == "double_henyey_greenstein", "two lobes");
  claims.Near(MeanCosineOf(filter), 0.6, 0.0, "g of the first lobe");
  claims.Near(FactOf(filter, "phase_second_g"), -0.4, 0.0, "g of the second");
  claims.Near(FactOf(filter, "phase_first_part"), 0.75, 0.0, "part of the first");

  filter->SetPhaseFunction(vtkParticipatingMedium::RAYLEIGH);
  filter->Update();
  claims.That(PhaseFunctionOf(filter) == "rayleigh" && MeanCosineOf(filter) == 0.0, "Rayleigh's has no mean cosine");
  filter->SetPhaseFunction(vtkParticipatingMedium::ISOTROPIC);
  filter->Update();
  claims.That(PhaseFunctionOf(filter) == "isotropic" && MeanCosineOf(filter) == 0.0, "nor has the isotropic one");
  claims.That(errors.None(), "all of these are good");
}

void ATableIsThePhaseFunction(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(Ramp());
  filter->SetPhaseFunction(vtkParticipatingMedium::TABULATED);
  const auto refused = [&](vtkDataObject* table, const char* part) {
    filter->SetPhaseTableData(table);
    filter->Update();
    claims.That(errors.WasOneWith(part), std::string("refused: ") + part);
  };
  refused(nullptr, "there is no PhaseTable");
  refused(TableOf("angle", { 0.0, 180.0 }, "value", { 1.0, 1.0 }), "no column 'cosine'. Its columns: 'angle', 'value'");
  refused(TableOf("cosine", { -1.0, 1.0 }, "p11", { 1.0, 1.0 }), "no column 'value'");
  refused(TableOf("cosine", { -1.0, 0.0, 1.0 }, "value", { 1.0, -1.0, 1.0 }), "Row 1 of the table");
  refused(TableOf("cosine", {}, "value", {}), "has 0 rows");
  vtkNew<vtkStringArray> words;
  words->SetName("cosine");
  words->InsertNextValue("one");
  words->InsertNextValue("two");
  auto table = TableOf("number", { 0.0, 1.0 }, "value", { 1.0, 1.0 });
  table->AddColumn(words);
  refused(table, "column 'cosine' is not of numbers");

  // 1 + 3 g c has the mean cosine g.
  filter->SetPhaseTableData(TableOf("cosine", { 1.0, -1.0 }, "value", { 160.0, 40.0 }));
  filter->Update();
  claims.That(errors.None() && PhaseFunctionOf(filter) == "tabulated", "a good table is taken");
  claims.Near(MeanCosineOf(filter), 0.2, 1e-12, "g of a table is its mean cosine");
  claims.Near(FactOf(filter, "phase_cosine", 1), -1.0, 0.0, "cosines of the table");
  claims.Near(FactOf(filter, "phase_value", 0), 160.0, 0.0, "values of the table");
  filter->SetPreset(vtkParticipatingMedium::CLOUD);
  filter->SetLengthUnit(vtkParticipatingMedium::METRES); // thick enough to be without a warning
  filter->Update();
  claims.That(errors.None() && PhaseFunctionOf(filter) == "tabulated", "a real medium with a table");

  vtkNew<vtkParticipatingMedium> next;
  next->SetInputDataObject(filter->GetOutput());
  next->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "density");
  next->Update();
  claims.That(PhaseFunctionOf(next) == "henyey_greenstein" && MeanCosineOf(next) == 0.0 &&
      !next->GetOutput()->GetFieldData()->HasArray("phase_cosine"),
    "a phase function that the input had is gone");
}

void MeanCosinesByVoxelPassThrough(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> filter;
  test::Errors errors(filter);
  const auto image = Ramp();
  test::AddValues<vtkFloatArray>(image->GetCellData(), "g", 4, 1, [](vtkIdType i, int) { return 0.25 * i; });
  filter->SetInputDataObject(image);
  filter->Update();
  claims.That(errors.None() && At(filter, "g", 3) == 0.75, "cells g of the input are the medium's");
  filter->SetPhaseFunction(vtkParticipatingMedium::RAYLEIGH);
  filter->Update();
  claims.That(errors.WasOneWith("has no mean cosine that could vary by voxel"), "Rayleigh's cannot vary");
  filter->SetPhaseFunction(vtkParticipatingMedium::HENYEY_GREENSTEIN);
  image->GetCellData()->GetArray("g")->SetComponent(2, 0, 1.0);
  image->Modified();
  filter->Update();
  claims.That(errors.WasOneWith("voxel (2, 0, 0)"), "a g of 1 is refused by its voxel");
}

void AnyImageWillDo(test::Claims& claims)
{
  const auto image = test::MakeImage({ { 2, 3, 1 }, { 0.1, 2.0, 3.0 }, { 1e6, 0.0, -5.0 }, { -3, 7, 2 } });
  test::AddValues<vtkUnsignedCharArray>(image->GetPointData(), "ct", image->GetNumberOfPoints(), 1,
    [](vtkIdType i, int) { return i % 3 == 0 ? 255.0 : 0.0; });
  vtkNew<vtkParticipatingMedium> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(image);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "ct");
  filter->SetMaximumDensity(255.0);
  filter->SetAlbedo(1.0, 1.0, 1.0);
  filter->SetPointData(vtkParticipatingMedium::AVERAGE_TO_CELLS);
  filter->Update();
  claims.That(errors.None(), "points of bytes, in an odd box");
  claims.Near(At(filter, "sigma_s", 0), 0.5, 1e-6, "average of a cell with half of its points dense");
  claims.Near(At(filter, "sigma_s", 1), 0.0, 1e-6, "average of a cell with no point dense");
}

bool HasBounds(vtkImageData* image, const std::array<double, 6>& expected)
{
  double bounds[6];
  image->GetBounds(bounds);
  return std::equal(expected.begin(), expected.end(), bounds);
}

void PointsAreInTheMiddleOfVoxels(test::Claims& claims)
{
  // 4 x 3 x 2 points.
  const auto image = test::MakeImage({ { 3, 2, 1 }, { 0.5, 2.0, 4.0 }, { 10.0, 0.0, -5.0 }, { -3, 7, 2 } });
  const vtkIdType points = image->GetNumberOfPoints();
  test::AddValues<vtkDoubleArray>(
    image->GetPointData(), "ct", points, 1, [](vtkIdType i, int) { return 0.5 + static_cast<double>(i); });
  test::AddPoints(image, "heat", 300.0);
  image->GetPointData()->SetActiveScalars("ct");
  vtkNew<vtkParticipatingMedium> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(image);
  filter->SetAlbedo(0.0, 0.0, 0.0);
  filter->Update();
  vtkImageData* const output = filter->GetOutput();
  const int extent[6] = { -3, 1, 7, 10, 2, 4 };
  claims.That(errors.None() && std::equal(extent, extent + 6, output->GetExtent()), "n points are n voxels");
  claims.That(HasBounds(output, { 8.25, 10.25, 13.0, 19.0, 1.0, 9.0 }), "bounds are half a spacing wider");
  bool untouched = output->GetNumberOfCells() == points;
  for (vtkIdType i = 0; untouched && i < points; ++i)
  {
    untouched = At(filter, "sigma_a", i) == 0.5 + static_cast<double>(i);
    double middle[6];
    output->GetCellBounds(i, middle);
    for (int axis = 0; axis < 3; ++axis)
    {
      claims.Near(
        0.5 * (middle[2 * axis] + middle[2 * axis + 1]), image->GetPoint(i)[axis], 1e-12, "middle of a voxel");
    }
  }
  claims.That(untouched, "values are those of the points");
  claims.That(output->GetCellData()->HasArray("heat") && output->GetPointData()->GetNumberOfArrays() == 0,
    "other arrays of points are cells, too");
  claims.That(image->GetPointData()->GetNumberOfArrays() == 2 && image->GetCellData()->GetNumberOfArrays() == 0,
    "the input stays as it is");

  filter->SetPointData(vtkParticipatingMedium::AVERAGE_TO_CELLS);
  filter->Update();
  claims.That(output->GetNumberOfCells() == 6 && output->GetPointData()->HasArray("heat"), "n - 1 voxels on request");
  claims.Near(At(filter, "sigma_a", 0), 0.5 + (0 + 1 + 4 + 5 + 12 + 13 + 16 + 17) / 8.0, 1e-6, "a mean of 8 points");

  // One array of cells: voxels are the cells.
  test::AddCells(image, "g", 0.5);
  filter->SetPointData(vtkParticipatingMedium::VOXELS_AROUND_POINTS);
  filter->Update();
  auto* const said = vtkArrayDownCast<vtkStringArray>(output->GetFieldData()->GetAbstractArray("settings_used"));
  claims.That(output->GetNumberOfCells() == 6, "beside an array of cells points are averaged");
  claims.That(said && said->GetValue(0).find("PointData = 1 for 'ct'") == 0, "that is said");
}

void OnePointAlongAnAxisIsOneVoxel(test::Claims& claims)
{
  const auto image = test::MakeImage({ { 3, 2, 0 }, { 1.0, 1.0, 0.25 } });
  test::AddPoints(image, "slice", 2.0);
  image->GetPointData()->SetActiveScalars("slice");
  test::AddValues<vtkUnsignedCharArray>(image->GetPointData(), vtkDataSetAttributes::GhostArrayName(), 12, 1,
    [](vtkIdType i, int) { return i == 5 ? vtkDataSetAttributes::HIDDENPOINT : 0; });
  vtkNew<vtkParticipatingMedium> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(image);
  filter->SetAlbedo(0.0, 0.0, 0.0);
  filter->Update();
  const int extent[6] = { 0, 4, 0, 3, 0, 1 };
  claims.That(errors.None() && std::equal(extent, extent + 6, filter->GetOutput()->GetExtent()), "a slice is a layer");
  claims.That(HasBounds(filter->GetOutput(), { -0.5, 3.5, -0.5, 2.5, -0.125, 0.125 }), "it is a spacing thick");
  claims.That(At(filter, "sigma_a", 4) == 2.0 && At(filter, "sigma_a", 5) == 0.0, "a hidden point is an empty voxel");
}

/// A ball in the middle of 20^3 voxels: the distance from its surface.
vtkSmartPointer<vtkImageData> Ball(const char* name, double spacing)
{
  auto image = test::MakeImage({ { 20, 20, 20 }, { spacing, spacing, spacing } });
  test::AddValues<vtkFloatArray>(image->GetCellData(), name, 8000, 1, [=](vtkIdType i, int) {
    const double at[3] = { i % 20 - 9.5, i / 20 % 20 - 9.5, i / 400 - 9.5 };
    return spacing * (std::sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]) - 7.0);
  });
  image->GetCellData()->SetActiveScalars(name);
  return image;
}

void LevelSetsAreFilledNotTakenForADensity(test::Claims& claims)
{
  for (const double spacing : { 1.0, 0.05 })
  {
    const auto ball = Ball("surface", spacing);
    vtkDataArray* const distance = ball->GetCellData()->GetArray("surface");
    vtkNew<vtkParticipatingMedium> filter;
    test::Errors errors(filter);
    filter->SetInputDataObject(ball);
    filter->SetAlbedo(0.0, 0.0, 0.0);
    filter->Update();
    claims.That(errors.WasOneWith("Switch LevelSet on"), "a level set as density is a warning");
    filter->LevelSetOn();
    filter->SetExtinctionScale(3.0);
    filter->Update();
    claims.That(errors.None(), "a level set as such is none");
    bool right = true;
    for (vtkIdType i = 0; i < 8000; ++i)
    {
      const double inside = -distance->GetComponent(i, 0) / spacing; // voxels
      right = right && std::abs(At(filter, "sigma_a", i) - 3.0 * std::min(std::max(inside, 0.0), 1.0)) < 1e-5;
    }
    claims.That(right, "fog fills the inside, with a ramp of a voxel");
  }

  // What a file says, where the border says nothing; and what is none.
  const auto cut = Ball("surface", 1.0);
  cut->GetCellData()->GetArray("surface")->SetComponent(0, 0, -1.0);
  vtkNew<vtkParticipatingMedium> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(cut);
  filter->Update();
  claims.That(errors.None(), "an array that is negative on the border is no level set");
  vtkNew<vtkStringArray> kind;
  kind->SetName("vdb:surface:class");
  kind->InsertNextValue("level set");
  cut->GetFieldData()->AddArray(kind);
  cut->Modified();
  filter->Update();
  claims.That(errors.WasOneWith("level set"), "unless its file says that it is");
  const auto tissue = Ball("ct", -1.0); // negative around
  filter->SetInputDataObject(tissue);
  filter->Update();
  claims.That(errors.None(), "a density that is negative around is none");
}

void BadInputIsOneError(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> filter;
  test::Errors errors(filter);
  const auto refused = [&](vtkImageData* image, const char* part) {
    filter->SetInputDataObject(image);
    filter->Update();
    claims.That(errors.WasOneWith(part), std::string("refused: ") + part);
    claims.That(filter->GetOutput()->GetNumberOfCells() == 0, "the output is empty after an error");
  };

  refused(test::MakeImage({}), "no active Scalars");
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "smoke");
  refused(Ramp(), "no array 'smoke'. Its cell arrays: 'density'");
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "density");

  auto image = test::MakeImage({});
  test::AddCells(image, "density", 1.0, 3);
  refused(image, "'density' has 3 components");
  image = Ramp();
  image->GetCellData()->GetArray("density")->SetComponent(2, 0, std::numeric_limits<double>::quiet_NaN());
  refused(image, "voxel (2, 0, 0)");
  refused(test::MakeImage({ { 4, 4, 0 } }), "single layer of points along z");
  refused(vtkSmartPointer<vtkImageData>::New(), "is empty");

  const auto refusedSettings = [&](const char* part) { refused(Ramp(), part); };
  filter->SetMinimumDensity(2.0);
  refusedSettings("MinimumDensity");
  filter->SetMinimumDensity(0.0);
  filter->SetExtinctionScale(-1.0);
  refusedSettings("ExtinctionScale");
  filter->SetExtinctionScale(1.0);
  filter->SetAlbedo(0.5, 1.5, 0.5);
  refusedSettings("Albedo");
  filter->SetAlbedo(0.5, 0.5, 0.5);
  filter->SetMeanCosine(1.0);
  refusedSettings("MeanCosine");
  filter->SetMeanCosine(0.0);
  filter->SetEmissionScale(-1.0);
  refusedSettings("EmissionScale");
  filter->SetEmissionScale(0.0);
  filter->SetPreset(vtkParticipatingMedium::CREAM);
  filter->SetMillimetresPerUnit(0.0);
  refusedSettings("MillimetresPerUnit");
  filter->SetMillimetresPerUnit(1.0);

  filter->Update();
  claims.That(errors.None() && filter->GetOutput()->GetNumberOfCells() == 4, "good input after bad is taken");
}

void BadPhaseFunctionsAreOneError(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(Ramp());
  const auto refusedSettings = [&](const char* part) {
    filter->Update();
    claims.That(errors.WasOneWith(part), std::string("refused: ") + part);
  };
  filter->AddChannelMeanCosine(0.5);
  refusedSettings("ChannelMeanCosines has 1 number;");
  filter->SetChannelMeanCosines(0.5, 0.5, -1.0);
  refusedSettings("ChannelMeanCosines is -1");
  filter->RemoveAllChannelMeanCosines();
  filter->SetSecondMeanCosine(1.0);
  refusedSettings("SecondMeanCosine is 1");
  filter->SetSecondMeanCosine(0.0);
  filter->SetFirstPart(1.5);
  refusedSettings("FirstPart");
  filter->SetFirstPart(1.0);
  filter->SetPhaseFunction(6);
  refusedSettings("PhaseFunction");
  filter->SetPhaseFunction(vtkParticipatingMedium::HENYEY_GREENSTEIN);
  filter->Update();
  claims.That(errors.None() && filter->GetOutput()->GetNumberOfCells() == 4, "good numbers after bad are taken");
}
}

int TestParticipatingMedium(int, char*[])
{
  test::Claims claims;
  DensityIsARamp(claims);
  ColourMakesThreeComponents(claims);
  PresetsAreRealMedia(claims);
  UnitsOfLengthHaveNames(claims);
  WhatIsNotNeededCanBeWrittenAllTheSame(claims);
  WarnsWhereItIsTooThinOrTooThick(claims);
  TheOutputSaysHowItScatters(claims);
  ATableIsThePhaseFunction(claims);
  MeanCosinesByVoxelPassThrough(claims);
  PointsAreInTheMiddleOfVoxels(claims);
  OnePointAlongAnAxisIsOneVoxel(claims);
  LevelSetsAreFilledNotTakenForADensity(claims);
  AnyImageWillDo(claims);
  BadInputIsOneError(claims);
  BadPhaseFunctionsAreOneError(claims);
  return claims.Result();
}
