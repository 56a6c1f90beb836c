#include "vtkMediumRayCaster.h"

#include "Device/Device.h"
#include "LightTransportData.h"
#include "Viewing/MediumRayCaster.h"
#include "Viewing/ToneMapping.h"
#include "WholeImage.h"

#include "vtkDataObject.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace
{
enum LightArray
{
  Fluence = 3, ///< after tyndall::MediumArray
  FluenceDirect = 4,
};

tyndall::Rgb ToRgb(const double* values)
{
  return { values[0], values[1], values[2] };
}

tyndall::ViewSettings SettingsOf(vtkMediumRayCaster* filter)
{
  tyndall::ViewSettings settings;
  std::copy_n(filter->GetImageSize(), 2, settings.imageSize.begin());
  settings.stepSize = filter->GetStepSize();
  settings.singleScatteringOnly = filter->GetSingleScatteringOnly();
  settings.shadowRays = filter->GetShadowRays();
  settings.rectangleSamples = filter->GetRectangleSamples();
  settings.showBackground = filter->GetShowBackground();
  settings.backgroundColor = ToRgb(filter->GetBackgroundColor());
  return settings;
}

tyndall::Camera CameraOf(vtkMediumRayCaster* filter, const tyndall::Grid& grid)
{
  tyndall::Camera camera;
  camera.position = ToRgb(filter->GetCameraPosition());
  camera.focalPoint = ToRgb(filter->GetCameraFocalPoint());
  camera.viewUp = ToRgb(filter->GetCameraViewUp());
  camera.viewAngle = filter->GetCameraViewAngle();
  camera.parallelScale = filter->GetCameraParallelScale();
  if (camera.position == camera.focalPoint)
  {
    const double aspect = static_cast<double>(filter->GetImageSize()[0]) / filter->GetImageSize()[1];
    camera =
      tyndall::FrameGrid(grid, aspect, camera.viewAngle, tyndall::ThreeQuarterView(camera.viewUp), camera.viewUp);
  }
  camera.parallelProjection = filter->GetCameraParallelProjection();
  return camera;
}

template <class Array, class Value>
vtkSmartPointer<Array> PixelArray(const char* name, const std::vector<Value>& values, int components)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

void WritePicture(const tyndall::Picture& picture, const std::vector<std::uint8_t>& color, vtkImageData* output)
{
  output->SetExtent(0, picture.width - 1, 0, picture.height - 1, 0, 0);
  output->SetOrigin(0.0, 0.0, 0.0);
  output->SetSpacing(1.0, 1.0, 1.0);
  vtkPointData* pixels = output->GetPointData();
  pixels->SetScalars(PixelArray<vtkUnsignedCharArray>("color", color, 4));
  pixels->AddArray(PixelArray<vtkFloatArray>("radiance", picture.radiance, 3));
  pixels->AddArray(PixelArray<vtkFloatArray>("alpha", picture.alpha, 1));
  pixels->AddArray(PixelArray<vtkFloatArray>("depth", picture.depth, 1));
}
}

vtkStandardNewMacro(vtkMediumRayCaster);

vtkMediumRayCaster::vtkMediumRayCaster() = default;

vtkMediumRayCaster::~vtkMediumRayCaster() = default;

int vtkMediumRayCaster::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkInformation* information = outputs->GetInformationObject(0);
  const int extent[6] = { 0, std::max(this->ImageSize[0], 1) - 1, 0, std::max(this->ImageSize[1], 1) - 1, 0, 0 };
  const double origin[3] = { 0.0, 0.0, 0.0 };
  const double spacing[3] = { 1.0, 1.0, 1.0 };
  information->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  information->Set(vtkDataObject::ORIGIN(), origin, 3);
  information->Set(vtkDataObject::SPACING(), spacing, 3);
  vtkDataObject::SetPointDataActiveScalarInfo(information, VTK_UNSIGNED_CHAR, 4);
  return 1;
}

