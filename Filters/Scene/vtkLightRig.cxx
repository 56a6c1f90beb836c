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

namespace
{
using tyndall::Light;
using tyndall::LightType;

constexpr double BallSize = 0.02; ///< radius of a point light's ball, relative to ShapeSize

/// Normalises a direction, so that values of the array `direction` can be compared; (0, 0, 0) stays (0, 0, 0).
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

/// A type of light: its name, and number and names of the arguments of the method that adds it, such as AddPointLight.
/// Used by methods that take one of these arguments per call, such as AddPointLightNumber, and by their error messages.
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

/// Makes a light of a type from the arguments of the method that adds it.
/// @param type  one of LightTypes
/// @param numbers  arguments in the order of NumbersOfLights
Light LightOf(int type, const double* numbers)
{
  const auto next = [&numbers] {
    numbers += 3;
    return tyndall::Triple(numbers - 3);
  };
  Light light;
  light.type = static_cast<LightType>(type);
  if (light.type != LightType::Directional)
  {
    light.position = next();
  }
  light.direction = light.type == LightType::Point ? std::array<double, 3>{} : Normalized(next());
  light.power = next();
  if (light.type == LightType::Spot)
  {
    light.angle = numbers[0];
  }
  else if (light.type == LightType::Rectangle)
  {
    light.size = { numbers[0], numbers[1] };
  }
  return light;
}
}

struct vtkLightRig::AddedLights
{
  std::array<std::vector<Light>, 4> Lights;   ///< complete lights by type
  std::array<std::vector<double>, 4> Numbers; ///< arguments given so far of an incomplete light, by type

  /// Takes the next argument of a light of this type; the last argument completes the light.
  void Add(int type, double number)
  {
    std::vector<double>& numbers = this->Numbers[type];
    numbers.push_back(number);
    if (numbers.size() == NumbersOfLights[type].Count)
    {
      this->Lights[type].push_back(LightOf(type, numbers.data()));
      numbers.clear();
    }
  }

  /// Checks that no light is incomplete.
  /// @throws InvalidInput if a light lacks arguments
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
  const double numbers[] = { dx, dy, dz, r, g, b };
  this->Added->Lights[DIRECTIONAL].push_back(LightOf(DIRECTIONAL, numbers));
  this->Modified();
}

void vtkLightRig::AddPointLight(double x, double y, double z, double r, double g, double b)
{
  const double numbers[] = { x, y, z, r, g, b };
  this->Added->Lights[POINT].push_back(LightOf(POINT, numbers));
  this->Modified();
}

void vtkLightRig::AddSpotLight(
  double x, double y, double z, double dx, double dy, double dz, double r, double g, double b, double angle)
{
  const double numbers[] = { x, y, z, dx, dy, dz, r, g, b, angle };
  this->Added->Lights[SPOT].push_back(LightOf(SPOT, numbers));
  this->Modified();
}

void vtkLightRig::AddRectangleLight(double x, double y, double z, double dx, double dy, double dz, double r, double g,
  double b, double width, double height)
{
  const double numbers[] = { x, y, z, dx, dy, dz, r, g, b, width, height };
  this->Added->Lights[RECTANGLE].push_back(LightOf(RECTANGLE, numbers));
  this->Modified();
}

#define LIGHTS_OF_TYPE(Kind, TYPE)                             \
  void vtkLightRig::Add##Kind##LightNumber(double number)      \
  {                                                            \
    this->Added->Add(TYPE, number);                            \
    this->Modified();                                          \
  }                                                            \
  void vtkLightRig::RemoveAll##Kind##Lights()                  \
  {                                                            \
    this->Added->Lights[TYPE].clear();                         \
    this->Added->Numbers[TYPE].clear();                        \
    this->Modified();                                          \
  }                                                            \
  int vtkLightRig::GetNumberOf##Kind##Lights() const           \
  {                                                            \
    return static_cast<int>(this->Added->Lights[TYPE].size()); \
  }
LIGHTS_OF_TYPE(Directional, DIRECTIONAL)
LIGHTS_OF_TYPE(Point, POINT)
LIGHTS_OF_TYPE(Spot, SPOT)
LIGHTS_OF_TYPE(Rectangle, RECTANGLE)
#undef LIGHTS_OF_TYPE

void vtkLightRig::RemoveAllLights()
{
  *this->Added = AddedLights();
  this->Modified();
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
  tyndall::AskForAll(request, inputs[0], outputs); // every rank reads all lights
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
    for (const std::vector<Light>& ofType : this->Added->Lights)
    {
      lights.insert(lights.end(), ofType.begin(), ofType.end());
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
