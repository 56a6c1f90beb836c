// Filters that hand on their input hand on all of its arrays, whichever of them is the active one, and say which of them
// they took for the medium's quantities, and which they do not know.

#include "MediumScene.h"

#include "vtkDiscreteOrdinates.h"
#include "vtkFieldData.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLPMCollect.h"
#include "vtkLPMPropagate.h"
#include "vtkMediumRayCaster.h"
#include "vtkParticipatingMedium.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"
#include "vtkPhotonReconstruction.h"
#include "vtkRefractionOctree.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

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

/// The first text of field data; empty: there is none.
std::string Fact(vtkAlgorithm* filter, const char* name)
{
  vtkDataObject* const output = filter->GetOutputDataObject(0);
  auto* const texts = vtkArrayDownCast<vtkStringArray>(output->GetFieldData()->GetAbstractArray(name));
  return texts && texts->GetNumberOfValues() > 0 ? texts->GetValue(0) : std::string();
}

constexpr const char* IndexIgnored = "ior (light goes straight on, as if it were 1 everywhere; PhotonMarcher";

/// @param warning  that there is to be one
void Check(test::Claims& claims, vtkAlgorithm* filter, const char* active, const char* warning = nullptr)
{
  test::Errors errors(filter);
  filter->SetInputDataObject(Medium(active));
  filter->Update();
  const std::string what = std::string(filter->GetClassName()) + " where " + active + " is active";
  claims.That(warning ? errors.WasOneWith(warning) : errors.None(), "no error of " + what);
  claims.That(Fact(filter, "ignored").find(warning ? warning : "") == 0, "what was ignored is told of " + what);
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

namespace
{
/// What a solver does not know of a medium is warned of, once, and told by its light; by blocks, too.
template <class Solver>
void TellsWhatItIgnores(test::Claims& claims, bool knows, int scheme)
{
  for (const int decomposition : { Solver::WHOLE, Solver::BLOCKS })
  {
    vtkNew<Solver> solver;
    solver->SetScheme(scheme);
    solver->SetDecomposition(decomposition);
    solver->SetSkyColor(1.0, 1.0, 1.0);
    Check(claims, solver, "ior", knows ? nullptr : IndexIgnored);
    test::Errors errors(solver);
    const auto even = Medium("ior");
    test::AddCells(even, "ior", 1.0);
    test::AddCells<vtkUnsignedCharArray>(even, vtkDataSetAttributes::GhostArrayName(), 0.0);
    even->GetCellData()->GetArray("ior")->SetComponent(5, 0, 2.0);
    even->GetCellData()
      ->GetArray(vtkDataSetAttributes::GhostArrayName())
      ->SetComponent(5, 0, vtkDataSetAttributes::HIDDENCELL);
    solver->SetInputDataObject(even);
    solver->Update();
    claims.That(errors.None() && Fact(solver, "ignored").empty(), "an index of 1, or of a hidden cell, is no matter");
  }
}

void PhotonsTellOfEmission(test::Claims& claims)
{
  vtkNew<vtkPhotonEmitter> emitter;
  emitter->SetInputDataObject(Medium("ior"));
  emitter->SetSkyColor(1.0, 1.0, 1.0);
  emitter->SetPhotonCount(10);
  for (const int decomposition : { vtkPhotonMarcher::WHOLE, vtkPhotonMarcher::BLOCKS })
  {
    vtkNew<vtkPhotonMarcher> marcher;
    marcher->SetDecomposition(decomposition);
    marcher->SetPhotonsConnection(emitter->GetOutputPort());
    const auto medium = Medium("ior");
    test::AddCells(medium, "emission", 0.0);
    medium->GetCellData()->GetArray("emission")->SetComponent(3, 0, 1.0);
    marcher->SetInputDataObject(medium);
    test::Errors errors(marcher);
    marcher->Update();
    claims.That(errors.WasOneWith("emission (photons carry the light of lights alone"), "photons do not know emission");
    claims.That(Fact(marcher, "ignored").find("emission") == 0, "and their light says so");
  }
}

/// The same medium whose arrays have other names.
vtkSmartPointer<vtkImageData> Renamed()
{
  const auto image = test::MakeMedium({}, 9.0, 0.0); // what has the usual names is something else
  test::AddCells(image, "mua", 0.1);
  test::AddCells(image, "mus", 0.2);
  test::AddCells(image, "n", 1.0);
  return image;
}

void Choose(vtkAlgorithm* filter)
{
  const char* const names[] = { "mua", "mus" };
  for (int i = 0; i < 2; ++i)
  {
    filter->SetInputArrayToProcess(i, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, names[i]);
  }
}

/// Of the middle of the picture.
double Seen(vtkAlgorithm* light)
{
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetInputConnection(light->GetOutputPort());
  caster->SetImageSize(9, 9);
  caster->SetCameraPosition(2.0, -10.0, 2.0);
  caster->SetCameraFocalPoint(2.0, 2.0, 2.0);
  caster->SetCameraViewUp(0.0, 0.0, 1.0);
  caster->Update();
  vtkDataArray* const radiance = caster->GetOutput()->GetPointData()->GetArray("radiance");
  return radiance ? radiance->GetComponent(40, 0) : -1.0;
}

/// Filters after a solver take the arrays that it took, wherever the user chose none.
void ChoicesGoWithTheLight(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> usual, maps, again;
  for (vtkLightPropagationMaps* solver : { usual.Get(), maps.Get(), again.Get() })
  {
    solver->SetSkyColor(1.0, 1.0, 1.0);
  }
  usual->SetInputDataObject(test::MakeMedium({}, 0.1, 0.2));
  usual->Update();
  maps->SetInputDataObject(Renamed());
  Choose(maps);
  maps->Update();
  claims.That(Fact(usual, "sigma_a_array").empty(), "the usual arrays need no word");
  claims.That(Fact(maps, "sigma_a_array") == "mua" && Fact(maps, "sigma_s_array") == "mus", "the light says which");
  const double seen = Seen(usual);
  claims.That(seen > 0.0, "there is a picture");
  claims.Near(Seen(maps), seen, 1e-6 * seen, "the picture is that of the arrays that were solved with");

  again->SetInputConnection(maps->GetOutputPort());
  again->Update();
  claims.Near(again->GetOutput()->GetCellData()->GetArray("fluence")->GetComponent(21, 0),
    usual->GetOutput()->GetCellData()->GetArray("fluence")->GetComponent(21, 0), 1e-6, "a solver after it");
  claims.That(Fact(again, "sigma_s_array") == "mus", "which says so, too");
  again->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "n");
  again->Update();
  claims.That(Fact(again, "sigma_a_array") == "n", "another choice wins");

  vtkNew<vtkRefractionOctree> octree;
  octree->SetInputDataObject(Renamed());
  octree->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "n");
  octree->Update();
  claims.That(Fact(octree, "ior_array") == "n", "an octree says which index it is of");

  vtkNew<vtkParticipatingMedium> medium;
  medium->SetInputConnection(maps->GetOutputPort());
  medium->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "mus");
  medium->Update();
  claims.That(Fact(medium, "sigma_a_array").empty(), "a medium that is made anew has its own arrays");
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
  TellsWhatItIgnores<vtkLightPropagationMaps>(claims, false, vtkLightPropagationMaps::CONSERVATIVE);
  TellsWhatItIgnores<vtkDiscreteOrdinates>(claims, false, vtkDiscreteOrdinates::CONSERVATIVE);
  TellsWhatItIgnores<vtkLatticeBoltzmannLighting>(claims, true, vtkLatticeBoltzmannLighting::CONSERVATIVE);
  TellsWhatItIgnores<vtkLatticeBoltzmannLighting>(claims, false, vtkLatticeBoltzmannLighting::PUBLISHED);
  PhotonsTellOfEmission(claims);
  ChoicesGoWithTheLight(claims);
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
    Check(claims, maps, active, IndexIgnored);

    vtkNew<vtkLPMPropagate> propagate;
    propagate->SetSkyColor(1.0, 1.0, 1.0);
    Check(claims, propagate, active, IndexIgnored);

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
