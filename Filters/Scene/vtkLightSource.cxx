#include "vtkLightSource.h"

#include "Common/LightTransportData.h"
#include "Pieces/GuardedWork.h"
#include "Scene/LightShapes.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPolyData.h"

vtkLightSource::vtkLightSource(double x, double y, double z)
  : Position{ x, y, z }
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(2);
}

vtkLightSource::~vtkLightSource() = default;

int vtkLightSource::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  return tyndall::Guarded(this, outputs, [&] {
    tyndall::DrawnLight drawn = this->MakeLight();
    drawn.light.power = tyndall::Triple(this->Power);
    drawn.light.position = tyndall::Triple(this->Position);
    tyndall::Illumination illumination;
    illumination.lights = { drawn.light };
    tyndall::Check(illumination);
    tyndall::WriteLights(illumination.lights, vtkPolyData::GetData(outputs, 0));
    tyndall::DrawLights({ drawn }, vtkPolyData::GetData(outputs, 1));
  });
}

void vtkLightSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Power: " << this->Power[0] << " " << this->Power[1] << " " << this->Power[2] << "\n";
  os << indent << "Position: " << this->Position[0] << " " << this->Position[1] << " " << this->Position[2] << "\n";
}
