#include "MediumScene.h"

#include "vtkDiscreteOrdinates.h"

#include "vtkTable.h"

#include "Numerics/Constants.h"

#include <string>

namespace
{
using tyndall::Pi;

void SetMeanCosine(vtkImageData* medium, double g)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName("g");
  array->InsertNextValue(g);
  medium->GetFieldData()->AddArray(array);
}

void FillsAFurnace(test::Claims& claims, double g)
{
  auto medium = test::MakeMedium({ { 5, 4, 6 }, { 0.5, 1.0, 0.7 }, { 0.0, 0.0, 0.0 }, { -2, 3, 9 } }, 0.0, 2.0);
  SetMeanCosine(medium, g);
  vtkNew<vtkDiscreteOrdinates> ordinates;
  test::Errors errors(ordinates);
  ordinates->SetInputDataObject(medium);
  ordinates->SetSkyColor(0.5, 0.5, 0.5);
  ordinates->SetTolerance(1e-7);
  ordinates->SetNetFlux(true);
  ordinates->Update();
  const std::string which = "g " + std::to_string(g);
  claims.That(errors.None(), which + ": solved without complaint");
  const double fluence = 4.0 * Pi * 0.5;
  claims.Near(test::Deviation(ordinates->GetOutput(), "fluence", fluence) / fluence, 0.0, 1e-5, which + ": fluence");
  claims.Near(test::Deviation(ordinates->GetOutput(), "net_flux", 0.0) / fluence, 0.0, 1e-5, which + ": what flows");
  claims.That(ordinates->GetBalanceError() < 1e-5, which + ": power is conserved");
  claims.That(ordinates->GetOrders() > 0 && ordinates->GetResidual() <= 1e-7, which + ": says how far it came");
  vtkTable* convergence = vtkTable::SafeDownCast(ordinates->GetOutputDataObject(1));
  claims.That(convergence && convergence->GetNumberOfRows() == ordinates->GetOrders(), which + ": a row an order");
  vtkFieldData* facts = ordinates->GetOutput()->GetFieldData();
  claims.That(facts->GetArray("energy_balance") && facts->GetArray("face_power_out"), which + ": where power went");
  claims.That(facts->GetAbstractArray("left_out") != nullptr, which + ": what it left out");
  claims.That(ordinates->GetOutput()->GetExtent()[0] == -2, which + ": keeps its extent");
}

void WarnsBeforeItIsNotStable(test::Claims& claims)
{
  auto medium = test::MakeMedium({ { 4, 4, 4 } }, 1.0, 1.0);
  vtkNew<vtkDiscreteOrdinates> ordinates;
  test::Errors errors(ordinates);
  ordinates->SetInputDataObject(medium);
  ordinates->SetSkyColor(1.0, 1.0, 1.0);
  ordinates->SetScheme(vtkDiscreteOrdinates::PUBLISHED);
  ordinates->SetMaximumOrders(5);
  ordinates->Update();
  claims.That(errors.WasOneWith("is above 1: here it is up to 2"), "warns that explicit steps are too long");
}

void SaysWhatIsWrong(test::Claims& claims)
{
  auto medium = test::MakeMedium({ { 3, 3, 3 } }, 1.0, 1.0);
  vtkNew<vtkDiscreteOrdinates> ordinates;
  test::Errors errors(ordinates);
  ordinates->SetInputDataObject(medium);
  ordinates->DefaultSkyOff();
  ordinates->Update();
  claims.That(errors.WasOneWith("Nothing shines"), "warns where it is dark");
  ordinates->SetSkyColor(1.0, 1.0, 1.0);
  ordinates->SetTerms(1000);
  ordinates->Update();
  claims.That(errors.WasOneWith("1000 terms"), "refuses more terms than directions");
  claims.That(ordinates->GetOutput()->GetNumberOfCells() == 0, "and makes nothing");
  ordinates->SetTerms(9);
  ordinates->Update();
  claims.That(errors.None() && ordinates->GetOutput()->GetNumberOfCells() == 27, "works again after that");
}
}

int TestDiscreteOrdinates(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    FillsAFurnace(claims, 0.0);
    FillsAFurnace(claims, 0.8);
    WarnsBeforeItIsNotStable(claims);
    SaysWhatIsWrong(claims);
  });
}
