#include "vtkLightRig.h"

#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Lights/Lights.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/UpdateExtent.h"
#include "Scene/LightShapes.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace
{
using tyndall::Light;
using tyndall::LightType;

constexpr double BallSize = 0.02; ///< of a point light, in ShapeSize

/// So that `direction` can be compared; a vector without length stays what it is.
std::array<double, 3> Normalized(const std::array<double, 3>& direction)
{
  Light along;
  along.direction = direction;
  return tyndall::DirectionOf(along);
}

Light SunLight(double elevation, double azimuth, const double power[3])
{
  const double up = vtkMath::RadiansFromDegrees(elevation);
  const double around = vtkMath::RadiansFromDegrees(azimuth);
  Light sun;
  sun.type = LightType::Directional;
  sun.direction = { -std::cos(up) * std::cos(around), -std::cos(up) * std::sin(around), -std::sin(up) };
  sun.power = { power[0], power[1], power[2] };
  return sun;
}

/// What defines a light, in the order of AddDirectionalLight, AddPointLight, ...
struct NumbersOfLight
{
  const char* Kind;
  std::size_t Count;
  const char* Names;
};

constexpr NumbersOfLight NumbersOfLights[] = {
  { "directional", 6, "dx, dy, dz, red, green, blue" },
  { "point", 6, "x, y, z, red, green, blue" },
  { "spot", 10, "x, y, z, dx, dy, dz, red, green, blue, angle" },
  { "rectangle", 11, "x, y, z, dx, dy, dz, red, green, blue, width, height" },
};
}

struct vtkLightRig::AddedLights
{
  std::vector<Light> Directional;
  std::vector<Light> Point;
  std::vector<Light> Spot;
  std::vector<Light> Rectangle;
  std::array<std::vector<double>, 4> Numbers; ///< of a light of each type that is not whole yet

  void Clear(LightTypes type, std::vector<Light>& lights)
  {
    lights.clear();
    this->Numbers[type].clear();
  }

  /// Calls add with the numbers of a light when they are all there.
  template <typename Add>
  void Take(LightTypes type, double number, const Add& add)
  {
    std::vector<double>& numbers = this->Numbers[type];
    numbers.push_back(number);
    if (numbers.size() == NumbersOfLights[type].Count)
    {
      add(numbers.data());
      numbers.clear();
    }
  }

  /// @throws InvalidInput where a light lacks numbers
  void CheckNumbers() const
  {
    for (std::size_t type = 0; type < this->Numbers.size(); ++type)
    {
      const std::size_t left = this->Numbers[type].size();
      if (left > 0)
      {
        const NumbersOfLight& needed = NumbersOfLights[type];
        throw tyndall::InvalidInput("The last " + std::string(needed.Kind) + " light has " + std::to_string(left) +
          (left == 1 ? " number" : " numbers") + "; a light of this kind takes " + std::to_string(needed.Count) + ": " +
          needed.Names + ".");
      }
    }
  }
};

vtkStandardNewMacro(vtkLightRig);

vtkLightRig::vtkLightRig()
  : Added(new AddedLights)
{
  this->SetNumberOfInputPorts(1);
  this->SetNumberOfOutputPorts(2);
}

vtkLightRig::~vtkLightRig() = default;

void vtkLightRig::AddDirectionalLight(double dx, double dy, double dz, double r, double g, double b)
{
  Light light;
  light.type = LightType::Directional;
  light.direction = Normalized({ dx, dy, dz });
  light.power = { r, g, b };
  this->Added->Directional.push_back(light);
  this->Modified();
}

void vtkLightRig::AddPointLight(double x, double y, double z, double r, double g, double b)
{
  Light light;
  light.type = LightType::Point;
  light.position = { x, y, z };
  light.direction = { 0.0, 0.0, 0.0 };
  light.power = { r, g, b };
  this->Added->Point.push_back(light);
  this->Modified();
}

void vtkLightRig::AddSpotLight(
  double x, double y, double z, double dx, double dy, double dz, double r, double g, double b, double angle)
{
  Light light;
  light.type = LightType::Spot;
  light.position = { x, y, z };
  light.direction = Normalized({ dx, dy, dz });
  light.power = { r, g, b };
  light.angle = angle;
  this->Added->Spot.push_back(light);
  this->Modified();
}

void vtkLightRig::AddRectangleLight(double x, double y, double z, double dx, double dy, double dz, double r, double g,
  double b, double width, double height)
{
  Light light;
  light.type = LightType::Rectangle;
  light.position = { x, y, z };
  light.direction = Normalized({ dx, dy, dz });
  light.power = { r, g, b };
  light.size = { width, height };
  this->Added->Rectangle.push_back(light);
  this->Modified();
}

