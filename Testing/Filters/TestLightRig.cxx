#include "TestSupport.h"

#include "vtkDataArray.h"
#include "vtkLightRig.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <cmath>
#include <limits>

namespace
{
double Value(vtkLightRig* rig, const char* array, vtkIdType light, int component)
{
  vtkDataArray* values = rig->GetOutput()->GetPointData()->GetArray(array);
  return values ? values->GetComponent(light, component) : std::numeric_limits<double>::quiet_NaN();
}

void UntouchedIsOneSun(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  rig->Update();
  claims.That(rig->GetOutput()->GetNumberOfPoints() == 1, "an untouched rig has one light");
  claims.That(rig->GetOutput()->GetNumberOfVerts() == 1, "it is a vertex");
  claims.Near(Value(rig, "light_type", 0, 0), vtkLightRig::DIRECTIONAL, 0.0, "its type");
  const double travels[3] = { 0.5, 0.5, -std::sqrt(0.5) };
  for (int axis = 0; axis < 3; ++axis)
  {
    claims.Near(Value(rig, "direction", 0, axis), travels[axis], 1e-15, "its direction");
    claims.Near(Value(rig, "power", 0, axis), 1.0, 0.0, "its power");
  }
  rig->SetSunElevation(90.0);
  rig->Update();
  claims.Near(Value(rig, "direction", 0, 2), -1.0, 0.0, "overhead, the sun's light travels down");
}

void EachKindIsARow(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  rig->SunOff();
  rig->AddRectangleLight(1, 2, 3, 0, 0, -5, 4, 5, 6, 7, 8);
  rig->AddSpotLight(1, 2, 3, 0, 2, 0, 4, 5, 6, 30);
  rig->AddPointLight(1, 2, 3, 4, 5, 6);
  rig->AddDirectionalLight(-3, 0, 0, 4, 5, 6);
  rig->Update();
  claims.That(rig->GetOutput()->GetNumberOfPoints() == 4, "four lights were added");
  for (int kind = 0; kind < 4; ++kind)
  {
    claims.Near(Value(rig, "light_type", kind, 0), kind, 0.0, "type of a light");
    claims.Near(Value(rig, "power", kind, 2), 6.0, 0.0, "blue power of a light");
  }
  claims.Near(Value(rig, "direction", vtkLightRig::DIRECTIONAL, 0), -1.0, 0.0, "direction is a unit vector");
  claims.Near(Value(rig, "direction", vtkLightRig::SPOT, 1), 1.0, 0.0, "direction is a unit vector");
  for (double length : { 1e-300, 1e-165, 1e160 })
  {
    vtkNew<vtkLightRig> extreme;
    extreme->SunOff();
    extreme->AddDirectionalLight(0.6 * length, 0, -0.8 * length, 4, 5, 6);
    extreme->Update();
    claims.Near(Value(extreme, "direction", 0, 2), -0.8, 1e-15, "direction is a unit vector, whatever was its length");
  }
  claims.Near(Value(rig, "angle", vtkLightRig::SPOT, 0), 30.0, 0.0, "angle of the spot");
  claims.Near(Value(rig, "size", vtkLightRig::RECTANGLE, 1), 8.0, 0.0, "height of the rectangle");
  claims.Near(rig->GetOutput()->GetPoint(vtkLightRig::POINT)[2], 3.0, 0.0, "height of the point light");

  for (int number = 1; number <= 11; ++number)
  {
    rig->AddRectangleLightNumber(number == 4 || number == 5 ? 0 : number);
  }
  rig->Update();
  claims.That(rig->GetOutput()->GetNumberOfPoints() == 5, "a light was added number by number");
  claims.Near(Value(rig, "size", 4, 1), 11.0, 0.0, "its last number");
  claims.Near(Value(rig, "power", 4, 0), 7.0, 0.0, "its seventh");
  rig->RemoveAllRectangleLights();
  rig->AddRectangleLight(1, 2, 3, 0, 0, -5, 4, 5, 6, 7, 8);

  rig->RemoveAllPointLights();
  rig->Update();
  claims.That(rig->GetOutput()->GetNumberOfPoints() == 3, "the point light was removed");
  rig->RemoveAllLights();
  rig->Update();
  claims.That(rig->GetOutput()->GetNumberOfPoints() == 0, "no light is left");
}

void BadLightsAreErrors(test::Claims& claims)
{
  vtkNew<vtkLightRig> rig;
  test::Errors errors(rig);
  const double nan = std::numeric_limits<double>::quiet_NaN();

  const auto refused = [&](const char* part, const char* claim) {
    rig->Update();
    claims.That(errors.WasOneWith(part), claim);
    claims.That(rig->GetOutput()->GetNumberOfPoints() == 0, "the output is empty after an error");
    rig->RemoveAllLights();
    rig->SetSunPower(1, 1, 1);
  };

  rig->AddDirectionalLight(0, 0, 0, 1, 1, 1);
  refused("Light 1 has direction (0, 0, 0)", "a light without direction is refused");
  rig->AddPointLight(nan, 0, 0, 1, 1, 1);
  refused("not finite", "a light nowhere is refused");
  rig->AddPointLight(0, 0, 0, 1, -1, 1);
  refused("power", "a light that takes power is refused");
  rig->SetSunPower(std::numeric_limits<double>::infinity(), 1, 1);
  refused("SunPower is (inf, 1, 1)", "an infinite sun is refused");
  rig->AddSpotLight(0, 0, 0, 0, 0, 1, 1, 1, 1, 0);
  refused("angle", "a closed spot is refused");
  rig->AddRectangleLight(0, 0, 0, 0, 0, 1, 1, 1, 1, 0, 1);
  refused("size", "a rectangle without width is refused");

  for (double number : { 0.0, 0.0, 0.0, 5.0, 5.0 })
  {
    rig->AddPointLightNumber(number);
  }
  refused("The last point light has 5 numbers; a light of this kind takes 6: x, y, z, red, green, blue",
    "a light that lacks a number is refused");

  rig->Update();
  claims.That(errors.None(), "a good rig after a bad one has no error");
  claims.That(rig->GetOutput()->GetNumberOfPoints() == 1, "the sun is back");
}
}

int TestLightRig(int, char*[])
{
  test::Claims claims;
  UntouchedIsOneSun(claims);
  EachKindIsARow(claims);
  BadLightsAreErrors(claims);
  return claims.Result();
}
