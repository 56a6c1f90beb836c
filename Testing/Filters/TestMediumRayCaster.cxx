#include "MediumScene.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkDiscreteOrdinates.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLightPropagationMaps.h"
#include "vtkLightRig.h"
#include "vtkMediumRayCaster.h"
#include "vtkParticipatingMedium.h"
#include "vtkPNGWriter.h"
#include "vtkPointData.h"
#include "vtkTestUtilities.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVersion.h"

#include "Numerics/Constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace
{
using tyndall::Pi;

/// An array of `values` in every cell, or function(x, y, z, component) of the cell's place in the unit cube.
template <class Function>
void AddCells(vtkImageData* image, const char* name, int components, const Function& function)
{
  int extent[6];
  image->GetExtent(extent);
  const int n[3] = { extent[1] - extent[0], extent[3] - extent[2], extent[5] - extent[4] };
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(image->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < image->GetNumberOfCells(); ++cell)
  {
    const double x = (cell % n[0] + 0.5) / n[0];
    const double y = (cell / n[0] % n[1] + 0.5) / n[1];
    const double z = (cell / (n[0] * n[1]) + 0.5) / n[2];
    for (int c = 0; c < components; ++c)
    {
      array->SetComponent(cell, c, function(x, y, z, c));
    }
  }
  image->GetCellData()->AddArray(array);
}

/// A box of uneven extent, far from the origin, filled alike.
vtkNew<vtkImageData> Homogeneous(double sigma_a, double sigma_s, double fluence)
{
  vtkNew<vtkImageData> image;
  image->SetExtent(3, 13, -2, 6, 1, 13);
  image->SetSpacing(0.5, 0.5, 0.25);
  image->SetOrigin(20.0, 0.0, -7.0);
  AddCells(image, "sigma_a", 1, [&](double, double, double, int) { return sigma_a; });
  AddCells(image, "sigma_s", 1, [&](double, double, double, int) { return sigma_s; });
  AddCells(image, "fluence", 3, [&](double, double, double, int c) { return fluence * (c + 1); });
  return image;
}

vtkDataArray* Pixels(vtkMediumRayCaster* caster, const char* name)
{
  return caster->GetOutput()->GetPointData()->GetArray(name);
}

double MiddlePixel(vtkMediumRayCaster* caster, const char* name, int component = 0)
{
  vtkDataArray* array = Pixels(caster, name);
  const int* size = caster->GetImageSize();
  return array ? array->GetComponent((size[1] / 2) * size[0] + size[0] / 2, component)
               : std::numeric_limits<double>::quiet_NaN();
}

/// Looks down on the image's middle, parallel.
void LookDown(vtkMediumRayCaster* caster, vtkImageData* image)
{
  const double* centre = image->GetCenter();
  caster->SetCameraFocalPoint(centre[0], centre[1], centre[2]);
  caster->SetCameraPosition(centre[0], centre[1], image->GetBounds()[5] + 10.0);
  caster->SetCameraViewUp(0.0, 1.0, 0.0);
  caster->SetCameraParallelProjection(true);
  caster->SetCameraParallelScale(1.0);
}

void SlabFollowsTheClosedForm(test::Claims& claims)
{
  const vtkNew<vtkImageData> image = Homogeneous(0.1, 0.4, 4.0 * Pi);
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetInputData(image);
  caster->SetImageSize(41, 31);
  LookDown(caster, image);
  caster->SetBackgroundRadiance(1.0, 0.0, 0.0);
  caster->Update();
  vtkImageData* picture = caster->GetOutput();
  claims.That(
    picture->GetDimensions()[0] == 41 && picture->GetDimensions()[1] == 31 && picture->GetDimensions()[2] == 1,
    "the picture has ImageSize pixels");
  const double left = std::exp(-0.5 * 3.0);
  claims.Near(MiddlePixel(caster, "alpha"), 1.0 - left, 1e-5, "alpha");
  claims.Near(MiddlePixel(caster, "radiance", 0), 0.8 * (1.0 - left) + left, 1e-5, "red radiance with the background");
  claims.Near(MiddlePixel(caster, "radiance", 2), 3.0 * 0.8 * (1.0 - left), 1e-5, "blue radiance");
  claims.Near(MiddlePixel(caster, "depth"), 10.0 + std::log(2.0) / 0.5, 1e-3, "depth");
  auto* color = vtkArrayDownCast<vtkUnsignedCharArray>(picture->GetPointData()->GetScalars());
  claims.That(color && color->GetName() == std::string("color") && color->GetNumberOfComponents() == 4,
    "color is the active scalars");
  claims.Near(MiddlePixel(caster, "color", 3), 255.0, 0.0, "color's alpha with the background");
  claims.That(picture->GetFieldData()->GetAbstractArray("device") != nullptr, "the device is field data");
  claims.Near(picture->GetFieldData()->GetArray("exposure")->GetTuple1(0), caster->GetUsedExposure(), 0.0, "exposure");

  caster->ShowBackgroundOff();
  caster->SetExposure(0.5);
  caster->SetToneCurve(vtkMediumRayCaster::LINEAR);
  caster->Update();
  claims.Near(MiddlePixel(caster, "radiance", 0), 0.8 * (1.0 - left), 1e-5, "red radiance alone");
  claims.Near(caster->GetUsedExposure(), 0.5, 0.0, "the exposure that was set");
  caster->SetExposure(0.2);
  caster->Update();
  claims.Near(MiddlePixel(caster, "color", 3), 255.0 * (1.0 - left), 0.6, "color's alpha without the background");
}

/// Whatever it is exposed to, and however little of what is behind it hides.
void SmokeLaidOverBlackLooksAsBeforeBlack(test::Claims& claims)
{
  for (const double sigma_t : { 0.001, 0.01, 0.1, 2.0 })
  {
    const vtkNew<vtkImageData> image = Homogeneous(0.2 * sigma_t, 0.8 * sigma_t, 4.0 * Pi);
    vtkNew<vtkMediumRayCaster> caster;
    caster->SetInputData(image);
    caster->SetImageSize(9, 9);
    LookDown(caster, image);
    for (const double exposure : { 0.0, 0.5 })
    {
      const std::string which = ": sigma_t " + std::to_string(sigma_t) + ", exposure " + std::to_string(exposure);
      caster->SetExposure(exposure);
      double before[3];
      caster->ShowBackgroundOn();
      caster->Update();
      for (int c = 0; c < 3; ++c)
      {
        before[c] = MiddlePixel(caster, "color", c);
      }
      caster->ShowBackgroundOff();
      caster->Update();
      const double opacity = MiddlePixel(caster, "color", 3) / 255.0;
      for (int c = 0; c < 3; ++c)
      {
        claims.Near(MiddlePixel(caster, "color", c) * opacity, before[c], 1.0, "smoke laid over black" + which);
      }
      claims.Near(
        MiddlePixel(caster, "alpha"), 1.0 - std::exp(-3.0 * sigma_t), 1e-5, "alpha is what the smoke hides" + which);
    }
  }
}

void PointArraysAndChosenNamesServe(test::Claims& claims)
{
  const vtkNew<vtkImageData> image = Homogeneous(0.1, 0.4, 4.0 * Pi);
  vtkNew<vtkFloatArray> points;
  points->SetName("haze");
  points->SetNumberOfTuples(image->GetNumberOfPoints());
  points->Fill(0.4);
  image->GetPointData()->AddArray(points);
  image->GetCellData()->RemoveArray("sigma_s");
  image->GetCellData()->GetArray("fluence")->SetName("light");
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetInputData(image);
  caster->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "haze");
  caster->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "light");
  caster->SetImageSize(9, 9);
  LookDown(caster, image);
  caster->Update();
  claims.Near(MiddlePixel(caster, "radiance", 0), 0.8 * (1.0 - std::exp(-1.5)), 1e-5, "radiance of chosen arrays");
}

