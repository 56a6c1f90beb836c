#include "vtkLightPropagationMaps.h"

#include "Device/Device.h"
#include "LightPropagation/FusedPropagation.h"
#include "LightPropagation/ParallelPropagation.h"
#include "LightPropagation/SequentialPropagation.h"
#include "LightTransportData.h"
#include "WholeImage.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace
{
enum InputPort
{
  MediumPort,
  LightsPort,
  EnvironmentPort,
  InputPortCount
};

tyndall::PropagationSettings SettingsOf(vtkLightPropagationMaps* filter)
{
  tyndall::PropagationSettings settings;
  settings.directionsPerFace = filter->GetDirectionsPerFace();
  settings.mapResolution = filter->GetMapResolution();
  settings.maximumOrders = filter->GetMaximumOrders();
  settings.tolerance = filter->GetTolerance();
  settings.periodic = { filter->GetPeriodicX(), filter->GetPeriodicY(), filter->GetPeriodicZ() };
  settings.storedDirections = filter->GetStoredDirections();
  settings.netFlux = filter->GetNetFlux();
  return settings;
}

tyndall::Illumination IlluminationOf(vtkLightPropagationMaps* filter, vtkInformationVector** inputs)
{
  tyndall::Illumination illumination;
  illumination.lights = tyndall::ReadLights(vtkPolyData::GetData(inputs[LightsPort]));
  illumination.environment = tyndall::Turned(tyndall::ReadEnvironment(vtkImageData::GetData(inputs[EnvironmentPort])),
    filter->GetEnvironmentUp(), filter->GetEnvironmentAzimuth());
  std::copy_n(filter->GetSkyColor(), 3, illumination.sky.begin());
  for (int face = 0; face < 6; ++face)
  {
    illumination.faces[face].fill(filter->GetFaceRadiance()[face]);
  }
  tyndall::Check(illumination);
  return illumination;
}

bool NothingShines(const tyndall::Medium& medium, const tyndall::Illumination& illumination)
{
  const tyndall::Rgb black = {};
  return illumination.lights.empty() && illumination.environment.Empty() && illumination.sky == black &&
    std::all_of(
      illumination.faces.begin(), illumination.faces.end(), [&](const tyndall::Rgb& face) { return face == black; }) &&
    !medium.emission.values;
}

tyndall::LightField Solve(
  vtkLightPropagationMaps* filter, const tyndall::Medium& medium, const tyndall::Illumination& illumination)
{
  const tyndall::PropagationSettings settings = SettingsOf(filter);
  const tyndall::Monitor monitor = tyndall::MonitorOf(filter);
  const bool published = filter->GetScheme() == vtkLightPropagationMaps::PUBLISHED;
  if (published && filter->GetAlgorithm() == vtkLightPropagationMaps::SEQUENTIAL)
  {
    return tyndall::SolveSequential(medium, illumination, settings, monitor);
  }
  const std::shared_ptr<tyndall::Device> device = tyndall::Device::Find(filter->GetDevice());
  return published ? tyndall::SolveParallel(*device, medium, illumination, settings, monitor)
                   : tyndall::SolveFused(*device, medium, illumination, settings, monitor);
}
}

vtkStandardNewMacro(vtkLightPropagationMaps);

vtkLightPropagationMaps::vtkLightPropagationMaps()
{
  this->SetNumberOfInputPorts(InputPortCount);
  this->SetNumberOfOutputPorts(2);
}

vtkLightPropagationMaps::~vtkLightPropagationMaps() = default;

void vtkLightPropagationMaps::SetLightsConnection(vtkAlgorithmOutput* lights)
{
  this->SetInputConnection(LightsPort, lights);
}

void vtkLightPropagationMaps::SetLightsData(vtkDataObject* lights)
{
  this->SetInputDataObject(LightsPort, lights);
}

void vtkLightPropagationMaps::RemoveLights()
{
  this->SetInputConnection(LightsPort, nullptr);
}

