#include "MediumScene.h"

#include "vtkMediumRayCaster.h"
#include "vtkStringArray.h"

#include "Numerics/Constants.h"

#include <cmath>
#include <string>
#include <vector>

namespace
{
using tyndall::Pi;

/// A slab of 3 lengths along z, seen from above.
struct Slab
{
  vtkSmartPointer<vtkImageData> medium = test::MakeMedium({ { 8, 8, 24 }, { 0.25, 0.25, 0.125 } }, 0.1, 0.4);
  vtkNew<vtkMediumRayCaster> caster;

  Slab()
  {
    test::AddCells(this->medium, "fluence", 4.0 * Pi);
    this->caster->SetInputData(this->medium);
    this->caster->SetImageSize(9, 9);
    this->caster->SetCameraFocalPoint(1.0, 1.0, 1.5);
    this->caster->SetCameraPosition(1.0, 1.0, 9.0);
    this->caster->SetCameraViewUp(0.0, 1.0, 0.0);
    this->caster->SetCameraParallelProjection(true);
    this->caster->SetCameraParallelScale(0.5);
  }

  void SetG(double g)
  {
    test::AddValues<vtkDoubleArray>(this->medium->GetFieldData(), "g", 1, 1, [g](vtkIdType, int) { return g; });
  }

  void SetG(const std::vector<double>& g)
  {
    test::AddValues<vtkDoubleArray>(
      this->medium->GetFieldData(), "g", 3, 1, [&](vtkIdType channel, int) { return g[channel]; });
  }

  void SetPhaseFunction(const char* name)
  {
    vtkNew<vtkStringArray> text;
    text->SetName("phase_function");
    text->InsertNextValue(name);
    this->medium->GetFieldData()->AddArray(text);
  }

  void SetMeanDirection(double x, double y, double z)
  {
    const double direction[3] = { x, y, z };
    test::AddValues<vtkFloatArray>(this->medium->GetCellData(), "mean_direction", this->medium->GetNumberOfCells(), 3,
      [&](vtkIdType, int c) { return direction[c]; });
  }

  /// A pane of n = 1.5 in n = 1.
  void AddGlass()
  {
    test::AddValues<vtkFloatArray>(this->medium->GetCellData(), "ior", this->medium->GetNumberOfCells(), 1,
      [](vtkIdType cell, int) { return 1.0 + 0.25 * (std::erfc(7.5 - cell / 64) - std::erfc(16.5 - cell / 64)); });
  }

  double Radiance(int channel = 0)
  {
    this->caster->Update();
    vtkDataArray* radiance = this->caster->GetOutput()->GetPointData()->GetArray("radiance");
    return radiance ? radiance->GetComponent(40, channel) : std::nan("");
  }
};

void LightOfKnownDirectionScattersByThePhaseFunction(test::Claims& claims)
{
  const double even = 0.8 * (1.0 - std::exp(-0.5 * 3.0)); // albedo times what a slab of evenly scattered light shows
  Slab slab;
  slab.SetG(0.6);
  claims.Near(slab.Radiance(), even, 1e-5, "radiance where no direction is known");
  for (double length : { 0.0, 0.5, 1.0 })
  {
    for (double cosine : { -1.0, 0.0, 0.5 }) // from the light's direction to that towards the camera, +z
    {
      slab.SetMeanDirection(length * std::sqrt(1.0 - cosine * cosine), 0.0, length * cosine);
      const double g = 0.6 * length;
      const std::string light =
        "light of anisotropy " + std::to_string(length) + " at cosine " + std::to_string(cosine);
      const double henyey = (1.0 - g * g) / std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5);
      claims.Near(slab.Radiance() / even, henyey, 2e-5 * henyey, "Henyey and Greenstein's scattering of " + light);
    }
  }
  slab.SetMeanDirection(0.6, 0.0, 0.8);
  slab.SetPhaseFunction("rayleigh");
  slab.SetG(0.0);
  const double rayleigh = 0.75 * (1.0 + 0.8 * 0.8);
  claims.Near(slab.Radiance() / even, rayleigh, 2e-5 * rayleigh, "Rayleigh's scattering, by the medium's field data");
  slab.SetPhaseFunction("henyey_greenstein");
  slab.SetG({ 0.6, 0.0, -0.6 });
  for (int c = 0; c < 3; ++c)
  {
    const double g = 0.6 - 0.6 * c, henyey = (1.0 - g * g) / std::pow(1.0 + g * g - 1.6 * g, 1.5);
    claims.Near(slab.Radiance(c) / even, henyey, 2e-5 * henyey, "each channel by its own g");
  }
  slab.SetG(0.0);
  claims.Near(slab.Radiance(), even, 1e-5, "without g the direction does not count");
  slab.SetG(0.3);
  test::AddValues<vtkFloatArray>(slab.medium->GetCellData(), "g", slab.medium->GetNumberOfCells(), 1,
    [](vtkIdType cell, int) { return cell % 2 == 0 ? 0.5 : 0.5000001; });
  const double byVoxel = 0.75 / std::pow(1.25 - 0.8, 1.5);
  claims.Near(slab.Radiance() / even, byVoxel, 2e-5 * byVoxel, "cells g count before field data");
}

