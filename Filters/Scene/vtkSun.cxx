#include "vtkSun.h"

#include "Scene/LightShapes.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSun);

vtkSun::vtkSun()
  : Superclass(-0.5, -0.5, 0.7071)
{
}

vtkSun::~vtkSun() = default;

tyndall::DrawnLight vtkSun::MakeLight() const
{
  tyndall::DrawnLight drawn = this->Superclass::MakeLight();
  drawn.light.type = tyndall::LightType::Directional;
  drawn.length *= 0.5;
  return drawn;
}
