#include "MediumScene.h"

#include "vtkColorTransferFunction.h"
#include "vtkLightPropagationMaps.h"
#include "vtkMediumRayCaster.h"
#include "vtkParticipatingMedium.h"
#include "vtkPiecewiseFunction.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace
{
unsigned SeedOfTheDay()
{
  return static_cast<unsigned>(std::time(nullptr) / 86400);
}

using Color = std::array<double, 3>;

/// A filter that makes a medium of an image by transfer functions.
struct MediumOfVolume
{
  explicit MediumOfVolume(vtkImageData* image)
  {
    this->property->SetScalarOpacity(this->opacity);
    this->property->SetColor(this->colors);
    this->property->SetInterpolationTypeToLinear(); // the default is nearest
    this->filter->SetInputData(image);
    this->filter->SetVolumeProperty(this->property);
    this->filter->UseTransferFunctionsOn();
  }

  void Everywhere(double alpha, const Color& color)
  {
    this->opacity->RemoveAllPoints();
    this->opacity->AddPoint(0.0, alpha);
    this->colors->RemoveAllPoints();
    this->colors->AddRGBPoint(0.0, color[0], color[1], color[2]);
  }

  double At(const char* name, vtkIdType cell, int component = 0)
  {
    this->filter->Update();
    vtkDataArray* const array = this->filter->GetOutput()->GetCellData()->GetArray(name);
    return array ? array->GetComponent(cell, component) : std::numeric_limits<double>::quiet_NaN();
  }

  vtkNew<vtkPiecewiseFunction> opacity;
  vtkNew<vtkColorTransferFunction> colors;
  vtkNew<vtkVolumeProperty> property;
  vtkNew<vtkParticipatingMedium> filter;
};

/// Transmittance of a ray along z through voxels of spacing h, by the midpoints of steps of h / 50 through scalars that
/// are interpolated between values at distances h, at most 16 mean free paths a voxel.
double TransmittanceOf(
  vtkPiecewiseFunction* opacity, double unit, double h, const std::vector<double>& values, double before, double after)
{
  double tau = 0.0;
  const int steps = static_cast<int>(std::lround((before + values.size() - 1 + after) * 50));
  for (int i = 0; i < steps; ++i)
  {
    const double at = std::clamp((i + 0.5) / 50 - before, 0.0, values.size() - 1.0);
    const std::size_t low = std::min(static_cast<std::size_t>(at), values.size() - 2);
    const double alpha = opacity->GetValue(values[low] + (at - low) * (values[low + 1] - values[low]));
    tau += std::min(-std::log1p(-std::min(alpha, 1.0 - 1e-15)) / unit, 16.0 / h) * h / 50;
  }
  return std::exp(-tau);
}

/// Opacities are those of an integral in double precision along the ray, at points and cells, whatever the functions.
void OpacityIsThatOfTheIntegral(test::Claims& claims)
{
  std::mt19937 random(SeedOfTheDay());
  std::uniform_real_distribution<double> number(0.0, 1.0);
  constexpr int layers = 24;
  constexpr double h = 0.5;
  double worst = 0.0;
  for (int trial = 0; trial < 20; ++trial)
  {
    for (const bool ofPoints : { true, false })
    {
      const vtkSmartPointer<vtkImageData> image = test::MakeImage({ { 2, 2, layers }, { h, h, h } });
      const std::size_t sites = layers + (ofPoints ? 1 : 0);
      std::vector<double> values(sites);
      std::generate(values.begin(), values.end(), [&] { return static_cast<float>(number(random)); });
      const vtkIdType layer = ofPoints ? 9 : 4;
      test::AddValues<vtkFloatArray>(
        ofPoints ? static_cast<vtkFieldData*>(image->GetPointData()) : image->GetCellData(), "s",
        layer * static_cast<vtkIdType>(sites), 1, [&](vtkIdType i, int) { return values[i / layer]; });
      MediumOfVolume medium(image);
      medium.colors->AddRGBPoint(0.0, 0.0, 0.0, 0.0);
      for (int i = 0; i < 6; ++i)
      {
        const double highest = trial % 4 == 0 ? 1.0 : std::pow(0.1, trial % 4); // opaque, and thin
        medium.opacity->AddPoint(i / 5.0, i % 2 == 0 && trial % 2 == 0 ? 0.0 : highest * number(random));
      }
      const double unit = 0.25 * h * std::pow(200.0, number(random));
      medium.property->SetScalarOpacityUnitDistance(unit);
      medium.filter->SetPointData(
        trial % 2 == 0 ? vtkParticipatingMedium::VOXELS_AROUND_POINTS : vtkParticipatingMedium::AVERAGE_TO_CELLS);
      medium.filter->SetInputArrayToProcess(
        0, 0, 0, ofPoints ? vtkDataObject::FIELD_ASSOCIATION_POINTS : vtkDataObject::FIELD_ASSOCIATION_CELLS, "s");
      medium.filter->Update();
      vtkImageData* const made = medium.filter->GetOutput();
      int size[3];
      made->GetDimensions(size);
      const int across = size[0] - 1;
      // In voxels around points those in the middle of 3 x 3 are inside.
      const int middle = across == 3 ? 4 : 0;
      double tau = 0.0;
      for (int z = 0; z < size[2] - 1; ++z)
      {
        tau +=
          h * (medium.At("sigma_a", z * across * across + middle) + medium.At("sigma_s", z * across * across + middle));
      }
      const double beyond = ofPoints ? 0.0 : 0.5;
      const double expected = TransmittanceOf(medium.opacity, unit, h, values, beyond, beyond);
      worst = std::max(worst, std::abs(std::exp(-tau) - expected));
    }
  }
  claims.That(worst < 1.0 / 255.0,
    "transmittances are those of integrals, but for " + std::to_string(worst) + ", seed " +
      std::to_string(SeedOfTheDay()));
}

/// The bytes that a picture along the normal shows of a block that is 300 mean free paths thick, lit evenly from above.
std::array<double, 3> ShownColor(const Color& color, double tau, double g, int emptyLayers)
{
  const int layers = static_cast<int>(std::lround(300.0 / tau));
  const vtkSmartPointer<vtkImageData> image = test::MakeImage({ { 3, 3, layers + emptyLayers } });
  test::AddValues<vtkUnsignedCharArray>(image->GetCellData(), "s", image->GetNumberOfCells(), 1,
    [&](vtkIdType i, int) { return i < 9 * layers ? 1.0 : 0.0; });
  MediumOfVolume medium(image);
  medium.Everywhere(0.0, color);
  medium.opacity->AddPoint(1.0, -std::expm1(-0.1 * tau));
  medium.property->SetScalarOpacityUnitDistance(0.1);
  medium.property->SetInterpolationTypeToNearest();
  medium.filter->SetMeanCosine(g);
  medium.filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "s");
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputConnection(medium.filter->GetOutputPort());
  maps->SetPeriodicX(true);
  maps->SetPeriodicY(true);
  maps->SetFaceRadiance(0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetInputConnection(maps->GetOutputPort());
  caster->SetImageSize(5, 5);
  caster->SetCameraFocalPoint(1.5, 1.5, 0.0);
  caster->SetCameraPosition(1.5, 1.5, 2.0 * layers + emptyLayers + 10.0);
  caster->SetCameraViewUp(0.0, 1.0, 0.0);
  caster->SetCameraParallelProjection(true);
  caster->SetCameraParallelScale(1.0);
  caster->SetExposure(1.0);
  caster->SetToneCurve(vtkMediumRayCaster::LINEAR);
  caster->ShowBackgroundOff();
  caster->Update();
  vtkDataArray* const shown = caster->GetOutput()->GetPointData()->GetArray("color");
  std::array<double, 3> bytes = { -1.0, -1.0, -1.0 };
  for (int c = 0; c < 3 && shown; ++c)
  {
    bytes[c] = shown->GetComponent(12, c);
  }
  return bytes;
}

/// A thick block, lit evenly, shows the colours that were chosen.
void ThickBlockShowsItsColor(test::Claims& claims)
{
  const std::vector<Color> patches = { { 1.0, 0.1, 0.1 }, { 0.1, 0.8, 0.1 }, { 0.1, 0.1, 1.0 }, { 1.0, 1.0, 1.0 },
    { 0.5, 0.5, 0.5 } };
  for (const auto& [tau, g, empty, tolerance] : std::vector<std::tuple<double, double, int, double>>{
         { 0.5, 0.0, 0, 3.0 }, { 2.0, 0.0, 0, 3.0 }, { 10.0, 0.0, 0, 3.0 }, { 0.5, 0.0, 4, 3.0 } })
  {
    double worst = 0.0;
    std::string all;
    for (const Color& patch : patches)
    {
      const std::array<double, 3> shown = ShownColor(patch, tau, g, empty);
      for (int c = 0; c < 3; ++c)
      {
        worst = std::max(worst, std::abs(shown[c] - 255.0 * patch[c]));
        all += " " + std::to_string(static_cast<int>(shown[c]));
      }
    }
    claims.That(worst <= tolerance,
      "patches of " + std::to_string(tau) + " mean free paths a voxel, g " + std::to_string(g) + ", " +
        std::to_string(empty) + " empty layers, show their colours but for " + std::to_string(worst) + ":" + all);
  }
}

/// Components as vtkVolume has them.
void ComponentsAreThoseOfVolumes(test::Claims& claims)
{
  const vtkSmartPointer<vtkImageData> image = test::MakeImage({ { 2, 2, 2 } });
  test::AddValues<vtkFloatArray>(
    image->GetCellData(), "rgba", 8, 4, [](vtkIdType, int c) { return c == 3 ? 0.5 : 100.0 * c; });
  test::AddValues<vtkFloatArray>(
    image->GetCellData(), "two", 8, 2, [](vtkIdType, int c) { return c == 0 ? 0.25 : 0.5; });
  test::AddValues<vtkFloatArray>(
    image->GetCellData(), "three", 8, 3, [](vtkIdType, int c) { return c == 0 ? 3.0 : 2.0 * (c - 1) * 2.0; });
  MediumOfVolume medium(image);
  const auto choose = [&](const char* name) {
    medium.filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, name);
  };
  const auto extinction = [&](int component = 0) {
    return medium.At("sigma_a", 0, component) + medium.At("sigma_s", 0, component);
  };
  medium.opacity->AddPoint(0.0, 0.0);
  medium.opacity->AddPoint(1.0, 0.5);
  medium.opacity->AddPoint(5.0, 0.9);
  medium.colors->AddRGBPoint(0.0, 0.0, 0.0, 0.0);
  medium.colors->AddRGBPoint(1.0, 1.0, 1.0, 1.0);
  const auto sigmaOf = [&](double s) { return -std::log1p(-medium.opacity->GetValue(s)); };
  medium.property->IndependentComponentsOff();
  choose("two");
  claims.Near(extinction(), sigmaOf(0.5), 1e-3 * sigmaOf(0.5), "opacity by the second of two dependent components");
  const double quarter = medium.At("sigma_s", 0) / extinction();
  choose("rgba");
  claims.Near(extinction(2), sigmaOf(0.5), 1e-3 * sigmaOf(0.5), "opacity by the fourth component of RGBA");
  claims.That(
    medium.At("sigma_s", 0, 0) == 0.0 && medium.At("sigma_s", 0, 1) < medium.At("sigma_s", 0, 2), "colours of RGBA");
  medium.property->IndependentComponentsOn();
  choose("two");
  medium.property->SetScalarOpacity(1, medium.opacity);
  medium.property->SetColor(1, medium.colors);
  medium.property->SetComponentWeight(1, 0.5);
  medium.filter->SetVectorMode(vtkParticipatingMedium::ALL_COMPONENTS);
  claims.Near(extinction(), sigmaOf(0.25) + 0.5 * sigmaOf(0.5), 2e-3, "independent components are added by weight");
  medium.filter->SetVectorMode(vtkParticipatingMedium::COMPONENT);
  claims.Near(extinction(), sigmaOf(0.25), 1e-3, "one component");
  claims.Near(medium.At("sigma_s", 0) / extinction(), quarter, 1e-3, "colour by the first of two dependent components");
  choose("three");
  medium.filter->SetVectorMode(vtkParticipatingMedium::MAGNITUDE);
  claims.Near(extinction(), sigmaOf(5.0), 1e-2, "the magnitude of (3, 0, 4)");
  medium.filter->SetVectorMode(vtkParticipatingMedium::AS_COLORS);
  medium.colors->SetVectorModeToComponent();
  medium.colors->SetVectorComponent(2);
  claims.Near(extinction(), sigmaOf(4.0), 1e-2, "the component of the colour map");
}

