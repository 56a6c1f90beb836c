#include "vtkPropagationAlgorithm.h"

#include "Common/LightTransportData.h"
#include "LightPropagation/PropagationSettings.h"

vtkPropagationAlgorithm::vtkPropagationAlgorithm()
{
  const tyndall::PropagationSettings defaults;
  this->Tolerance = defaults.tolerance;
  this->PeriodicX = defaults.periodic[0];
  this->PeriodicY = defaults.periodic[1];
  this->PeriodicZ = defaults.periodic[2];
}

vtkPropagationAlgorithm::~vtkPropagationAlgorithm() = default;

tyndall::Illumination vtkPropagationAlgorithm::ReadAllIllumination(vtkInformationVector** inputs)
{
  tyndall::Illumination illumination = this->ReadIllumination(inputs);
  tyndall::AddDiffuse(illumination, this->SkyColor, this->FaceRadiance);
  return illumination;
}

void vtkPropagationAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "PeriodicX: " << this->PeriodicX << "\n";
  os << indent << "PeriodicY: " << this->PeriodicY << "\n";
  os << indent << "PeriodicZ: " << this->PeriodicZ << "\n";
  PrintNumbers(os, indent, "FaceRadiance", this->FaceRadiance, 6);
  PrintNumbers(os, indent, "SkyColor", this->SkyColor, 3);
  os << indent << "EstimateError: " << this->EstimateError << "\n";
}
