#include "MediumScene.h"

#include "vtkLightRig.h"
#include "vtkMeshVoxelizer.h"
#include "vtkSolverComparison.h"
#include "vtkSphereSource.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include "Numerics/Constants.h"

#include <cmath>
#include <limits>

namespace
{
using tyndall::Pi;

double Number(vtkTable* table, vtkIdType row, const char* column)
{
  return table->GetValueByName(row, column).ToDouble();
}

std::string Text(vtkTable* table, vtkIdType row, const char* column)
{
  return table->GetValueByName(row, column).ToString();
}

/// Only the default method, at one setting, with all the time that it takes: which runs there are must not depend on
/// the machine.
void AskForOne(vtkSolverComparison* comparison)
{
  comparison->ConstantSourceOff();
  comparison->AsPublishedOff();
  comparison->PhotonsOff();
  comparison->RemoveAllDirections();
  comparison->AddDirections(25);
  comparison->RemoveAllMapResolutions();
  comparison->AddMapResolution(1);
  comparison->RemoveAllCoarsenings();
  comparison->AddCoarsening(1);
  comparison->RemoveAllOrders();
  comparison->SetRepeats(1);
  comparison->SetTimeBudget(1e6);
}

/// A cloud whose density varies from voxel to voxel.
vtkSmartPointer<vtkImageData> Cloud(int edge)
{
  auto medium = test::MakeMedium({ { edge, edge, edge }, { 1.0 / edge, 1.0 / edge, 1.0 / edge } }, 0.2, 4.0);
  vtkDataArray* scattering = medium->GetCellData()->GetArray("sigma_s");
  for (vtkIdType i = 0; i < scattering->GetNumberOfTuples(); ++i)
  {
    scattering->SetComponent(i, 0, 4.0 * (1.0 + std::sin(0.7 * (i % edge)) * std::cos(0.5 * (i / edge % edge))));
  }
  return medium;
}

void LightIsNoErrorOfItself(test::Claims& claims)
{
  const auto medium = Cloud(8);
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputDataObject(medium);
  maps->SetSkyColor(1.0, 1.0, 1.0);
  vtkNew<vtkSolverComparison> comparison;
  test::Errors errors(comparison);
  AskForOne(comparison);
  comparison->SetInputDataObject(medium);
  comparison->SetSkyColor(1.0, 1.0, 1.0);
  comparison->SetReferenceConnection(maps->GetOutputPort());
  comparison->Update();
  vtkTable* table = comparison->GetOutput();
  if (claims.That(errors.None() && table->GetNumberOfRows() == 1, "a row a setting"))
  {
    claims.That(
      Number(table, 0, "error_l2") == 0.0 && Number(table, 0, "error_max") == 0.0, "the same light has no error");
    claims.That(Number(table, 0, "pareto") == 1.0, "and nothing is better");
    claims.That(Number(table, 0, "seconds") > 0.0 && Number(table, 0, "peak_bytes") > 8 * 8 * 8 * 4, "time and memory");
    claims.That(!(Number(table, 0, "core_seconds") <= 0.0), "processor time, not known on a GPU");
    claims.That(Number(table, 0, "iterations") == maps->GetOrders(), "as many orders as the solver tells");
    claims.Near(Number(table, 0, "balance"), maps->GetBalanceError(), 1e-12, "balance");
    auto* again = vtkImageData::SafeDownCast(comparison->GetOutputDataObject(1));
    vtkDataArray* light = again->GetCellData()->GetArray("fluence");
    claims.That(light && light->GetNumberOfTuples() == 512 && again->GetCellData()->GetArray("fluence_direct"),
      "the reference comes out");
    claims.That(
      light && light->GetComponent(77, 0) == maps->GetOutput()->GetCellData()->GetArray("fluence")->GetComponent(77, 0),
      "as it was");
    claims.That(std::string(comparison->GetRecommended()).find("light propagation maps, 25 directions: ") == 0 &&
        Text(table, 0, "filters") == "LightPropagationMaps DirectionsPerFace=25",
      "what is recommended");
    claims.That(Text(table, 0, "setting") == "25 directions" && Text(table, 0, "grid") == "8x8x8", "what was run");
  }
}

void CoarserIsWorse(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkSolverComparison> comparison;
  test::Errors errors(comparison);
  AskForOne(comparison);
  comparison->SetMonteCarloReference(vtkSolverComparison::NEVER);
  comparison->SetInputDataObject(Cloud(16));
  comparison->SetLightsConnection(rig->GetOutputPort());
  comparison->SetSkyColor(0.2, 0.2, 0.2);
  comparison->RemoveAllDirections();
  comparison->AddDirections(1);
  comparison->AddDirections(25);
  comparison->AddCoarsening(2);
  comparison->AddCoarsening(4);
  comparison->AddCoarsening(5); // does not divide
  comparison->AddOrders(1);
  comparison->Update();
  vtkTable* table = comparison->GetOutput();
  claims.That(errors.None() && table->GetNumberOfRows() == 7, "two sets of directions on three grids, and one order");
  const auto error = [&](const std::string& setting) {
    for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
    {
      if (Text(table, row, "setting") == setting)
      {
        return Number(table, row, "error_l2");
      }
    }
    claims.That(false, "there is a row " + setting);
    return std::nan("");
  };
  const double fine = error("25 directions");
  claims.That(fine < 0.05, "the finest is near the converged run");
  claims.That(fine < error("1 directions"), "few directions are worse");
  claims.That(fine < error("25 directions, voxels x 2"), "coarse voxels are worse");
  claims.That(error("25 directions, voxels x 2") < error("25 directions, voxels x 4"), "the coarser the worse");
  claims.That(10.0 * fine < error("25 directions, 1 order"), "light of one order is far too dark");
  auto* reference = vtkStringArray::SafeDownCast(table->GetFieldData()->GetAbstractArray("reference"));
  claims.That(reference && reference->GetValue(0).find("directions") != std::string::npos, "the reference is named");
}

/// Albedo 1 between faces of radiance 1: fluence is 4 pi, on any grid.
void GridsAreMatched(test::Claims& claims)
{
  for (int edge : { 2, 4, 8, 16 })
  {
    const double spacing = 8.0 / edge;
    auto reference = test::MakeImage({ { edge, edge, edge }, { spacing, spacing, spacing } });
    test::AddCells(reference, "fluence", 4.0 * Pi);
    reference->GetCellData()->GetArray("fluence")->SetComponent(0, 0, std::numeric_limits<double>::quiet_NaN());
    vtkNew<vtkSolverComparison> comparison;
    test::Errors errors(comparison);
    AskForOne(comparison);
    comparison->AddCoarsening(2);
    comparison->SetInputDataObject(test::MakeMedium({ { 8, 8, 8 } }, 0.0, 0.3));
    comparison->SetFaceRadiance(1, 1, 1, 1, 1, 1);
    comparison->SetTolerance(1e-6);
    comparison->SetReferenceData(reference);
    comparison->Update();
    vtkTable* table = comparison->GetOutput();
    const std::string name = "a reference of " + std::to_string(edge) + " voxels an edge";
    claims.That(errors.None() && table->GetNumberOfRows() == 2, name);
    for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
    {
      claims.Near(Number(table, row, "error_max"), 0.0, 1e-4, "the furnace against " + name);
    }
    test::AddCells(reference, "fluence", 8.0 * Pi);
    comparison->Update();
    claims.Near(table->GetNumberOfRows() > 0 ? Number(table, 0, "error_l2") : -1.0, 0.5, 1e-4, "half of " + name);
  }
}

void PhotonsAreComparedWithDirectLight(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkSolverComparison> comparison;
  test::Errors errors(comparison);
  AskForOne(comparison);
  comparison->SetMonteCarloReference(vtkSolverComparison::NEVER); // of direct light there is another reference
  comparison->PhotonsOn();
  comparison->RemoveAllPhotonCounts();
  comparison->AddPhotonCount(1000);
  comparison->AddPhotonCount(100000);
  comparison->SetInputDataObject(test::MakeMedium({ { 8, 8, 8 } }, 0.1, 0.2));
  comparison->SetLightsConnection(rig->GetOutputPort());
  comparison->Update();
  vtkTable* table = comparison->GetOutput();
  if (claims.That(errors.None() && table->GetNumberOfRows() == 3, "propagation and two numbers of photons"))
  {
    claims.That(
      Text(table, 1, "quantity") == "fluence_direct" && Text(table, 0, "quantity") == "fluence", "quantities");
    claims.That(Number(table, 2, "error_l2") < 0.02, "many photons find the direct light");
    claims.That(Number(table, 2, "error_l2") < Number(table, 1, "error_l2"), "few are worse");
    claims.That(Number(table, 1, "pareto") == 1.0, "quantities do not compete");
  }

  auto bent = test::MakeMedium({ { 8, 8, 8 } }, 0.1, 0.2);
  test::AddCells(bent, "ior", 1.0);
  bent->GetCellData()->GetArray("ior")->SetComponent(200, 0, 1.2);
  comparison->SetInputDataObject(bent);
  comparison->Update();
  claims.That(errors.None() && table->GetNumberOfRows() == 2 && Text(table, 0, "method") == "photons",
    "bent light is a matter of photons");
  claims.That(std::string(comparison->GetLeftOut()).find("does not bend") != std::string::npos, "and it is said");
}

void MonteCarloIsComparedWithAllLight(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkSolverComparison> comparison;
  test::Errors errors(comparison);
  AskForOne(comparison);
  comparison->MonteCarloOn();
  comparison->RemoveAllPhotonCounts();
  comparison->AddPhotonCount(100000);
  comparison->SetTimeBudget(20.0);
  comparison->SetInputDataObject(test::MakeMedium({ { 8, 8, 8 } }, 0.1, 0.4));
  comparison->SetLightsConnection(rig->GetOutputPort());
  comparison->Update();
  vtkTable* table = comparison->GetOutput();
  if (claims.That(errors.None() && table->GetNumberOfRows() == 2, "propagation and photons that are scattered"))
  {
    claims.That(
      Text(table, 1, "method") == "Monte Carlo" && Text(table, 1, "quantity") == "fluence", "all light is compared");
    claims.That(Number(table, 1, "error_l2") < 0.03, "both find it");
    claims.That(Number(table, 1, "estimated_error") > 0.0, "and photons say how sure they are");
  }
  comparison->SetPeriodicX(true);
  comparison->Update();
  claims.That(std::string(comparison->GetLeftOut()).find("Monte Carlo: photons do not return") != std::string::npos,
    "photons do not go round");
}

void LatticesAreComparedWithPhotons(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkSolverComparison> comparison;
  test::Errors errors(comparison);
  AskForOne(comparison);
  comparison->LightPropagationMapsOff();
  comparison->LatticeBoltzmannOn();
  claims.That(comparison->GetMonteCarloReference() == vtkSolverComparison::WHERE_IT_CAN_BEAT, "photons may be it");
  comparison->MonteCarloReferenceOn();
  comparison->RemoveAllPhotonCounts();
  comparison->AddPhotonCount(20000);
  comparison->SetTimeBudget(120.0); // kernels are compiled in it, on a busy machine
  comparison->SetInputDataObject(test::MakeMedium({ { 8, 8, 8 } }, 0.01, 0.4));
  comparison->SetLightsConnection(rig->GetOutputPort());
  comparison->Update();
  vtkTable* table = comparison->GetOutput();
  if (claims.That(errors.None() && table->GetNumberOfRows() == 2, "lattices of 6 and 18 directions"))
  {
    claims.That(
      Text(table, 1, "method") == "lattice Boltzmann" && Text(table, 1, "setting") == "18 directions", "by name");
    claims.That(Number(table, 1, "error_l2") < 0.1, "near light of photons");
    claims.That(Number(table, 1, "error_l2") < Number(table, 0, "error_l2"), "more directions are better");
    claims.That(std::string(comparison->GetReferenceText()).find("scattered until they end") != std::string::npos,
      "photons make the reference");
  }
  comparison->SetPeriodicX(true);
  comparison->Update();
  claims.That(errors.WasOneWith("MonteCarloReference cannot be made"), "they cannot where axes are periodic");
}

vtkSmartPointer<vtkImageData> Reference(std::array<int, 3> cells, const char* array)
{
  auto image = test::MakeImage({ cells });
  test::AddCells(image, array, 1.0);
  return image;
}

void BadInput(test::Claims& claims)
{
  vtkNew<vtkSolverComparison> comparison;
  test::Errors errors(comparison);
  AskForOne(comparison);
  comparison->SetInputDataObject(test::MakeMedium({ { 4, 4, 4 } }, 0.5, 1.0));
  comparison->SetSkyColor(1.0, 1.0, 1.0);
  comparison->SetReferenceData(Reference({ 4, 4, 4 }, "fluence"));
  const auto says = [&](const std::string& part) {
    comparison->Update();
    claims.That(errors.WasOneWith(part), "refused: " + part);
    claims.That(comparison->GetOutput()->GetNumberOfRows() == 0, "the table is empty: " + part);
  };
  comparison->SetReferenceData(Reference({ 4, 4, 5 }, "fluence"));
  says("4x4x5");
  comparison->SetReferenceData(Reference({ 4, 4, 4 }, "light"));
  says("neither an array 'fluence' nor 'fluence_direct'");
  comparison->SetReferenceData(Reference({ 4, 4, 4 }, "fluence"));
  comparison->LightPropagationMapsOff();
  says("No method");
  comparison->LightPropagationMapsOn();
  comparison->AddDirections(24);
  says("24");
  comparison->RemoveAllDirections();
  says("Directions is empty");
  comparison->AddDirections(4);
  comparison->AddCoarsening(0);
  says("Coarsenings has 0");
  comparison->RemoveAllCoarsenings();
  comparison->AddCoarsening(1);
  for (double budget : { 0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity() })
  {
    comparison->SetTimeBudget(budget);
    says("TimeBudget");
  }
  comparison->SetTimeBudget(1e6);
  comparison->SetAcceptedError(0.0);
  says("AcceptedError");
  comparison->SetAcceptedError(0.01);
  comparison->AddTerms(0);
  says("Terms has 0");
  comparison->RemoveAllTerms();
  comparison->AddStepSize(0.0);
  says("voxels");
  comparison->RemoveAllStepSizes();
  comparison->AddOctreeTolerance(std::nan(""));
  says("OctreeTolerances has nan");
  comparison->RemoveAllOctreeTolerances();
  comparison->AddFilterSize(4);
  says("FilterSizes has 4");
  comparison->RemoveAllFilterSizes();
  comparison->AddFilterSize(9);
  comparison->PicturesOn();
  says("there is no camera");
  comparison->PicturesOff();
  comparison->SetTolerance(0.0);
  says("Tolerance");
  comparison->SetTolerance(1e-3);
  comparison->SetDevice("abacus");
  says("abacus");
  comparison->SetDevice("");
  comparison->Update();
  claims.That(
    errors.None() && comparison->GetOutput()->GetNumberOfRows() == 1, "good input after all the bad is compared");
}

/// A mesh needs the medium that was made of it, and must be closed as for vtkMeshVoxelizer; then it is voxelised anew.
void MeshesAreVoxelised(test::Claims& claims)
{
  vtkNew<vtkSphereSource> ball;
  ball->SetThetaResolution(16);
  ball->SetPhiResolution(16);
  vtkNew<vtkMeshVoxelizer> voxelizer;
  voxelizer->SetInputConnection(ball->GetOutputPort());
  voxelizer->SetSampleDimensions(16, 16, 16);
  voxelizer->SetFilterSize(3);
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkSolverComparison> comparison;
  test::Errors errors(comparison);
  AskForOne(comparison);
  comparison->SetInputConnection(voxelizer->GetOutputPort());
  comparison->SetLightsConnection(rig->GetOutputPort());
  comparison->SetMeshConnection(ball->GetOutputPort());
  comparison->RemoveAllPhotonCounts();
  comparison->AddPhotonCount(5000);
  comparison->RemoveAllSupersamplingFactors();
  comparison->AddSupersamplingFactor(2);
  comparison->RemoveAllFilterSizes();
  comparison->AddFilterSize(3);
  comparison->SetTimeBudget(120.0);
  comparison->Update();
  vtkTable* table = comparison->GetOutput();
  if (claims.That(errors.None() && table->GetNumberOfRows() == 1, "a voxelisation"))
  {
    claims.That(Text(table, 0, "method") == "voxelizer and photons" && Number(table, 0, "recommended") == 1.0, "row");
    claims.That(Number(table, 0, "error_l2") < 0.5, "near that of a quarter of the voxel edge");
    claims.That(std::string(comparison->GetRecommendedFilters()) == Text(table, 0, "filters") &&
        Text(table, 0, "filters").find("MeshVoxelizer Input=@Mesh SampleDimensions=16,16,16") == 0,
      "the filters that repeat it: " + Text(table, 0, "filters"));
  }
  ball->SetEndTheta(180.0);
  voxelizer->SetInputData(nullptr);
  comparison->SetInputDataObject(voxelizer->GetOutput());
  comparison->Update();
  claims.That(errors.WasOneWith("open"), "an open mesh");
  comparison->SetInputDataObject(test::MakeMedium({ { 4, 4, 4 } }, 0.5, 1.0));
  comparison->Update();
  claims.That(errors.WasOneWith("'occupancy'"), "a medium that was not made of a mesh");
}

/// What is not known, or not there, is said so.
void UnknownIsSaid(test::Claims& claims)
{
  vtkNew<vtkSolverComparison> comparison;
  test::Errors errors(comparison);
  AskForOne(comparison);
  comparison->SetInputDataObject(Cloud(8));
  const auto reference = Cloud(8);
  test::AddCells(reference, "fluence", 1.0);
  test::AddCells(reference, "fluence_direct", 1.0);
  comparison->SetReferenceData(reference);
  comparison->SetSkyColor(1.0, 1.0, 1.0);
  comparison->AddOrders(1);
  comparison->Update();
  vtkTable* const table = comparison->GetOutput();
  if (claims.That(errors.None() && table->GetNumberOfRows() == 2, "all orders, and one"))
  {
    claims.That(Number(table, 0, "estimated_error") < 1.0, "the error of all orders is estimated");
    claims.That(std::isnan(Number(table, 1, "estimated_error")),
      "that of one order is not known: " + std::to_string(Number(table, 1, "estimated_error")));
  }

  comparison->SetSkyColor(0.0, 0.0, 0.0);
  comparison->DefaultSkyOff();
  comparison->PhotonsOn();
  comparison->Update();
  claims.That(errors.None() &&
      std::string(comparison->GetLeftOut()).find("photons are made of lights, and nothing shines") != std::string::npos,
    std::string("photons without light: ") + comparison->GetLeftOut());
}

void ThePublishedSchemeIsLeftOutWhereGVaries(test::Claims& claims)
{
  vtkNew<vtkSolverComparison> comparison;
  test::Errors errors(comparison);
  AskForOne(comparison);
  comparison->AsPublishedOn();
  const auto medium = Cloud(6);
  test::AddValues<vtkDoubleArray>(
    medium->GetFieldData(), "g", 3, 1, [](vtkIdType channel, int) { return 0.1 * channel; });
  comparison->SetInputDataObject(medium);
  comparison->SetSkyColor(1.0, 1.0, 1.0);
  comparison->SetMonteCarloReference(vtkSolverComparison::NEVER);
  comparison->Update();
  claims.That(errors.None() && comparison->GetOutput()->GetNumberOfRows() == 1 &&
      std::string(comparison->GetLeftOut()).find("as published: the phase function (g) differs between channels") !=
        std::string::npos,
    std::string("a g of each channel: ") + comparison->GetLeftOut());
}

/// Asks to stop at a report of progress.
struct Stopper : vtkCommand
{
  static Stopper* New() { return new Stopper; }
  void Execute(vtkObject* caller, unsigned long, void*) override
  {
    auto* filter = static_cast<vtkAlgorithm*>(caller);
    this->Last = filter->GetProgress();
    if (++this->Reports == this->StopAt)
    {
      filter->SetAbortExecute(1);
    }
  }
  int Reports = 0;
  int StopAt = 0;
  double Last = 0.0;
};

void ReportsAndStops(test::Claims& claims)
{
  vtkNew<vtkSolverComparison> comparison;
  test::Errors errors(comparison);
  vtkNew<Stopper> stopper;
  comparison->AddObserver(vtkCommand::ProgressEvent, stopper);
  AskForOne(comparison);
  comparison->SetInputDataObject(test::MakeMedium({ { 16, 16, 16 } }, 0.0, 1.0));
  comparison->SetSkyColor(1.0, 1.0, 1.0);
  stopper->StopAt = 10;
  comparison->Update();
  claims.That(
    errors.None() && comparison->GetOutput()->GetNumberOfRows() == 0, "an abort is no error and gives no table");
  claims.That(
    stopper->Reports >= 10 && stopper->Reports <= 12, "it stops at once: " + std::to_string(stopper->Reports));
  claims.That(comparison->GetOutput()->GetFieldData()->HasArray("aborted"), "and says so");

  stopper->StopAt = 0;
  comparison->SetTimeBudget(1e-9); // over before the first run, on any machine
  comparison->SetReferenceData(Reference({ 16, 16, 16 }, "fluence"));
  comparison->AddDirections(10000);
  comparison->Update();
  claims.That(errors.WasOneWith("TimeBudget, 1e-09 s, was over before 2 of 2 runs were made") &&
      std::string(comparison->GetLeftOut()).find("10000 directions") != std::string::npos,
    "what takes longer than the budget is named");
}
}

int TestSolverComparison(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    LightIsNoErrorOfItself(claims);
    CoarserIsWorse(claims);
    GridsAreMatched(claims);
    PhotonsAreComparedWithDirectLight(claims);
    MonteCarloIsComparedWithAllLight(claims);
    LatticesAreComparedWithPhotons(claims);
    BadInput(claims);
    MeshesAreVoxelised(claims);
    UnknownIsSaid(claims);
    ThePublishedSchemeIsLeftOutWhereGVaries(claims);
    ReportsAndStops(claims);
  });
}
