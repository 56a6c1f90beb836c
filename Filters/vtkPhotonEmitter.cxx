#include "vtkPhotonEmitter.h"

#include "LightTransportData.h"
#include "PhotonData.h"
#include "WholeImage.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>

namespace
{
enum InputPort
{
  MediumPort,
  LightsPort,
  EnvironmentPort,
  InputPortCount
};

tyndall::Illumination IlluminationOf(vtkPhotonEmitter* filter, vtkInformationVector** inputs)
{
  tyndall::Illumination illumination;
  illumination.lights = tyndall::ReadLights(vtkPolyData::GetData(inputs[LightsPort]));
  illumination.environment = tyndall::Turned(tyndall::ReadEnvironment(vtkImageData::GetData(inputs[EnvironmentPort])),
    filter->GetEnvironmentUp(), filter->GetEnvironmentAzimuth());
  std::copy_n(filter->GetSkyColor(), 3, illumination.sky.begin());
  return illumination;
}

bool NothingShines(const tyndall::Illumination& illumination)
{
  return illumination.lights.empty() && illumination.environment.Empty() && illumination.sky == tyndall::Rgb{};
}

bool IsFirstPiece(vtkInformation* output)
{
  auto* piece = vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER();
  return !output->Has(piece) || output->Get(piece) <= 0;
}
}

vtkStandardNewMacro(vtkPhotonEmitter);

vtkPhotonEmitter::vtkPhotonEmitter()
{
  this->SetNumberOfInputPorts(InputPortCount);
}

vtkPhotonEmitter::~vtkPhotonEmitter() = default;

void vtkPhotonEmitter::SetLightsConnection(vtkAlgorithmOutput* lights)
{
  this->SetInputConnection(LightsPort, lights);
}

void vtkPhotonEmitter::SetLightsData(vtkDataObject* lights)
{
  this->SetInputDataObject(LightsPort, lights);
}

void vtkPhotonEmitter::RemoveLights()
{
  this->SetInputConnection(LightsPort, nullptr);
}

void vtkPhotonEmitter::SetEnvironmentConnection(vtkAlgorithmOutput* environment)
{
  this->SetInputConnection(EnvironmentPort, environment);
}

void vtkPhotonEmitter::SetEnvironmentData(vtkDataObject* environment)
{
  this->SetInputDataObject(EnvironmentPort, environment);
}

void vtkPhotonEmitter::RemoveEnvironment()
{
  this->SetInputConnection(EnvironmentPort, nullptr);
}

int vtkPhotonEmitter::FillInputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == LightsPort ? "vtkPolyData" : "vtkImageData");
  if (port != MediumPort)
  {
    information->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkPhotonEmitter::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*)
{
  for (int port = 0; port < InputPortCount; ++port)
  {
    tyndall::AskForAll(inputs[port]);
  }
  return 1;
}

int vtkPhotonEmitter::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Photons = 0;
  this->Power = 0.0;
  this->Seconds = 0.0;
  return tyndall::Guarded(this, outputs, [&] {
    const tyndall::Grid grid = tyndall::GridOf(vtkImageData::GetData(inputs[MediumPort]));
    const tyndall::Illumination illumination = IlluminationOf(this, inputs);
    if (NothingShines(illumination))
    {
      vtkWarningMacro(
        "Nothing shines on the volume, so there are no photons. Connect Lights or an Environment, or set SkyColor.");
    }
    if (!IsFirstPiece(outputs->GetInformationObject(0)))
    {
      return;
    }
    tyndall::EmissionSettings settings;
    settings.photonCount = static_cast<std::size_t>(this->PhotonCount);
    settings.sampler = static_cast<tyndall::Sampler>(this->Sampler);
    settings.seed = static_cast<std::uint64_t>(this->Seed);
    const tyndall::EmittedPhotons emitted =
      tyndall::EmitPhotons(grid, illumination, settings, tyndall::MonitorOf(this));
    tyndall::WritePhotons(emitted, vtkPolyData::GetData(outputs));
    this->Photons = static_cast<vtkIdType>(emitted.photons.size());
    this->Power = emitted.power[0] + emitted.power[1] + emitted.power[2];
    this->Seconds = emitted.seconds;
  });
}

void vtkPhotonEmitter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PhotonCount: " << this->PhotonCount << "\n";
  os << indent << "Sampler: " << this->Sampler << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "SkyColor: " << this->SkyColor[0] << " " << this->SkyColor[1] << " " << this->SkyColor[2] << "\n";
  os << indent << "EnvironmentUp: " << this->EnvironmentUp << "\n";
  os << indent << "EnvironmentAzimuth: " << this->EnvironmentAzimuth << "\n";
  os << indent << "Photons: " << this->Photons << "\n";
  os << indent << "Power: " << this->Power << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
}
