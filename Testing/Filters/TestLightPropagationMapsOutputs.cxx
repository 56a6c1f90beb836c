#include "MediumScene.h"

#include "Reference/SlabReference.h"

#include "vtkInformation.h"
#include "vtkLightPropagationMaps.h"
#include "vtkLightRig.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace
{
int ComponentsOf(vtkFieldData* data, const char* name)
{
  vtkAbstractArray* array = data->GetAbstractArray(name);
  return array ? array->GetNumberOfComponents() : 0;
}

double Mean(vtkImageData* image, const char* name, int component)
{
  vtkDataArray* array = image->GetCellData()->GetArray(name);
  double sum = 0.0;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    sum += array->GetComponent(i, component);
  }
  return array ? sum / array->GetNumberOfTuples() : -1.0;
}

void WritesWhatItSays(test::Claims& claims)
{
  const auto medium = test::MakeMedium({ { 6, 5, 4 } }, 0.1, 1.0);
  test::AddCells(medium, "temperature", 300.0);
  test::AddPoints(medium, "potential", 1.0);
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  maps->SetInputDataObject(medium);
  maps->SetLightsConnection(rig->GetOutputPort());
  maps->Update();
  vtkImageData* output = maps->GetOutput();
  vtkCellData* cells = output->GetCellData();
  claims.That(errors.None(), "a scene of medium and lights is all it needs");
  claims.That(ComponentsOf(cells, "fluence") == 1 && ComponentsOf(cells, "fluence_direct") == 1 &&
      ComponentsOf(cells, "scattered_radiance") == 1 && ComponentsOf(cells, "net_flux") == 0,
    "a grey scene has grey light");
  claims.That(cells->GetScalars() == cells->GetArray("fluence"), "fluence is what is shown first");
  claims.That(ComponentsOf(cells, "temperature") == 1 && ComponentsOf(output->GetPointData(), "potential") == 1 &&
      ComponentsOf(cells, "sigma_s") == 1,
    "the input's arrays are passed on");
  claims.That(medium->GetCellData()->GetNumberOfArrays() == 3, "the input stays as it is");

  vtkFieldData* facts = output->GetFieldData();
  claims.That(ComponentsOf(facts, "energy_balance") == 1 && facts->GetArray("energy_balance")->GetNumberOfTuples() == 5,
    "energy_balance has five rows");
  claims.That(facts->GetArray("face_power_out") && facts->GetArray("face_power_out")->GetNumberOfTuples() == 6,
    "face_power_out has six rows");
  double out = 0.0;
  for (int face = 0; face < 6; ++face)
  {
    out += facts->GetArray("face_power_out")->GetComponent(face, 0);
  }
  const double escaped = facts->GetArray("energy_balance")->GetComponent(3, 0);
  claims.Near(out, escaped, 1e-9 * escaped, "what leaves through the faces");
  auto* device = vtkStringArray::SafeDownCast(facts->GetAbstractArray("device"));
  claims.That(device && device->GetNumberOfValues() == 1 && device->GetValue(0) == maps->GetDeviceName(), "device");
  claims.That(vtkStringArray::SafeDownCast(facts->GetAbstractArray("left_out")) != nullptr, "left_out");

  auto* convergence = vtkTable::SafeDownCast(maps->GetOutputDataObject(1));
  claims.That(convergence->GetNumberOfRows() == maps->GetOrders() && maps->GetOrders() > 2, "a row an order");
  for (const char* column : { "iteration", "seconds", "residual", "change", "absorbed", "escaped", "left_over" })
  {
    claims.That(convergence->GetColumnByName(column) != nullptr, std::string("column ") + column);
  }
  claims.That(
    maps->GetResidual() <= maps->GetTolerance() && maps->GetResidual() > 0.0, "the residual is below Tolerance");
}

void ColourAndFluxComeOnRequest(test::Claims& claims)
{
  const auto medium = test::MakeMedium({ { 4, 4, 4 } }, 0.1, 1.0);
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputDataObject(medium);
  maps->SetSkyColor(1.0, 2.0, 4.0);
  maps->SetNetFlux(true);
  maps->Update();
  vtkCellData* cells = maps->GetOutput()->GetCellData();
  claims.That(
    ComponentsOf(cells, "fluence") == 3 && ComponentsOf(cells, "net_flux") == 9, "a blue sky has three channels");
  const double red = Mean(maps->GetOutput(), "fluence", 0);
  claims.Near(Mean(maps->GetOutput(), "fluence", 2), 4.0 * red, 1e-5 * red, "four times as blue as red");
  claims.That(cells->GetArray("fluence")->GetComponentName(2) == std::string("B"), "components have names");
  maps->SetMaximumOrders(1);
  maps->Update();
  claims.That(maps->GetOrders() == 1 && Mean(maps->GetOutput(), "fluence", 0) < red, "one order is less than all");
}

