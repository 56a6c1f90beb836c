#include "vtkAimedLight.h"

#include "Device/Errors.h"
#include "Scene/LightShapes.h"

#include "vtkMath.h"

#include <cmath>

vtkAimedLight::~vtkAimedLight() = default;

tyndall::DrawnLight vtkAimedLight::MakeLight() const
{
  tyndall::DrawnLight drawn;
  double* const direction = drawn.light.direction.data();
  vtkMath::Subtract(this->FocalPoint, this->Position, direction);
  drawn.length = std::hypot(direction[0], direction[1], direction[2]);
  drawn.light.direction = tyndall::DirectionOf(drawn.light);
  if (!(drawn.length > 0.0))
  {
    throw tyndall::InvalidInput(
      "Position and FocalPoint are the same place; the light shines from the first towards the second: move one.");
  }
  return drawn;
}

void vtkAimedLight::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FocalPoint: " << this->FocalPoint[0] << " " << this->FocalPoint[1] << " " << this->FocalPoint[2]
     << "\n";
}
