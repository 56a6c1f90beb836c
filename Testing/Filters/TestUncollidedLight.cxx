// Uncollided light of photons, bent by glass, handed on to the solvers that scatter it.

#include "MediumScene.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDiscreteOrdinates.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLightPropagationMaps.h"
#include "vtkLightRig.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"
#include "vtkPointData.h"
#include "vtkRefractionOctree.h"

#include <cmath>
#include <string>

namespace
{
const test::Box FogBox = { { 16, 14, 18 }, { 0.1, 0.1, 0.1 }, { -0.8, -0.7, 2.0 }, { 0, 1, 0 } };

/// Fog round a lens of glass, under the sun.
struct Caustic
{
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkPhotonEmitter> emitter;
  vtkNew<vtkPhotonMarcher> marcher;
  vtkSmartPointer<vtkImageData> medium = test::MakeMedium(FogBox, 0.05, 0.8);

  Caustic()
  {
    test::AddValues<vtkDoubleArray>(
      this->medium->GetCellData(), "ior", this->medium->GetNumberOfCells(), 1, [](vtkIdType i, int) {
        const double r = std::hypot(i % 16 - 7.5, i / 16 % 14 - 6.5, i / 224 - 11.5);
        return 1.0 + 0.2 * std::erfc((r - 5.0) / 1.5);
      });
    this->rig->SetSunElevation(70.0);
    this->emitter->SetInputDataObject(this->medium);
    this->emitter->SetLightsConnection(this->rig->GetOutputPort());
    this->emitter->SetPhotonCount(100000);
    this->marcher->SetInputDataObject(this->medium);
    this->marcher->SetPhotonsConnection(this->emitter->GetOutputPort());
  }

  vtkImageData* Light() { return vtkImageData::SafeDownCast(this->marcher->GetOutputDataObject(0)); }
};

double Fact(vtkImageData* light, const char* name, int i)
{
  vtkDataArray* fact = light->GetFieldData()->GetArray(name);
  return fact ? fact->GetComponent(i, 0) : std::nan("");
}

template <class Solver>
void ScattersACaustic(test::Claims& claims, const std::string& name)
{
  Caustic caustic;
  vtkNew<Solver> solver;
  solver->SetInputDataObject(caustic.medium);
  solver->SetLightsConnection(caustic.rig->GetOutputPort()); // not read
  solver->SetSkyColor(5.0, 5.0, 5.0);                        // nor this
  solver->SetUncollidedLightConnection(caustic.marcher->GetOutputPort());
  solver->Update();
  vtkImageData* light = solver->GetOutput();
  const double entered = Fact(caustic.Light(), "energy_balance", 0);
  claims.Near(Fact(light, "energy_balance", 0), entered, 1e-5 * entered, name + ": all power is handed over");
  claims.That(solver->GetBalanceError() < 1e-5, name + ": and kept");
  vtkDataArray* direct = light->GetCellData()->GetArray("fluence_direct");
  vtkDataArray* given = caustic.Light()->GetCellData()->GetArray("fluence_direct");
  vtkDataArray* all = light->GetCellData()->GetArray("fluence");
  double difference = 0.0, scattered = 0.0, most = 0.0;
  for (vtkIdType i = 0; i < all->GetNumberOfTuples(); ++i)
  {
    difference = std::max(difference, std::abs(direct->GetComponent(i, 0) - given->GetComponent(i, 0)));
    scattered += (all->GetComponent(i, 0) - direct->GetComponent(i, 0)) / all->GetNumberOfTuples();
    most = std::max(most, given->GetComponent(i, 0));
  }
  claims.That(most > 2.0, name + ": there is a caustic");
  claims.Near(difference / most, 0.0, 1e-5, name + ": uncollided light is that of the photons");
  claims.That(scattered > 0.2 && scattered < 2.0, name + ": and is scattered");
  claims.That(std::string(solver->GetLeftOut()).find("UncollidedLight") != std::string::npos, name + ": says so");

  solver->RemoveUncollidedLight();
  solver->SetSkyColor(0.0, 0.0, 0.0);
  solver->Update();
  const double own = Fact(solver->GetOutput(), "energy_balance", 0);
  claims.Near(own / entered, 1.0, 0.01, name + ": without it lights shine as before");
}

template <class Solver>
void RefusesOtherVoxels(test::Claims& claims, const std::string& name)
{
  Caustic caustic;
  caustic.marcher->Update();
  vtkNew<Solver> solver;
  test::Errors errors(solver);
  solver->SetInputDataObject(caustic.medium);
  vtkNew<vtkImageData> moved;
  moved->ShallowCopy(caustic.Light());
  moved->SetOrigin(0.0, -0.7, 2.0);
  solver->SetUncollidedLightData(moved);
  solver->Update();
  claims.That(errors.WasOneWith("UncollidedLight has 16 x 14 x 18 voxels"), name + ": one error for another box");
  claims.That(solver->GetOutput()->GetNumberOfCells() == 0, name + ": and no light");

  vtkNew<vtkImageData> bare;
  bare->ShallowCopy(caustic.Light());
  bare->GetCellData()->RemoveArray("fluence_direct");
  solver->SetUncollidedLightData(bare);
  solver->Update();
  claims.That(errors.WasOneWith("fluence_direct"), name + ": one error where there is no light");

  vtkNew<vtkPhotonMarcher> scattered;
  scattered->SetInputDataObject(caustic.medium);
  scattered->SetPhotonsConnection(caustic.emitter->GetOutputPort());
  scattered->SetMaximumOrders(3);
  scattered->Update();
  solver->SetUncollidedLightData(scattered->GetOutputDataObject(0));
  solver->Update();
  claims.That(errors.WasOneWith("MaximumOrders 1"), name + ": one error for light that was scattered");

  solver->SetUncollidedLightData(caustic.Light());
  solver->Update();
  claims.That(errors.WasOneWith("does not depend on the medium's ior"), name + ": and goes on");
}
}