void TellsItsErrorOnRequest(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputDataObject(test::MakeMedium({ { 8, 6, 4 } }, 0.1, 1.0));
  maps->SetSkyColor(1.0, 2.0, 4.0);
  maps->Update();
  claims.That(maps->GetEstimatedError() == 0.0 && ComponentsOf(maps->GetOutput()->GetCellData(), "fluence_error") == 0,
    "no error is estimated unasked");
  const double red = Mean(maps->GetOutput(), "fluence", 0);
  for (int scheme : { vtkLightPropagationMaps::CONSERVATIVE, vtkLightPropagationMaps::PUBLISHED })
  {
    maps->SetScheme(scheme);
    maps->EstimateErrorOn();
    maps->Update();
    const double error = Mean(maps->GetOutput(), "fluence_error", 0);
    claims.That(maps->GetEstimatedError() > 1e-4 && maps->GetEstimatedError() < 0.5, "an error of sense");
    claims.That(error > 0.2 * maps->GetEstimatedError() * red && error < 5.0 * maps->GetEstimatedError() * red,
      "the number and the array agree");
    claims.Near(Mean(maps->GetOutput(), "fluence_error", 2), 4.0 * error, 1e-3 * error, "each colour has its own");
  }
  maps->SetScheme(vtkLightPropagationMaps::CONSERVATIVE);
  maps->Update();
  claims.Near(Mean(maps->GetOutput(), "fluence", 0), red, 1e-12, "the light is the same with the estimate");
  maps->EstimateErrorOff();
  maps->Update();
  claims.That(ComponentsOf(maps->GetOutput()->GetCellData(), "fluence_error") == 0, "the estimate goes again");
}

void SourceAndAccelerationReachTheSolver(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  maps->SetInputDataObject(test::MakeMedium({ { 1, 1, 16 } }, 0.0, 10.0));
  maps->SetFaceRadiance(0, 0, 0, 0, 1.0, 0);
  maps->PeriodicXOn();
  maps->PeriodicYOn();
  const auto transmitted = [&] {
    maps->Update();
    return maps->GetOutput()->GetFieldData()->GetArray("face_power_out")->GetComponent(5, 0) /
      maps->GetOutput()->GetFieldData()->GetArray("energy_balance")->GetComponent(0, 0);
  };
  const double exact = ThickSlabTransmittance(160.0);
  claims.Near(transmitted(), exact, 0.01 * exact, "by default thick voxels transmit as they should");
  const int sweeps = maps->GetOrders();
  claims.That(sweeps <= 15, "in a few sweeps");
  maps->SetSource(vtkLightPropagationMaps::CONSTANT);
  claims.That(transmitted() > 1.5 * exact && maps->GetOrders() <= 15, "a constant source transmits too much, as soon");
  maps->SetAcceleration(vtkLightPropagationMaps::NONE);
  maps->SetTolerance(1e-2);
  claims.That(transmitted() > 1.2 * exact && maps->GetOrders() > 100, "one order after the other takes many");
  claims.That(errors.None(), "nothing to complain about");
  maps->SetSource(vtkLightPropagationMaps::LINEAR);
  maps->Update();
  claims.That(errors.WasOneWith("Acceleration"), "the linear source needs the acceleration");
}

/// By what each changes in the light of a face.
void RaysAreAsTheyAreSet(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputDataObject(test::MakeMedium({ { 5, 4, 6 } }, 0.1, 0.5));
  maps->SetFaceRadiance(0, 0, 0, 0, 1.0, 0);
  maps->SetTolerance(1e-6);
  const auto fluence = [&] {
    maps->Update();
    return maps->GetOutput()->GetCellData()->GetArray("fluence")->GetComponent(17, 0);
  };
  const double usual = fluence();
  const auto changes = [&](const char* what, const std::function<void()>& set, const std::function<void()>& setBack) {
    set();
    claims.That(fluence() != usual, std::string(what) + " reaches the solver");
    setBack();
    claims.That(fluence() == usual, std::string(what) + " can be taken back");
  };
  changes(
    "StaggeredRays", [&] { maps->StaggeredRaysOn(); }, [&] { maps->StaggeredRaysOff(); });
  const int resolution = maps->GetMapResolution(), directions = maps->GetDirectionsPerFace();
  changes(
    "MapResolution", [&] { maps->SetMapResolution(resolution + 2); }, [&] { maps->SetMapResolution(resolution); });
  changes(
    "DirectionsPerFace", [&] { maps->SetDirectionsPerFace(9); }, [&] { maps->SetDirectionsPerFace(directions); });
}

