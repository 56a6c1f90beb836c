#include "vtkRectangleLight.h"

#include "Common/LightTransportData.h"
#include "Scene/LightShapes.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkRectangleLight);

vtkRectangleLight::vtkRectangleLight()
  : Superclass(-0.5, 0.0, 0.5)
{
}

vtkRectangleLight::~vtkRectangleLight() = default;

tyndall::DrawnLight vtkRectangleLight::MakeLight() const
{
  tyndall::DrawnLight drawn;
  drawn.light.type = tyndall::LightType::Rectangle;
  drawn.light.direction = tyndall::Triple(this->Direction);
  drawn.light.direction = tyndall::DirectionOf(drawn.light);
  drawn.light.size = { this->Size[0], this->Size[1] };
  return drawn;
}

void vtkRectangleLight::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Direction: " << this->Direction[0] << " " << this->Direction[1] << " " << this->Direction[2] << "\n";
  os << indent << "Size: " << this->Size[0] << " " << this->Size[1] << "\n";
}
