#include "MediumScene.h"

#include "vtkLightPropagationMaps.h"

#include <cstdlib>
#include <filesystem>

/// Where the OpenCL loader finds no driver, the filter says so, and whatever needs no device goes on.
int TestLightPropagationMapsNoDevice(int, char*[])
{
  const std::filesystem::path empty = std::filesystem::temp_directory_path() / "tyndall_no_opencl";
  std::filesystem::create_directories(empty);
  setenv("OCL_ICD_VENDORS", empty.c_str(), 1);
  unsetenv("OCL_ICD_FILENAMES");

  test::Claims claims;
  vtkNew<vtkLightPropagationMaps> maps;
  test::Errors errors(maps);
  maps->SetInputDataObject(test::MakeMedium({ { 3, 3, 3 } }, 0.5, 1.0));
  maps->SetSkyColor(1.0, 1.0, 1.0);
  for (int again = 0; again < 2; ++again)
  {
    maps->Modified();
    maps->Update();
    claims.That(errors.WasOneWith("pocl-opencl-icd"), "it says that there is no device and what to install");
    claims.That(maps->GetOutput()->GetNumberOfCells() == 0, "the output is empty");
  }

  maps->SetScheme(vtkLightPropagationMaps::PUBLISHED);
  maps->SetAlgorithm(vtkLightPropagationMaps::SEQUENTIAL);
  maps->SetDirectionsPerFace(4);
  maps->SetMaximumOrders(3);
  maps->Update();
  claims.That(errors.None() && maps->GetOutput()->GetNumberOfCells() == 27, "the sequential algorithm needs no device");
  return claims.Result();
}