void UntouchedCameraSeesTheWholeBox(test::Claims& claims)
{
  const vtkNew<vtkImageData> image = Homogeneous(1e3, 0.0, 0.0);
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetInputData(image);
  for (int up = 0; up < 3; ++up)
  {
    caster->SetCameraViewUp(up == 0, up == 1, up == 2);
    caster->SetImageSize(80, 60);
    caster->Update();
    vtkDataArray* alpha = Pixels(caster, "alpha");
    bool edgeIsFree = true;
    int covered = 0;
    for (int pixel = 0; pixel < 80 * 60; ++pixel)
    {
      const int i = pixel % 80;
      const int j = pixel / 80;
      const bool opaque = alpha->GetTuple1(pixel) > 0.5;
      edgeIsFree = edgeIsFree && !(opaque && (i == 0 || j == 0 || i == 79 || j == 59));
      covered += opaque;
    }
    claims.That(edgeIsFree, "the box is inside the picture");
    claims.That(covered > 80 * 60 / 4, "the box fills a good part of the picture");
  }
}

void LightsServeWhereThereIsNoFluence(test::Claims& claims)
{
  const vtkNew<vtkImageData> image = Homogeneous(0.0, 0.01, 0.0);
  image->GetCellData()->RemoveArray("fluence");
  vtkNew<vtkLightRig> rig;
  rig->SetSunElevation(90.0);
  rig->SetSunPower(2.0, 2.0, 2.0);
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetInputData(image);
  caster->SetLightsConnection(rig->GetOutputPort());
  caster->SetImageSize(9, 9);
  LookDown(caster, image);
  caster->Update();
  const double expected = 2.0 / (4.0 * Pi) * -std::expm1(-2.0 * 0.01 * 3.0) / 2.0;
  claims.Near(MiddlePixel(caster, "radiance", 1), expected, 1e-3 * expected, "light that scattered once");
}

