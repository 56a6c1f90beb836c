// Three scattering orders chained by hand are what vtkLightPropagationMaps computes in one go.

#include "MediumScene.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLightPropagationMaps.h"
#include "vtkLightRig.h"
#include "vtkLPMCollect.h"
#include "vtkLPMPropagate.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>

namespace
{
void AddCells(vtkImageData* image, const char* name, int components, float densest)
{
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(image->GetNumberOfCells());
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    array->SetValue(i, densest * static_cast<float>(i * 7919 % 101) / 101.0f);
  }
  image->GetCellData()->AddArray(array);
}

void MakeMedium(vtkImageData* image, int components)
{
  image->SetExtent(-2, 5, 3, 9, 0, 5);
  image->SetSpacing(1.0, 0.7, 1.5);
  AddCells(image, "sigma_a", 1, 0.1f);
  AddCells(image, "sigma_s", components, 0.4f);
  AddCells(image, "emission", 1, 0.2f);
}

void MakeEnvironment(vtkImageData* image)
{
  image->SetDimensions(8, 4, 1);
  vtkNew<vtkFloatArray> radiance;
  radiance->SetName("radiance");
  radiance->SetNumberOfComponents(1);
  for (int i = 0; i < 32; ++i)
  {
    radiance->InsertNextValue(static_cast<float>(i % 5));
  }
  image->GetPointData()->AddArray(radiance);
}

double LargestDifference(vtkImageData* image, vtkImageData* reference, const char* name)
{
  vtkDataArray* a = image->GetCellData()->GetArray(name);
  vtkDataArray* b = reference->GetCellData()->GetArray(name);
  if (!a || !b || a->GetNumberOfTuples() != b->GetNumberOfTuples() ||
    a->GetNumberOfComponents() != b->GetNumberOfComponents())
  {
    return HUGE_VAL;
  }
  double largest = 0.0;
  for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < a->GetNumberOfComponents(); ++c)
    {
      const double expected = b->GetComponent(i, c);
      largest = std::max(largest, std::abs(a->GetComponent(i, c) - expected) / std::max(std::abs(expected), 1e-30));
    }
  }
  return largest;
}

/// Grey media in grey light, coloured media, and more stored directions with a forward phase function.
struct Case
{
  int components;
  double red;
  int storedDirections;
  double g;
};

