// Filters that hand on their input hand on all of its arrays, whichever of them is the active one, and say which of
// them they took for the medium's quantities, and which they do not know; and take arrays of points as those of the
// voxels around them, and images whose axes are others than the world's as those that have these.

#include "MediumScene.h"

#include "vtkDiscreteOrdinates.h"
#include "vtkFieldData.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLPMCollect.h"
#include "vtkLPMPropagate.h"
#include "vtkMediumRayCaster.h"
#include "vtkParticipatingMedium.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonImportance.h"
#include "vtkPhotonMarcher.h"
#include "vtkPhotonReconstruction.h"
#include "vtkPointLight.h"
#include "vtkPointSet.h"
#include "vtkRefractionOctree.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

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
/// 5 x 4 x 3 voxels that differ from each other, as cells or as points in their middle.
vtkSmartPointer<vtkImageData> Varied(bool asPoints)
{
  auto image = test::MakeImage({ { 5, 4, 3 }, { 0.5, 0.5, 0.5 }, { 1.0, 2.0, 3.0 }, { 2, -1, 0 } });
  if (asPoints)
  {
    image = test::MakeImage({ { 4, 3, 2 }, { 0.5, 0.5, 0.5 }, { 1.25, 2.25, 3.25 }, { 2, -1, 0 } });
  }
  vtkFieldData* const to = asPoints ? static_cast<vtkFieldData*>(image->GetPointData()) : image->GetCellData();
  const auto add = [&](const char* name, double mean, int components = 1) {
    test::AddValues<vtkFloatArray>(to, name, 60, components,
      [=](vtkIdType i, int c) { return mean * (1.0 + 0.5 * std::sin(1.3 * static_cast<double>(i) + c)); });
  };
  add("sigma_a", 0.2);
  add("sigma_s", 0.6);
  add("emission", 0.1);
  add("fluence", 2.0);
  add("fluence_batches", 2.0, 2);
  test::AddValues<vtkFloatArray>(to, "ior", 60, 1, [](vtkIdType i, int) { // of 1 at the faces of the box
    const bool inside = i % 5 > 0 && i % 5 < 4 && i / 5 % 4 > 0 && i / 5 % 4 < 3 && i / 20 == 1;
    return inside ? 1.0 + 0.01 * static_cast<double>(i % 5) : 1.0;
  });
  return image;
}

bool SameArrays(vtkFieldData* a, vtkFieldData* b)
{
  bool same = a->GetNumberOfArrays() == b->GetNumberOfArrays();
  for (int i = 0; same && i < a->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* const values = a->GetArray(i);
    vtkDataArray* const others = values ? b->GetArray(values->GetName()) : nullptr;
    same = !values ||
      (others && values->GetNumberOfValues() == others->GetNumberOfValues() &&
        values->GetNumberOfComponents() == others->GetNumberOfComponents());
    for (vtkIdType value = 0; same && values && value < values->GetNumberOfValues(); ++value)
    {
      same = values->GetVariantValue(value) == others->GetVariantValue(value);
    }
  }
  return same;
}