void ArraysCanBeChosen(test::Claims& claims)
{
  Slab slab;
  slab.SetG(0.6);
  slab.SetMeanDirection(0.0, 0.0, 1.0);
  slab.AddGlass();
  slab.caster->SetTableFace(4);
  const double expected = slab.Radiance();
  slab.medium->GetCellData()->GetArray("mean_direction")->SetName("m");
  claims.That(std::abs(slab.Radiance() - expected) > 0.01, "a direction of another name does not count");
  slab.caster->SetInputArrayToProcess(6, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "m");
  claims.Near(slab.Radiance(), expected, 0.0, "radiance of a chosen direction");
  slab.caster->SetCameraPosition(9.0, 1.0, 9.0);
  const double bent = slab.Radiance();
  slab.medium->GetCellData()->GetArray("ior")->SetName("n");
  claims.That(std::abs(slab.Radiance() - bent) > 1e-3, "an index of another name does not count");
  slab.caster->SetInputArrayToProcess(5, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "n");
  claims.Near(slab.Radiance(), bent, 0.0, "radiance of a chosen index");
}

void SurfacesMirror(test::Claims& claims)
{
  Slab slab;
  test::AddCells(slab.medium, "sigma_a", 0.0);
  test::AddCells(slab.medium, "sigma_s", 0.0);
  slab.AddGlass();
  slab.caster->SetBackgroundRadiance(1.0, 1.0, 1.0);
  slab.caster->SetCameraPosition(1.0, 1.0, -9.0); // from the side of the smaller index
  claims.Near(slab.Radiance(), 1.0, 1e-4, "an even sky through glass");
  test::AddCells(slab.medium, "fluence", 0.0);
  slab.caster->SetTableFace(5); // behind the glass, and dark: there is no light on it
  slab.caster->SetTableReflectance(0.0);
  claims.Near(slab.Radiance(), 0.0, 1e-5, "a dark table behind glass");
  slab.caster->SetSurfaceReflection(vtkMediumRayCaster::FIXED);
  slab.caster->SetSurfaceReflectance(0.3);
  claims.Near(slab.Radiance(), 0.3, 1e-3, "the sky in a surface of fixed reflectance");
  slab.caster->SetSurfaceReflection(vtkMediumRayCaster::FRESNEL);
  claims.Near(slab.Radiance(), 0.04, 1e-3, "the sky in glass of n = 1.5");
}

void ATableShowsTheLightOnIt(test::Claims& claims)
{
  Slab slab;
  test::AddCells(slab.medium, "sigma_a", 0.0);
  test::AddCells(slab.medium, "sigma_s", 0.0);
  slab.caster->SetTableFace(4);
  slab.caster->SetTableColor(0.8, 0.4, 0.0);
  const double red = slab.Radiance(0);
  claims.That(red > 0.0, "the table is seen");
  claims.Near(slab.Radiance(1), 0.5 * red, 1e-5 * red, "its colour");
  claims.Near(slab.Radiance(2), 0.0, 1e-6, "what it does not reflect");
}

void BadSettingsAreOneError(test::Claims& claims)
{
  const auto refused = [&](const char* part, auto change) {
    Slab slab;
    slab.AddGlass();
    slab.SetMeanDirection(0.0, 0.0, 1.0);
    change(slab);
    test::Errors errors(slab.caster);
    slab.caster->Update();
    claims.That(errors.WasOneWith(part), std::string("refused: ") + part);
    claims.That(slab.caster->GetOutput()->GetNumberOfPoints() == 0, std::string("empty output after: ") + part);
  };
  const auto mirror = [](Slab& slab) { slab.caster->SetSurfaceReflection(vtkMediumRayCaster::FIXED); };
  refused("SurfaceIndex is -0.5", [&](Slab& slab) {
    mirror(slab);
    slab.caster->SetSurfaceIndex(-0.5);
  });
  refused("SurfaceReflectance is 1.5", [&](Slab& slab) {
    mirror(slab);
    slab.caster->SetSurfaceReflectance(1.5);
  });
  refused("table", [](Slab& slab) {
    slab.caster->SetTableFace(0);
    slab.caster->SetTableReflectance(0.7);
  });
  refused("TableColor is (-0.1, 0, 0)", [](Slab& slab) {
    slab.caster->SetTableFace(0);
    slab.caster->SetTableColor(-0.1, 0.0, 0.0);
  });
  refused("refractive index", [](Slab& slab) { test::AddCells(slab.medium, "ior", 0.0); });
  refused("components", [](Slab& slab) { test::AddCells(slab.medium, "ior", 1.5, 3); });
  refused("components", [](Slab& slab) { test::AddCells(slab.medium, "mean_direction", 0.5, 1); });
  refused("mean_direction", [](Slab& slab) { test::AddCells(slab.medium, "mean_direction", HUGE_VAL, 3); });
}
}

int TestMediumRayCasterRefracts(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    LightOfKnownDirectionScattersByThePhaseFunction(claims);
    ArraysCanBeChosen(claims);
    SurfacesMirror(claims);
    ATableShowsTheLightOnIt(claims);
    BadSettingsAreOneError(claims);
  });
}
