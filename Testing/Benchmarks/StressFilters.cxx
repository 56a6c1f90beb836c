#include "StressFilters.h"

#include "vtkFieldData.h"

namespace bench
{
void AddField(vtkImageData* image, const char* name, const std::vector<float>& values, int components)
{
  if (!values.empty())
  {
    test::AddValues<vtkFloatArray>(image->GetCellData(), name, image->GetNumberOfCells(), components,
      [&](vtkIdType i, int c) { return values[static_cast<std::size_t>(i * components + c)]; });
  }
}

vtkSmartPointer<vtkImageData> ImageOf(const StressScene& scene)
{
  test::Box box;
  box.cells = scene.cells;
  box.spacing = scene.spacing;
  const vtkSmartPointer<vtkImageData> image = test::MakeImage(box);
  AddField(image, "sigma_a", scene.absorption, scene.channels);
  AddField(image, "sigma_s", scene.scattering, scene.channels);
  AddField(image, "emission", scene.emission, scene.channels);
  AddField(image, "ior", scene.index, 1);
  test::AddValues<vtkDoubleArray>(image->GetFieldData(), "g", 1, 1, [&](vtkIdType, int) { return scene.g; });
  return image;
}

namespace
{
void AddLamp(vtkLightRig* rig, const Lamp& lamp, const StressScene& scene)
{
  const Vector &at = lamp.at, &to = lamp.along, &p = lamp.power;
  const double width = lamp.width > 0.0 ? lamp.width : 0.5 * scene.spacing[0];
  switch (lamp.kind)
  {
    case Lamp::Sun: rig->AddDirectionalLight(to[0], to[1], to[2], p[0], p[1], p[2]); break;
    case Lamp::Point: rig->AddPointLight(at[0], at[1], at[2], p[0], p[1], p[2]); break;
    case Lamp::Spot: rig->AddSpotLight(at[0], at[1], at[2], to[0], to[1], to[2], p[0], p[1], p[2], 60.0); break;
    case Lamp::Rectangle:
      rig->AddRectangleLight(at[0], at[1], at[2], to[0], to[1], to[2], p[0], p[1], p[2], width, width);
      break;
  }
}
}

void SetRig(vtkLightRig* rig, const StressScene& scene)
{
  rig->SetSun(false);
  for (const Lamp& lamp : scene.lamps)
  {
    AddLamp(rig, lamp, scene);
  }
}

std::vector<float> Floats(vtkDataSetAttributes* attributes, const char* name)
{
  std::vector<float> values;
  vtkDataArray* array = attributes->GetArray(name);
  for (vtkIdType i = 0; array && i < array->GetNumberOfValues(); ++i)
  {
    const int components = array->GetNumberOfComponents();
    values.push_back(static_cast<float>(array->GetComponent(i / components, static_cast<int>(i % components))));
  }
  return values;
}

namespace
{
std::vector<double> Facts(vtkDataObject* data, const char* name)
{
  std::vector<double> values;
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  for (vtkIdType i = 0; array && i < array->GetNumberOfValues(); ++i)
  {
    const int components = array->GetNumberOfComponents();
    values.push_back(array->GetComponent(i / components, static_cast<int>(i % components)));
  }
  return values;
}
}

void ReadLight(vtkImageData* image, StressOutcome& outcome)
{
  vtkCellData* cells = image->GetCellData();
  outcome.empty = image->GetNumberOfCells() == 0;
  outcome.fluence = Floats(cells, "fluence");
  outcome.fluenceDirect = Floats(cells, "fluence_direct");
  outcome.fluenceError = Floats(cells, "fluence_error");
  outcome.netFlux = Floats(cells, "net_flux");
  outcome.directions = Floats(cells, "mean_direction");
  outcome.balance = Facts(image, "energy_balance");
  outcome.facePowerOut = Facts(image, "face_power_out");
  outcome.halfRangeFlux = Facts(image, "half_range_flux");
  outcome.scattered = Facts(image, "scattered");
  vtkDataArray* fluence = cells->GetArray("fluence");
  outcome.channels = fluence ? fluence->GetNumberOfComponents() : 1;
}
}
