#include "MediumScene.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDiscreteOrdinates.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkLatticeBoltzmannLighting.h"
#include "vtkLightPropagationMaps.h"

#include <cmath>
#include <string>

namespace
{
/// Fog that thickens along x, of these numbers of voxels.
void FillWithFog(vtkImageData* medium, const int voxels[3], double absorption = 0.02, double scattering = 0.2)
{
  medium->SetDimensions(voxels[0] + 1, voxels[1] + 1, voxels[2] + 1);
  for (const char* name : { "sigma_a", "sigma_s" })
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    array->SetNumberOfTuples(medium->GetNumberOfCells());
    for (vtkIdType i = 0; i < medium->GetNumberOfCells(); ++i)
    {
      array->SetValue(
        i, (name[6] == 'a' ? absorption : scattering) * (0.5 + static_cast<double>(i % voxels[0]) / voxels[0]));
    }
    medium->GetCellData()->AddArray(array);
  }
}

double RelativeDifference(vtkDataArray* found, vtkDataArray* light)
{
  double difference = 0.0, all = 0.0;
  for (vtkIdType i = 0; i < light->GetNumberOfTuples(); ++i)
  {
    difference += std::pow(light->GetComponent(i, 0) - found->GetComponent(i, 0), 2);
    all += std::pow(light->GetComponent(i, 0), 2);
  }
  return std::sqrt(difference / all);
}

template <class Solver>
void IsLikeTheLight(const char* name, const int voxels[3], test::Claims& claims)
{
  vtkNew<vtkImageData> medium;
  FillWithFog(medium, voxels);
  vtkNew<Solver> solver;
  test::Errors errors(solver);
  solver->SetInputDataObject(medium);
  vtkNew<vtkImageData> found[2];
  for (int preview = 0; preview < 2; ++preview)
  {
    solver->SetPreview(preview != 0);
    solver->Update();
    found[preview]->ShallowCopy(solver->GetOutput());
  }
  vtkDataArray* const light = found[0]->GetCellData()->GetArray("fluence");
  vtkDataArray* const preview = found[1]->GetCellData()->GetArray("fluence");
  const double difference = RelativeDifference(preview, light);
  const std::string who = name;
  claims.That(preview->GetNumberOfTuples() == medium->GetNumberOfCells(), who + ": a value a voxel");
  claims.That(difference > 0.0, who + ": a preview is not the light itself");
  claims.Near(difference, 0.0, 0.12, who + ": relative difference to the light");
  const bool isHalved = std::string(solver->GetLeftOut()).find("a preview") != std::string::npos;
  claims.That(
    isHalved != (who == "the lattice" && voxels[0] % 2 == 1), who + " says where it is one of half the voxels");
  claims.That(errors.None(), who + " has no errors");
}

/// Thick and bright, so that there are many orders: a preview sweeps few of them, and adds the others.
void OrdinatesGoOnAsASeries(test::Claims& claims)
{
  constexpr int voxels[3] = { 16, 16, 16 };
  vtkNew<vtkImageData> medium;
  FillWithFog(medium, voxels, 0.005, 1.0);
  vtkNew<vtkDiscreteOrdinates> solver;
  test::Errors errors(solver);
  solver->SetInputDataObject(medium);
  solver->Update();
  vtkNew<vtkImageData> light;
  light->ShallowCopy(solver->GetOutput());
  solver->PreviewOn();
  solver->Update();
  claims.That(std::string(solver->GetLeftOut()).find("those after 24 are a geometric series") != std::string::npos,
    "discrete ordinates say after how many orders a series goes on");
  claims.That(errors.None(), "which is no error");
  claims.Near(RelativeDifference(
                solver->GetOutput()->GetCellData()->GetArray("fluence"), light->GetCellData()->GetArray("fluence")),
    0.0, 0.15, "discrete ordinates with a series: relative difference to the light");
}
}

int TestPreview(int, char*[])
{
  return test::WithDevice([](test::Claims& claims) {
    constexpr int grids[][3] = { { 16, 12, 14 }, { 17, 12, 15 }, { 17, 12, 1 } };
    for (const int* const voxels : grids)
    {
      IsLikeTheLight<vtkLightPropagationMaps>("light propagation maps", voxels, claims);
      IsLikeTheLight<vtkDiscreteOrdinates>("discrete ordinates", voxels, claims);
      IsLikeTheLight<vtkLatticeBoltzmannLighting>("the lattice", voxels, claims);
    }
    OrdinatesGoOnAsASeries(claims);
  });
}