/// The same voxels by axes of their own: axis a of the image goes along `world[a]`, down where that is so.
/// @param bySpacing  down by a negative spacing, not by the direction
vtkSmartPointer<vtkImageData> Turned(
  vtkImageData* image, const std::array<int, 3>& world, const std::array<bool, 3>& down, bool bySpacing = false)
{
  auto turned = vtkSmartPointer<vtkImageData>::New();
  double bounds[6], origin[3], spacing[3], direction[9] = {};
  image->GetBounds(bounds);
  int extent[6] = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    const int w = world[axis];
    extent[2 * axis + 1] = image->GetDimensions()[w] - 1;
    origin[w] = bounds[2 * w + (down[axis] ? 1 : 0)];
    spacing[axis] = image->GetSpacing()[w] * (down[axis] && bySpacing ? -1.0 : 1.0);
    direction[3 * w + axis] = down[axis] && !bySpacing ? -1.0 : 1.0;
  }
  turned->SetExtent(extent);
  turned->SetOrigin(origin);
  turned->SetSpacing(spacing);
  turned->SetDirectionMatrix(direction);
  vtkCellData* const cells = image->GetCellData();
  for (int i = 0; i < cells->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* const from = cells->GetArray(i);
    test::AddValues<vtkFloatArray>(turned->GetCellData(), from->GetName(), turned->GetNumberOfCells(),
      from->GetNumberOfComponents(), [&](vtkIdType cell, int c) {
        const int* const size = turned->GetDimensions();
        const vtkIdType at[3] = { cell % (size[0] - 1), cell / (size[0] - 1) % (size[1] - 1),
          cell / (size[0] - 1) / (size[1] - 1) };
        vtkIdType there[3];
        for (int axis = 0; axis < 3; ++axis)
        {
          there[world[axis]] = down[axis] ? size[axis] - 2 - at[axis] : at[axis];
        }
        const int* const cellsOf = image->GetDimensions();
        return from->GetComponent((there[2] * (cellsOf[1] - 1) + there[1]) * (cellsOf[0] - 1) + there[0], c);
      });
  }
  return turned;
}

/// That a filter makes the same of another image as of Varied's cells.
void MakesTheSame(test::Claims& claims, vtkAlgorithm* filter, vtkImageData* other = nullptr)
{
  const std::string what = filter->GetClassName();
  test::Errors errors(filter);
  vtkSmartPointer<vtkDataSet> made[2];
  const vtkSmartPointer<vtkImageData> others = other ? vtkSmartPointer<vtkImageData>(other) : Varied(true);
  for (const bool isOther : { false, true })
  {
    filter->SetInputDataObject(isOther ? others : Varied(false));
    filter->Update();
    auto* const output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    made[isOther].TakeReference(output->NewInstance());
    made[isOther]->DeepCopy(output);
    const bool ignores = !Fact(filter, "ignored").empty();
    claims.That(
      ignores ? errors.WasOneWith("The light does not depend on the medium's") : errors.None(), "no error of " + what);
  }
  const auto &ofCells = made[0], &ofPoints = made[1];
  double bounds[2][6];
  ofCells->GetBounds(bounds[0]);
  ofPoints->GetBounds(bounds[1]);
  claims.That(ofCells->GetNumberOfPoints() > 0 && std::equal(bounds[0], bounds[0] + 6, bounds[1]),
    what + " has the same bounds of other images of the same voxels");
  claims.That(SameArrays(ofCells->GetCellData(), ofPoints->GetCellData()) &&
      SameArrays(ofCells->GetPointData(), ofPoints->GetPointData()),
    what + " makes the same of other images of the same voxels");
}

/// With axes exchanged, or down, by direction or by spacing, the light is the same in the world.
void AxesAreTakenAsTheyGo(test::Claims& claims)
{
  const auto image = Varied(false);
  const vtkSmartPointer<vtkImageData> turned[] = { Turned(image, { 0, 1, 2 }, { true, false, false }),
    Turned(image, { 2, 0, 1 }, { false, true, true }), Turned(image, { 1, 0, 2 }, { false, false, true }, true) };
  vtkNew<vtkPointLight> lamp;
  lamp->SetPosition(0.0, 1.0, 2.0);
  for (vtkImageData* const other : turned)
  {
    vtkNew<vtkParticipatingMedium> medium;
    medium->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "sigma_a");
    MakesTheSame(claims, medium, other);
    vtkNew<vtkLightPropagationMaps> maps;
    maps->SetLightsConnection(lamp->GetOutputPort());
    MakesTheSame(claims, maps, other);
    vtkNew<vtkMediumRayCaster> caster;
    caster->SetLightsConnection(lamp->GetOutputPort());
    caster->SetImageSize(16, 12);
    MakesTheSame(claims, caster, other);
    vtkNew<vtkPhotonEmitter> emitter;
    emitter->SetLightsConnection(lamp->GetOutputPort());
    emitter->SetPhotonCount(100);
    MakesTheSame(claims, emitter, other);
    vtkNew<vtkPhotonMarcher> marcher;
    marcher->SetPhotonsData(emitter->GetOutput());
    MakesTheSame(claims, marcher, other);
  }

  // A filter after another one knows of the other axes before it has the data.
  vtkNew<vtkParticipatingMedium> medium;
  vtkNew<vtkLightPropagationMaps> maps;
  medium->SetInputDataObject(turned[1]);
  medium->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "sigma_a");
  maps->SetInputConnection(medium->GetOutputPort());
  maps->SetLightsConnection(lamp->GetOutputPort());
  maps->Update();
  claims.That(maps->GetOutput()->GetNumberOfCells() == 60, "a chain keeps all voxels");
}

