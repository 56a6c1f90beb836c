#include "MediumScene.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkLightRig.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
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

void ScatteredPhotonsGoOn(test::Claims& claims)
{
  Pipeline pipeline(
    test::MakeMedium({ { 4, 5, 6 }, { 0.5, 0.5, 0.5 }, { -1.0, -1.0, 3.0 }, { 0, 2, 0 } }, 0.1, 1.5), 20000);
  pipeline.marcher->Update();
  const double entered = pipeline.Fact("energy_balance", 0);
  claims.That(!pipeline.Light()->GetCellData()->GetArray("fluence_error"), "uncollided light has no randomness");
  vtkNew<vtkFloatArray> uncollided;
  uncollided->DeepCopy(pipeline.Light()->GetCellData()->GetArray("fluence"));
  pipeline.marcher->SetMaximumOrders(0);
  pipeline.marcher->Update();
  vtkCellData* cells = pipeline.Light()->GetCellData();
  vtkDataArray *all = cells->GetArray("fluence"), *direct = cells->GetArray("fluence_direct"),
               *error = cells->GetArray("fluence_error");
  if (!claims.That(all && direct && error, "fluence, its unscattered part and its error"))
  {
    return;
  }
  double more = 0.0, errors = 0.0;
  for (vtkIdType i = 0; i < all->GetNumberOfTuples(); ++i)
  {
    claims.Near(direct->GetComponent(i, 0), uncollided->GetComponent(i, 0), 1e-5, "uncollided light");
    more += all->GetComponent(i, 0) - direct->GetComponent(i, 0);
    errors += error->GetComponent(i, 0) / all->GetComponent(i, 0);
  }
  claims.That(more > 10.0, "scattered light is there");
  claims.That(errors / 120.0 > 1e-3 && errors / 120.0 < 0.1, "and some percent uncertain");
  claims.Near(pipeline.Fact("energy_balance", 0), entered, 1e-5 * entered, "power that entered");
  claims.That(pipeline.marcher->GetBalanceError() < 1e-6, "balance");
  claims.That(pipeline.marcher->GetScatterings() > 20000, "scatterings");
  const double escaped = pipeline.Fact("energy_balance", 3);
  pipeline.marcher->Modified();
  pipeline.marcher->Update();
  claims.That(pipeline.Fact("energy_balance", 3) == escaped, "the same seed, the same light");
  pipeline.marcher->SetSeed(2);
  pipeline.marcher->Update();
  claims.That(pipeline.Fact("energy_balance", 3) != escaped, "another seed, another light");
  pipeline.marcher->SetMaximumOrders(2);
  pipeline.marcher->Update();
  claims.That(pipeline.Fact("energy_balance", 4) > 0.1, "photons of few orders are left over");
  test::Errors complaints(pipeline.marcher);
  pipeline.marcher->SetScheme(vtkPhotonMarcher::PUBLISHED);
  pipeline.marcher->Update();
  claims.That(complaints.WasOneWith("MaximumOrders"), "the published scheme knows one order");
}

void WhatIsNotNeededCanBeComputedAllTheSame(test::Claims& claims)
{
  Pipeline pipeline(test::MakeMedium({ { 4, 4, 8 }, { 0.5, 0.5, 0.5 }, { -1.0, -1.0, 3.0 }, { 0, 2, 0 } }, 0.1, 0.5));
  const auto says = [&](const char* word) {
    return std::string(pipeline.marcher->GetLeftOut()).find(word) != std::string::npos;
  };
  pipeline.marcher->Update();
  const double less = pipeline.Fact("energy_balance", 2);
  claims.That(says("refraction:") && says("colour:"), "a constant index and colours are left out");
  pipeline.marcher->LeaveOutOff();
  pipeline.marcher->Update();
  claims.That(!pipeline.marcher->GetMediumKept(), "the medium is prepared anew");
  claims.That(!says("refraction:") && !says("colour:"), "and are not, where all is to be computed");
  claims.Near(pipeline.Fact("energy_balance", 2) / less, 1.0, 1e-6, "the same light");
}