/// Latitude-longitude image of `above` over `below` the horizon.
vtkNew<vtkImageData> Environment(float above, float below)
{
  vtkNew<vtkImageData> environment;
  environment->SetDimensions(8, 4, 1);
  vtkNew<vtkFloatArray> radiance;
  radiance->SetName("radiance");
  radiance->SetNumberOfComponents(3);
  for (int pixel = 0; pixel < 32; ++pixel)
  {
    const float value = pixel < 16 ? below : above;
    radiance->InsertNextTuple3(value, value, value);
  }
  environment->GetPointData()->SetScalars(radiance);
  return environment;
}

void EnvironmentIsTheBackground(test::Claims& claims)
{
  const vtkNew<vtkImageData> image = Homogeneous(0.0, 0.0, 0.0);
  const vtkNew<vtkImageData> environment = Environment(3.0f, 1.0f);
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetInputData(image);
  caster->SetEnvironmentData(environment);
  caster->SetImageSize(9, 9);
  LookDown(caster, image);
  caster->SetBackgroundRadiance(9.0, 9.0, 9.0);
  caster->Update();
  claims.Near(MiddlePixel(caster, "radiance"), 1.0, 1e-5, "what is below");
  caster->SetCameraPosition(image->GetCenter()[0], image->GetCenter()[1], -100.0);
  caster->Update();
  claims.Near(MiddlePixel(caster, "radiance"), 3.0, 1e-5, "what is above");
}

