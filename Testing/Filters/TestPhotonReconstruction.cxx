#include "AdaptiveScene.h"

#include "vtkStringArray.h"

#include <string>

namespace
{
using Pipeline = test::Adaptive;

bool AreTexts(vtkDataObject* data, const char* fact)
{
  auto* texts = vtkArrayDownCast<vtkStringArray>(data->GetFieldData()->GetAbstractArray(fact));
  return texts && texts->GetNumberOfValues() > 0;
}

void ThePipelineWorksUntouched(test::Claims& claims)
{
  Pipeline scene(test::GlassBall());
  test::AddCells(vtkImageData::SafeDownCast(scene.marcher->GetInputDataObject(0, 0)), "temperature", 300.0);
  test::Errors ofImportance(scene.importance), ofEmitter(scene.emitter), ofMarcher(scene.marcher),
    ofReconstruction(scene.reconstruction);
  scene.reconstruction->Update();
  claims.That(ofImportance.None() && ofEmitter.None() && ofMarcher.None() && ofReconstruction.None(), "no error");

  vtkImageData* noisy = scene.Noisy();
  vtkImageData* smooth = scene.Smooth();
  vtkDataArray* fluence = test::FiniteCells(claims, smooth, "fluence", 1);
  vtkDataArray* direct = test::FiniteCells(claims, smooth, "fluence_direct", 1);
  vtkDataArray* direction = test::FiniteCells(claims, smooth, "mean_direction", 3);
  vtkDataArray* level = test::FiniteCells(claims, smooth, "mip_level", 1);
  vtkDataArray* error = test::FiniteCells(claims, smooth, "fluence_error", 1);
  if (!fluence || !direct || !direction || !level || !error)
  {
    return;
  }
  claims.That(smooth->GetCellData()->GetScalars() == fluence, "fluence is the active array");
  claims.That(fluence->GetRange()[0] >= 0.0 && error->GetRange()[0] >= 0.0, "neither light nor its error is negative");
  claims.That(level->GetRange()[0] >= 0.0 && level->GetRange()[1] <= 5.0, "levels of the pyramid");
  claims.That(direction->GetRange(-1)[1] <= 1.0 + 1e-6, "mean directions are at most 1 long");
  claims.Near(test::Total(fluence), test::TotalCells(noisy, "fluence"), 1e-5 * test::Total(fluence), "total fluence");
  claims.Near(test::Total(direct), test::Total(fluence), 0.0, "total of the direct light");
  double squares = 0.0, errors = 0.0;
  for (vtkIdType i = 0; i < fluence->GetNumberOfTuples(); ++i)
  {
    squares += std::pow(fluence->GetComponent(i, 0), 2);
    errors += std::pow(error->GetComponent(i, 0), 2);
  }
  claims.That(errors > 0.0, "there is an error");
  claims.Near(scene.reconstruction->GetMeanError(), std::sqrt(errors / squares), 1e-9, "mean error on the panel");

  claims.That(!smooth->GetCellData()->HasArray("fluence_batches"), "batches end here");
  claims.That(noisy->GetCellData()->HasArray("fluence_batches"), "their array stays in the input");
  for (const char* name : { "sigma_a", "sigma_s", "ior", "temperature" })
  {
    claims.That(smooth->GetCellData()->GetArray(name) &&
        smooth->GetCellData()->GetArray(name) == noisy->GetCellData()->GetArray(name),
      std::string(name) + " is passed on");
  }
  for (int i = 0; i < 5; ++i)
  {
    claims.Near(test::Fact(smooth, "energy_balance", i), test::Fact(noisy, "energy_balance", i), 0.0, "energy balance");
  }
  for (const char* fact : { "scattered", "face_power_out" })
  {
    claims.That(smooth->GetFieldData()->HasArray(fact), std::string(fact) + " is passed on");
  }
  claims.Near(test::Fact(smooth, "fluence_bias"), scene.reconstruction->GetBias(), 0.0, "bias in the data");
  claims.That(!noisy->GetFieldData()->HasArray("fluence_bias"), "and not in those of the filter before");
  claims.That(AreTexts(smooth, "left_out") && AreTexts(smooth, "device"), "left_out and device");
  claims.That(scene.reconstruction->GetSeconds() > 0.0, "time on the panel");
}

void WhatWasLeftOutBeforeIsStillSaid(test::Claims& claims)
{
  Pipeline scene(test::GlassBall(16));
  scene.reconstruction->Update();
  auto* before = vtkArrayDownCast<vtkStringArray>(scene.Noisy()->GetFieldData()->GetAbstractArray("left_out"));
  auto* after = vtkArrayDownCast<vtkStringArray>(scene.Smooth()->GetFieldData()->GetAbstractArray("left_out"));
  if (!claims.That(before && after && before->GetNumberOfValues() > 0, "something was left out"))
  {
    return;
  }
  for (vtkIdType i = 0; i < before->GetNumberOfValues(); ++i)
  {
    claims.That(after->LookupValue(before->GetValue(i)) >= 0, "still said: " + before->GetValue(i));
  }
  for (vtkIdType i = 0; i < after->GetNumberOfValues(); ++i)
  {
    claims.That(after->LookupValue(after->GetValue(i)) == i, "said once: " + after->GetValue(i));
  }
}

void EverySchemeGivesLight(test::Claims& claims)
{
  Pipeline scene(test::GlassBall());
  scene.marcher->PhotonCountsOn();
  test::Errors errors(scene.reconstruction);
  using Filter = vtkPhotonReconstruction;
  for (int scheme = Filter::PUBLISHED; scheme <= Filter::NEAREST_PHOTONS; ++scheme)
  {
    scene.reconstruction->SetScheme(scheme);
    for (int conserve : { Filter::NEVER, Filter::ALWAYS, Filter::BY_SCHEME })
    {
      scene.reconstruction->SetConserveFluence(conserve);
      scene.reconstruction->Update();
      const std::string what = "scheme " + std::to_string(scheme) + ", conservation " + std::to_string(conserve);
      claims.That(errors.None(), "no error of " + what);
      vtkDataArray* fluence = test::FiniteCells(claims, scene.Smooth(), "fluence", 1);
      test::FiniteCells(claims, scene.Smooth(), "mip_level", 1);
      const bool conserved =
        conserve == Filter::ALWAYS || (conserve == Filter::BY_SCHEME && scheme == Filter::CONSERVATIVE);
      const double before = test::TotalCells(scene.Noisy(), "fluence");
      const double bias = conserved ? 0.0 : scene.reconstruction->GetBias();
      claims.Near(test::Total(fluence) / before, 1.0 + bias, 1e-5, "total fluence of " + what);
      claims.That(scene.Smooth()->GetCellData()->HasArray("fluence_error") == (scheme == Filter::CONSERVATIVE),
        "a standard error of the conservative scheme alone");
      claims.That(
        (scene.reconstruction->GetMeanError() > 0.0) == (scheme == Filter::CONSERVATIVE), "on the panel, too");
    }
  }
  scene.reconstruction->SetScheme(Filter::CONSTANT_RADIUS);
  for (int level : { 0, 3 })
  {
    scene.reconstruction->SetLevel(level);
    scene.reconstruction->Update();
    claims.Near(
      test::Deviation(scene.Smooth(), "mip_level", level), 0.0, 0.0, "levels, less the one that is asked for");
  }
}

void ColoursAreSmoothed(test::Claims& claims)
{
  Pipeline scene(test::GlassBall(16));
  scene.rig->SetSunPower(3.0, 2.0, 1.0);
  scene.emitter->SetBatches(4);
  scene.reconstruction->Update();
  test::FiniteCells(claims, scene.Noisy(), "fluence_batches", 12);
  vtkDataArray* fluence = test::FiniteCells(claims, scene.Smooth(), "fluence", 3);
  vtkDataArray* error = test::FiniteCells(claims, scene.Smooth(), "fluence_error", 3);
  if (fluence && error)
  {
    claims.Near(test::Total(fluence, 0) / test::Total(fluence, 2), 3.0, 1e-3, "red over blue");
    claims.That(
      fluence->GetComponentName(2) && std::string(fluence->GetComponentName(2)) == "B", "channels have names");
  }
}

/// Smoothing is there to be nearer to what ten times as many photons show.
void ItIsNearerToTheTruth(test::Claims& claims)
{
  Pipeline many(test::GlassBall());
  many.emitter->SetPhotonCount(2000000);
  many.emitter->RemoveImportanceMap();
  many.marcher->Update();
  Pipeline few(test::GlassBall());
  few.emitter->SetPhotonCount(4000);
  few.reconstruction->Update();
  const auto distance = [&](vtkImageData* image) {
    double sum = 0.0;
    for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
    {
      sum += std::pow(image->GetCellData()->GetArray("fluence")->GetComponent(i, 0) -
          many.Noisy()->GetCellData()->GetArray("fluence")->GetComponent(i, 0),
        2);
    }
    return std::sqrt(sum);
  };
  claims.That(distance(few.Smooth()) < 0.7 * distance(few.Noisy()), "smooth light is nearer to the truth");
}
}

int TestPhotonReconstruction(int, char*[])
{
  return test::WithDevice([&](test::Claims& claims) {
    ThePipelineWorksUntouched(claims);
    WhatWasLeftOutBeforeIsStillSaid(claims);
    EverySchemeGivesLight(claims);
    ColoursAreSmoothed(claims);
    ItIsNearerToTheTruth(claims);
  });
}
