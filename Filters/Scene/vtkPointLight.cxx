#include "vtkPointLight.h"

#include "Scene/LightShapes.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPointLight);

vtkPointLight::vtkPointLight()
  : Superclass(0.0, 0.0, 0.7)
{
}

vtkPointLight::~vtkPointLight() = default;

tyndall::DrawnLight vtkPointLight::MakeLight() const
{
  tyndall::DrawnLight drawn;
  drawn.light.type = tyndall::LightType::Point;
  drawn.light.direction = { 0.0, 0.0, 0.0 };
  drawn.length = this->ShapeSize;
  return drawn;
}

void vtkPointLight::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ShapeSize: " << this->ShapeSize << "\n";
}