void EmissionIsTheColorOfThickBodies(test::Claims& claims)
{
  const vtkSmartPointer<vtkImageData> image = test::MakeImage({ { 2, 2, 2 } });
  test::AddCells(image, "s", 1.0);
  MediumOfVolume medium(image);
  medium.Everywhere(0.5, { 1.0, 0.5, 0.0 });
  medium.filter->SetColorMeans(vtkParticipatingMedium::EMISSION);
  medium.filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "s");
  claims.Near(medium.At("sigma_a", 3), std::log(2.0), 1e-6, "extinction absorbs");
  claims.Near(medium.At("sigma_s", 3), 0.0, 0.0, "and scatters nothing");
  claims.Near(medium.At("emission", 3, 0), std::log(2.0), 1e-6, "red emission");
  claims.Near(medium.At("emission", 3, 1) / std::log(2.0), 0.2140, 1e-4, "green emission, decoded from sRGB");
  medium.filter->SetExtinctionScale(3.0);
  claims.Near(medium.At("sigma_a", 3), 3.0 * std::log(2.0), 1e-5, "the factor of the coefficients");
  medium.opacity->AddPoint(0.0, 0.75);
  claims.Near(medium.At("sigma_a", 3), 3.0 * std::log(4.0), 1e-5, "an edited function runs the filter");
}

