// Ray casting of a lit medium, against VTK's own volume ray casters without shading, at the same step, from the same
// cameras, in one process. Needs a display (Xvfb), but for `--alone`, which leaves VTK's out.
//
//   TyndallBenchRaycast [--quick] [--alone] [folder]
//
// The last picture of each method is written to the folder as PPM, to be looked at.

#include "Program.h"

#include "Device/Clock.h"
#include "Device/Device.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "Viewing/MediumRayCaster.h"
#include "Viewing/ToneMapping.h"

#include "vtkAutoInit.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkFloatArray.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkRenderer.h"
#include "vtkRenderWindow.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2)

using namespace tyndall;

namespace
{
constexpr int Width = 800;
constexpr int Height = 600;

/// A medium of n^3 voxels in the unit cube.
struct Scene
{
  const char* name;
  Grid grid;
  std::vector<float> sigma;
  std::vector<float> fluence, fluenceDirect;
  int channels = 1;
};

double Noise(double x, double y, double z)
{
  double sum = 0.0;
  double amplitude = 0.5;
  double frequency = 1.0;
  for (int octave = 0; octave < 4; ++octave)
  {
    const double f = frequency;
    sum += amplitude * std::sin(f * (x + 0.7 * std::sin(f * y))) * std::sin(f * (y + 0.8 * std::sin(f * z))) *
      std::sin(f * (z + 0.9 * std::sin(f * x)));
    amplitude *= 0.6;
    frequency *= 2.1;
  }
  return sum;
}

/// A cloud with clear air about it, or haze that fills the box and that every ray has to cross to its end.
Scene MakeScene(const char* name, int n, bool cloud)
{
  Scene scene;
  scene.name = name;
  scene.grid.size = { n, n, n };
  scene.grid.spacing = { 1.0 / n, 1.0 / n, 1.0 / n };
  ForGridVoxels({ n, n, n }, [&](std::size_t, int i, int j, int k) {
    const double x = (i + 0.5) / n - 0.5;
    const double y = (j + 0.5) / n - 0.5;
    const double z = (k + 0.5) / n - 0.5;
    const double noise = Noise(9.0 * x, 9.0 * y, 9.0 * z);
    const double ball = 0.36 - std::sqrt(x * x + y * y + 1.6 * z * z);
    scene.sigma.push_back(static_cast<float>(cloud ? 300.0 * std::max(0.0, ball + 0.3 * noise) : 1.0 + 0.5 * noise));
  });
  return scene;
}

Medium MediumOf(const Scene& scene)
{
  Medium medium;
  medium.grid = scene.grid;
  medium.sigma_s = { scene.sigma.data(), 1 };
  return medium;
}

/// Light of a coloured sky and a sun; few directions, for what is measured is how it is looked at.
void Solve(Device& device, Scene& scene)
{
  Illumination illumination;
  illumination.sky = { 0.10, 0.16, 0.28 };
  Light sun;
  sun.direction = { -0.5, 0.4, -0.8 };
  sun.power = { 3.0, 2.7, 2.2 };
  illumination.lights = { sun };
  PropagationSettings settings;
  settings.directionsPerFace = 9;
  settings.maximumOrders = 12;
  LightField light = SolveConservative(device, MediumOf(scene), illumination, settings, {});
  scene.fluence = std::move(light.fluence);
  scene.fluenceDirect = std::move(light.fluenceDirect);
  scene.channels = light.channels;
}

/// The camera goes around, so that no picture is like the one before.
Camera CameraOf(const Scene& scene, int view)
{
  const double angle = 0.5 + 0.05 * view;
  return FrameGrid(scene.grid, static_cast<double>(Width) / Height, 30.0, { std::sin(angle), -std::cos(angle), 0.45 });
}

struct Seconds
{
  double wall = 0.0;
  double cores = 0.0; ///< of all threads together: tells more than `wall` where others use the machine too
};

/// Medians over several views; one more comes before, to warm up.
Seconds Median(int views, const std::function<void(int)>& show)
{
  show(-1);
  std::vector<double> wall, cores;
  for (int view = 0; view < views; ++view)
  {
    const auto start = std::chrono::steady_clock::now();
    const double clock = CoreSeconds();
    show(view);
    cores.push_back(CoreSeconds() - clock);
    wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  const auto middle = [](std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
  };
  return { middle(wall), middle(cores) };
}

void WritePicture(const std::string& file, const unsigned char* pixels, int components)
{
  std::FILE* out = std::fopen(file.c_str(), "wb");
  if (!out)
  {
    return;
  }
  std::fprintf(out, "P6\n%d %d\n255\n", Width, Height);
  for (int j = Height - 1; j >= 0; --j)
  {
    for (int i = 0; i < Width; ++i)
    {
      std::fwrite(pixels + static_cast<std::size_t>(components) * (j * Width + i), 1, 3, out);
    }
  }
  std::fclose(out);
}

struct Case
{
  const Scene& scene;
  double step; ///< voxels
  int views;
  std::string folder;

  std::string Name() const
  {
    char text[64];
    std::snprintf(text, sizeof(text), "%s, step %g", this->scene.name, this->step);
    return text;
  }
  std::string File(const std::string& method) const
  {
    return this->folder + "/" + this->scene.name + "_" + method + ".ppm";
  }
};

/// Without `against` there is no ratio; without peak bytes they are not known.
void Print(const Case& what, const std::string& method, Seconds seconds, std::size_t peakBytes = 0, Seconds other = {},
  const std::string& against = {})
{
  const Grid& grid = what.scene.grid;
  std::printf(
    R"({"bench": "raycast", "case": "%s", "method": "%s", "grid": "%dx%dx%d", "image": "%dx%d", "seconds": %.4g, )"
    R"("core_seconds": %.4g)",
    what.Name().c_str(), method.c_str(), grid.size[0], grid.size[1], grid.size[2], Width, Height, seconds.wall,
    seconds.cores);
  if (peakBytes > 0)
  {
    std::printf(R"(, "peak_bytes": %zu)", peakBytes);
  }
  if (!against.empty())
  {
    std::printf(R"(, "ratio": %.3g, "core_ratio": %.3g, "against": "%s")", other.wall / seconds.wall,
      other.cores / seconds.cores, against.c_str());
  }
  std::printf("}\n");
  std::fflush(stdout);
}

/// Ours: `radiance` and the picture for the screen. Medium and light are on the device already.
Seconds TimeOurs(Device& device, const Case& what, bool single, std::size_t* peakBytes)
{
  ViewSettings settings;
  settings.imageSize = { Width, Height };
  settings.stepSize = what.step;
  settings.singleScatteringOnly = single;
  device.ResetPeak();
  MediumRayCaster caster(device, MediumOf(what.scene),
    { { what.scene.fluence.data(), what.scene.channels }, { what.scene.fluenceDirect.data(), what.scene.channels },
      {} },
    {}, settings);
  std::vector<std::uint8_t> color;
  const Seconds seconds = Median(what.views, [&](int view) {
    const Picture picture = caster.Render(CameraOf(what.scene, view));
    color = ToneMap(picture.radiance, {}, {});
  });
  *peakBytes = device.PeakBytes();
  if (!what.folder.empty())
  {
    WritePicture(what.File(single ? "single" : "multiple"), color.data(), 4);
  }
  return seconds;
}

/// What comes before the first picture of a medium: upload, packing, and the picture itself.
Seconds TimeFirst(Device& device, const Case& what)
{
  ViewSettings settings;
  settings.imageSize = { Width, Height };
  settings.stepSize = what.step;
  return Median(what.views, [&](int view) {
    MediumRayCaster caster(
      device, MediumOf(what.scene), { { what.scene.fluence.data(), what.scene.channels }, {}, {} }, {}, settings);
    caster.Render(CameraOf(what.scene, view));
  });
}

/// Direct light found by shadow rays, one a voxel, for every picture anew (the phase function depends on the camera).
Seconds TimeShadowRays(Device& device, const Case& what)
{
  ViewSettings settings;
  settings.imageSize = { Width, Height };
  settings.stepSize = what.step;
  settings.shadowRays = true;
  Medium medium = MediumOf(what.scene);
  medium.phase = PhaseFunction::HenyeyGreenstein(0.5);
  Illumination illumination;
  illumination.lights.resize(1);
  illumination.lights[0].direction = { -0.5, 0.4, -0.8 };
  MediumRayCaster caster(device, medium, {}, illumination, settings);
  return Median(what.views, [&](int view) { caster.Render(CameraOf(what.scene, view)); });
}

/// The same extinction as VTK's opacity, the same brightness everywhere.
void SetTransferFunctions(const Scene& scene, vtkVolumeProperty* property)
{
  const double largest = *std::max_element(scene.sigma.begin(), scene.sigma.end());
  vtkNew<vtkPiecewiseFunction> opacity;
  for (int i = 0; i <= 255; ++i)
  {
    const double sigma = largest * i / 255.0;
    opacity->AddPoint(sigma, -std::expm1(-sigma * scene.grid.spacing[0]));
  }
  vtkNew<vtkColorTransferFunction> color;
  color->AddRGBPoint(0.0, 0.5, 0.6, 0.7);
  color->AddRGBPoint(largest, 1.0, 0.9, 0.8);
  property->SetScalarOpacity(opacity);
  property->SetColor(color);
  property->SetScalarOpacityUnitDistance(scene.grid.spacing[0]);
  property->SetInterpolationTypeToLinear();
  property->ShadeOff();
}

Seconds TimeVtk(const Case& what, vtkVolumeMapper* mapper, const std::string& method)
{
  const Grid& grid = what.scene.grid;
  vtkNew<vtkImageData> image; // values at the voxels' centres
  image->SetDimensions(grid.size[0], grid.size[1], grid.size[2]);
  image->SetSpacing(grid.spacing.data());
  image->SetOrigin(0.5 * grid.spacing[0], 0.5 * grid.spacing[1], 0.5 * grid.spacing[2]);
  vtkNew<vtkFloatArray> sigma;
  sigma->SetArray(const_cast<float*>(what.scene.sigma.data()), static_cast<vtkIdType>(what.scene.sigma.size()), 1);
  image->GetPointData()->SetScalars(sigma);
  mapper->SetInputDataObject(image);
  mapper->SetBlendModeToComposite();
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);
  SetTransferFunctions(what.scene, volume->GetProperty());
  vtkNew<vtkRenderer> renderer;
  renderer->AddVolume(volume);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(Width, Height);
  window->AddRenderer(renderer);
  const Seconds seconds = Median(what.views, [&](int view) {
    const Camera camera = CameraOf(what.scene, view);
    vtkCamera* active = renderer->GetActiveCamera();
    active->SetPosition(camera.position.data());
    active->SetFocalPoint(camera.focalPoint.data());
    active->SetViewUp(camera.viewUp.data());
    active->SetViewAngle(camera.viewAngle);
    renderer->ResetCameraClippingRange();
    window->Render();
    window->WaitForCompletion();
  });
  if (!what.folder.empty())
  {
    vtkNew<vtkUnsignedCharArray> pixels;
    window->GetPixelData(0, 0, Width - 1, Height - 1, 0, pixels);
    WritePicture(what.File(method), pixels->GetPointer(0), 3);
  }
  return seconds;
}

Seconds TimeFixedPoint(const Case& what)
{
  vtkNew<vtkFixedPointVolumeRayCastMapper> mapper;
  mapper->AutoAdjustSampleDistancesOff();
  mapper->IntermixIntersectingGeometryOff();
  mapper->SetSampleDistance(static_cast<float>(what.step * what.scene.grid.spacing[0]));
  mapper->SetImageSampleDistance(1.0f);
  return TimeVtk(what, mapper, "vtkFixedPointVolumeRayCastMapper");
}

Seconds TimeGpu(const Case& what)
{
  vtkNew<vtkGPUVolumeRayCastMapper> mapper;
  mapper->AutoAdjustSampleDistancesOff();
  mapper->LockSampleDistanceToInputSpacingOff();
  mapper->UseJitteringOff();
  mapper->SetSampleDistance(static_cast<float>(what.step * what.scene.grid.spacing[0]));
  mapper->SetImageSampleDistance(1.0f);
  return TimeVtk(what, mapper, "vtkGPUVolumeRayCastMapper");
}

/// What ours is compared with.
struct Against
{
  std::string method; ///< empty: nothing
  Seconds seconds;
};

/// Times VTK's ray casters.
/// @return the faster one
Against TimeVtks(const Case& what)
{
  const Against fixedPoint = { "vtkFixedPointVolumeRayCastMapper", TimeFixedPoint(what) };
  const Against gpu = { "vtkGPUVolumeRayCastMapper", TimeGpu(what) };
  Print(what, fixedPoint.method, fixedPoint.seconds);
  Print(what, gpu.method, gpu.seconds);
  return gpu.seconds.wall < fixedPoint.seconds.wall ? gpu : fixedPoint;
}

void Run(Device& device, const Case& what, bool alone)
{
  const Against against = alone ? Against() : TimeVtks(what);

  std::size_t peakBytes = 0;
  const Seconds single = TimeOurs(device, what, true, &peakBytes);
  Print(what, "MediumRayCaster, single scattering", single, peakBytes, against.seconds, against.method);
  const Seconds multiple = TimeOurs(device, what, false, &peakBytes);
  Print(what, "MediumRayCaster, multiple scattering", multiple, peakBytes, against.seconds, against.method);
  Print(what, "MediumRayCaster, first picture", TimeFirst(device, what));
  Print(what, "MediumRayCaster, shadow rays", TimeShadowRays(device, what));
}

void RunAll(Device& device, const bench::Arguments& arguments)
{
  const bool quick = arguments.quick;
  std::vector<std::string> words = arguments.words;
  const auto kept = std::remove(words.begin(), words.end(), "--alone");
  const bool alone = kept != words.end();
  words.erase(kept, words.end());
  const std::string folder = words.empty() ? "" : words.front();
  const int n = quick ? 32 : 128;
  std::vector<Scene> scenes = { MakeScene("cloud", n, true) };
  if (!quick)
  {
    scenes.push_back(MakeScene("haze", n, false));
  }
  for (Scene& scene : scenes)
  {
    Solve(device, scene);
    Run(device, { scene, 0.5, quick ? 1 : 7, folder }, alone);
    if (!quick)
    {
      Run(device, { scene, 1.0, 7, {} }, alone);
    }
  }
}
}

int main(int argc, char* argv[])
{
  return bench::RunOnDevice(argc, argv, RunAll);
}
