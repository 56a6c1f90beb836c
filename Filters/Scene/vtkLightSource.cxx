#include "vtkLightSource.h"

#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Device/Errors.h"
#include "Pieces/GuardedWork.h"
#include "Scene/LightShapes.h"

#include "vtkAimedLight.h"
#include "vtkPointLight.h"
#include "vtkRectangleLight.h"
#include "vtkSpotLight.h"
#include "vtkSun.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <cmath>

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
  tyndallPrintMacro(Power, Position);
}

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
  tyndallPrintMacro(FocalPoint);
}

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
  tyndallPrintMacro(ShapeSize);
}

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
  tyndallPrintMacro(Angle);
}

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
  tyndallPrintMacro(Direction, Size);
}