int vtkMediumRayCaster::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  this->Seconds = this->UsedExposure = 0.0;
  this->DeviceName.clear();
  this->LeftOut.clear();
  return tyndall::Guarded(this, outputs, [&] {
    vtkImageData* image = vtkImageData::GetData(inputs[MEDIUM]);
    const tyndall::MediumInput input = tyndall::ReadMedium(this, image);
    using tyndall::Need;
    const auto fluence = tyndall::ReadChosenCells(this, Fluence, image, "fluence", Need::Optional);
    const auto direct = tyndall::ReadChosenCells(this, FluenceDirect, image, "fluence_direct", Need::Optional);
    const tyndall::Illumination illumination = this->ReadIllumination(inputs);
    tyndall::ViewSettings settings = SettingsOf(this);
    settings.shadowRays |= !fluence.IsThere() && !illumination.lights.empty();
    if (!fluence.IsThere() && illumination.lights.empty() && !input.emission.IsThere())
    {
      vtkWarningMacro(
        "The medium is dark: it has no array fluence (a solver makes it, e.g. LightPropagationMaps), there "
        "are no Lights, and it does not emit.");
    }

    const std::shared_ptr<tyndall::Device> device = tyndall::Device::Find(this->Device);
    tyndall::MediumRayCaster caster(*device, input.medium, { fluence, direct }, illumination, settings);
    const tyndall::Picture picture = caster.Render(CameraOf(this, input.medium.grid), tyndall::MonitorOf(this));
    tyndall::ToneMapping toneMapping;
    toneMapping.exposure = this->Exposure > 0.0 ? this->Exposure : tyndall::AutomaticExposure(picture.radiance);
    toneMapping.curve = static_cast<tyndall::ToneCurve>(this->ToneCurve);
    const std::vector<float> opaque;
    const auto color = tyndall::ToneMap(picture.radiance, this->ShowBackground ? opaque : picture.alpha, toneMapping);

    vtkImageData* output = vtkImageData::GetData(outputs);
    WritePicture(picture, color, output);
    tyndall::AddFact(output, "exposure", std::vector<double>{ toneMapping.exposure });
    tyndall::AddFact(output, "left_out", caster.LeftOut());
    tyndall::AddFact(output, "device", std::vector<std::string>{ device->Name() });
    tyndall::KeepWhatIsAskedFor(outputs->GetInformationObject(0), output);

    this->UsedExposure = toneMapping.exposure;
    this->DeviceName = device->Name();
    this->LeftOut = tyndall::Lines(caster.LeftOut());
    this->Seconds = std::chrono::duration<double>(Clock::now() - start).count();
  });
}

void vtkMediumRayCaster::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ImageSize: " << this->ImageSize[0] << " " << this->ImageSize[1] << "\n";
  PrintNumbers(os, indent, "CameraPosition", this->CameraPosition, 3);
  PrintNumbers(os, indent, "CameraFocalPoint", this->CameraFocalPoint, 3);
  PrintNumbers(os, indent, "CameraViewUp", this->CameraViewUp, 3);
  os << indent << "CameraViewAngle: " << this->CameraViewAngle << "\n";
  os << indent << "CameraParallelProjection: " << this->CameraParallelProjection << "\n";
  os << indent << "CameraParallelScale: " << this->CameraParallelScale << "\n";
  os << indent << "StepSize: " << this->StepSize << "\n";
  os << indent << "SingleScatteringOnly: " << this->SingleScatteringOnly << "\n";
  os << indent << "ShadowRays: " << this->ShadowRays << "\n";
  os << indent << "RectangleSamples: " << this->RectangleSamples << "\n";
  os << indent << "ShowBackground: " << this->ShowBackground << "\n";
  PrintNumbers(os, indent, "BackgroundColor", this->BackgroundColor, 3);
  os << indent << "Exposure: " << this->Exposure << "\n";
  os << indent << "ToneCurve: " << (this->ToneCurve == LINEAR ? "linear" : "filmic") << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
  os << indent << "UsedExposure: " << this->UsedExposure << "\n";
  os << indent << "DeviceName: " << this->DeviceName << "\n";
  os << indent << "LeftOut: " << this->LeftOut << "\n";
}