void vtkLightPropagationMaps::SetEnvironmentConnection(vtkAlgorithmOutput* environment)
{
  this->SetInputConnection(EnvironmentPort, environment);
}

void vtkLightPropagationMaps::SetEnvironmentData(vtkDataObject* environment)
{
  this->SetInputDataObject(EnvironmentPort, environment);
}

void vtkLightPropagationMaps::RemoveEnvironment()
{
  this->SetInputConnection(EnvironmentPort, nullptr);
}

int vtkLightPropagationMaps::FillInputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == LightsPort ? "vtkPolyData" : "vtkImageData");
  if (port != MediumPort)
  {
    information->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkLightPropagationMaps::FillOutputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

int vtkLightPropagationMaps::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*)
{
  for (int port = 0; port < InputPortCount; ++port)
  {
    tyndall::AskForAll(inputs[port]);
  }
  return 1;
}

int vtkLightPropagationMaps::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Note({});
  return tyndall::Guarded(this, outputs, [&] {
    vtkImageData* image = vtkImageData::GetData(inputs[MediumPort]);
    const tyndall::MediumInput input = tyndall::ReadMedium(this, image);
    const tyndall::Illumination illumination = IlluminationOf(this, inputs);
    if (NothingShines(input.medium, illumination))
    {
      vtkWarningMacro(
        "Nothing shines on the medium, so it is dark. Connect Lights or an Environment, or set SkyColor.");
    }

    tyndall::LightField light = Solve(this, input.medium, illumination);

    this->Note(light);
    tyndall::WriteConvergence(light.convergence, vtkTable::GetData(outputs, 1));
    vtkImageData* output = vtkImageData::GetData(outputs, 0);
    tyndall::PassOn(image, output);
    tyndall::WriteLight(std::move(light), output);
    tyndall::KeepWhatIsAskedFor(outputs->GetInformationObject(0), output);
  });
}

void vtkLightPropagationMaps::Note(const tyndall::LightField& light)
{
  const bool any = !light.convergence.empty();
  this->Orders = static_cast<int>(light.convergence.size());
  this->Residual = any ? light.convergence.back().residual : 0.0;
  this->Seconds = any ? light.convergence.back().seconds : 0.0;
  this->BalanceError = light.balance.RelativeError(light.channels);
  this->DeviceName = light.device;
  this->LeftOut = tyndall::Lines(light.leftOut);
}

void vtkLightPropagationMaps::PrintSelf(ostream& os, vtkIndent indent)
{
  const auto print = [&](const char* name, const double* values, int count) {
    os << indent << name << ":";
    std::for_each(values, values + count, [&](double value) { os << " " << value; });
    os << "\n";
  };
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Scheme: " << (this->Scheme == SOUND ? "sound" : "as published") << "\n";
  os << indent << "Algorithm: " << (this->Algorithm == SEQUENTIAL ? "sequential" : "parallel") << "\n";
  os << indent << "DirectionsPerFace: " << this->DirectionsPerFace << "\n";
  os << indent << "MapResolution: " << this->MapResolution << "\n";
  os << indent << "MaximumOrders: " << this->MaximumOrders << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "Periodic: " << this->PeriodicX << " " << this->PeriodicY << " " << this->PeriodicZ << "\n";
  print("FaceRadiance", this->FaceRadiance, 6);
  print("SkyColor", this->SkyColor, 3);
  os << indent << "EnvironmentUp: " << this->EnvironmentUp << "\n";
  os << indent << "EnvironmentAzimuth: " << this->EnvironmentAzimuth << "\n";
  os << indent << "NetFlux: " << this->NetFlux << "\n";
  os << indent << "StoredDirections: " << this->StoredDirections << "\n";
  os << indent << "Device: " << this->Device << "\n";
  os << indent << "Orders: " << this->Orders << "\n";
  os << indent << "Residual: " << this->Residual << "\n";
  os << indent << "BalanceError: " << this->BalanceError << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
  os << indent << "DeviceName: " << this->DeviceName << "\n";
  os << indent << "LeftOut: " << this->LeftOut << "\n";
}