void EmptyIsWhatIsNoNumberOrHidden(test::Claims& claims)
{
  const vtkSmartPointer<vtkImageData> image = test::MakeImage({ { 4, 1, 1 } });
  test::AddValues<vtkDoubleArray>(image->GetCellData(), "s", 4, 1,
    [](vtkIdType i, int) { return i == 1 ? std::numeric_limits<double>::quiet_NaN() : 1.0; });
  vtkUnsignedCharArray* const flags = image->AllocateCellGhostArray();
  flags->SetValue(3, vtkDataSetAttributes::HIDDENCELL);
  MediumOfVolume medium(image);
  medium.Everywhere(0.5, { 0.0, 0.0, 0.0 });
  medium.filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "s");
  for (vtkIdType i = 0; i < 4; ++i)
  {
    claims.Near(medium.At("sigma_a", i), i % 2 == 0 ? std::log(2.0) : 0.0, 1e-6, "voxel " + std::to_string(i));
  }
}

void WhatIsNotSupportedIsSaid(test::Claims& claims)
{
  const vtkSmartPointer<vtkImageData> image = test::MakeImage({ { 2, 2, 2 } });
  test::AddCells(image, "s", 1.0);
  test::AddCells(image, "v", 1.0, 3);
  const auto says = [&](const char* array, const char* what, const std::function<void(MediumOfVolume&)>& spoil) {
    MediumOfVolume medium(image);
    medium.Everywhere(0.5, { 0.0, 0.0, 0.0 });
    medium.filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, array);
    spoil(medium);
    test::Errors errors(medium.filter);
    medium.filter->Update();
    claims.That(errors.WasOneWith(what), std::string("one error says: ") + what);
  };
  says("s", "two dimensions",
    [](MediumOfVolume& medium) { medium.property->SetTransferFunctionMode(vtkVolumeProperty::TF_2D); });
  says("s", "gradient opacity", [](MediumOfVolume& medium) { medium.property->SetGradientOpacity(medium.opacity); });
  says("s", "unit distance", [](MediumOfVolume& medium) { medium.property->SetScalarOpacityUnitDistance(0.0); });
  says("v", "3 components", [](MediumOfVolume& medium) { medium.property->IndependentComponentsOff(); });
  says("v", "VectorComponent is 3", [](MediumOfVolume& medium) {
    medium.filter->SetVectorMode(vtkParticipatingMedium::COMPONENT);
    medium.filter->SetVectorComponent(3);
  });
  says("s", "no transfer functions", [](MediumOfVolume& medium) { medium.filter->SetVolumeProperty(nullptr); });
}
}

int TestMediumOfVolume(int, char*[])
{
  test::Claims claims;
  OpacityIsThatOfTheIntegral(claims);
  ComponentsAreThoseOfVolumes(claims);
  EmissionIsTheColorOfThickBodies(claims);
  EmptyIsWhatIsNoNumberOrHidden(claims);
  WhatIsNotSupportedIsSaid(claims);
  return test::WithDevice(ThickBlockShowsItsColor, claims);
}
