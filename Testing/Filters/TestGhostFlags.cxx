// vtkGhostType of media, light and environment: what is hidden is empty, what is a duplicate is not counted twice.
#include "MediumScene.h"

#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkLightRig.h"
#include "vtkLPMPropagate.h"
#include "vtkMediumRayCaster.h"
#include "vtkParticipatingMedium.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonMarcher.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <functional>
#include <limits>

namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr int Edge = 6;

using IsHidden = std::function<bool(vtkIdType)>;

bool InBlock(vtkIdType cell)
{
  const vtkIdType i = cell % Edge, j = cell / Edge % Edge, k = cell / (Edge * Edge);
  return i >= 2 && i < 4 && j >= 2 && j < 4 && k >= 2;
}

/// The cells round the point (3, 3, 3), the middle of the box.
bool AroundMiddle(vtkIdType cell)
{
  const vtkIdType i = cell % Edge, j = cell / Edge % Edge, k = cell / (Edge * Edge);
  return i >= 2 && i < 4 && j >= 2 && j < 4 && k >= 2 && k < 4;
}

void Flag(vtkDataSetAttributes* of, vtkIdType count, unsigned char flag, const IsHidden& flagged)
{
  test::AddValues<vtkUnsignedCharArray>(
    of, vtkDataSetAttributes::GhostArrayName(), count, 1, [&](vtkIdType i, int) { return flagged(i) ? flag : 0.0; });
}

/// A medium with a block in it of other values.
vtkSmartPointer<vtkImageData> Medium(const IsHidden& inBlock, double ofBlock, double indexOfBlock = 1.0)
{
  auto image = test::MakeImage({ { Edge, Edge, Edge } });
  const auto add = [&](const char* name, double around, double block) {
    test::AddValues<vtkFloatArray>(image->GetCellData(), name, image->GetNumberOfCells(), 1,
      [&](vtkIdType i, int) { return inBlock(i) ? block : around; });
  };
  add("sigma_a", 0.1, ofBlock);
  add("sigma_s", 0.3, ofBlock);
  add("ior", 1.0, indexOfBlock);
  return image;
}

vtkSmartPointer<vtkImageData> HiddenBlock()
{
  auto image = Medium(InBlock, NaN, NaN); // what hidden cells have may be anything
  Flag(image->GetCellData(), image->GetNumberOfCells(), vtkDataSetAttributes::HIDDENCELL, InBlock);
  return image;
}

vtkSmartPointer<vtkImageData> HiddenPoint()
{
  auto image = Medium(AroundMiddle, 5.0);
  const vtkIdType middle = 3 + (Edge + 1) * (3 + (Edge + 1) * 3);
  Flag(image->GetPointData(), image->GetNumberOfPoints(), vtkDataSetAttributes::HIDDENPOINT,
    [=](vtkIdType point) { return point == middle; });
  return image;
}

/// Largest difference of an array of cells or pixels; infinite where one of both does not have it.
double Difference(vtkImageData* a, vtkImageData* b, const char* name)
{
  const auto find = [&](vtkImageData* image) {
    vtkDataArray* const array = image->GetCellData()->GetArray(name);
    return array ? array : image->GetPointData()->GetArray(name);
  };
  vtkDataArray* const first = find(a);
  vtkDataArray* const second = find(b);
  if (!first || !second || first->GetNumberOfValues() == 0 || first->GetNumberOfValues() != second->GetNumberOfValues())
  {
    return VTK_DOUBLE_MAX;
  }
  double largest = 0.0;
  for (vtkIdType i = 0; i < first->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < first->GetNumberOfComponents(); ++c)
    {
      largest = std::max(largest, std::abs(first->GetComponent(i, c) - second->GetComponent(i, c)));
    }
  }
  return largest;
}

vtkSmartPointer<vtkImageData> Copy(vtkAlgorithm* filter)
{
  auto copy = vtkSmartPointer<vtkImageData>::New();
  copy->DeepCopy(filter->GetOutputDataObject(0));
  return copy;
}

vtkSmartPointer<vtkImageData> Propagated(vtkImageData* medium, int scheme)
{
  vtkNew<vtkLightPropagationMaps> maps;
  vtkNew<vtkLightRig> rig;
  maps->SetInputDataObject(medium);
  maps->SetLightsConnection(rig->GetOutputPort());
  maps->SetScheme(scheme);
  maps->Update();
  return Copy(maps);
}

vtkSmartPointer<vtkImageData> Marched(vtkImageData* medium)
{
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkPhotonEmitter> emitter;
  emitter->SetInputDataObject(medium);
  emitter->SetLightsConnection(rig->GetOutputPort());
  emitter->SetPhotonCount(2000);
  vtkNew<vtkPhotonMarcher> marcher;
  marcher->SetInputDataObject(medium);
  marcher->SetPhotonsConnection(emitter->GetOutputPort());
  marcher->Update();
  return Copy(marcher);
}

