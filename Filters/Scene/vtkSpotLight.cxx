#include "vtkSpotLight.h"

#include "Scene/LightShapes.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSpotLight);

vtkSpotLight::vtkSpotLight()
  : Superclass(0.5, -0.5, 0.5)
{
}

vtkSpotLight::~vtkSpotLight() = default;

tyndall::DrawnLight vtkSpotLight::MakeLight() const
{
  tyndall::DrawnLight drawn = this->Superclass::MakeLight();
  drawn.light.type = tyndall::LightType::Spot;
  drawn.light.angle = this->Angle;
  return drawn;
}

void vtkSpotLight::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Angle: " << this->Angle << "\n";
}