/// The same cells' values as those of points in their middles.
vtkSmartPointer<vtkImageData> AsPoints(vtkImageData* cells)
{
  const int* const size = cells->GetDimensions();
  const double* const spacing = cells->GetSpacing();
  double corner[3];
  cells->GetPoint(0, corner);
  auto points = vtkSmartPointer<vtkImageData>::New();
  points->SetDimensions(size[0] - 1, size[1] - 1, size[2] - 1);
  points->SetSpacing(cells->GetSpacing());
  points->SetOrigin(corner[0] + 0.5 * spacing[0], corner[1] + 0.5 * spacing[1], corner[2] + 0.5 * spacing[2]);
  points->GetPointData()->ShallowCopy(cells->GetCellData());
  points->SetFieldData(cells->GetFieldData());
  return points;
}

template <class Filter>
double SumOfFluence(test::Claims& claims, Filter* filter, const std::string& what)
{
  test::Errors errors(filter);
  filter->Update();
  claims.That(errors.None(), what + ": no error");
  auto* const light = vtkImageData::SafeDownCast(filter->GetOutputDataObject(0));
  vtkDataArray* const fluence = light->GetCellData()->GetArray("fluence");
  double sum = 0.0;
  for (vtkIdType i = 0; fluence && i < fluence->GetNumberOfTuples(); ++i)
  {
    sum += fluence->GetComponent(i, 0) * (1.0 + i % 7);
  }
  return sum;
}

template <class Solver>
void TakesLightAroundPoints(test::Claims& claims, Caustic& caustic, const std::string& name)
{
  vtkNew<vtkImageData> medium;
  medium->ShallowCopy(caustic.medium);
  medium->GetCellData()->RemoveArray("ior"); // of which most solvers warn
  vtkNew<Solver> solver;
  solver->SetInputDataObject(medium);
  solver->SetUncollidedLightData(caustic.Light());
  const double wanted = SumOfFluence(claims, solver.Get(), name);
  solver->SetUncollidedLightData(AsPoints(caustic.Light()));
  claims.Near(
    SumOfFluence(claims, solver.Get(), name + ", points") / wanted, 1.0, 1e-6, name + ": light around points");
  solver->SetInputDataObject(AsPoints(medium));
  claims.Near(
    SumOfFluence(claims, solver.Get(), name + ", all points") / wanted, 1.0, 1e-6, name + ": and a medium around them");
}

/// Second images have a voxel around each of their points, as the medium has; beside a medium whose cells are read,
/// those that lie between its points.
void SecondImagesAreAroundPoints(test::Claims& claims)
{
  Caustic caustic;
  caustic.emitter->SetPhotonCount(2000);
  caustic.marcher->Update();
  TakesLightAroundPoints<vtkLightPropagationMaps>(claims, caustic, "maps");
  TakesLightAroundPoints<vtkDiscreteOrdinates>(claims, caustic, "ordinates");
  TakesLightAroundPoints<vtkLatticeBoltzmannLighting>(claims, caustic, "lattice");

  vtkNew<vtkRefractionOctree> octree;
  octree->SetInputDataObject(caustic.medium);
  octree->Update();
  auto* const levels = vtkImageData::SafeDownCast(octree->GetOutputDataObject(0));
  caustic.marcher->SetOctreeData(levels);
  const double wanted = SumOfFluence(claims, caustic.marcher.Get(), "octree");
  caustic.marcher->SetOctreeData(AsPoints(levels));
  claims.Near(SumOfFluence(claims, caustic.marcher.Get(), "octree of points") / wanted, 1.0, 1e-6, "levels of points");

  vtkNew<vtkImageData> between; // a level at each point of the medium, of which cells are read
  between->CopyStructure(caustic.medium);
  test::AddValues<vtkFloatArray>(
    between->GetPointData(), "octree_level", between->GetNumberOfPoints(), 1, [](vtkIdType, int) { return 0.0; });
  caustic.marcher->SetOctreeData(between);
  claims.That(SumOfFluence(claims, caustic.marcher.Get(), "octree between") > 0.0, "levels are averaged to the cells");
}

int TestUncollidedLight(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    ScattersACaustic<vtkLightPropagationMaps>(claims, "maps");
    ScattersACaustic<vtkDiscreteOrdinates>(claims, "ordinates");
    RefusesOtherVoxels<vtkLightPropagationMaps>(claims, "maps");
    RefusesOtherVoxels<vtkDiscreteOrdinates>(claims, "ordinates");
    SecondImagesAreAroundPoints(claims);
  });
}