void BadInputIsAnError(test::Claims& claims)
{
  const auto refused = [&](const char* part, auto change) {
    const vtkNew<vtkImageData> image = Homogeneous(0.1, 0.4, 1.0);
    vtkNew<vtkMediumRayCaster> caster;
    caster->SetInputData(image);
    caster->SetImageSize(9, 9);
    change(caster.Get(), image.Get());
    test::Errors errors(caster);
    caster->Update();
    claims.That(errors.WasOneWith(part), std::string("refused: ") + part);
    claims.That(caster->GetOutput()->GetNumberOfPoints() == 0, std::string("empty output after: ") + part);
    // The application lives on.
    const vtkNew<vtkImageData> good = Homogeneous(0.1, 0.4, 1.0);
    vtkNew<vtkMediumRayCaster> next;
    next->SetInputData(good);
    next->SetImageSize(9, 9);
    next->Update();
    claims.That(next->GetOutput()->GetNumberOfPoints() == 81, "the next picture is right");
  };
  refused("sigma_s", [](vtkMediumRayCaster*, vtkImageData* image) { image->GetCellData()->RemoveArray("sigma_s"); });
  refused("nan", [](vtkMediumRayCaster*, vtkImageData* image) {
    image->GetCellData()->GetArray("sigma_a")->SetComponent(5, 0, std::nan(""));
  });
  refused("fluence", [](vtkMediumRayCaster*, vtkImageData* image) {
    image->GetCellData()->GetArray("fluence")->SetComponent(5, 0, HUGE_VAL);
  });
  refused("components", [](vtkMediumRayCaster*, vtkImageData* image) {
    image->GetCellData()->RemoveArray("fluence");
    AddCells(image, "fluence", 2, [](double, double, double, int) { return 1.0; });
  });
  refused("fluence_direct", [](vtkMediumRayCaster* caster, vtkImageData*) { caster->SingleScatteringOnlyOn(); });
  refused("no array 'foo'", [](vtkMediumRayCaster* caster, vtkImageData*) {
    caster->SetInputArrayToProcess(5, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "foo");
  });
  refused("StepSize is 0", [](vtkMediumRayCaster* caster, vtkImageData*) { caster->SetStepSize(0.0); });
  for (double step : { 1e-30, 1e-6, 1e300, std::nan("") })
  {
    refused("StepSize", [=](vtkMediumRayCaster* caster, vtkImageData*) { caster->SetStepSize(step); });
  }
  for (double colour : { -1.0, 1e39, HUGE_VAL, std::nan("") })
  {
    refused("BackgroundRadiance",
      [=](vtkMediumRayCaster* caster, vtkImageData*) { caster->SetBackgroundRadiance(0.1, colour, 0.2); });
  }
  for (double exposure : { -1.0, 1e39, HUGE_VAL, std::nan("") })
  {
    refused("Exposure", [=](vtkMediumRayCaster* caster, vtkImageData*) { caster->SetExposure(exposure); });
  }
  refused("too far", [](vtkMediumRayCaster* caster, vtkImageData*) { caster->SetCameraPosition(1e308, 0, 0); });
  refused("pixels", [](vtkMediumRayCaster* caster, vtkImageData*) { caster->SetImageSize(50000, 50000); });
  refused("parallel scale", [](vtkMediumRayCaster* caster, vtkImageData*) {
    caster->SetCameraPosition(0, -5, 0.1);
    caster->SetCameraParallelProjection(true);
    caster->SetCameraParallelScale(1e300);
  });
  refused("view up", [](vtkMediumRayCaster* caster, vtkImageData*) {
    caster->SetCameraPosition(0, 0, 5);
    caster->SetCameraViewUp(0, 0, 1);
  });
  refused("view angle", [](vtkMediumRayCaster* caster, vtkImageData*) { caster->SetCameraViewAngle(180.0); });
  refused("ImageSize is (0, 9)", [](vtkMediumRayCaster* caster, vtkImageData*) { caster->SetImageSize(0, 9); });
  refused("no such device", [](vtkMediumRayCaster* caster, vtkImageData*) { caster->SetDevice("no such device"); });
}

