// What filters do where MemoryBudget is less than they need: solvers find the same light, others say what is missing.

#include "MediumScene.h"

#include "vtkDiscreteOrdinates.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLightPropagationMaps.h"
#include "vtkLightRig.h"
#include "vtkMediumRayCaster.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonImportance.h"
#include "vtkPhotonMarcher.h"

#include <string>
#include <vector>

namespace
{
vtkSmartPointer<vtkImageData> Medium(int edge)
{
  return test::MakeMedium({ { edge, edge, edge } }, 0.05, 0.2);
}

std::vector<double> Fluence(vtkImageData* image)
{
  vtkDataArray* array = image->GetCellData()->GetArray("fluence");
  std::vector<double> values;
  for (vtkIdType i = 0; array && i < array->GetNumberOfValues(); ++i)
  {
    values.push_back(array->GetVariantValue(i).ToDouble());
  }
  return values;
}

template <class Solver>
void FindsTheSameLight(test::Claims& claims, const std::string& which)
{
  vtkNew<Solver> solver;
  test::Errors errors(solver);
  solver->SetInputDataObject(Medium(24));
  solver->SetMaximumOrders(3);
  solver->Update();
  const std::vector<double> whole = Fluence(solver->GetOutput());
  claims.That(std::string(solver->GetDeviceName()).find("budget") == std::string::npos, which + ": whole by itself");
  solver->SetMemoryBudget(1);
  solver->Update();
  claims.That(errors.None(), which + ": no complaint");
  claims.That(!whole.empty() && Fluence(solver->GetOutput()) == whole, which + ": the same light within 1 MiB");
  const std::string device = solver->GetDeviceName();
  claims.That(device.find("in host memory") != std::string::npos, which + ": says what lies where: " + device);
  solver->SetMemoryBudget(-1);
  solver->Update();
  claims.That(errors.WasOneWith("MemoryBudget"), which + ": one error where it is negative");
}

template <class Filter>
void SaysWhatIsMissing(test::Claims& claims, Filter* filter, const std::string& which, const std::string& part)
{
  test::Errors errors(filter);
  filter->SetMemoryBudget(1);
  filter->Update();
  claims.That(errors.WasOneWith(part), which + ": one error where 1 MiB is too little");
  filter->SetMemoryBudget(1000);
  filter->Update();
  claims.That(errors.None(), which + ": works within 1000 MiB");
  filter->SetMemoryBudget(0);
  filter->Update();
  claims.That(errors.None(), which + ": works without a budget");
}
}

int TestMemoryBudget(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    FindsTheSameLight<vtkLightPropagationMaps>(claims, "light propagation maps");
    FindsTheSameLight<vtkLatticeBoltzmannLighting>(claims, "lattice");

    vtkNew<vtkDiscreteOrdinates> ordinates;
    ordinates->SetInputDataObject(Medium(16));
    ordinates->SetMaximumOrders(1);
    SaysWhatIsMissing(claims, ordinates.GetPointer(), "discrete ordinates", "has 1 MiB left");

    const auto medium = Medium(64);
    vtkNew<vtkLightRig> rig;
    vtkNew<vtkPhotonEmitter> emitter;
    emitter->SetInputDataObject(medium);
    emitter->SetLightsConnection(rig->GetOutputPort());
    emitter->SetPhotonCount(500);
    vtkNew<vtkPhotonMarcher> marcher;
    marcher->SetInputDataObject(medium);
    marcher->SetPhotonsConnection(emitter->GetOutputPort());
    SaysWhatIsMissing(claims, marcher.GetPointer(), "photons", "of the memory budget");

    vtkNew<vtkPhotonImportance> importance;
    importance->SetInputDataObject(medium);
    importance->SetLightsConnection(rig->GetOutputPort());
    importance->SetPilotCount(256);
    SaysWhatIsMissing(claims, importance.GetPointer(), "importance", "of the memory budget");

    test::AddCells(medium, "fluence", 1.0);
    vtkNew<vtkMediumRayCaster> caster;
    caster->SetInputDataObject(medium);
    caster->SetImageSize(16, 12);
    SaysWhatIsMissing(claims, caster.GetPointer(), "ray caster", "of the memory budget");
  });
}