void LightOfAnEarlierSolveGoes(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> first;
  first->SetInputDataObject(test::MakeMedium({ { 4, 4, 4 } }, 0.1, 1.0));
  first->SetSkyColor(1.0, 1.0, 1.0);
  first->SetNetFlux(true);
  first->SetStoredDirections(6);
  vtkNew<vtkLightPropagationMaps> second;
  second->SetInputConnection(first->GetOutputPort());
  second->SetSkyColor(2.0, 2.0, 2.0);
  second->Update();
  vtkCellData* cells = second->GetOutput()->GetCellData();
  claims.That(ComponentsOf(cells, "net_flux") == 0 && ComponentsOf(cells, "scattered_radiance") == 1,
    "no array of an earlier solve is left");
  const double once = Mean(first->GetOutput(), "fluence", 0);
  claims.Near(Mean(second->GetOutput(), "fluence", 0), 2.0 * once, 1e-5 * once, "twice the sky, twice the light");
}

void ABoxWithoutFacesIsSaidToBeDark(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputDataObject(test::MakeMedium({ { 4, 4, 4 } }, 0.1, 1.0));
  maps->SetSkyColor(1.0, 1.0, 1.0);
  maps->SetPeriodicX(true);
  maps->SetPeriodicY(true);
  test::Errors errors(maps);
  maps->Update();
  claims.That(errors.None(), "one axis is open");
  maps->SetPeriodicZ(true);
  maps->Update();
  claims.That(errors.WasOneWith("three axes periodic"), "three periodic axes keep the sky out: a warning");
}

/// Fluence of a cube lit by an environment that is bright in one column of pixels or one row.
vtkSmartPointer<vtkImageData> LitFrom(int brightColumn, int brightRow, int up, double azimuth)
{
  const auto environment = test::MakeImage({ { 15, 7, 0 } });
  test::AddValues<vtkFloatArray>(environment->GetPointData(), "radiance", 16 * 8, 1,
    [=](vtkIdType i, int) { return i % 16 == brightColumn || i / 16 == brightRow ? 1.0 : 0.0; });
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputDataObject(test::MakeMedium({ { 5, 5, 5 } }, 1.0, 0.0));
  maps->SetEnvironmentData(environment);
  maps->SetEnvironmentUp(up);
  maps->SetEnvironmentAzimuth(azimuth);
  maps->Update();
  vtkSmartPointer<vtkImageData> output = maps->GetOutput();
  return output;
}

double At(vtkImageData* image, int i, int j, int k)
{
  vtkDataArray* fluence = image->GetCellData()->GetArray("fluence");
  return fluence ? fluence->GetComponent((k * 5 + j) * 5 + i, 0) : -1.0;
}

void EnvironmentStandsAsTold(test::Claims& claims)
{
  const auto zenith = LitFrom(-1, 7, 2, 0.0);
  claims.That(At(zenith, 2, 2, 4) > 5.0 * At(zenith, 2, 2, 0), "the last row is the zenith, above");
  const auto sideways = LitFrom(-1, 7, 0, 0.0);
  claims.That(At(sideways, 4, 2, 2) > 5.0 * At(sideways, 0, 2, 2), "up can be x");
  const auto along = LitFrom(-1, 7, 1, 0.0);
  claims.That(At(along, 2, 4, 2) > 5.0 * At(along, 2, 0, 2), "up can be y");
  const auto east = LitFrom(0, -1, 2, 0.0);
  claims.That(At(east, 4, 2, 2) > 3.0 * At(east, 0, 2, 2), "the first column is +x");
  const auto north = LitFrom(0, -1, 2, 90.0);
  double difference = 0.0;
  for (int j = 0; j < 5; ++j)
  {
    for (int i = 0; i < 5; ++i)
    {
      difference = std::max(difference, std::abs(At(north, 4 - j, i, 2) / At(east, i, j, 2) - 1.0));
    }
  }
  claims.Near(difference, 0.0, 1e-5, "what differs when environment and grid are turned by 90 degrees");
}

