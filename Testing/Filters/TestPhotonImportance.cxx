#include "AdaptiveScene.h"

#include "vtkInformation.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{
using Pipeline = test::Adaptive;

std::vector<double> Values(vtkImageData* image, const char* name)
{
  vtkDataArray* array = image->GetCellData()->GetArray(name);
  std::vector<double> values;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    values.push_back(array->GetComponent(i, 0));
  }
  return values;
}

bool HasText(vtkDataObject* data, const char* fact, const char* part)
{
  auto* texts = vtkArrayDownCast<vtkStringArray>(data->GetFieldData()->GetAbstractArray(fact));
  bool found = false;
  for (vtkIdType i = 0; texts && i < texts->GetNumberOfValues(); ++i)
  {
    found = found || texts->GetValue(i).find(part) != std::string::npos;
  }
  return found;
}

void AMapHasALayerALight(test::Claims& claims)
{
  Pipeline scene(test::GlassBall());
  scene.rig->AddPointLight(50.0, 16.0, 16.0, 100.0, 90.0, 80.0);
  scene.importance->SetSkyColor(0.1, 0.1, 0.1);
  scene.importance->SetPilotCount(1050); // 32 x 32
  test::Errors errors(scene.importance);
  scene.importance->Update();
  claims.That(errors.None(), "no error");
  const int* size = scene.Map()->GetDimensions();
  claims.That(size[0] == 33 && size[1] == 33 && size[2] == 4, "a layer of 32 x 32 cells for each of three lights");
  const double* bounds = scene.Map()->GetBounds();
  claims.Near(bounds[1], 1.0, 1e-12, "the unit square's width");
  claims.Near(bounds[3], 1.0, 1e-12, "the unit square's height");
  claims.Near(bounds[5], 3.0, 1e-12, "a layer's height is 1");
  if (vtkDataArray* importance = test::FiniteCells(claims, scene.Map(), "importance", 1))
  {
    claims.That(scene.Map()->GetCellData()->GetScalars() == importance, "importance is the active array");
    for (int layer = 0; layer < 3; ++layer)
    {
      double sum = 0.0;
      for (int i = 0; i < 1024; ++i)
      {
        sum += importance->GetComponent(1024 * layer + i, 0) / 1024.0;
      }
      claims.Near(sum, 1.0, 1e-5, "mean importance of a light");
    }
    claims.That(importance->GetRange()[0] >= 0.29, "the background is everywhere");
    claims.That(importance->GetRange()[1] > 1.5, "somewhere photons are to be dense");
  }
  for (int layer = 0; layer < 3; ++layer)
  {
    claims.Near(test::Fact(scene.Map(), "light", layer), layer == 2 ? -1.0 : layer, 0.0, "number of a layer's light");
  }
  claims.Near(test::Fact(scene.Map(), "even"), 0.0, 0.0, "the light is not even");
  claims.That(!scene.importance->GetEven(), "nor on the panel");
  claims.That(scene.importance->GetUsedGradientThreshold() > 0.0, "the threshold that was used is told");
  claims.That(
    scene.importance->GetSeconds() > 0.0 && *scene.importance->GetDeviceName() != '\0', "and time and device");
}

void ThePilotLightIsThere(test::Claims& claims)
{
  auto medium = test::MakeMedium({ { 20, 12, 8 }, { 0.5, 1.0, 2.0 }, { -1.0, 3.0, 4.0 }, { 2, 0, 1 } }, 0.0, 0.01);
  test::AddValues<vtkDoubleArray>(medium->GetCellData(), "ior", medium->GetNumberOfCells(), 1,
    [](vtkIdType i, int) { return 1.0 + 0.02 * (i % 20); });
  Pipeline scene(medium);
  scene.importance->SetPilotDimensions(7, 16, 4);
  scene.importance->Update();
  vtkImageData* pilot = scene.Pilot();
  const int* size = pilot->GetDimensions();
  claims.That(size[0] == 8 && size[1] == 13 && size[2] == 5, "coarse cells, no more than there are voxels");
  for (int i = 0; i < 6; ++i)
  {
    claims.Near(pilot->GetBounds()[i], medium->GetBounds()[i], 1e-9, "a bound of the coarse cells' box");
  }
  test::FiniteCells(claims, pilot, "fluence", 1);
  if (vtkDataArray* count = test::FiniteCells(claims, pilot, "photon_count", 1))
  {
    for (vtkIdType i = 3 * 7 * 12; i < 4 * 7 * 12; ++i)
    {
      claims.That(count->GetComponent(i, 0) > 0.0, "a sun's pilot photons are in every cell at the top");
    }
  }
  vtkDataArray* mean = test::FiniteCells(claims, pilot, "origin_mean", 2);
  claims.That(mean && mean->GetRange(0)[0] >= 0.0 && mean->GetRange(0)[1] < 32.0, "origins are columns of the map");
  test::FiniteCells(claims, pilot, "origin_deviation", 2);
  test::FiniteCells(claims, pilot, "gradient", 1);
  vtkDataArray* chosen = test::FiniteCells(claims, pilot, "chosen", 1);
  claims.That(chosen && chosen->GetRange()[0] >= 0.0 && chosen->GetRange()[1] <= 1.0, "chosen or not");
  claims.That(pilot->GetFieldData()->HasArray("left_out") && pilot->GetFieldData()->HasArray("device"),
    "left_out and device of the pilot light");
}

