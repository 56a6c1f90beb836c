// Computes the light of a cloud under the sun from its density, in a plain VTK pipeline; writes the light to a file and
// prints the energy balance.

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkLightPropagationMaps.h>
#include <vtkLightRig.h>
#include <vtkNew.h>
#include <vtkParticipatingMedium.h>
#include <vtkSmartPointer.h>
#include <vtkVDBWriter.h>

#include <cmath>
#include <iostream>

namespace
{
/// Density of a ball of 32^3 voxels of 10 m, which decreases outwards: mass of water in g/m^3.
vtkSmartPointer<vtkImageData> Cloud()
{
  constexpr int n = 32;
  auto cloud = vtkSmartPointer<vtkImageData>::New();
  cloud->SetDimensions(n + 1, n + 1, n + 1);
  cloud->SetSpacing(10.0, 10.0, 10.0);
  vtkNew<vtkFloatArray> water;
  water->SetName("density");
  for (int i = 0; i < n * n * n; ++i)
  {
    const double r = std::hypot(i % n - 15.5, i / n % n - 15.5, i / n / n - 15.5) / (n / 2);
    water->InsertNextValue(static_cast<float>(0.5 * std::fmax(0.0, 1.0 - r)));
  }
  cloud->GetCellData()->SetScalars(water);
  return cloud;
}
}

int main(int argc, char* argv[])
{
  vtkNew<vtkParticipatingMedium> medium;
  medium->SetInputData(Cloud());
  medium->SetPreset(vtkParticipatingMedium::CLOUD);
  medium->SetMillimetresPerUnit(1000.0);

  vtkNew<vtkLightRig> sun; // untouched: one sun, 45 degrees high

  vtkNew<vtkLightPropagationMaps> light;
  light->SetInputConnection(medium->GetOutputPort());
  light->SetLightsConnection(sun->GetOutputPort());
  light->SetTolerance(1e-3);
  light->Update();

  vtkImageData* result = vtkImageData::SafeDownCast(light->GetOutputDataObject(0));
  vtkDataArray* balance = result->GetFieldData()->GetArray("energy_balance");
  if (!balance)
  {
    return 1; // the error has been printed to the error stream
  }
  std::cout << "entered " << balance->GetTuple1(0) << " W, absorbed " << balance->GetTuple1(2) << " W, escaped "
            << balance->GetTuple1(3) << " W, left over " << balance->GetTuple1(4) << " W after " << light->GetOrders()
            << " orders\n";

  vtkNew<vtkVDBWriter> writer;
  writer->SetInputData(result);
  writer->SetFileName(argc > 1 ? argv[1] : "light.vdb");
  return writer->Write() == 1 && light->GetBalanceError() < 1e-5 ? 0 : 1;
}
