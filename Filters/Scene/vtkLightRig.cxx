#include "vtkLightRig.h"

#include "Common/LightTransportData.h"
#include "Lights/Lights.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace
{
using tyndall::Light;
using tyndall::LightType;

/// Unit vector, so that `direction` can be compared; a vector without length stays what it is.
std::array<double, 3> Normalized(std::array<double, 3> direction)
{
  vtkMath::Normalize(direction.data());
  return direction;
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

vtkNew<vtkDoubleArray> MakeArray(const char* name, std::initializer_list<const char*> components, std::size_t tuples)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(static_cast<int>(components.size()));
  array->SetNumberOfTuples(static_cast<vtkIdType>(tuples));
  int component = 0;
  for (const char* componentName : components)
  {
    if (componentName[0] != '\0')
    {
      array->SetComponentName(component, componentName);
    }
    ++component;
  }
  return array;
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

void Pack(const std::vector<Light>& lights, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  vtkNew<vtkUnsignedCharArray> type;
  type->SetName("light_type");
  type->SetNumberOfTuples(static_cast<vtkIdType>(lights.size()));
  const auto direction = MakeArray("direction", { "X", "Y", "Z" }, lights.size());
  const auto power = MakeArray("power", { "R", "G", "B" }, lights.size());
  const auto size = MakeArray("size", { "width", "height" }, lights.size());
  const auto angle = MakeArray("angle", { "" }, lights.size());

  for (const Light& light : lights)
  {
    const vtkIdType id = points->InsertNextPoint(light.position.data());
    vertices->InsertNextCell(1, &id);
    type->SetValue(id, static_cast<unsigned char>(light.type));
    direction->SetTuple(id, light.direction.data());
    power->SetTuple(id, light.power.data());
    size->SetTuple(id, light.size.data());
    angle->SetValue(id, light.angle);
  }

  output->SetPoints(points);
  output->SetVerts(vertices);
  for (vtkDataArray* array : std::initializer_list<vtkDataArray*>{ type, direction, power, size, angle })
  {
    output->GetPointData()->AddArray(array);
  }
}
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
  this->SetNumberOfInputPorts(0);
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

int vtkLightRig::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  return tyndall::Guarded(this, outputVector, [&] {
    this->Added->CheckNumbers();
    tyndall::Illumination illumination;
    if (this->Sun)
    {
      illumination.lights.push_back(SunLight(this->SunElevation, this->SunAzimuth, this->SunPower));
    }
    for (const auto* kind :
      { &this->Added->Directional, &this->Added->Point, &this->Added->Spot, &this->Added->Rectangle })
    {
      illumination.lights.insert(illumination.lights.end(), kind->begin(), kind->end());
    }
    tyndall::Check(illumination);
    Pack(illumination.lights, vtkPolyData::GetData(outputVector));
  });
}

void vtkLightRig::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Sun: " << (this->Sun ? "on" : "off") << "\n";
  os << indent << "SunElevation: " << this->SunElevation << "\n";
  os << indent << "SunAzimuth: " << this->SunAzimuth << "\n";
  os << indent << "SunPower: " << this->SunPower[0] << " " << this->SunPower[1] << " " << this->SunPower[2] << "\n";
  os << indent << "Directional lights: " << this->GetNumberOfDirectionalLights() << "\n";
  os << indent << "Point lights: " << this->GetNumberOfPointLights() << "\n";
  os << indent << "Spot lights: " << this->GetNumberOfSpotLights() << "\n";
  os << indent << "Rectangle lights: " << this->GetNumberOfRectangleLights() << "\n";
}