void vtkLightRig::AddDirectionalLightNumber(double number)
{
  this->Added->Take(
    DIRECTIONAL, number, [&](const double* n) { this->AddDirectionalLight(n[0], n[1], n[2], n[3], n[4], n[5]); });
  this->Modified();
}

void vtkLightRig::AddPointLightNumber(double number)
{
  this->Added->Take(POINT, number, [&](const double* n) { this->AddPointLight(n[0], n[1], n[2], n[3], n[4], n[5]); });
  this->Modified();
}

void vtkLightRig::AddSpotLightNumber(double number)
{
  this->Added->Take(SPOT, number,
    [&](const double* n) { this->AddSpotLight(n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9]); });
  this->Modified();
}

void vtkLightRig::AddRectangleLightNumber(double number)
{
  this->Added->Take(RECTANGLE, number, [&](const double* n) {
    this->AddRectangleLight(n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9], n[10]);
  });
  this->Modified();
}

void vtkLightRig::RemoveAllDirectionalLights()
{
  this->Added->Clear(DIRECTIONAL, this->Added->Directional);
  this->Modified();
}

void vtkLightRig::RemoveAllPointLights()
{
  this->Added->Clear(POINT, this->Added->Point);
  this->Modified();
}

void vtkLightRig::RemoveAllSpotLights()
{
  this->Added->Clear(SPOT, this->Added->Spot);
  this->Modified();
}

void vtkLightRig::RemoveAllRectangleLights()
{
  this->Added->Clear(RECTANGLE, this->Added->Rectangle);
  this->Modified();
}

void vtkLightRig::RemoveAllLights()
{
  *this->Added = AddedLights();
  this->Modified();
}

int vtkLightRig::GetNumberOfDirectionalLights() const
{
  return static_cast<int>(this->Added->Directional.size());
}

int vtkLightRig::GetNumberOfPointLights() const
{
  return static_cast<int>(this->Added->Point.size());
}

int vtkLightRig::GetNumberOfSpotLights() const
{
  return static_cast<int>(this->Added->Spot.size());
}

int vtkLightRig::GetNumberOfRectangleLights() const
{
  return static_cast<int>(this->Added->Rectangle.size());
}

int vtkLightRig::FillInputPortInformation(int, vtkInformation* information)
{
  information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  information->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  information->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  return 1;
}

int vtkLightRig::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::AskForAll(request, inputs[0], outputs); // every rank has every light
  return 1;
}

int vtkLightRig::RequestData(vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  return tyndall::Guarded(this, request, given, outputs, [&](vtkInformationVector** inputs) {
    this->Added->CheckNumbers();
    std::vector<Light> lights;
    if (this->Sun)
    {
      lights.push_back(SunLight(this->SunElevation, this->SunAzimuth, this->SunPower));
    }
    for (const auto* kind :
      { &this->Added->Directional, &this->Added->Point, &this->Added->Spot, &this->Added->Rectangle })
    {
      lights.insert(lights.end(), kind->begin(), kind->end());
    }
    tyndall::Illumination own;
    own.lights = lights;
    tyndall::Check(own);
    for (int i = 0; i < inputs[0]->GetNumberOfInformationObjects(); ++i)
    {
      const std::vector<Light> given = tyndall::ReadLights(vtkPolyData::GetData(inputs[0], i));
      lights.insert(lights.end(), given.begin(), given.end());
    }
    tyndall::WriteLights(lights, vtkPolyData::GetData(outputs, 0));
    this->DrawOwn(own.lights, vtkPolyData::GetData(outputs, 1));
  });
}

void vtkLightRig::DrawOwn(const std::vector<Light>& lights, vtkPolyData* shapes) const
{
  std::vector<tyndall::DrawnLight> drawn;
  for (const Light& light : lights)
  {
    drawn.push_back({ light, this->ShapeSize });
    if (light.type == LightType::Directional)
    {
      drawn.back().length *= 0.5;
      for (int axis = 0; axis < 3; ++axis)
      {
        drawn.back().light.position[axis] = this->ShapeCenter[axis] - this->ShapeSize * light.direction[axis];
      }
    }
    else if (light.type == LightType::Point)
    {
      drawn.back().length *= BallSize;
    }
  }
  tyndall::DrawLights(drawn, shapes);
}

void vtkLightRig::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Sun: " << (this->Sun ? "on" : "off") << "\n";
  tyndallPrintMacro(SunElevation, SunAzimuth, SunPower, ShapeCenter, ShapeSize);
  os << indent << "Directional lights: " << this->GetNumberOfDirectionalLights() << "\n";
  os << indent << "Point lights: " << this->GetNumberOfPointLights() << "\n";
  os << indent << "Spot lights: " << this->GetNumberOfSpotLights() << "\n";
  os << indent << "Rectangle lights: " << this->GetNumberOfRectangleLights() << "\n";
}
