#include "vtkRectangleLight.h"

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
  tyndall::DrawnLight drawn = this->Superclass::MakeLight();
  drawn.light.type = tyndall::LightType::Rectangle;
  drawn.light.size = { this->Size[0], this->Size[1] };
  return drawn;
}

void vtkRectangleLight::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Size: " << this->Size[0] << " " << this->Size[1] << "\n";
}
