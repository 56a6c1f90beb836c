#include "MediumScene.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkLightRig.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>

namespace
{
/// A sun from above on a medium, its photons, and what they leave.
struct Pipeline
{
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkPhotonEmitter> emitter;
  vtkNew<vtkPhotonMarcher> marcher;

  explicit Pipeline(vtkImageData* medium, vtkIdType photons = 6400)
  {
    this->rig->SetSunElevation(90.0);
    this->emitter->SetInputDataObject(medium);
    this->emitter->SetLightsConnection(this->rig->GetOutputPort());
    this->emitter->SetPhotonCount(photons);
    this->emitter->SetSampler(vtkPhotonEmitter::GRID);
    this->marcher->SetInputDataObject(medium);
    this->marcher->SetPhotonsConnection(this->emitter->GetOutputPort());
  }

  vtkImageData* Light() { return vtkImageData::SafeDownCast(this->marcher->GetOutputDataObject(0)); }
  vtkPolyData* Paths() { return vtkPolyData::SafeDownCast(this->marcher->GetOutputDataObject(1)); }
  double Fact(const char* name, int i)
  {
    vtkDataArray* fact = this->Light()->GetFieldData()->GetArray(name);
    return fact ? fact->GetComponent(i, 0) : std::nan("");
  }
};

void ABeamFallsOffAndItsPowerIsKept(test::Claims& claims)
{
  Pipeline pipeline(test::MakeMedium({ { 4, 4, 8 }, { 0.5, 0.5, 0.5 }, { -1.0, -1.0, 3.0 }, { 0, 2, 0 } }, 0.1, 0.5));
  pipeline.marcher->SetPathCount(3);
  pipeline.marcher->Update();
  vtkDataArray* fluence = pipeline.Light()->GetCellData()->GetArray("fluence");
  if (!claims.That(fluence && fluence->GetNumberOfComponents() == 1, "fluence of a grey scene"))
  {
    return;
  }
  const double tau = 0.6 * 0.5;
  for (int k = 0; k < 8; ++k)
  {
    const double exact = std::exp(-tau * (7 - k)) * -std::expm1(-tau) / tau;
    claims.Near(fluence->GetComponent(16 * k + 5, 0), exact, 1e-5, "fluence of a beam");
  }
  claims.Near(test::Deviation(pipeline.Light(), "fluence_direct", 0.5),
    test::Deviation(pipeline.Light(), "fluence", 0.5), 0.0, "all of it is direct");
  claims.Near(
    pipeline.Light()->GetCellData()->GetArray("mean_direction")->GetComponent(5, 2), -1.0, 1e-5, "it goes down");
  claims.Near(pipeline.Fact("energy_balance", 0), 4.0, 1e-4, "power that entered");
  claims.Near(pipeline.Fact("face_power_out", 4), 4.0 * std::exp(-8.0 * tau), 1e-4, "power that left below");
  claims.Near(pipeline.Fact("scattered", 0), pipeline.Fact("energy_balance", 2) * 5.0 / 6.0, 1e-4, "power scattered");
  claims.That(pipeline.marcher->GetBalanceError() < 1e-6, "balance");
  claims.That(pipeline.Paths()->GetNumberOfLines() == 3, "three paths");
  claims.Near(pipeline.Paths()->GetBounds()[4], 3.0, 1e-5, "paths go through the box");
  vtkDataArray* left = pipeline.Paths()->GetPointData()->GetArray("power_left");
  claims.Near(left->GetComponent(1, 0), std::exp(-8.0 * tau), 1e-5, "what is left at a path's end");
}

void GlassBendsTheLight(test::Claims& claims)
{
  auto medium = test::MakeMedium({ { 24, 24, 24 } }, 0.0, 0.01);
  test::AddValues<vtkDoubleArray>(medium->GetCellData(), "ior", medium->GetNumberOfCells(), 1, [](vtkIdType i, int) {
    const double r = std::hypot(i % 24 - 11.5, i / 24 % 24 - 11.5, i / 576 - 11.5);
    return 1.0 + 0.25 * std::erfc((r - 7.0) / 2.0);
  });
  Pipeline pipeline(medium, 24 * 24 * 9);
  for (int scheme : { vtkPhotonMarcher::PUBLISHED, vtkPhotonMarcher::SOUND })
  {
    pipeline.marcher->SetScheme(scheme);
    pipeline.marcher->SetPathCount(2);
    pipeline.marcher->Update();
    vtkDataArray* fluence = pipeline.Light()->GetCellData()->GetArray("fluence");
    claims.That(fluence->GetComponent((2 * 24 + 11) * 24 + 11, 0) > 1.5, "below the ball light is gathered");
    claims.That(fluence->GetComponent((2 * 24 + 11) * 24 + 6, 0) < 0.8, "round that it is missing");
    claims.That(pipeline.Paths()->GetNumberOfLines() == 2, "two paths");
  }
  vtkCellData* cells = pipeline.Light()->GetCellData();
  claims.That(cells->GetArray("ior") && cells->GetArray("ior") == medium->GetCellData()->GetArray("ior"),
    "the index goes on to who looks at the light");
  const vtkIdType steps = pipeline.marcher->GetSteps();
  claims.That(pipeline.marcher->GetBalanceError() < 1e-6, "balance");

  vtkNew<vtkImageData> octree;
  octree->CopyStructure(medium);
  test::AddCells<vtkUnsignedCharArray>(octree, "octree_level", 1.0);
  pipeline.marcher->SetOctreeData(octree);
  pipeline.marcher->Update();
  claims.That(pipeline.marcher->GetSteps() < steps, "an octree saves steps");
}

void BadInputIsOneError(test::Claims& claims)
{
  auto medium = test::MakeMedium({}, 0.1, 0.1);
  Pipeline pipeline(medium, 100);
  test::Errors errors(pipeline.marcher);
  pipeline.marcher->SetIntegratorOrder(3);
  pipeline.marcher->Update();
  claims.That(errors.WasOneWith("there are 1, 2 and 4"), "an order that there is not");
  claims.That(pipeline.Light()->GetNumberOfCells() == 0, "and no light");
  pipeline.marcher->SetIntegratorOrder(2);

  vtkNew<vtkImageData> other;
  other->SetDimensions(3, 3, 3);
  pipeline.marcher->SetOctreeData(other);
  pipeline.marcher->Update();
  claims.That(errors.WasOneWith("another size"), "an octree of something else");
  pipeline.marcher->RemoveOctree();

  test::AddCells(medium, "ior", 0.0);
  medium->Modified();
  pipeline.marcher->Update();
  claims.That(errors.WasOneWith("a refractive index must be"), "an index of 0");
  medium->GetCellData()->RemoveArray("ior");

  vtkNew<vtkPolyData> points;
  vtkNew<vtkPoints> one;
  one->InsertNextPoint(1.0, 1.0, 1.0);
  points->SetPoints(one);
  pipeline.marcher->SetPhotonsData(points);
  pipeline.marcher->Update();
  claims.That(errors.WasOneWith("no point array 'direction'"), "points that are no photons");
}
}

int TestPhotonMarcher(int, char*[])
{
  if (!test::HasDevice())
  {
    return test::SkippedWithoutDevice("nothing was solved");
  }
  test::Claims claims;
  ABeamFallsOffAndItsPowerIsKept(claims);
  GlassBendsTheLight(claims);
  BadInputIsOneError(claims);
  return claims.Result();
}
