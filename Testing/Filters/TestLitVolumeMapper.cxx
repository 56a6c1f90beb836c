#include "MediumScene.h"

#include "vtkActor.h"
#include "vtkAutoInit.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkImageData.h"
#include "vtkLitVolumeMapper.h"
#include "vtkMediumRayCaster.h"
#include "vtkOutlineSource.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkRenderWindow.h"
#include "vtkSphereSource.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

VTK_MODULE_INIT(vtkRenderingOpenGL2);

namespace
{
constexpr int Width = 120, Height = 90;

/// A box from 0 to 12, 10, 8.
vtkSmartPointer<vtkImageData> Fog(double sigma_a, double sigma_s)
{
  auto image = test::MakeImage({ { 12, 10, 8 } });
  const auto add = [&](const char* name, double value) {
    test::AddValues<vtkFloatArray>(image->GetCellData(), name, image->GetNumberOfCells(), 1,
      [value](vtkIdType i, int) { return value * (1 + i % 3); });
  };
  add("sigma_a", sigma_a);
  add("sigma_s", sigma_s);
  add("fluence", 1.0);
  return image;
}

struct Scene
{
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkLitVolumeMapper> mapper;
  vtkNew<vtkVolume> volume;

  explicit Scene(vtkImageData* medium)
  {
    this->window->SetOffScreenRendering(1);
    this->window->SetMultiSamples(0);
    this->window->SetSize(Width, Height);
    this->window->AddRenderer(this->renderer);
    this->mapper->SetInputData(medium);
    this->volume->SetMapper(this->mapper);
    this->renderer->AddVolume(this->volume);
    vtkCamera* const camera = this->renderer->GetActiveCamera();
    camera->SetPosition(30, -25, 14);
    camera->SetFocalPoint(6, 5, 4);
    camera->SetViewUp(0, 0, 1);
    camera->SetViewAngle(30);
    this->renderer->ResetCameraClippingRange();
  }

  vtkNew<vtkUnsignedCharArray> Drawn()
  {
    this->renderer->ResetCameraClippingRange();
    this->window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->window->GetPixelData(0, 0, Width - 1, Height - 1, 0, pixels);
    return pixels;
  }

