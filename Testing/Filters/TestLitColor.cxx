// What solvers make of their light for volume mappers: lit_color.

#include "MediumScene.h"

#include "vtkDiscreteOrdinates.h"
#include "vtkFieldData.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLightPropagationMaps.h"
#include "vtkUnsignedCharArray.h"

#include <string>

namespace
{
vtkDataArray* Colors(vtkImageData* light)
{
  return light->GetCellData()->GetArray("lit_color");
}

bool HasFacts(vtkImageData* light)
{
  return light->GetFieldData()->HasArray("lit_color_distance") && light->GetFieldData()->HasArray("lit_color_exposure");
}

double Exposure(vtkImageData* light)
{
  return light->GetFieldData()->GetArray("lit_color_exposure")->GetComponent(0, 0);
}

template <class Solver>
void MakesColors(test::Claims& claims, const char* name)
{
  const auto which = [name](const char* claim) { return std::string(name) + ": " + claim; };
  vtkNew<Solver> solver;
  test::Errors errors(solver);
  solver->SetInputDataObject(test::MakeMedium({ { 6, 5, 4 } }, 0.1, 0.6));
  solver->SetSkyColor(1.0, 1.0, 1.0);
  solver->Update();
  claims.That(!solver->GetLitColor() && !Colors(solver->GetOutput()), which("off unless it is asked for"));
  vtkDataArray* const fluence = solver->GetOutput()->GetCellData()->GetArray("fluence");
  const void* const values = fluence->GetVoidPointer(0);
  const auto isKept = [&] {
    return solver->GetOutput()->GetCellData()->GetArray("fluence")->GetVoidPointer(0) == values;
  };

  solver->LitColorOn();
  solver->Update();
  vtkDataArray* const made = Colors(solver->GetOutput());
  claims.That(made && made->GetNumberOfComponents() == 4 && made->GetDataType() == VTK_UNSIGNED_CHAR &&
      made->GetNumberOfTuples() == 120,
    which("a colour and an opacity for each cell"));
  claims.That(HasFacts(solver->GetOutput()), which("and what belongs to them"));
  claims.That(isKept(), which("the light is not solved again"));
  claims.That(made->GetComponent(60, 0) > 50.0 && made->GetComponent(60, 3) > 100.0, which("the medium is seen"));

  const double automatic = Exposure(solver->GetOutput()), shown = made->GetComponent(60, 0);
  solver->SetExposure(2.0 * automatic);
  solver->Update();
  claims.That(Exposure(solver->GetOutput()) == 2.0 * automatic && isKept(), which("the exposure that was given"));
  claims.That(Colors(solver->GetOutput())->GetComponent(60, 0) > shown, which("which makes it brighter"));
  solver->SetToneCurve(0);
  solver->Update();
  claims.That(Colors(solver->GetOutput()) && isKept(), which("and another curve"));

  vtkNew<Solver> next;
  next->SetInputDataObject(solver->GetOutput());
  next->SetSkyColor(1.0, 1.0, 1.0);
  next->Update();
  claims.That(!Colors(next->GetOutput()) && !HasFacts(next->GetOutput()), which("those of another solve are dropped"));

  claims.That(errors.None(), which("no error until here"));
  solver->SetExposure(-1.0);
  solver->Update();
  claims.That(
    errors.WasOneWith("Exposure") && solver->GetOutput()->GetNumberOfCells() == 0, which("a bad exposure is an error"));
  solver->SetExposure(0.0);
  solver->LitColorOff();
  solver->Update();
  claims.That(!Colors(solver->GetOutput()) && !HasFacts(solver->GetOutput()) && isKept(), which("off it is as before"));
}
}

int TestLitColor(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    MakesColors<vtkLightPropagationMaps>(claims, "LightPropagationMaps");
    MakesColors<vtkDiscreteOrdinates>(claims, "DiscreteOrdinates");
    MakesColors<vtkLatticeBoltzmannLighting>(claims, "LatticeBoltzmannLighting");
  });
}