// Voxels ten mean free paths thick under a sky of radiance 1: 1 - sqrt(1 - albedo) H(1) leaves, of which their centres
// have half.
void ThickVoxelsShineAtTheirSurface(test::Claims& claims)
{
  const vtkNew<vtkImageData> image = Homogeneous(0.2, 19.8, 0.0);
  vtkNew<vtkLightPropagationMaps> solver;
  solver->SetInputData(image);
  solver->SetSkyColor(1.0, 1.0, 1.0);
  solver->EstimateErrorOn();
  solver->Update();
  vtkImageData* const lit = vtkImageData::SafeDownCast(solver->GetOutputDataObject(0));
  vtkDataArray* const surface = lit->GetFieldData()->GetArray("surface_radiance");
  vtkDataArray* const error = lit->GetFieldData()->GetArray("surface_radiance_error");
  vtkDataArray* const length = lit->GetFieldData()->GetArray("error_length");
  claims.That(surface && error && error->GetNumberOfTuples() == surface->GetNumberOfTuples() && length &&
      length->GetComponent(0, 0) > 0.0,
    "the solver tells the error of what leaves, and its errors' length");
  claims.That(surface && surface->GetNumberOfTuples() == 2 * (10 * 8 + 8 * 12 + 12 * 10),
    "the solver says what leaves every face at the box's");
  const auto seen = [&](vtkImageData* medium, const char* fluence) {
    vtkNew<vtkMediumRayCaster> caster;
    caster->SetInputData(medium);
    caster->SetImageSize(9, 9);
    caster->SetShowBackground(false);
    caster->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, fluence);
    LookDown(caster, medium);
    caster->Update();
    return MiddlePixel(caster, "radiance");
  };
  claims.Near(seen(lit, "fluence"), 0.7527, 0.02, "the light at the surface is seen");

  vtkNew<vtkImageData> other; // with fluence of another name beside it
  other->ShallowCopy(lit);
  vtkNew<vtkFloatArray> copy;
  copy->DeepCopy(lit->GetCellData()->GetArray("fluence"));
  copy->SetName("mine");
  other->GetCellData()->AddArray(copy);
  vtkNew<vtkImageData> without;
  without->ShallowCopy(lit);
  vtkNew<vtkFieldData> nothing;
  without->SetFieldData(nothing);
  const double centres = seen(without, "fluence");
  claims.That(centres < 0.65, "without it voxels' centres are seen");
  claims.Near(seen(other, "mine"), centres, 1e-6, "it belongs to the array that the solver wrote");
}