void TheLightsPowerChangesNothing(test::Claims& claims)
{
  Pipeline scene(test::GlassBall());
  scene.importance->Update();
  const std::vector<double> map = Values(scene.Map(), "importance");
  const double threshold = scene.importance->GetUsedGradientThreshold();
  for (double factor : { 1e-6, 1e6 })
  {
    double power[3];
    scene.rig->GetSunPower(power);
    Pipeline other(test::GlassBall());
    other.rig->SetSunPower(factor * power[0], factor * power[1], factor * power[2]);
    other.importance->Update();
    const std::vector<double> found = Values(other.Map(), "importance");
    if (!claims.That(found.size() == map.size() && !map.empty(), "a map of another power"))
    {
      return;
    }
    double most = 0.0;
    for (std::size_t i = 0; i < map.size(); ++i)
    {
      most = std::max(most, std::abs(found[i] - map[i]));
    }
    claims.Near(most, 0.0, 1e-6, "change of the map with the light's power");
    claims.Near(
      other.importance->GetUsedGradientThreshold() / (factor * threshold), 1.0, 1e-4, "threshold of the power");
  }
}

void OwnThresholdsAreUsed(test::Claims& claims)
{
  Pipeline scene(test::GlassBall());
  scene.importance->SetThresholds(vtkPhotonImportance::OWN);
  scene.importance->SetGradientThreshold(1e30);
  scene.importance->SetLuminanceThreshold(0.0);
  scene.importance->Update();
  claims.Near(scene.importance->GetUsedGradientThreshold(), 1e30, 0.0, "own threshold");
  claims.Near(test::TotalCells(scene.Pilot(), "chosen"), 0.0, 0.0, "cells chosen by a threshold that none reaches");
  scene.importance->SetGradientThreshold(0.0);
  scene.importance->Update();
  claims.That(test::TotalCells(scene.Pilot(), "chosen") > 1000.0, "all lit cells are as steep as 0");
}

void EvenLightIsSaid(test::Claims& claims)
{
  Pipeline scene(test::MakeMedium({ { 16, 16, 16 } }, 0.0, 0.001));
  scene.importance->Update();
  claims.That(scene.importance->GetEven(), "the light of a sun in thin fog is even");
  claims.Near(test::Fact(scene.Map(), "even"), 1.0, 0.0, "even in the map");
  claims.Near(test::Deviation(scene.Map(), "importance", 1.0), 0.0, 1e-6, "importance of even light, less 1");
  claims.That(HasText(scene.Map(), "left_out", "even"), "left_out says so");
  claims.That(std::string(scene.importance->GetLeftOut()).find("even") != std::string::npos, "and the panel");

  scene.emitter->Update();
  vtkNew<vtkPhotonEmitter> evenly;
  evenly->SetInputConnection(scene.emitter->GetInputConnection(0, 0));
  evenly->SetLightsConnection(scene.rig->GetOutputPort());
  evenly->SetPhotonCount(20000);
  evenly->SetBatches(2);
  evenly->Update();
  bool same = evenly->GetOutput()->GetNumberOfPoints() == scene.Photons()->GetNumberOfPoints();
  for (vtkIdType i = 0; same && i < 20000; i += 17)
  {
    double a[3], b[3];
    evenly->GetOutput()->GetPoint(i, a);
    scene.Photons()->GetPoint(i, b);
    same = a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
  }
  claims.That(same, "an even map leaves photons where they are");
}

void WhatIsNotNeededCanBeComputedAllTheSame(test::Claims& claims)
{
  Pipeline scene(test::MakeMedium({ { 16, 16, 16 } }, 0.0, 0.05));
  scene.importance->SetThresholds(vtkPhotonImportance::OWN);
  scene.importance->SetGradientThreshold(1e30);
  scene.importance->Update();
  const std::vector<double> first = Values(scene.Pilot(), "fluence");
  scene.importance->SetLuminanceThreshold(0.7 * *std::max_element(first.begin(), first.end()));
  const auto says = [&](const char* text) {
    return std::string(scene.importance->GetLeftOut()).find(text) != std::string::npos;
  };
  scene.importance->Update();
  const std::vector<double> map = Values(scene.Map(), "importance"), light = Values(scene.Pilot(), "fluence");
  claims.That(says("refraction:") && says("absorption:"), "pilot photons leave out refraction and absorption");
  claims.That(!scene.importance->GetEven(), "dark cells are in the map");
  scene.importance->LeaveOutOff();
  scene.importance->Update();
  claims.That(!says("refraction:") && !says("absorption:"), "and do not, where all is to be computed");
  const auto farthest = [](const std::vector<double>& a, const std::vector<double>& b) {
    double most = a.size() == b.size() ? 0.0 : 1e30, largest = 0.0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    {
      most = std::max(most, std::abs(a[i] - b[i]));
      largest = std::max(largest, std::abs(b[i]));
    }
    return most / largest;
  };
  claims.Near(farthest(Values(scene.Pilot(), "fluence"), light), 0.0, 1e-5, "difference of the pilot light");
  claims.Near(farthest(Values(scene.Map(), "importance"), map), 0.0, 1e-5, "difference of the map");
}

