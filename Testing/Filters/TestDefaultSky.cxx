#include "MediumScene.h"

#include "vtkDiscreteOrdinates.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLightRig.h"
#include "vtkStringArray.h"

#include <string>

namespace
{
double LeastFluence(vtkImageData* light)
{
  vtkDataArray* const fluence = light->GetCellData()->GetArray("fluence");
  return fluence ? fluence->GetRange(0)[0] : -1.0;
}

bool SaysThatItShone(vtkImageData* light)
{
  auto* const leftOut = vtkArrayDownCast<vtkStringArray>(light->GetFieldData()->GetAbstractArray("left_out"));
  return leftOut && leftOut->GetNumberOfValues() > 0 &&
    std::string(leftOut->GetValue(0)).find("DefaultSky") != std::string::npos;
}

template <class Solver>
void ShinesWhereNothingIsGiven(test::Claims& claims)
{
  vtkNew<Solver> solver;
  test::Errors errors(solver);
  const std::string name = solver->GetClassName();
  solver->SetInputDataObject(test::MakeMedium({ { 3, 3, 3 } }, 0.1, 0.9));
  solver->Update();
  claims.That(errors.None() && LeastFluence(solver->GetOutput()) > 0.0, name + " is not dark, and does not complain");
  claims.That(SaysThatItShone(solver->GetOutput()), name + " says that the default sky shone");

  vtkNew<Solver> asked;
  vtkNew<vtkLightRig> rig;
  asked->SetInputDataObject(test::MakeMedium({ { 3, 3, 3 } }, 0.1, 0.9));
  asked->SetLightsConnection(rig->GetOutputPort());
  asked->SetSkyColor(0.1, 0.1, 0.1);
  asked->Update();
  vtkDataArray* const found = solver->GetOutput()->GetCellData()->GetArray("fluence");
  vtkDataArray* const expected = asked->GetOutput()->GetCellData()->GetArray("fluence");
  for (vtkIdType i = 0; found && expected && i < expected->GetNumberOfTuples(); ++i)
  {
    claims.Near(found->GetComponent(i, 0), expected->GetComponent(i, 0), 0.0, name + ": of a rig and a grey sky");
  }
  claims.That(!SaysThatItShone(asked->GetOutput()), name + " is silent about a sky that was asked for");

  solver->DefaultSkyOff();
  solver->Update();
  claims.That(errors.WasOneWith("Nothing shines"), name + " warns where it is switched off");
  claims.That(test::Deviation(solver->GetOutput(), "fluence", 0.0) == 0.0, name + " is dark where it is switched off");
}

void IsNotUsedBesideOtherLight(test::Claims& claims)
{
  const auto isUsed = [](vtkLightPropagationMaps* maps) {
    maps->Update();
    return SaysThatItShone(maps->GetOutput());
  };
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  const auto medium = test::MakeMedium({ { 3, 3, 3 } }, 0.1, 0.9);
  maps->SetInputDataObject(medium);
  claims.That(isUsed(maps), "without light");
  maps->SetFaceRadiance(0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
  claims.That(!isUsed(maps), "not beside a face that shines");
  maps->SetFaceRadiance(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  maps->SetFaceAlbedo(0.0, 0.0, 0.0, 0.0, 0.5, 0.0);
  claims.That(isUsed(maps), "a face that gives back light is no light");
  vtkNew<vtkLightRig> night;
  night->SetSun(false);
  claims.That(errors.None(), "no complaints so far");
  maps->SetLightsConnection(night->GetOutputPort());
  claims.That(!isUsed(maps) && errors.WasOneWith("Nothing shines"), "not where lights are connected, all of them off");
  maps->RemoveLights();
  test::AddCells(medium, "emission", 0.0);
  claims.That(isUsed(maps), "an emission of 0 is no light");
  medium->GetCellData()->RemoveArray("emission");
  test::AddCells(medium, "emission", 1.0);
  claims.That(!isUsed(maps) && errors.None(), "not where the medium emits");
}
}

int TestDefaultSky(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    ShinesWhereNothingIsGiven<vtkLightPropagationMaps>(claims);
    ShinesWhereNothingIsGiven<vtkDiscreteOrdinates>(claims);
    ShinesWhereNothingIsGiven<vtkLatticeBoltzmannLighting>(claims);
    IsNotUsedBesideOtherLight(claims);
  });
}
