#include "vtkLitImageAlgorithm.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"

vtkLitImageAlgorithm::vtkLitImageAlgorithm() = default;

vtkLitImageAlgorithm::~vtkLitImageAlgorithm() = default;

vtkImageData* vtkLitImageAlgorithm::GetOutput()
{
  return vtkImageData::SafeDownCast(this->GetOutputDataObject(0));
}

int vtkLitImageAlgorithm::FillOutputPortInformation(int, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkImageData");
  return 1;
}

void vtkLitImageAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Device: " << this->Device << "\n";
}
