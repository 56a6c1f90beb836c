#include "MediumScene.h"

#include "vtkParticipatingMedium.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <limits>

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

double MeanCosineOf(vtkParticipatingMedium* filter)
{
  vtkDataArray* g = filter->GetOutput()->GetFieldData()->GetArray("g");
  return g ? g->GetTuple1(0) : std::numeric_limits<double>::quiet_NaN();
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
  filter->Update();
  claims.That(errors.None(), "points of bytes, in an odd box");
  claims.Near(At(filter, "sigma_s", 0), 0.5, 1e-6, "average of a cell with half of its points dense");
  claims.Near(At(filter, "sigma_s", 1), 0.0, 1e-6, "average of a cell with no point dense");
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
}

int TestParticipatingMedium(int, char*[])
{
  test::Claims claims;
  DensityIsARamp(claims);
  ColourMakesThreeComponents(claims);
  PresetsAreRealMedia(claims);
  AnyImageWillDo(claims);
  BadInputIsOneError(claims);
  return claims.Result();
}
