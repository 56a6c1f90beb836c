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

namespace
{
/// Filters behind ours often make shallow copies of arrays, and the filter that made them runs again or goes.
void ShallowCopiesOutliveTheirFilter(test::Claims& claims)
{
  const std::size_t voxels = 64 * 64 * 64;
  vtkNew<vtkFloatArray> copy;
  vtkNew<vtkFloatArray> longer;
  {
    vtkNew<vtkParticipatingMedium> filter;
    const auto image = test::MakeImage({ { 64, 64, 64 } });
    test::AddCells(image, "density", 0.25);
    filter->SetInputDataObject(image);
    filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "density");
    filter->Update();
    vtkDataArray* const made = filter->GetOutput()->GetCellData()->GetArray("sigma_s");
    copy->ShallowCopy(made);
    longer->ShallowCopy(made);
  }
  const std::vector<float> others(voxels, -1.0f); // where the memory was, were it given back
  longer->InsertNextValue(5.0f);
  const float first = copy->GetValue(0);
  bool same = first > 0.0f;
  for (vtkIdType i = 0; i < copy->GetNumberOfValues(); ++i)
  {
    same = same && copy->GetValue(i) == first && longer->GetValue(i) == first;
  }
  claims.That(same, "a shallow copy keeps the values of an array that is gone");
  claims.That(longer->GetValue(longer->GetNumberOfValues() - 1) == 5.0f, "and can grow");
}
}

int TestArraysArePassedOn(int, char*[])
{
  if (!test::HasDevice())
  {
    return test::SkippedWithoutDevice("nothing was solved");
  }
  test::Claims claims;
  ShallowCopiesOutliveTheirFilter(claims);
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
