#include "vtkLitMediumAlgorithm.h"

#include "Common/ImageInput.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Lights/Lights.h"
#include "Pieces/UpdateExtent.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPolyData.h"

#include <utility>

vtkLitMediumAlgorithm::vtkLitMediumAlgorithm()
{
  this->SetNumberOfInputPorts(3);
}

vtkLitMediumAlgorithm::~vtkLitMediumAlgorithm() = default;

vtkImageData* vtkLitMediumAlgorithm::GetOutput()
{
  return vtkImageData::SafeDownCast(this->GetOutputDataObject(0));
}

int vtkLitMediumAlgorithm::FillInputPortInformation(int port, vtkInformation* information)
{
  if (port == LIGHTS)
  {
    information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  }
  else
  {
    tyndall::TakeImages(information);
  }
  if (port == ENVIRONMENT)
  {
    tyndall::TakePictures(information);
  }
  if (port == MEDIUM)
  {
    tyndall::ReadsVoxels(information, { "sigma_a", "sigma_s", "emission", "ior" }, { "g" });
  }
  else
  {
    if (port > ENVIRONMENT) // input port that a subclass adds for light of another filter
    {
      tyndall::ReadsVoxels(information, {}, { "fluence", "fluence_direct", "mean_direction" });
    }
    information->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkLitMediumAlgorithm::FillOutputPortInformation(int, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkImageData");
  return 1;
}

vtkTypeBool vtkLitMediumAlgorithm::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::WarnOfBlocks(this, request, inputs);
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

int vtkLitMediumAlgorithm::RequestInformation(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::TellVoxels(this, MEDIUM, inputs[MEDIUM], outputs);
  return 1;
}

int vtkLitMediumAlgorithm::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    tyndall::AskForAll(request, inputs[port], outputs);
  }
  return 1;
}

tyndall::Illumination vtkLitMediumAlgorithm::ReadIllumination(vtkInformationVector** inputs)
{
  tyndall::Illumination illumination;
  illumination.lights = tyndall::ReadLights(vtkPolyData::GetData(inputs[LIGHTS]));
  illumination.environment = tyndall::Turned(tyndall::ReadEnvironment(vtkImageData::GetData(inputs[ENVIRONMENT])),
    this->EnvironmentUp, this->EnvironmentAzimuth);
  return tyndall::InOwnAxes(std::move(illumination), tyndall::OwnAxesOf(this));
}

void vtkLitMediumAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(PointData, EnvironmentUp, EnvironmentAzimuth);
}