void AnotherNumberOfLightsIsFollowed(test::Claims& claims)
{
  Pipeline scene(test::GlassBall(16));
  const auto layersAre = [&](int count, const std::string& when) {
    scene.emitter->Update();
    claims.Near(scene.Map()->GetDimensions()[2], count + 1, 0.0, "layers " + when);
    int whole[6];
    scene.importance->GetOutputInformation(0)->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole);
    claims.Near(whole[5], count, 0.0, "layers that the pipeline knows of " + when);
    claims.That(scene.Photons()->GetNumberOfPoints() > 19000, "photons " + when);
    const vtkMTimeType made = scene.Map()->GetMTime();
    scene.emitter->SetSeed(scene.emitter->GetSeed() + 1);
    scene.emitter->Update();
    claims.That(scene.Map()->GetMTime() == made, "the map is not made again for other photons " + when);
  };
  layersAre(1, "of a sun");
  scene.rig->AddPointLight(50.0, 8.0, 8.0, 100.0, 90.0, 80.0);
  layersAre(2, "with a lamp");
  scene.rig->SunOff();
  layersAre(1, "of the lamp alone");
}

/// One pilot photon tells nothing.
void FewPilotPhotonsAreEnough(test::Claims& claims)
{
  for (int count : { 1, 2, 5 })
  {
    Pipeline scene(test::GlassBall(16));
    scene.importance->SetPilotCount(count);
    test::Errors errors(scene.importance);
    scene.emitter->Update();
    const int edge = count == 5 ? 2 : 1;
    claims.That(errors.None() && scene.Map()->GetDimensions()[0] == edge + 1, "a map of few pilot photons");
    vtkDataArray* importance = test::FiniteCells(claims, scene.Map(), "importance", 1);
    claims.Near(test::Total(importance), edge * edge, 1e-5, "its total");
    test::FiniteCells(claims, scene.Pilot(), "origin_deviation", 2);
    claims.That(scene.Photons()->GetNumberOfPoints() == 20000, "photons of it");
  }
}

void NoPilotPhotonsAreAnError(test::Claims& claims)
{
  for (int count : { 0, -3 })
  {
    Pipeline scene(test::GlassBall(16));
    scene.importance->SetPilotCount(count);
    test::Errors errors(scene.importance);
    scene.importance->Update();
    claims.That(errors.WasOneWith("PilotCount is "), "one error that says that there are no pilot photons");
    claims.That(scene.Map()->GetNumberOfCells() == 0, "no map");
  }
}

void ALightThatMissesIsNoLight(test::Claims& claims)
{
  Pipeline scene(test::GlassBall(16));
  scene.rig->SunOff();
  scene.rig->AddSpotLight(8.0, 8.0, 40.0, 0.0, 0.0, 1.0, 5.0, 5.0, 5.0, 20.0); // it looks away
  test::Errors errors(scene.importance), ofReconstruction(scene.reconstruction);
  scene.reconstruction->Update();
  claims.That(errors.None() && ofReconstruction.None(), "a light that misses is no error");
  if (scene.Map()->GetNumberOfCells() > 0)
  {
    test::FiniteCells(claims, scene.Map(), "importance", 1);
    test::FiniteCells(claims, scene.Pilot(), "fluence", 1);
  }
  claims.That(scene.Photons()->GetNumberOfPoints() == 0, "no photons of a light that misses");
  claims.Near(test::Total(test::FiniteCells(claims, scene.Smooth(), "fluence", 1)), 0.0, 0.0, "its light");
}

void NothingShinesIsAWarning(test::Claims& claims)
{
  vtkNew<vtkPhotonImportance> importance;
  test::Errors errors(importance);
  importance->SetInputDataObject(test::GlassBall(8));
  importance->Update();
  claims.That(errors.WasOneWith("Nothing shines"), "a warning where nothing shines");
  claims.That(test::AreEmpty({ importance }), "no map");
}
}

int TestPhotonImportance(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    AMapHasALayerALight(claims);
    ThePilotLightIsThere(claims);
    TheLightsPowerChangesNothing(claims);
    OwnThresholdsAreUsed(claims);
    EvenLightIsSaid(claims);
    WhatIsNotNeededCanBeComputedAllTheSame(claims);
    AnotherNumberOfLightsIsFollowed(claims);
    FewPilotPhotonsAreEnough(claims);
    NoPilotPhotonsAreAnError(claims);
    ALightThatMissesIsNoLight(claims);
    NothingShinesIsAWarning(claims);
  });
}