void HandsOnThePieceAskedFor(test::Claims& claims)
{
  const auto medium = test::MakeMedium({ { 8, 4, 4 } }, 0.1, 1.0);
  const auto solve = [&](std::array<int, 6> extent) {
    vtkNew<vtkLightPropagationMaps> maps;
    maps->SetInputDataObject(medium);
    maps->SetSkyColor(1.0, 1.0, 1.0);
    maps->UpdateInformation();
    vtkInformation* information = maps->GetOutputInformation(0);
    information->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent.data(), 6);
    maps->Update();
    return vtkSmartPointer<vtkImageData>(maps->GetOutput());
  };
  const auto whole = solve({ 0, 8, 0, 4, 0, 4 });
  const auto piece = solve({ 5, 8, 0, 4, 0, 4 });
  claims.That(piece->GetNumberOfCells() == 3 * 4 * 4, "a piece is a piece");
  bool equal = piece->GetCellData()->GetArray("fluence") != nullptr;
  for (int i = 0; equal && i < 3 * 4 * 4; ++i)
  {
    const int there = i / 3 * 8 + 5 + i % 3;
    equal = piece->GetCellData()->GetArray("fluence")->GetComponent(i, 0) ==
      whole->GetCellData()->GetArray("fluence")->GetComponent(there, 0);
  }
  claims.That(equal, "with the light of the whole");
}

/// Counts reports of progress; asks to stop at the given one.
struct Watcher : vtkCommand
{
  static Watcher* New() { return new Watcher; }
  void Execute(vtkObject* caller, unsigned long, void*) override
  {
    auto* filter = static_cast<vtkAlgorithm*>(caller);
    this->Grows = this->Grows && filter->GetProgress() >= this->Last;
    this->Last = filter->GetProgress();
    if (++this->Reports == this->StopAt)
    {
      filter->SetAbortExecute(1);
    }
  }
  int Reports = 0;
  int StopAt = 0;
  double Last = 0.0;
  bool Grows = true;
};

void ReportsAndStops(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  vtkNew<Watcher> watcher;
  maps->AddObserver(vtkCommand::ProgressEvent, watcher);
  maps->SetInputDataObject(test::MakeMedium({ { 24, 24, 24 } }, 0.0, 1.0));
  maps->SetSkyColor(1.0, 1.0, 1.0);
  maps->Update();
  claims.That(watcher->Reports > 10 && watcher->Grows, "progress is reported, and grows");
  const double before = maps->GetOutput()->GetCellData()->GetArray("fluence")->GetComponent(77, 0);

  watcher->Reports = 0;
  watcher->StopAt = 5;
  maps->SetDirectionsPerFace(100);
  maps->SetTolerance(1e-6);
  maps->Update();
  claims.That(watcher->Reports >= 5 && watcher->Reports <= 6,
    "it stops when told, at once: " + std::to_string(watcher->Reports) + " reports");
  claims.That(errors.None(), "and that is no error");
  const auto isMarked = [&] {
    return maps->GetOutput()->GetFieldData()->HasArray("aborted") != 0 &&
      maps->GetOutputDataObject(1)->GetFieldData()->HasArray("aborted") != 0;
  };
  for (int update = 0; update < 2; ++update)
  {
    claims.That(maps->GetOutput()->GetNumberOfCells() == 24 * 24 * 24, "the last light stays then");
    claims.That(maps->GetOutput()->GetCellData()->GetArray("fluence")->GetComponent(77, 0) == before, "as it was");
    claims.That(isMarked() && maps->GetOrders() == 0, "and is marked as that of before");
    claims.That(std::string(maps->GetLeftOut()).find("that of before") != std::string::npos, "on the panel, too");
    watcher->Reports = 0;
    maps->Update();
    claims.That(watcher->Reports == 0, "nothing runs again by itself");
  }
  watcher->Reports = 0;
  maps->SetDirectionsPerFace(64);
  maps->Update();
  claims.That(maps->GetOutput()->GetNumberOfCells() == 24 * 24 * 24 && isMarked(), "nor does it go when stopped again");
  watcher->Reports = 0;
  maps->SetInputDataObject(test::MakeMedium({ { 26, 24, 24 } }, 0.0, 1.0));
  maps->Update();
  claims.That(maps->GetOutput()->GetNumberOfCells() == 0 && isMarked(), "light of other voxels does not stay");

  watcher->StopAt = 0;
  maps->SetDirectionsPerFace(4);
  maps->Update();
  claims.That(maps->GetOutput()->GetNumberOfCells() == 26 * 24 * 24 && !isMarked(), "it runs again after that");
}
}

int TestLightPropagationMapsOutputs(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    WritesWhatItSays(claims);
    ColourAndFluxComeOnRequest(claims);
    TellsItsErrorOnRequest(claims);
    SourceAndAccelerationReachTheSolver(claims);
    RaysAreAsTheyAreSet(claims);
    LightOfAnEarlierSolveGoes(claims);
    ABoxWithoutFacesIsSaidToBeDark(claims);
    EnvironmentStandsAsTold(claims);
    HandsOnThePieceAskedFor(claims);
    ReportsAndStops(claims);
  });
}
