#include "VolumeLight.h"

#include "Common/LightTransportWriting.h"
#include "Lights/Lights.h"
#include "Numerics/Constants.h"

#include "vtkAlgorithmOutput.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkLightPropagationMaps.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkParticipatingMedium.h"
#include "vtkPolyData.h"
#include "vtkRenderer.h"
#include "vtkTrivialProducer.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tyndall
{
namespace
{
using Place = std::array<double, 3>;

/// A position of the world in the coordinates of a volume.
Place Within(vtkMatrix4x4* toVolume, const double* position)
{
  const double world[4] = { position[0], position[1], position[2], 1.0 };
  double within[4];
  toVolume->MultiplyPoint(world, within);
  return { within[0] / within[3], within[1] / within[3], within[2] / within[3] };
}

Light LightOf(vtkLight* light, vtkMatrix4x4* toVolume, const double centre[3])
{
  double position[3], focus[3];
  light->GetTransformedPosition(position);
  light->GetTransformedFocalPoint(focus);
  Light made;
  made.position = Within(toVolume, position);
  const Place aim = Within(toVolume, focus);
  double factor = Pi * light->GetIntensity();
  for (int axis = 0; axis < 3; ++axis)
  {
    made.direction[axis] = aim[axis] - made.position[axis];
  }
  if (light->GetPositional())
  {
    const double half = std::min(light->GetConeAngle(), 90.0) * Pi / 180.0;
    const bool isSpot = light->GetConeAngle() < 90.0;
    const double solidAngle = isSpot ? 2.0 * Pi * (1.0 - std::cos(half)) : 4.0 * Pi;
    const double distance = std::sqrt(vtkMath::Distance2BetweenPoints(made.position.data(), centre));
    const double* const attenuation = light->GetAttenuationValues();
    factor *= solidAngle * distance * distance /
      (attenuation[0] + attenuation[1] * distance + attenuation[2] * distance * distance);
    made.type = isSpot ? LightType::Spot : LightType::Point;
    made.angle = 2.0 * light->GetConeAngle();
  }
  for (int c = 0; c < 3; ++c)
  {
    made.power[c] = factor * light->GetDiffuseColor()[c];
  }
  return made;
}

std::vector<double> NumbersOf(const std::vector<Light>& lights)
{
  std::vector<double> numbers;
  for (const Light& light : lights)
  {
    numbers.push_back(static_cast<double>(light.type));
    numbers.push_back(light.angle);
    for (const Place& vector : { light.position, light.direction, light.power })
    {
      numbers.insert(numbers.end(), vector.begin(), vector.end());
    }
  }
  return numbers;
}

/// The lights of a renderer that shine.
std::vector<vtkLight*> ShiningLights(vtkRenderer* renderer)
{
  std::vector<vtkLight*> shining;
  vtkCollectionSimpleIterator at;
  vtkLightCollection* const all = renderer->GetLights();
  all->InitTraversal(at);
  while (vtkLight* const light = all->GetNextLight(at))
  {
    if (light->GetSwitch() && light->GetIntensity() > 0.0)
    {
      shining.push_back(light);
    }
  }
  return shining;
}

/// What a moving camera does not change: the properties of lights, and the place of the volume.
std::vector<double> SettingsOf(const RendererLights& lights)
{
  std::vector<double> settings(lights.place->GetData(), lights.place->GetData() + 16);
  for (vtkLight* const light : ShiningLights(lights.renderer))
  {
    settings.insert(settings.end(),
      { 1.0 * light->GetLightType(), 1.0 * light->GetPositional(), light->GetIntensity(), light->GetConeAngle() });
    settings.insert(settings.end(), light->GetDiffuseColor(), light->GetDiffuseColor() + 3);
    settings.insert(settings.end(), light->GetAttenuationValues(), light->GetAttenuationValues() + 3);
    if (!light->LightTypeIsHeadlight()) // which the renderer moves with its camera
    {
      settings.insert(settings.end(), light->GetPosition(), light->GetPosition() + 3);
      settings.insert(settings.end(), light->GetFocalPoint(), light->GetFocalPoint() + 3);
    }
  }
  return settings;
}
}

VolumeLight::VolumeLight()
{
  this->Medium->UseTransferFunctionsOn();
  this->Solver->SetInputConnection(this->Medium->GetOutputPort());
  this->Solver->SetLightsConnection(this->Lights->GetOutputPort());
}

VolumeLight::~VolumeLight() = default;

vtkAlgorithmOutput* VolumeLight::GetLights()
{
  return this->Lights->GetOutputPort();
}

void VolumeLight::PlaceLights(const RendererLights& lights)
{
  std::vector<double> settings = SettingsOf(lights);
  if (!lights.followCamera && settings == this->LightSettings)
  {
    return;
  }
  this->LightSettings = std::move(settings);
  vtkNew<vtkMatrix4x4> toVolume;
  vtkMatrix4x4::Invert(lights.place, toVolume);
  std::vector<Light> placed;
  for (vtkLight* const light : ShiningLights(lights.renderer))
  {
    placed.push_back(LightOf(light, toVolume, lights.centre));
  }
  std::vector<double> numbers = NumbersOf(placed);
  if (!this->Lights->GetOutputDataObject(0) || numbers != this->LightsInNumbers)
  {
    vtkNew<vtkPolyData> written;
    WriteLights(placed, written);
    this->Lights->SetOutput(written);
    this->LightsInNumbers = std::move(numbers);
  }
}

vtkAlgorithmOutput* VolumeLight::Update(
  vtkAlgorithmOutput* scalars, vtkVolumeProperty* property, const RendererLights& lights, bool isStill)
{
  if (this->Solved->GetOutputDataObject(0) && !isStill)
  {
    return this->Solved->GetOutputPort();
  }
  this->Medium->SetInputConnection(scalars);
  this->Medium->SetVolumeProperty(property);
  this->PlaceLights(lights);
  this->Solver->Update();
  vtkImageData* const solved = this->Solver->GetOutput();
  if (!this->Solved->GetOutputDataObject(0) || solved->GetMTime() > this->SolvedTime)
  {
    vtkNew<vtkImageData> kept;
    kept->ShallowCopy(solved);
    this->Solved->SetOutput(kept);
    this->SolvedTime.Modified();
  }
  return this->Solved->GetOutputPort();
}
}
