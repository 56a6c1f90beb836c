#include "Comparison/ComparedRun.h"

#include "Viewing/PictureError.h"

#include <utility>

namespace tyndall
{
namespace
{
constexpr std::pair<Quality, const char*> Qualities[] = { { Quality::Draft, "draft" }, { Quality::Default, "default" },
  { Quality::Fine, "fine" }, { Quality::Reference, "reference" } };

/// Radiance of the scene's picture without background, as the fluence of three channels.
/// @param estimate  whether to estimate the picture's error, without the part due to the error of the light
LightField Rendered(
  Device& device, const ComparedScene& scene, ViewSettings settings, bool estimate, const Monitor& monitor)
{
  settings.imageSize = scene.imageSize;
  settings.showBackground = false;
  SolvedLight light;
  light.fluence = scene.seen;
  MediumRayCaster caster(device, scene.medium, light, scene.illumination, settings, scene.ior);
  Picture picture = caster.Render(*scene.camera, monitor);
  if (estimate)
  {
    PictureErrorCasters(device, scene.medium, light, scene.illumination, settings, scene.ior)
      .Estimate(picture, *scene.camera, monitor);
  }
  LightField radiance;
  radiance.channels = 3;
  radiance.fluence = std::move(picture.radiance);
  radiance.relativeError = picture.relativeError;
  return radiance;
}
}

std::vector<ComparedRun> PictureRunsOf(Device& device, const ComparedScene& scene)
{
  std::vector<ComparedRun> runs;
  for (const auto& [quality, name] : Qualities)
  {
    const ViewSettings settings = AtQuality(quality, ViewSettings());
    ComparedRun run;
    run.method = ComparedMethod::Pictures;
    run.setting = std::string("quality ") + name;
    run.filters = "MediumRayCaster Quality=" + std::to_string(static_cast<int>(quality));
    run.grid.size = { scene.imageSize[0], scene.imageSize[1], 1 };
    run.cost = 1.0 / settings.stepSize;
    run.estimates = true;
    run.solve = [=, &device, &scene](bool estimate, const Monitor& monitor) {
      return Rendered(device, scene, settings, estimate, monitor);
    };
    runs.push_back(std::move(run));
  }
  return runs;
}

std::vector<float> ReferencePicture(Device& device, const ComparedScene& scene, const Monitor& monitor)
{
  ViewSettings settings = AtQuality(Quality::Reference, ViewSettings());
  settings.stepSize *= 0.5;
  settings.minimumTransmittance = 0.0;
  return Rendered(device, scene, settings, false, monitor).fluence;
}
}