void GlassBendsTheLight(test::Claims& claims)
{
  auto medium = test::MakeMedium({ { 24, 24, 24 } }, 0.0, 0.01);
  test::AddValues<vtkDoubleArray>(medium->GetCellData(), "ior", medium->GetNumberOfCells(), 1, [](vtkIdType i, int) {
    const double r = std::hypot(i % 24 - 11.5, i / 24 % 24 - 11.5, i / 576 - 11.5);
    return 1.0 + 0.25 * std::erfc((r - 7.0) / 2.0);
  });
  Pipeline pipeline(medium, 24 * 24 * 9);
  for (int scheme : { vtkPhotonMarcher::PUBLISHED, vtkPhotonMarcher::CONSERVATIVE })
  {
    pipeline.marcher->SetScheme(scheme);
    pipeline.marcher->SetPathCount(2);
    pipeline.marcher->Update();
    vtkDataArray* fluence = pipeline.Light()->GetCellData()->GetArray("fluence");
    claims.That(fluence->GetComponent((2 * 24 + 11) * 24 + 11, 0) > 1.5, "below the ball light is gathered");
    claims.That(fluence->GetComponent((2 * 24 + 11) * 24 + 4, 0) < 0.8, "round that it is missing");
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

/// One photon across the volume's diagonal: each voxel gets all of its power, though its way through them is longer.
void PackingLossIsToldApart(test::Claims& claims)
{
  const auto medium = test::MakeMedium({ { 16, 16, 16 } }, 0.1, 0.0);
  vtkNew<vtkPoints> start;
  start->InsertNextPoint(0.0, 0.0, 0.0);
  vtkNew<vtkPolyData> photons;
  photons->SetPoints(start);
  test::AddValues<vtkFloatArray>(photons->GetPointData(), "direction", 1, 3, [](vtkIdType, int) { return 1.0; });
  test::AddValues<vtkFloatArray>(photons->GetPointData(), "power", 1, 1, [](vtkIdType, int) { return 1.0; });
  vtkNew<vtkPhotonMarcher> marcher;
  marcher->SetInputDataObject(medium);
  marcher->SetPhotonsData(photons);
  marcher->SetScheme(vtkPhotonMarcher::PUBLISHED);
  marcher->Update();
  auto* light = vtkImageData::SafeDownCast(marcher->GetOutputDataObject(0));
  vtkDataArray* loss = light->GetFieldData()->GetArray("packing_loss");
  if (claims.That(loss && loss->GetNumberOfValues() == 1, "packing_loss is a number"))
  {
    claims.Near(loss->GetComponent(0, 0), marcher->GetPackingLoss(), 0.0, "PackingLoss is it");
  }
  claims.That(std::abs(marcher->GetPackingLoss()) < 0.02, "a photon alone loses what rounding to 8 bits takes");
  claims.That(marcher->GetBalanceError() > 0.1, "the balance shows that power is no path");

  // The light of many at one place does not fit into 8 bits of each.
  photons->GetPointData()->Initialize();
  start->SetNumberOfPoints(20000);
  for (vtkIdType i = 0; i < 20000; ++i)
  {
    start->SetPoint(i, 0.0, 8.5, 8.5);
  }
  start->Modified();
  test::AddValues<vtkFloatArray>(
    photons->GetPointData(), "direction", 20000, 3, [](vtkIdType, int c) { return c == 0 ? 1.0 : 0.0; });
  test::AddValues<vtkFloatArray>(photons->GetPointData(), "power", 20000, 1, [](vtkIdType, int) { return 1e-4; });
  photons->Modified();
  marcher->Update();
  claims.That(marcher->GetPackingLoss() > 0.2, "many photons at one place lose light");

  vtkNew<vtkImageData> marched;
  marched->ShallowCopy(light);
  marcher->SetScheme(vtkPhotonMarcher::CONSERVATIVE);
  marcher->SetInputDataObject(marched);
  marcher->Update();
  claims.That(!light->GetFieldData()->HasArray("packing_loss") && marcher->GetPackingLoss() == 0.0,
    "the conservative scheme has none, not even that of a march before");
}

/// Counts are of photons, weights their mean, and the light of batches is the light.
void CountsAndBatchesAddUp(test::Claims& claims)
{
  Pipeline pipeline(test::MakeMedium({ { 4, 4, 8 } }, 0.0, 0.1), 6400);
  pipeline.marcher->Update();
  vtkCellData* cells = pipeline.Light()->GetCellData();
  claims.That(!cells->HasArray("photon_count") && !cells->HasArray("photon_weight"), "nothing is counted unasked");
  claims.That(!cells->HasArray("fluence_batches"), "one batch has no light apart");
  pipeline.marcher->PhotonCountsOn();
  pipeline.emitter->SetBatches(4);
  pipeline.rig->SetSunPower(3.0, 2.0, 1.0);
  pipeline.marcher->Update();
  vtkDataArray* fluence = cells->GetArray("fluence");
  vtkDataArray* batches = cells->GetArray("fluence_batches");
  if (!claims.That(batches && batches->GetNumberOfComponents() == 12, "four batches of three channels"))
  {
    return;
  }
  for (vtkIdType voxel : { 0, 37, 127 })
  {
    for (int c = 0; c < 3; ++c)
    {
      double mean = 0.0;
      for (int batch = 0; batch < 4; ++batch)
      {
        mean += 0.25 * batches->GetComponent(voxel, 3 * batch + c);
      }
      claims.Near(mean / fluence->GetComponent(voxel, c), 1.0, 1e-5, "mean of the batches over fluence");
    }
    claims.Near(
      batches->GetComponent(voxel, 0) / batches->GetComponent(voxel, 2), 3.0, 1e-4, "a batch's red over its blue");
  }
  claims.Near(
    test::Deviation(pipeline.Light(), "photon_count", 400.0), 0.0, 12.0, "photons of a voxel, less a column's");
  claims.Near(test::Deviation(pipeline.Light(), "photon_weight", 1.0), 0.0, 1e-4, "their weight, less 1");

  vtkNew<vtkImageData> marched;
  marched->ShallowCopy(pipeline.Light());
  pipeline.marcher->SetInputDataObject(marched);
  pipeline.marcher->PhotonCountsOff();
  pipeline.marcher->SetScheme(vtkPhotonMarcher::PUBLISHED);
  pipeline.marcher->Update();
  cells = pipeline.Light()->GetCellData();
  claims.That(cells->HasArray("fluence") && !cells->HasArray("photon_count") && !cells->HasArray("photon_weight") &&
      !cells->HasArray("fluence_batches"),
    "the published scheme keeps neither, not even of a march before");
}

void TrappedLightIsAWarning(test::Claims& claims)
{
  auto medium = test::MakeMedium({ { 24, 24, 24 } }, 0.0, 0.0);
  test::AddValues<vtkDoubleArray>(medium->GetCellData(), "ior", medium->GetNumberOfCells(), 1, [](vtkIdType i, int) {
    const double r = std::hypot(i % 24 - 11.5, i / 24 % 24 - 11.5, i / 576 - 11.5);
    return 1.0 + 1.5 * std::erfc((r - 7.0) / 2.0);
  });
  Pipeline pipeline(medium, 1000);
  pipeline.rig->SunOff();
  pipeline.rig->AddPointLight(16.0, 12.0, 12.0, 1.0, 1.0, 1.0);
  test::Errors errors(pipeline.marcher);
  pipeline.marcher->Update();
  claims.That(pipeline.Fact("energy_balance", 4) > 0.01 * pipeline.Fact("energy_balance", 0), "light is trapped");
  claims.That(errors.WasOneWith("% of the power that entered"), "trapped light is warned of");
  claims.That(pipeline.Light()->GetNumberOfCells() > 0, "there is light all the same");
}

/// A cloudlet in a corner of a box of 4 x 4 x 4 bricks: light of empty space is by voxel, as a file says, or by brick.
void EmptySpaceIsKeptAsAskedFor(test::Claims& claims)
{
  vtkSmartPointer<vtkImageData> medium = test::MakeMedium({ { 32, 32, 32 }, { 0.1, 0.1, 0.1 } }, 0.0, 0.0);
  medium->GetCellData()->GetArray("sigma_s")->SetComponent(33 * 32 + 1, 0, 5.0);
  Pipeline pipeline(medium);
  pipeline.rig->SetSunElevation(55.0);
  const auto deposits = [&](int emptySpace) {
    pipeline.marcher->SetEmptySpace(emptySpace);
    pipeline.marcher->Update();
    return pipeline.marcher->GetDeposits();
  };
  const auto said = [&] {
    return std::string(pipeline.marcher->GetLeftOut()).find("light voxel by voxel in empty space") != std::string::npos;
  };
  const vtkIdType byVoxel = deposits(vtkPhotonMarcher::BY_VOXEL);
  claims.That(!said() && byVoxel > 6400 * 20, "light voxel by voxel");
  const vtkIdType byBrick = deposits(vtkPhotonMarcher::BY_BRICK);
  claims.That(said() && 2 * byBrick < byVoxel, "light by brick");
  claims.That(pipeline.marcher->GetBalanceError() < 1e-6, "the balance by brick");
  vtkDataArray* fluence = pipeline.Light()->GetCellData()->GetArray("fluence");
  claims.That(fluence->GetComponent(16 * 1024 + 16 * 32 + 16, 0) == fluence->GetComponent(23 * 1024 + 23 * 32 + 23, 0),
    "one light in a brick");
  claims.That(deposits(vtkPhotonMarcher::AS_READ) == byVoxel && !said(), "nothing says that the medium is sparse");
  for (const double active : { 0.24, 0.26 })
  {
    test::AddValues<vtkDoubleArray>(
      medium->GetFieldData(), "active_part", 1, 1, [&](vtkIdType, int) { return active; });
    medium->Modified();
    claims.That(
      (deposits(vtkPhotonMarcher::AS_READ) == byBrick) == (active < 0.25), "a file of which a part is active");
  }
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

  const auto octreeRefused = [&](const test::Box& box, const char* part) {
    const auto octree = test::MakeImage(box);
    test::AddCells<vtkUnsignedCharArray>(octree, "octree_level", 0.0);
    pipeline.marcher->SetOctreeData(octree);
    pipeline.marcher->Update();
    claims.That(errors.WasOneWith(part), std::string("an octree of something else: ") + part);
  };
  octreeRefused({ { 2, 2, 2 } }, "The octree has 2 x 2 x 2 voxels");
  octreeRefused({ { 4, 4, 4 }, { 2.0, 2.0, 2.0 } }, "spacing (2, 2, 2)");
  octreeRefused({ { 4, 4, 4 }, { 1.0, 1.0, 1.0 }, { 50.0, 0.0, 0.0 } }, "origin (50, 0, 0)");
  octreeRefused({ { 4, 4, 4 }, { 1.0, 1.0, 1.0 }, { 50.0, 0.0, 0.0 } },
    "the medium 4 x 4 x 4 voxels of spacing (1, 1, 1) from origin (0, 0, 0)");
  const auto same = test::MakeImage({ { 4, 4, 4 }, { 1.0, 1.0, 1.0 }, { -2.0, 0.0, 0.0 }, { 2, 0, 0 } });
  test::AddCells<vtkUnsignedCharArray>(same, "octree_level", 0.0);
  pipeline.marcher->SetOctreeData(same);
  pipeline.marcher->Update();
  claims.That(errors.None(), "the same grid by another extent is taken");
  pipeline.marcher->RemoveOctree();

  pipeline.marcher->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "foo");
  pipeline.marcher->Update();
  claims.That(errors.WasOneWith("no array 'foo'"), "an index that is not there");
  pipeline.marcher->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "ior");
  vtkNew<vtkStringArray> text;
  text->SetName("ior");
  text->SetNumberOfValues(64);
  medium->GetCellData()->AddArray(text);
  medium->Modified();
  pipeline.marcher->Update();
  claims.That(errors.WasOneWith("'ior' is text"), "an index of text");

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

/// Photons by hand: what is shorter than its points is one error, and memory behind it is not read.
void ShortArraysAreRefused(test::Claims& claims)
{
  Pipeline pipeline(test::MakeMedium({ { 4, 4, 4 } }, 0.1, 0.5), 100);
  test::Errors errors(pipeline.marcher);
  const auto refused = [&](const char* name, const std::string& part, const auto& change) {
    vtkNew<vtkPolyData> photons;
    pipeline.emitter->Update();
    photons->DeepCopy(pipeline.emitter->GetOutputDataObject(0));
    change(photons.Get(), photons->GetPointData()->GetArray(name));
    pipeline.marcher->SetPhotonsData(photons);
    pipeline.marcher->Update();
    claims.That(errors.WasOneWith(part), std::string("photons are refused: ") + part);
    claims.That(pipeline.Light()->GetNumberOfCells() == 0, std::string("and there is no light: ") + part);
  };
  for (const char* name : { "direction", "power", "weight", "batch", "light" })
  {
    refused(name, "'" + std::string(name) + "' has 99 values where the dataset has 100 points",
      [](vtkPolyData*, vtkDataArray* array) { array->Resize(99); });
    refused(name, "'" + std::string(name) + "' has 101 values where the dataset has 100 points",
      [](vtkPolyData*, vtkDataArray* array) { array->SetNumberOfTuples(101); });
  }
  refused("batch", "'mass' has 3 values where the dataset has 100 cells", [](vtkPolyData* photons, vtkDataArray*) {
    test::AddValues<vtkFloatArray>(photons->GetCellData(), "mass", 3, 1, [](vtkIdType, int) { return 1.0; });
  });
  refused("batch", "'photon_box' has 5 values", [](vtkPolyData* photons, vtkDataArray*) {
    test::AddValues<vtkFloatArray>(photons->GetFieldData(), "photon_box", 5, 1, [](vtkIdType, int) { return 1.0; });
  });
}
}

int TestPhotonMarcher(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    ABeamFallsOffAndItsPowerIsKept(claims);
    ScatteredPhotonsGoOn(claims);
    WhatIsNotNeededCanBeComputedAllTheSame(claims);
    GlassBendsTheLight(claims);
    PackingLossIsToldApart(claims);
    CountsAndBatchesAddUp(claims);
    TrappedLightIsAWarning(claims);
    EmptySpaceIsKeptAsAskedFor(claims);
    BadInputIsOneError(claims);
    ShortArraysAreRefused(claims);
  });
}
