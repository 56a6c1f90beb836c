#include "vtkScatteringSolver.h"

#include "Common/LightTransportData.h"
#include "Propagation/LastOutputs.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"

vtkScatteringSolver::vtkScatteringSolver()
  : Solved(std::make_unique<tyndall::LastOutputs>())
{
  this->SetNumberOfInputPorts(UNCOLLIDED + 1);
  this->SetNumberOfOutputPorts(2);
}

vtkScatteringSolver::~vtkScatteringSolver() = default;

void vtkScatteringSolver::SetUncollidedLightConnection(vtkAlgorithmOutput* light)
{
  this->SetInputConnection(UNCOLLIDED, light);
}

void vtkScatteringSolver::SetUncollidedLightData(vtkDataObject* light)
{
  this->SetInputDataObject(UNCOLLIDED, light);
}

void vtkScatteringSolver::RemoveUncollidedLight()
{
  this->SetInputConnection(UNCOLLIDED, nullptr);
}

int vtkScatteringSolver::FillOutputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

tyndall::IlluminationInput vtkScatteringSolver::ReadShining(vtkInformationVector** inputs, bool emits)
{
  vtkImageData* const given = vtkImageData::GetData(inputs[UNCOLLIDED]);
  if (!given)
  {
    return this->ReadAllIllumination(inputs, emits);
  }
  tyndall::IlluminationInput input;
  input.uncollided = tyndall::ReadUncollided(given, tyndall::GridOf(vtkImageData::GetData(inputs[MEDIUM])));
  input.illumination.uncollided = input.uncollided.image;
  tyndall::AddFaceAlbedo(input.illumination, this->FaceAlbedo, this->FaceAlbedoColor);
  return input;
}

void vtkScatteringSolver::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Quality: " << this->Quality << "\n";
  os << indent << "Preview: " << this->Preview << "\n";
  os << indent << "SettingsUsed: " << this->SettingsUsed << "\n";
}
