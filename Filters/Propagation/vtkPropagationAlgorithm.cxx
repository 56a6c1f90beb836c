#include "vtkPropagationAlgorithm.h"

#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Light/LeftOut.h"
#include "LightPropagation/PropagationSettings.h"
#include "Scene/vtkLightRig.h"

#include "vtkImageData.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

#include <algorithm>

namespace
{
/// Whether all lights are directional, so that all light enters through the faces of the box.
bool OnlyFromFarAway(const tyndall::Illumination& illumination)
{
  return std::all_of(illumination.lights.begin(), illumination.lights.end(),
    [](const tyndall::Light& light) { return light.type == tyndall::LightType::Directional; });
}

/// Adds the default sky: an isotropic sky, and the default sun of vtkLightRig, because a white medium under an
/// isotropic sky alone looks uniform.
void AddDefaultSky(tyndall::Illumination& illumination, const tyndall::OwnAxes& axes)
{
  constexpr double radiance = 0.1; // W/(length^2 sr): irradiance pi 0.1, a third of the sun's, as of a clear sky
  vtkNew<vtkLightRig> untouched;
  untouched->Update();
  illumination.lights = tyndall::InOwnAxes(tyndall::ReadLights(untouched->GetOutput()), axes);
  illumination.sky.fill(radiance);
}
}

vtkPropagationAlgorithm::vtkPropagationAlgorithm()
{
  const tyndall::PropagationSettings defaults;
  this->Tolerance = defaults.tolerance;
  this->PeriodicX = defaults.periodic[0];
  this->PeriodicY = defaults.periodic[1];
  this->PeriodicZ = defaults.periodic[2];
}

vtkPropagationAlgorithm::~vtkPropagationAlgorithm() = default;

tyndall::IlluminationInput vtkPropagationAlgorithm::ReadAllIllumination(vtkInformationVector** inputs, bool emits)
{
  tyndall::IlluminationInput shining;
  tyndall::Illumination& illumination = shining.illumination;
  illumination = this->ReadIllumination(inputs);
  tyndall::AddDiffuse(illumination, this->SkyColor, this->FaceRadiance);
  tyndall::AddFaceAlbedo(illumination, this->FaceAlbedo, this->FaceAlbedoColor);
  const bool isConnected = vtkPolyData::GetData(inputs[LIGHTS]) || vtkImageData::GetData(inputs[ENVIRONMENT]);
  shining.isDefaultSky = this->DefaultSky && !isConnected && !emits && tyndall::NothingShines(illumination);
  if (shining.isDefaultSky)
  {
    AddDefaultSky(illumination, tyndall::OwnAxesOf(this));
  }
  return shining;
}

void vtkPropagationAlgorithm::TellOfDefaultSky(
  const tyndall::IlluminationInput& shining, std::vector<std::string>& leftOut)
{
  if (shining.isDefaultSky)
  {
    leftOut.insert(leftOut.begin(), tyndall::left_out::DefaultSky);
  }
}

void vtkPropagationAlgorithm::SetFaceAlbedoColor(const double values[18])
{
  tyndall::NoteProperty(this, "FaceAlbedoColor", values, 18, 0.0, 1.0);
  if (!std::equal(values, values + 18, this->FaceAlbedoColor))
  {
    std::copy_n(values, 18, this->FaceAlbedoColor);
    this->Modified();
  }
}

void vtkPropagationAlgorithm::WarnWhereDark(const tyndall::Illumination& illumination, bool emits)
{
  if (illumination.uncollided.IsThere())
  {
    return;
  }
  if (tyndall::NothingShines(illumination) && !emits)
  {
    vtkWarningMacro(
      "Nothing shines on the medium, so it is dark. Connect Lights or an Environment, or set SkyColor, or "
      "switch DefaultSky on.");
  }
  else if (this->PeriodicX && this->PeriodicY && this->PeriodicZ && !emits && OnlyFromFarAway(illumination))
  {
    vtkWarningMacro("With all three axes periodic the box has no face that light of the sky, an environment, faces or "
                    "a directional light could come in through, so it is dark. Leave one axis open.");
  }
}

void vtkPropagationAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(Device, Tolerance, PeriodicX, PeriodicY, PeriodicZ, FaceRadiance, FaceAlbedo, FaceAlbedoColor,
    SkyColor, DefaultSky, EstimateError);
}