vtkSmartPointer<vtkImageData> Viewed(vtkMediumRayCaster* caster, vtkImageData* medium)
{
  caster->SetInputDataObject(medium);
  caster->SetImageSize(24, 16);
  caster->Update();
  return Copy(caster);
}

void HiddenIsEmpty(test::Claims& claims)
{
  const auto empty = Medium(InBlock, 0.0);
  const auto hidden = HiddenBlock();
  for (const int scheme : { vtkLightPropagationMaps::PUBLISHED, vtkLightPropagationMaps::CONSERVATIVE })
  {
    const auto light = Propagated(hidden, scheme);
    claims.Near(Difference(light, Propagated(empty, scheme), "fluence"), 0.0, 0.0, "propagation with hidden cells");
    claims.That(light->GetCellData()->HasArray(vtkDataSetAttributes::GhostArrayName()), "flags are handed on");
  }
  claims.Near(Difference(Marched(hidden), Marched(empty), "fluence"), 0.0, 0.0, "photons with hidden cells");
  const auto around = Medium(AroundMiddle, 0.0);
  claims.Near(Difference(Propagated(HiddenPoint(), vtkLightPropagationMaps::CONSERVATIVE),
                Propagated(around, vtkLightPropagationMaps::CONSERVATIVE), "fluence"),
    0.0, 0.0, "cells with a hidden point");
}

/// A caster keeps its scene; other flags make another one.
void ViewsFollowFlags(test::Claims& claims)
{
  vtkNew<vtkMediumRayCaster> caster, other;
  vtkNew<vtkLightRig> rig;
  caster->SetLightsConnection(rig->GetOutputPort());
  other->SetLightsConnection(rig->GetOutputPort());
  const auto medium = Medium(InBlock, 5.0);
  const auto all = Viewed(caster, medium);
  Flag(medium->GetCellData(), medium->GetNumberOfCells(), vtkDataSetAttributes::HIDDENCELL, InBlock);
  medium->Modified();
  const auto hidden = Viewed(caster, medium);
  claims.That(Difference(all, hidden, "alpha") > 0.05, "hidden cells are not seen");
  claims.Near(Difference(hidden, Viewed(other, Medium(InBlock, 0.0)), "radiance"), 0.0, 0.0, "they are empty");
}

void DensityOfHiddenIsNone(test::Claims& claims)
{
  const auto image = test::MakeImage({ { 2, 1, 1 } });
  test::AddCells(image, "density", 1.0);
  image->GetCellData()->SetActiveScalars("density");
  Flag(image->GetCellData(), 2, vtkDataSetAttributes::HIDDENCELL, [](vtkIdType i) { return i == 1; });
  vtkNew<vtkParticipatingMedium> medium;
  medium->SetInputDataObject(image);
  medium->SetMinimumDensity(-1.0);
  medium->Update();
  vtkDataArray* const sigma = medium->GetOutput()->GetCellData()->GetArray("sigma_s");
  claims.That(sigma && sigma->GetTuple1(0) > 0.5 && sigma->GetTuple1(1) == 0.0, "no medium of a hidden density");
}

void HiddenSkyIsBlack(test::Claims& claims)
{
  auto picture = vtkSmartPointer<vtkImageData>::New();
  picture->SetDimensions(8, 4, 1);
  test::AddPoints(picture, "radiance", 1.0, 3);
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputDataObject(Medium(InBlock, 0.0));
  maps->SetEnvironmentData(picture);
  const auto entered = [&] {
    maps->Update();
    vtkDataArray* const balance = maps->GetOutput()->GetFieldData()->GetArray("energy_balance");
    return balance ? balance->GetComponent(0, 0) : NaN;
  };
  const double all = entered();
  Flag(picture->GetPointData(), 32, vtkDataSetAttributes::HIDDENPOINT, [](vtkIdType i) { return i >= 16; });
  picture->Modified();
  claims.Near(entered() / all, 0.5, 0.05, "power of a sky of which half is hidden, over that of the whole");
}

