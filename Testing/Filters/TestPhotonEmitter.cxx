#include "MediumScene.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIntArray.h"
#include "vtkLightRig.h"
#include "vtkPhotonEmitter.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <cmath>
#include <fstream>
#include <sys/resource.h>
#include <unistd.h>

namespace
{
double Total(vtkPolyData* photons, int channel)
{
  vtkDataArray* power = photons->GetPointData()->GetArray("power");
  double sum = 0.0;
  for (vtkIdType i = 0; power && i < power->GetNumberOfTuples(); ++i)
  {
    sum += power->GetComponent(i, channel);
  }
  return sum;
}

void ASunGivesItsPhotons(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  rig->SetSunElevation(90.0);
  rig->SetSunPower(4.0, 2.0, 1.0);
  for (int sampler = vtkPhotonEmitter::HAMMERSLEY; sampler <= vtkPhotonEmitter::RANDOM; ++sampler)
  {
    vtkNew<vtkPhotonEmitter> emitter;
    // An extent that starts elsewhere: the box is (2, 0, 0) to (6, 4, 4).
    emitter->SetInputDataObject(test::MakeImage({ { 4, 4, 4 }, { 1.0, 1.0, 1.0 }, { 0.0, 0.0, 0.0 }, { 2, 0, 0 } }));
    emitter->SetLightsConnection(rig->GetOutputPort());
    emitter->SetPhotonCount(1000);
    emitter->SetSampler(sampler);
    emitter->Update();
    vtkPolyData* photons = emitter->GetOutput();
    claims.That(photons->GetNumberOfPoints() == 1000 && photons->GetNumberOfVerts() == 1000, "a thousand photons");
    claims.Near(Total(photons, 0), 4.0 * 16.0, 1e-3, "red power of the sun on the box");
    claims.Near(Total(photons, 2), 1.0 * 16.0, 1e-3, "blue power of the sun on the box");
    claims.Near(emitter->GetPower()[0], 4.0 * 16.0, 1e-2, "red power on the panel");
    claims.Near(emitter->GetPower()[2], 1.0 * 16.0, 1e-2, "blue power on the panel");
    claims.That(photons->GetPointData()->GetVectors() != nullptr, "directions are the active vectors");
    const double* bounds = photons->GetBounds();
    claims.That(bounds[0] >= 2.0 && bounds[1] <= 6.0 && bounds[2] >= 0.0 && bounds[3] <= 4.0, "they are on the box");
    claims.Near(bounds[4], 4.0, 1e-9, "they are on its top");
    claims.Near(photons->GetPointData()->GetArray("weight")->GetComponent(0, 0), 1.0, 0.0, "weight");
    claims.Near(photons->GetPointData()->GetArray("light")->GetComponent(0, 0), 0.0, 0.0, "number of the light");
  }
}

void WhatMissesTheVolumeIsLeftOut(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  rig->SetSun(false);
  rig->AddSpotLight(2.0, 2.0, 9.0, 0.5, 0.0, -1.0, 1.0, 1.0, 1.0, 40.0); // half of its cone passes the box
  rig->AddSpotLight(2.0, 2.0, 9.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 40.0);  // shines away from the box
  vtkNew<vtkPhotonEmitter> emitter;
  emitter->SetInputDataObject(test::MakeImage({}));
  emitter->SetLightsConnection(rig->GetOutputPort());
  emitter->Update();
  const std::string leftOut = emitter->GetLeftOut();
  claims.That(leftOut.find("of the samples would miss it") != std::string::npos, "samples beside the box: " + leftOut);
  claims.That(leftOut.find("1 of 2 does not reach it") != std::string::npos, "the lamp that shines away: " + leftOut);
  claims.That(emitter->GetOutput()->GetFieldData()->GetAbstractArray("left_out") != nullptr, "in field data, too");
  rig->RemoveAllSpotLights();
  rig->SetSun(true);
  emitter->Update();
  claims.That(std::string(emitter->GetLeftOut()).empty(), "all photons of a sun meet the box");
}

void ASkyGivesPhotonsFromEverywhere(test::Claims& claims)
{
  vtkNew<vtkPhotonEmitter> emitter;
  emitter->SetInputDataObject(test::MakeImage({}));
  emitter->SetSkyColor(1.0, 1.0, 1.0);
  emitter->SetPhotonCount(5000);
  emitter->Update();
  claims.Near(Total(emitter->GetOutput(), 1) / (std::acos(-1.0) * 96.0), 1.0, 5e-3, "power of the sky");
}

/// A map of two halves of the outline's square, one three times as dense as the other, that belongs to a light.
vtkSmartPointer<vtkImageData> TwoHalves(int light)
{
  auto map = test::MakeImage({ { 8, 8, 1 } });
  test::AddValues<vtkFloatArray>(
    map->GetCellData(), "importance", 64, 1, [](vtkIdType i, int) { return i % 8 < 4 ? 1.5 : 0.5; });
  test::AddValues<vtkIntArray>(map->GetFieldData(), "light", 1, 1, [=](vtkIdType, int) { return light; });
  return map;
}

void AMapMakesPhotonsDense(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  rig->SetSunElevation(90.0);
  vtkNew<vtkPhotonEmitter> emitter;
  test::Errors errors(emitter);
  emitter->SetInputDataObject(test::MakeImage({}));
  emitter->SetLightsConnection(rig->GetOutputPort());
  emitter->SetPhotonCount(8000);
  emitter->SetImportanceMapData(TwoHalves(0));
  emitter->Update();
  vtkPointData* data = emitter->GetOutput()->GetPointData();
  vtkDataArray* weight = data->GetArray("weight");
  vtkDataArray* batch = data->GetArray("batch");
  if (!claims.That(errors.None() && weight && batch && weight->GetNumberOfTuples() == 8000, "photons of a map"))
  {
    return;
  }
  claims.Near(Total(emitter->GetOutput(), 0), 16.0, 1e-3, "power of the sun, all the same");
  claims.Near(emitter->GetPower()[1], 16.0, 1e-2, "power on the panel is that of a channel");
  vtkIdType dense = 0, first = 0;
  double product = 0.0;
  for (vtkIdType i = 0; i < 8000; ++i)
  {
    dense += weight->GetComponent(i, 0) < 1.0;
    first += batch->GetComponent(i, 0) == 0.0;
    product = std::max(product,
      std::abs(data->GetArray("power")->GetComponent(i, 0) / weight->GetComponent(i, 0) * 8000.0 / 16.0 - 1.0));
  }
  claims.Near(dense / 8000.0, 0.75, 2e-3, "part of the photons in the denser half");
  claims.Near(first, 4000.0, 0.0, "photons of the first of two batches");
  claims.Near(product, 0.0, 1e-4, "power over weight is that of photons spread evenly");
  claims.Near(weight->GetRange()[0], 1.0 / 1.5, 1e-5, "weight where photons are dense");
  claims.Near(weight->GetRange()[1], 2.0, 1e-5, "weight where they are sparse");

  emitter->SetMaximumDensity(1.0);
  emitter->Update();
  claims.Near(data->GetArray("weight")->GetRange()[1], 1.0, 1e-5, "no density above 1: photons are spread evenly");
  emitter->SetMaximumDensity(8.0);
  emitter->SetBatches(16);
  emitter->Update();
  claims.Near(data->GetArray("batch")->GetRange()[1], 15.0, 0.0, "the last of sixteen batches");
  emitter->SetBatches(0);
  emitter->RemoveImportanceMap();
  emitter->Update();
  claims.Near(data->GetArray("batch")->GetRange()[1], 0.0, 0.0, "one batch without a map");
  claims.Near(data->GetArray("weight")->GetRange()[1], 1.0, 0.0, "weight of photons spread evenly");

  emitter->SetSkyColor(1.0, 1.0, 1.0);
  emitter->SetImportanceMapData(TwoHalves(-1));
  emitter->Update();
  double heaviest = 0.0;
  for (vtkIdType i = 0; i < data->GetArray("weight")->GetNumberOfTuples(); ++i)
  {
    const bool sun = data->GetArray("light")->GetComponent(i, 0) == 0.0;
    heaviest = std::max(heaviest, sun ? data->GetArray("weight")->GetComponent(i, 0) : 0.0);
  }
  claims.Near(heaviest, 1.0, 0.0, "a map of the sky leaves the sun alone");
}

void NothingShinesIsAWarning(test::Claims& claims)
{
  vtkNew<vtkPhotonEmitter> emitter;
  test::Errors errors(emitter);
  emitter->SetInputDataObject(test::MakeImage({}));
  emitter->Update();
  claims.That(errors.WasOneWith("Nothing shines"), "a warning where nothing shines");
  claims.That(emitter->GetOutput()->GetNumberOfPoints() == 0, "no photons");
}

void BadInputIsOneError(test::Claims& claims)
{
  vtkNew<vtkPhotonEmitter> emitter;
  test::Errors errors(emitter);
  emitter->SetInputDataObject(test::MakeImage({ { 4, 0, 4 } }));
  emitter->SetSkyColor(1.0, 1.0, 1.0);
  emitter->Update();
  claims.That(errors.WasOneWith("single layer of points along y"), "an image without voxels");
  emitter->SetInputDataObject(test::MakeImage({}));
  emitter->SetSkyColor(-1.0, 1.0, 1.0);
  emitter->Update();
  claims.That(errors.WasOneWith("SkyColor is (-1, 1, 1)"), "a negative sky");
  emitter->SetSkyColor(1.0, 1.0, 1.0);
  for (vtkIdType count : { vtkIdType(1) << 62, vtkIdType(1) << 44 })
  {
    emitter->SetPhotonCount(count);
    emitter->Update();
    claims.That(errors.WasOneWith("Ask for fewer photons (PhotonCount)"), "more photons than there is memory");
  }
}

#ifndef __SANITIZE_ADDRESS__ // which ends the program where memory does
void MemoryThatEndsIsAnError(test::Claims& claims)
{
  vtkNew<vtkPhotonEmitter> emitter;
  test::Errors errors(emitter);
  emitter->SetInputDataObject(test::MakeImage({}));
  emitter->SetSkyColor(1.0, 1.0, 1.0);
  emitter->SetPhotonCount(10'000'000);
  long pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  rlimit before;
  getrlimit(RLIMIT_AS, &before);
  const rlimit little = { static_cast<rlim_t>(pages * sysconf(_SC_PAGESIZE) + (64 << 20)), before.rlim_max };
  setrlimit(RLIMIT_AS, &little);
  emitter->Update();
  setrlimit(RLIMIT_AS, &before);
  claims.That(errors.WasOneWith("memory does not suffice. Ask for less: fewer photons"), "memory that ends");
  claims.That(emitter->GetOutput()->GetNumberOfPoints() == 0, "and no photons");
}
#endif
}

int TestPhotonEmitter(int, char*[])
{
  test::Claims claims;
  ASunGivesItsPhotons(claims);
  WhatMissesTheVolumeIsLeftOut(claims);
  ASkyGivesPhotonsFromEverywhere(claims);
  AMapMakesPhotonsDense(claims);
  NothingShinesIsAWarning(claims);
  BadInputIsOneError(claims);
#ifndef __SANITIZE_ADDRESS__
  MemoryThatEndsIsAnError(claims);
#endif
  return claims.Result();
}