void CompareChainWithSolver(test::Claims& claims, const Case& scene)
{
  vtkNew<vtkImageData> medium;
  vtkNew<vtkImageData> environment;
  MakeMedium(medium, scene.components);
  MakeEnvironment(environment);
  vtkNew<vtkDoubleArray> g;
  g->SetName("g");
  g->InsertNextValue(scene.g);
  medium->GetFieldData()->AddArray(g);
  vtkNew<vtkLightRig> rig;
  rig->SetSunPower(scene.red, 1.0, 1.0);

  vtkNew<vtkLightPropagationMaps> solver;
  solver->SetInputDataObject(medium);
  solver->SetLightsConnection(rig->GetOutputPort());
  solver->SetEnvironmentData(environment);
  solver->SetSkyColor(0.5, 0.5, 0.5);
  solver->SetFaceRadiance(0.0, 1.0, 2.0, 3.0, 4.0, 5.0);
  solver->SetScheme(vtkLightPropagationMaps::PUBLISHED);
  solver->SetAlgorithm(vtkLightPropagationMaps::PARALLEL);
  solver->SetDirectionsPerFace(9);
  solver->SetMapResolution(2);
  solver->SetStoredDirections(scene.storedDirections);
  solver->SetMaximumOrders(3);
  solver->Update();

  vtkNew<vtkLPMPropagate> propagate[3];
  vtkNew<vtkLPMCollect> collect[3];
  for (int order = 0; order < 3; ++order)
  {
    if (order == 0)
    {
      propagate[order]->SetInputDataObject(medium);
    }
    else
    {
      propagate[order]->SetInputConnection(collect[order - 1]->GetOutputPort());
    }
    propagate[order]->SetLightsConnection(rig->GetOutputPort());
    propagate[order]->SetEnvironmentData(environment);
    propagate[order]->SetSkyColor(0.5, 0.5, 0.5);
    propagate[order]->SetFaceRadiance(0.0, 1.0, 2.0, 3.0, 4.0, 5.0);
    propagate[order]->SetDirectionsPerFace(9);
    propagate[order]->SetMapResolution(2);
    propagate[order]->SetStoredDirections(scene.storedDirections);
    collect[order]->SetInputConnection(propagate[order]->GetOutputPort());
  }
  collect[2]->Update();

  vtkImageData* chained = collect[2]->GetOutput();
  vtkImageData* solved = vtkImageData::SafeDownCast(solver->GetOutputDataObject(0));
  for (const char* name : { "fluence", "fluence_direct", "scattered_radiance" })
  {
    claims.Near(LargestDifference(chained, solved, name), 0.0, 2e-6, name);
  }
  claims.That(propagate[2]->GetOrder() == 2, "the third propagation is of order 2");
  claims.That(!chained->GetCellData()->GetArray("T_xmin"), "T is not handed on");
  vtkDataArray* t = propagate[0]->GetOutput()->GetCellData()->GetArray("T_zmax");
  const int channels = scene.components == 3 || scene.red != 1.0 ? 3 : 1;
  claims.That(t && t->GetNumberOfComponents() == 9 * channels, "T has a component a direction and channel");
  claims.That(propagate[0]->GetBytes() == 6.0 * 9 * channels * 4 * medium->GetNumberOfCells(), "T says its size");
  claims.That(propagate[0]->GetSeconds() > 0.0 && collect[0]->GetSeconds() > 0.0, "both halves say their time");
  const auto says = [](const char* leftOut, const char* word) {
    return std::string(leftOut).find(word) != std::string::npos;
  };
  claims.That(says(propagate[2]->GetLeftOut(), "colour") == (channels == 1), "and whether one channel does");
  claims.That(says(collect[2]->GetLeftOut(), "colour") == (channels == 1), "both of them");
  vtkDataArray* unscattered = chained->GetCellData()->GetArray("unscattered");
  const int sources = scene.storedDirections == 1 ? 6 : scene.storedDirections;
  claims.That(unscattered && unscattered->GetNumberOfComponents() == sources * channels, "U is by direction");
}

void SayWhatIsMissing(test::Claims& claims)
{
  vtkNew<vtkImageData> medium;
  MakeMedium(medium, 1);
  vtkNew<vtkLPMCollect> collect;
  test::Errors errors(collect);
  collect->SetInputDataObject(medium);
  collect->Update();
  claims.That(errors.WasOneWith("T_xmin"), "LPMCollect says that it needs T");
  claims.That(collect->GetOutput()->GetNumberOfCells() == 0, "its output is empty then");

  AddCells(medium, "unscattered", 5, 1.0f);
  vtkNew<vtkLPMPropagate> propagate;
  test::Errors others(propagate);
  propagate->SetInputDataObject(medium);
  propagate->Update();
  claims.That(others.WasOneWith("'unscattered' has 5 components"), "LPMPropagate says what is wrong with U");

  medium->GetCellData()->RemoveArray("unscattered");
  propagate->SetDirectionsPerFace(24);
  propagate->Update();
  claims.That(others.WasOneWith("DirectionsPerFace is 24"), "directions must fill a square");
}
}

int TestLPMStepByStep(int, char*[])
{
  return test::WithDevice([](test::Claims& claims) {
    CompareChainWithSolver(claims, { 1, 1.0, 1, 0.0 });
    CompareChainWithSolver(claims, { 1, 3.0, 1, 0.0 });
    CompareChainWithSolver(claims, { 3, 1.0, 6, 0.6 });
    SayWhatIsMissing(claims);
  });
}
