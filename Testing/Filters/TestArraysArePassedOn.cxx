// Filters that hand on their input hand on all of its arrays, whichever of them is the active one.

#include "MediumScene.h"

#include "vtkLPMCollect.h"
#include "vtkLPMPropagate.h"
#include "vtkParticipatingMedium.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"
#include "vtkPhotonReconstruction.h"
#include "vtkRefractionOctree.h"

namespace
{
const char* const CellNames[] = { "occupancy", "ior", "sigma_a", "sigma_s", "temperature" };

vtkSmartPointer<vtkImageData> Medium(const char* active)
{
  auto image = test::MakeMedium({}, 0.1, 0.2);
  test::AddCells(image, "occupancy", 0.5);
  test::AddCells(image, "temperature", 300.0);
  test::AddValues<vtkFloatArray>(image->GetCellData(), "ior", image->GetNumberOfCells(), 1,
    [](vtkIdType i, int) { return 1.0 + 0.01 * static_cast<double>(i % 4); });
  test::AddPoints(image, "pressure", 1.0);
  image->GetPointData()->SetActiveScalars("pressure");
  image->GetCellData()->SetActiveScalars(active);
  return image;
}

void Check(test::Claims& claims, vtkAlgorithm* filter, const char* active)
{
  test::Errors errors(filter);
  filter->SetInputDataObject(Medium(active));
  filter->Update();
  const std::string what = std::string(filter->GetClassName()) + " where " + active + " is active";
  claims.That(errors.None(), "no error of " + what);
  auto* output = vtkImageData::SafeDownCast(filter->GetOutputDataObject(0));
  for (const char* name : CellNames)
  {
    claims.That(output->GetCellData()->HasArray(name), std::string(name) + " goes through " + what);
  }
  claims.That(output->GetPointData()->HasArray("pressure"), "pressure goes through " + what);
}
}

int TestArraysArePassedOn(int, char*[])
{
  if (!test::HasDevice())
  {
    return test::SkippedWithoutDevice("nothing was solved");
  }
  test::Claims claims;
  for (const char* active : CellNames)
  {
    vtkNew<vtkRefractionOctree> octree;
    Check(claims, octree, active);
    claims.That(std::string(octree->GetOutput()->GetCellData()->GetScalars()->GetName()) == "octree_level",
      "octree_level is the active array");

    vtkNew<vtkParticipatingMedium> density;
    density->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "occupancy");
    Check(claims, density, active);

    vtkNew<vtkPhotonEmitter> emitter;
    emitter->SetInputDataObject(Medium(active));
    emitter->SetSkyColor(1.0, 1.0, 1.0);
    emitter->SetPhotonCount(10);
    vtkNew<vtkPhotonMarcher> marcher;
    marcher->SetPhotonsConnection(emitter->GetOutputPort());
    Check(claims, marcher, active);

    vtkNew<vtkPhotonReconstruction> reconstruction;
    reconstruction->SetScheme(vtkPhotonReconstruction::CONSTANT_RADIUS);
    reconstruction->SetInputConnection(marcher->GetOutputPort());
    reconstruction->Update();
    for (const char* name : CellNames)
    {
      claims.That(reconstruction->GetOutput()->GetCellData()->HasArray(name),
        std::string(name) + " goes through vtkPhotonReconstruction where " + active + " is active");
    }

    vtkNew<vtkLightPropagationMaps> maps;
    maps->SetSkyColor(1.0, 1.0, 1.0);
    Check(claims, maps, active);

    vtkNew<vtkLPMPropagate> propagate;
    propagate->SetSkyColor(1.0, 1.0, 1.0);
    Check(claims, propagate, active);

    vtkNew<vtkLPMCollect> collect;
    propagate->Update();
    collect->SetInputConnection(propagate->GetOutputPort());
    collect->Update();
    for (const char* name : CellNames)
    {
      auto* collected = vtkImageData::SafeDownCast(collect->GetOutputDataObject(0));
      claims.That(collected->GetCellData()->HasArray(name), std::string(name) + " goes through vtkLPMCollect");
    }
  }
  return claims.Result();
}