/// Lights and photons that are hidden, or another rank's, are left out.
void PointsAreLeftOut(test::Claims& claims)
{
  const auto medium = Medium(InBlock, 0.2);
  const auto lit = [&](const IsHidden& hidden, const IsHidden& duplicate) {
    vtkNew<vtkLightRig> rig;
    for (int i = 0; i < 3; ++i)
    {
      rig->AddPointLight(1.0 + i, 2.0, 3.0, 1.0, 1.0, 1.0);
    }
    rig->SunOff();
    rig->Update();
    auto lights = vtkSmartPointer<vtkPolyData>::New();
    lights->ShallowCopy(rig->GetOutput());
    test::AddValues<vtkUnsignedCharArray>(
      lights->GetPointData(), vtkDataSetAttributes::GhostArrayName(), 3, 1, [&](vtkIdType i, int) {
        return hidden(i) ? vtkDataSetAttributes::HIDDENPOINT : duplicate(i) ? vtkDataSetAttributes::DUPLICATEPOINT : 0;
      });
    vtkNew<vtkLightPropagationMaps> maps;
    maps->SetInputDataObject(medium);
    maps->SetLightsData(lights);
    maps->Update();
    return maps->GetOutput()->GetFieldData()->GetArray("energy_balance")->GetComponent(0, 0);
  };
  const auto none = [](vtkIdType) { return false; };
  claims.Near(lit(none, none), 3.0, 1e-4, "power of three lamps");
  claims.Near(lit([](vtkIdType i) { return i == 1; }, [](vtkIdType i) { return i == 2; }), 1.0, 1e-4,
    "power of three lamps, of which one is hidden and one a duplicate");

  vtkNew<vtkLightRig> rig;
  vtkNew<vtkPhotonEmitter> emitter;
  emitter->SetInputDataObject(medium);
  emitter->SetLightsConnection(rig->GetOutputPort());
  emitter->SetPhotonCount(1000);
  emitter->Update();
  auto photons = vtkSmartPointer<vtkPolyData>::New();
  photons->ShallowCopy(emitter->GetOutput());
  vtkNew<vtkPhotonMarcher> marcher;
  marcher->SetInputDataObject(medium);
  marcher->SetPhotonsData(photons);
  const auto entered = [&] {
    marcher->Update();
    vtkDataObject* const light = marcher->GetOutputDataObject(0);
    return light->GetFieldData()->GetArray("energy_balance")->GetComponent(0, 0);
  };
  const double all = entered();
  Flag(photons->GetPointData(), photons->GetNumberOfPoints(), vtkDataSetAttributes::DUPLICATEPOINT,
    [](vtkIdType i) { return i % 2 == 1; });
  photons->Modified();
  claims.Near(entered() / all, 0.5, 1e-4, "power of photons of which half are duplicates");
}

/// What a neighbour has, too, is marked in a piece with ghost cells, so that sums over ranks have it once.
void GhostsOfPiecesAreMarked(test::Claims& claims)
{
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputDataObject(Medium(InBlock, 0.2));
  maps->SetSkyColor(1.0, 1.0, 1.0);
  maps->Update();
  double whole = 0.0, ofPieces = 0.0;
  const auto add = [&](double& sum) {
    vtkImageData* const piece = maps->GetOutput();
    vtkUnsignedCharArray* const flags = piece->GetCellGhostArray();
    for (vtkIdType i = 0; i < piece->GetNumberOfCells(); ++i)
    {
      const bool duplicate = flags && (flags->GetValue(i) & vtkDataSetAttributes::DUPLICATECELL);
      sum += duplicate ? 0.0 : piece->GetCellData()->GetArray("fluence")->GetComponent(i, 0);
    }
    return piece->GetNumberOfCells();
  };
  add(whole);
  maps->UpdatePiece(0, 2, 1);
  vtkIdType cells = add(ofPieces);
  maps->UpdatePiece(1, 2, 1);
  cells += add(ofPieces);
  claims.That(cells > Edge * Edge * Edge, "pieces with ghost cells overlap");
  claims.Near(ofPieces / whole, 1.0, 1e-6, "sum over pieces with ghost cells, over that of the whole");
}

void DuplicatesCountOnce(test::Claims& claims)
{
  const auto medium = Medium(InBlock, 0.2);
  const auto alone = Propagated(medium, vtkLightPropagationMaps::CONSERVATIVE);
  Flag(medium->GetCellData(), medium->GetNumberOfCells(), vtkDataSetAttributes::DUPLICATECELL,
    [](vtkIdType cell) { return cell % Edge == 0; });
  claims.Near(Difference(Propagated(medium, vtkLightPropagationMaps::CONSERVATIVE), alone, "fluence"), 0.0, 0.0,
    "an image with duplicates that is solved as a whole");
  vtkNew<vtkLightPropagationMaps> maps;
  maps->SetInputDataObject(medium);
  maps->SetSkyColor(1.0, 1.0, 1.0);
  test::Errors errors(maps);
  maps->UpdatePiece(0, 2, 0);
  claims.That(errors.WasOneWith("duplicates of another rank's (vtkGhostType)"), "duplicates of a divided image");
}
}

int TestGhostFlags(int, char*[])
{
  test::Claims claims;
  DensityOfHiddenIsNone(claims);
  return test::WithDevice(
    [](test::Claims& claims) {
      HiddenIsEmpty(claims);
      ViewsFollowFlags(claims);
      HiddenSkyIsBlack(claims);
      DuplicatesCountOnce(claims);
      PointsAreLeftOut(claims);
      GhostsOfPiecesAreMarked(claims);
    },
    claims);
}
