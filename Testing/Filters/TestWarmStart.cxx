// Light that filters keep from one update to the next.

#include "MediumScene.h"

#include "vtkDiscreteOrdinates.h"
#include "vtkLightPropagationMaps.h"
#include "vtkTable.h"

#include <cmath>
#include <string>

namespace
{
/// Root mean square of the difference of two lights' fluence over that of the second.
double Difference(vtkImageData* a, vtkImageData* b)
{
  vtkDataArray* one = a->GetCellData()->GetArray("fluence");
  vtkDataArray* two = b->GetCellData()->GetArray("fluence");
  double difference = 0.0, sum = 0.0;
  for (vtkIdType i = 0; i < two->GetNumberOfTuples(); ++i)
  {
    difference += std::pow(one->GetComponent(i, 0) - two->GetComponent(i, 0), 2);
    sum += std::pow(two->GetComponent(i, 0), 2);
  }
  return std::sqrt(difference / sum);
}

bool HasColumn(vtkAlgorithm* solver)
{
  return vtkTable::SafeDownCast(solver->GetOutputDataObject(1))->GetColumnByName("sweeps_saved") != nullptr;
}

bool Says(const char* leftOut, const char* words)
{
  return std::string(leftOut).find(words) != std::string::npos;
}

/// A slider that is moved and let go, another grid, and off.
template <class Solver>
void KeepsItsLight(test::Claims& claims, const char* name, int acceleration)
{
  const test::Box box = { { 9, 8, 7 } };
  const auto which = [name](const char* claim) { return std::string(name) + ": " + claim; };
  vtkNew<Solver> solver;
  test::Errors errors(solver);
  solver->SetAcceleration(acceleration);
  solver->SetInputDataObject(test::MakeMedium(box, 0.02, 0.4));
  solver->SetSkyColor(1.0, 1.0, 1.0);
  solver->Update();
  claims.That(!solver->GetWarmStart() && !HasColumn(solver), which("off unless it is asked for"));
  vtkNew<vtkImageData> cold;
  cold->ShallowCopy(solver->GetOutput());
  solver->WarmStartOn();
  solver->Update();
  const int orders = solver->GetOrders();
  claims.That(Difference(solver->GetOutput(), cold) == 0.0, which("the first update begins in the dark"));
  claims.That(HasColumn(solver) && solver->GetSweepsSaved() == 0 && Says(solver->GetLeftOut(), "there is none"),
    which("and says so"));

  solver->SetInputDataObject(test::MakeMedium(box, 0.02, 0.42));
  solver->Update();
  claims.That(solver->GetOrders() < orders && solver->GetSweepsSaved() > 0, which("another medium takes fewer sweeps"));
  claims.That(Says(solver->GetLeftOut(), "begun from the last light"), which("and says why"));
  claims.That(solver->GetBalanceError() < 1e-5, which("its power is conserved"));
  vtkNew<Solver> fresh;
  fresh->SetAcceleration(acceleration);
  fresh->SetInputDataObject(solver->GetInputDataObject(0, 0));
  fresh->SetSkyColor(1.0, 1.0, 1.0);
  fresh->SetTolerance(1e-7);
  fresh->Update();
  const double error = Difference(solver->GetOutput(), fresh->GetOutput());
  claims.Near(error, 0.0, 1e-4, which("the difference to the same light"));

  solver->SetSkyColor(0.3, 0.3, 0.3);
  solver->Update();
  claims.That(solver->GetOrders() < orders, which("other light takes fewer sweeps"));
  solver->SetInputDataObject(test::MakeMedium({ { 9, 8, 6 } }, 0.02, 0.42));
  solver->Update();
  claims.That(Says(solver->GetLeftOut(), "the grid has changed") && solver->GetSweepsSaved() == 0,
    which("light of another grid is dropped"));
  solver->Modified();
  solver->Update();
  claims.That(solver->GetSweepsSaved() > 0, which("and the new one's kept"));

  solver->SetInputDataObject(test::MakeImage(box));
  solver->Update();
  claims.That(errors.WasOneWith("sigma_"), which("a medium without coefficients is an error"));
  solver->SetInputDataObject(test::MakeMedium({ { 9, 8, 6 } }, 0.02, 0.4));
  solver->Update();
  claims.That(errors.None() && solver->GetSweepsSaved() > 0, which("after which the light is still there"));
  solver->WarmStartOff();
  solver->Update();
  claims.That(!HasColumn(solver) && !Says(solver->GetLeftOut(), "WarmStart"), which("off again"));
  solver->WarmStartOn();
  solver->Update();
  claims.That(Says(solver->GetLeftOut(), "there is none"), which("off drops what was kept"));
}

/// Papers begin in the dark.
template <class Solver>
void BeginsInTheDarkAsPublished(test::Claims& claims)
{
  vtkNew<Solver> solver;
  test::Errors errors(solver);
  solver->SetInputDataObject(test::MakeMedium({ { 5, 4, 3 } }, 0.02, 0.4));
  solver->SetSkyColor(1.0, 1.0, 1.0);
  solver->SetScheme(Solver::PUBLISHED);
  solver->WarmStartOn();
  solver->Update();
  const int orders = solver->GetOrders();
  solver->Modified();
  solver->Update();
  claims.That(errors.None() && solver->GetOrders() == orders && solver->GetSweepsSaved() == 0 &&
      Says(solver->GetLeftOut(), "WarmStart"),
    "as published WarmStart has no effect, and left_out says so");
}

void EstimatesTheErrorOfAllOfIt(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  maps->SetInputDataObject(test::MakeMedium({ { 10, 9, 8 } }, 0.02, 0.5));
  maps->SetSkyColor(1.0, 1.0, 1.0);
  maps->EstimateErrorOn();
  maps->WarmStartOn();
  maps->Update();
  const double error = maps->GetEstimatedError();
  maps->Modified();
  maps->Update();
  claims.That(errors.None() && maps->GetSweepsSaved() > 0, "light is kept of the whole grid, not of coarser ones");
  claims.Near(maps->GetEstimatedError(), error, maps->GetTolerance(), "the error of all of it");
}
}

int TestWarmStart(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    KeepsItsLight<vtkLightPropagationMaps>(claims, "maps", vtkLightPropagationMaps::AUTOMATIC_ACCELERATION);
    KeepsItsLight<vtkDiscreteOrdinates>(claims, "ordinates", vtkDiscreteOrdinates::NONE);
    BeginsInTheDarkAsPublished<vtkLightPropagationMaps>(claims);
    BeginsInTheDarkAsPublished<vtkDiscreteOrdinates>(claims);
    EstimatesTheErrorOfAllOfIt(claims);
  });
}