void PointsAreVoxelsOfAllFilters(test::Claims& claims)
{
  vtkNew<vtkPointLight> lamp;
  lamp->SetPosition(0.0, 1.0, 2.0);
  const auto lit = [&](vtkLitMediumAlgorithm* filter) {
    filter->SetLightsConnection(lamp->GetOutputPort());
    MakesTheSame(claims, filter);
  };
  vtkNew<vtkLightPropagationMaps> maps;
  lit(maps);
  lit(vtkNew<vtkDiscreteOrdinates>());
  lit(vtkNew<vtkLatticeBoltzmannLighting>());
  lit(vtkNew<vtkLPMPropagate>());
  lit(vtkNew<vtkPhotonImportance>());
  vtkNew<vtkMediumRayCaster> caster;
  caster->SetImageSize(16, 12);
  lit(caster);
  vtkNew<vtkPhotonEmitter> emitter;
  emitter->SetPhotonCount(100);
  lit(emitter);
  vtkNew<vtkPhotonMarcher> marcher;
  marcher->SetPhotonsData(emitter->GetOutput());
  MakesTheSame(claims, marcher);
  MakesTheSame(claims, vtkNew<vtkRefractionOctree>());
  vtkNew<vtkPhotonReconstruction> reconstruction;
  reconstruction->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "fluence");
  MakesTheSame(claims, reconstruction);

  // Points beside cells.
  const auto mixed = test::MakeMedium({ { 3, 3, 3 } }, 0.1, 0.2);
  mixed->GetCellData()->RemoveArray("sigma_s");
  test::AddPoints(mixed, "sigma_s", 0.3);
  maps->SetInputDataObject(mixed);
  maps->Update();
  claims.That(maps->GetOutput()->GetNumberOfCells() == 27, "beside an array of cells points are averaged");
  claims.That(std::string(maps->GetSettingsUsed()).find("PointData = 1 for 'sigma_s'") != std::string::npos,
    std::string("that is among the settings used: ") + maps->GetSettingsUsed());
}

/// What a solver does not know of a medium is warned of, once, and told by its light; by blocks, too.
template <class Solver>
void TellsWhatItIgnores(test::Claims& claims, bool knows, int scheme,
  const std::vector<int>& decompositions = { Solver::WHOLE, Solver::BLOCKS })
{
  for (const int decomposition : decompositions)
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
  return test::WithDevice([&](test::Claims& claims) {
    ShallowCopiesOutliveTheirFilter(claims);
    PointsAreVoxelsOfAllFilters(claims);
    AxesAreTakenAsTheyGo(claims);
    TellsWhatItIgnores<vtkLightPropagationMaps>(claims, false, vtkLightPropagationMaps::CONSERVATIVE);
    TellsWhatItIgnores<vtkDiscreteOrdinates>(claims, false, vtkDiscreteOrdinates::CONSERVATIVE);
    TellsWhatItIgnores<vtkLatticeBoltzmannLighting>(claims, true, vtkLatticeBoltzmannLighting::CONSERVATIVE);
    TellsWhatItIgnores<vtkLatticeBoltzmannLighting>(
      claims, false, vtkLatticeBoltzmannLighting::PUBLISHED, { vtkLatticeBoltzmannLighting::WHOLE });
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
  });
}