  /// Shown as white, whatever the lights.
  void Add(vtkAlgorithm* shape)
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(shape->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    this->renderer->AddActor(actor);
  }
};

vtkIdType PixelAt(int column, int row)
{
  return 3 * (static_cast<vtkIdType>(row) * Width + column);
}

int LargestDifference(vtkUnsignedCharArray* window, vtkUnsignedCharArray* picture)
{
  int largest = 0;
  for (vtkIdType pixel = 0; pixel < picture->GetNumberOfTuples(); ++pixel)
  {
    for (int c = 0; c < 3; ++c)
    {
      largest = std::max(largest, std::abs(window->GetValue(3 * pixel + c) - picture->GetValue(4 * pixel + c)));
    }
  }
  return largest;
}

/// @param direction  of the medium's image; null: not turned
void ShowsThePictureOfTheRayCaster(test::Claims& claims, const double* direction)
{
  const auto medium = Fog(0.01, 0.05);
  if (direction)
  {
    medium->SetDirectionMatrix(direction);
  }
  for (bool parallel : { false, true })
  {
    Scene scene(medium);
    if (direction)
    {
      scene.renderer->ResetCamera();
    }
    vtkCamera* const camera = scene.renderer->GetActiveCamera();
    camera->SetParallelProjection(parallel);
    camera->SetParallelScale(9);
    scene.mapper->GetRayCaster()->SetExposure(8);
    const auto window = scene.Drawn();
    vtkNew<vtkMediumRayCaster> caster;
    caster->SetInputData(medium);
    caster->SetImageSize(Width, Height);
    caster->SetCameraPosition(camera->GetPosition());
    caster->SetCameraFocalPoint(camera->GetFocalPoint());
    caster->SetCameraParallelProjection(parallel);
    caster->SetCameraParallelScale(9);
    caster->SetExposure(8);
    caster->Update();
    auto* const picture = vtkUnsignedCharArray::SafeDownCast(caster->GetOutput()->GetPointData()->GetScalars());
    claims.That(picture && picture->GetValue(4 * (45 * Width + 60)) > 50, "there is a picture");
    claims.That(picture && LargestDifference(window, picture) <= 1, "the window shows it");
  }
}

/// An absorber before a white sphere, half of which is inside: exp(-tau) of white.
void EndsRaysAtOpaqueSurfaces(test::Claims& claims)
{
  auto medium = test::MakeImage({ { 12, 10, 8 } });
  for (const char* name : { "sigma_a", "sigma_s" })
  {
    test::AddValues<vtkFloatArray>(medium->GetCellData(), name, medium->GetNumberOfCells(), 1,
      [name](vtkIdType, int) { return name[6] == 'a' ? 0.1 : 0.0; });
  }
  test::AddValues<vtkFloatArray>(
    medium->GetCellData(), "fluence", medium->GetNumberOfCells(), 1, [](vtkIdType, int) { return 1.0; });
  Scene scene(medium);
  vtkCamera* const camera = scene.renderer->GetActiveCamera();
  camera->SetPosition(6, -30, 4);
  camera->SetFocalPoint(6, 5, 4);
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(200);
  sphere->SetPhiResolution(200);
  sphere->SetRadius(2.0);
  scene.Add(sphere);
  vtkNew<vtkOutlineSource> outline;
  outline->SetBounds(medium->GetBounds());
  scene.Add(outline);
  for (double y : { 0.0, 4.0, 9.0, 12.5 })
  {
    sphere->SetCenter(6.0, y, 4.0);
    const double before = std::min(std::max(y - 2.0, 0.0), 10.0);
    const auto window = scene.Drawn();
    claims.Near(window->GetValue(PixelAt(Width / 2, Height / 2)), 255.0 * std::exp(-0.1 * before), 2.0,
      "white behind the medium until the sphere at " + std::to_string(y));
  }
}

void CastsFewerRaysWhileTheCameraMoves(test::Claims& claims)
{
  Scene scene(Fog(0.01, 0.05));
  scene.Drawn();
  claims.That(scene.mapper->GetCastSize()[0] == Width, "a ray for each pixel where nothing moves");
  const double exposure = scene.mapper->GetUsedExposure();
  claims.That(exposure > 0.0, "the exposure is chosen");
  scene.mapper->SetFrameTime(0.001);
  scene.window->SetDesiredUpdateRate(30.0);
  scene.renderer->GetActiveCamera()->Azimuth(40);
  scene.window->SetSize(4 * Width, 4 * Height);
  scene.window->Render();
  claims.That(scene.mapper->GetCastSize()[0] < 4 * Width, "fewer where the camera moves");
  claims.That(scene.mapper->GetUsedExposure() == exposure, "the exposure stays");
}

void RefusesAStretchedVolume(test::Claims& claims)
{
  Scene scene(Fog(0.01, 0.05));
  test::Errors errors(scene.mapper);
  scene.volume->SetScale(1.0, 2.0, 1.0);
  scene.window->Render();
  claims.That(errors.WasOneWith("stretched"), "a stretched volume is an error");
  scene.volume->SetScale(1.0, 1.0, 1.0);
  vtkCamera* const camera = scene.renderer->GetActiveCamera();
  camera->SetFocalPoint(camera->GetPosition());
  scene.window->Render();
  claims.That(errors.WasOneWith("position and focal point are the same"), "a camera that looks nowhere is another");
  camera->SetPosition(std::nan(""), 0.0, 0.0);
  scene.window->Render();
  claims.That(errors.WasOneWith("is not finite"), "and so is one that stands nowhere");
}

/// A ball of scalars is shown by transfer functions, and by the lights of the renderer, as they are edited.
void LightsScalarsByTransferFunctions(test::Claims& claims)
{
  const vtkSmartPointer<vtkImageData> image = test::MakeImage({ { 12, 10, 8 } });
  test::AddValues<vtkFloatArray>(image->GetPointData(), "s", image->GetNumberOfPoints(), 1, [&](vtkIdType point, int) {
    const double* const at = image->GetPoint(point);
    return 4.0 - std::hypot(at[0] - 6.0, std::hypot(at[1] - 5.0, at[2] - 4.0));
  });
  image->GetPointData()->SetActiveScalars("s");
  Scene scene(image);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 0.0);
  opacity->AddPoint(1.0, 0.9);
  vtkNew<vtkColorTransferFunction> colors;
  colors->AddRGBPoint(0.0, 1.0, 0.2, 0.2);
  vtkVolumeProperty* const property = scene.volume->GetProperty();
  property->SetScalarOpacity(opacity);
  property->SetColor(colors);
  property->SetInterpolationTypeToLinear();
  scene.mapper->LightScalarsOn();
  const vtkIdType middle = PixelAt(Width / 2, Height / 2);
  const vtkNew<vtkUnsignedCharArray> red = scene.Drawn();
  claims.That(red->GetValue(middle) > red->GetValue(middle + 1) + 40, "the ball is red in the headlight");
  claims.Near(red->GetValue(PixelAt(2, 2)), 0.0, 0.0, "beside the ball there is nothing");
  colors->RemoveAllPoints();
  colors->AddRGBPoint(0.0, 0.2, 1.0, 0.2);
  const vtkNew<vtkUnsignedCharArray> green = scene.Drawn();
  claims.That(green->GetValue(middle + 1) > green->GetValue(middle) + 40, "an edit makes it green");
}
}

int TestLitVolumeMapper(int, char*[])
{
  return test::WithDevice([](test::Claims& claims) {
    const double turned[9] = { 0.48, -0.8, -0.36, 0.64, 0.6, -0.48, 0.6, 0.0, 0.8 };
    const double mirrored[9] = { -0.48, -0.8, -0.36, -0.64, 0.6, -0.48, -0.6, 0.0, 0.8 };
    for (const double* direction : { static_cast<const double*>(nullptr), turned, mirrored })
    {
      ShowsThePictureOfTheRayCaster(claims, direction);
    }
    EndsRaysAtOpaqueSurfaces(claims);
    CastsFewerRaysWhileTheCameraMoves(claims);
    RefusesAStretchedVolume(claims);
    LightsScalarsByTransferFunctions(claims);
  });
}