// A vacuum over ground of which the sky above lets in radiance 1: ground, of the solver's FaceAlbedo, shows its albedo.
template <class Solver>
void GroundIsSeen(test::Claims& claims, const std::string& which)
{
  const vtkNew<vtkImageData> image = Homogeneous(0.0, 0.0, 0.0);
  vtkNew<Solver> solver;
  solver->SetInputData(image);
  solver->SetPeriodicX(true);
  solver->SetPeriodicY(true);
  solver->SetFaceRadiance(0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
  solver->SetFaceAlbedo(0.0, 0.0, 0.0, 0.0, 0.5, 0.0);
  std::array<double, 18> colours;
  colours.fill(1.0);
  colours[13] = 0.4;
  solver->SetFaceAlbedoColor(colours.data());
  solver->SetTolerance(1e-6);
  vtkNew<vtkMediumRayCaster> caster;
  test::Errors errors(caster);
  caster->SetInputConnection(solver->GetOutputPort());
  caster->SetImageSize(9, 9);
  caster->SetBackgroundRadiance(7.0, 7.0, 7.0);
  LookDown(caster, image);
  caster->Update();
  claims.That(errors.None(), which + ": no complaint");
  // Along directions that hardly fall light goes round for long.
  claims.Near(MiddlePixel(caster, "radiance", 0), 0.5, 0.01, which + ": red of the ground");
  claims.Near(MiddlePixel(caster, "radiance", 1), 0.2, 0.004, which + ": green of the ground");
  claims.Near(MiddlePixel(caster, "alpha"), 0.0, 1e-6, which + ": it is behind the medium");
  solver->SetFaceAlbedo(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  caster->Update();
  claims.Near(MiddlePixel(caster, "radiance", 0), 7.0, 1e-5, which + ": without, the background is seen");
  vtkFieldData* const facts = vtkImageData::SafeDownCast(solver->GetOutputDataObject(0))->GetFieldData();
  claims.That(!facts->GetArray("face_power") && !facts->GetArray("face_albedo"), which + ": nor said");
}

// Between faces of radiance 1, which pictures do not show, a white medium scatters as much light to the eye as it hides
// of them, the light that small angles scatter included.
void LightOfFacesIsScatteredStraightOn(test::Claims& claims)
{
  vtkNew<vtkParticipatingMedium> medium;
  medium->SetInputData(Homogeneous(0.0, 0.4, 1.0));
  medium->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "sigma_s");
  medium->SetAlbedo(1.0, 1.0, 1.0);
  medium->SetMeanCosine(0.85);
  vtkNew<vtkLightPropagationMaps> solver;
  solver->SetInputConnection(medium->GetOutputPort());
  solver->SetFaceRadiance(1.0, 1.0, 1.0, 1.0, 1.0, 1.0);
  solver->SetStoreMoments(true);
  vtkNew<vtkMediumRayCaster> caster;
  test::Errors errors(caster);
  caster->SetInputConnection(solver->GetOutputPort());
  caster->SetImageSize(9, 9);
  caster->Update();
  const double alpha = MiddlePixel(caster, "alpha");
  claims.That(errors.None() && alpha > 0.1, "a medium is seen");
  claims.Near(MiddlePixel(caster, "radiance", 0), alpha, 0.02, "as bright as what it hides");
  vtkNew<vtkImageData> without;
  without->ShallowCopy(solver->GetOutputDataObject(0));
  without->GetFieldData()->RemoveArray("face_radiance");
  caster->SetInputData(without);
  caster->Update();
  claims.That(MiddlePixel(caster, "radiance", 0) < 0.9 * alpha, "as face_radiance says");
}

void DarkMediumIsAWarning(test::Claims& claims)
{
  const vtkNew<vtkImageData> image = Homogeneous(0.1, 0.4, 1.0);
  image->GetCellData()->RemoveArray("fluence");
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetInputData(image);
  caster->SetImageSize(9, 9);
  test::Errors errors(caster);
  caster->Update();
  claims.That(errors.WasOneWith("dark"), "a warning says that the medium is dark");
  claims.That(caster->GetOutput()->GetNumberOfPoints() == 81, "the picture is made all the same");
}

void ErrorIsEstimatedOnRequest(test::Claims& claims)
{
  const vtkNew<vtkImageData> image = Homogeneous(0.1, 0.4, 1.0);
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetInputData(image);
  caster->SetImageSize(21, 16);
  caster->Update();
  claims.That(!Pixels(caster, "picture_error") && caster->GetEstimatedError() == 0.0, "no error unless asked for");
  caster->EstimateErrorOn();
  caster->Update();
  const double ofRays = caster->GetEstimatedError();
  claims.That(Pixels(caster, "picture_error") && Pixels(caster, "picture_error")->GetNumberOfComponents() == 3,
    "picture_error has three channels");
  claims.That(ofRays < 1e-3, "an even medium takes no small steps");
  claims.That(
    std::string(caster->GetLeftOut()).find("fluence_error") != std::string::npos, "the light's error is missing");

  AddCells(image, "fluence_error", 3, [](double, double, double, int c) { return 0.1 * (c + 1); });
  image->Modified();
  caster->Update();
  claims.That(caster->GetEstimatedError() > 0.02 && caster->GetEstimatedError() < 0.101, "the light's error is seen");
  claims.That(
    std::string(caster->GetLeftOut()).find("fluence_error") == std::string::npos, "the light's error is not missing");
  claims.That(Pixels(caster, "picture_error")->GetComponent(21 * 8 + 10, 2) > 0.02 * MiddlePixel(caster, "radiance", 2),
    "the error of a pixel");
  const double estimated = caster->GetEstimatedError();
  caster->SetImageSize(40, 30);
  caster->Update();
  claims.That(caster->GetSceneKept(), "the scene of the estimate is kept, too");
  claims.Near(caster->GetEstimatedError(), estimated, 0.1 * estimated, "the same error in another size");

  caster->SetStepSize(10.0);
  test::Errors errors(caster);
  caster->Update();
  claims.That(errors.None() && caster->GetEstimatedError() > estimated, "the longest steps have a larger error");

  caster->SetStepSize(1.0);
  vtkNew<vtkDoubleArray> length;
  length->SetName("error_length");
  length->InsertNextValue(0.1);
  image->GetFieldData()->AddArray(length);
  image->Modified();
  caster->Update();
  claims.That(caster->GetEstimatedError() < 0.5 * estimated, "errors of short length cancel along rays");
}

void Stop(vtkObject* caster, unsigned long, void* calls, void*)
{
  ++*static_cast<int*>(calls);
  static_cast<vtkMediumRayCaster*>(caster)->SetAbortExecute(1);
}

void AbortStops(test::Claims& claims)
{
  const vtkNew<vtkImageData> image = Homogeneous(0.1, 0.4, 1.0);
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetInputData(image);
  caster->SetImageSize(400, 300);
  vtkNew<vtkCallbackCommand> stop;
  int calls = 0;
  stop->SetCallback(Stop);
  stop->SetClientData(&calls);
  const unsigned long tag = caster->AddObserver(vtkCommand::ProgressEvent, stop);
  test::Errors errors(caster);
  caster->Update();
  claims.That(calls > 0, "progress is reported");
  claims.That(errors.None(), "an abort is no error");
  claims.That(caster->GetOutput()->GetNumberOfPoints() == 0, "after an abort there is no picture");
  caster->RemoveObserver(tag);
  caster->SetAbortExecute(0);
  caster->Modified();
  caster->Update();
  claims.That(caster->GetOutput()->GetNumberOfPoints() == 400 * 300, "the next update makes the picture");
}

/// A cumulus of noise in a clear sky, to be looked at; its numbers are checked elsewhere.
void PictureOfACloud(test::Claims& claims, const std::string& file)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(65, 65, 65);
  const auto density = [](double x, double y, double z) {
    const double r = std::sqrt((x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5) + 1.5 * (z - 0.45) * (z - 0.45));
    const double waves = std::sin(13.0 * x + 3.0 * std::sin(9.0 * y)) * std::sin(11.0 * y + 4.0 * std::sin(10.0 * z)) *
      std::sin(12.0 * z + 2.0 * std::sin(15.0 * x));
    return std::max(0.0, 0.42 + 0.1 * waves - r);
  };
  AddCells(image, "sigma_s", 1, [&](double x, double y, double z, int) { return 6.0 * density(x, y, z); });
  AddCells(image, "sigma_a", 1, [](double, double, double, int) { return 0.0; });
  vtkNew<vtkLightRig> rig;
  rig->SetSunElevation(50.0);
  rig->SetSunPower(6.0, 5.6, 5.0);
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetInputData(image);
  caster->SetLightsConnection(rig->GetOutputPort());
  caster->SetBackgroundRadiance(0.1, 0.2, 0.45);
  caster->SetImageSize(400, 300);
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(caster->GetOutputPort());
  writer->SetFileName(file.c_str());
  writer->Write();
  claims.That(MiddlePixel(caster, "alpha") > 0.99, "the cloud is in the middle");
}
}

int TestMediumRayCaster(int argc, char* argv[])
{
  return test::WithDevice([&](test::Claims& claims) {
    SlabFollowsTheClosedForm(claims);
    SmokeLaidOverBlackLooksAsBeforeBlack(claims);
    PointArraysAndChosenNamesServe(claims);
    UntouchedCameraSeesTheWholeBox(claims);
    LightsServeWhereThereIsNoFluence(claims);
    EnvironmentIsTheBackground(claims);
    BadInputIsAnError(claims);
    ThickVoxelsShineAtTheirSurface(claims);
    GroundIsSeen<vtkLightPropagationMaps>(claims, "light propagation maps");
    GroundIsSeen<vtkDiscreteOrdinates>(claims, "discrete ordinates");
    LightOfFacesIsScatteredStraightOn(claims);
    DarkMediumIsAWarning(claims);
    ErrorIsEstimatedOnRequest(claims);
    AbortStops(claims);
    char* folder = vtkTestUtilities::GetArgOrEnvOrDefault("-T", argc, argv, "VTK_TEMP_DIR", "Testing/Temporary");
    PictureOfACloud(claims, std::string(folder) + "/MediumRayCasterCloud.png");
    delete[] folder;
  });
}
