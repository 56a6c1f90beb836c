#include "AdaptiveRuns.h"

#include "Measure.h"

#include "../Kernels/MeshShapes.h"
#include "Photons/Published/PublishedPhotons.h"

#include <algorithm>
#include <array>

namespace bench
{
using namespace tyndall;

namespace
{
constexpr std::size_t Pilots = 1024; ///< at most; PhotonImportance's default

bool IsAdaptive(Way way)
{
  return way == Way::AdaptivePublished || way == Way::Adaptive;
}

/// 1 2 1 along each axis, faces repeated: the reference pipeline's filter.
std::vector<float> Gauss3(std::vector<float> values, const Grid& grid)
{
  std::size_t stride = 1;
  for (int a = 0; a < 3; ++a)
  {
    const std::vector<float> from = values;
    const std::size_t size = static_cast<std::size_t>(grid.size[a]);
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      const std::size_t at = i / stride % size;
      values[i] = 0.25f * from[at > 0 ? i - stride : i] + 0.5f * from[i] + 0.25f * from[at + 1 < size ? i + stride : i];
    }
    stride *= size;
  }
  return values;
}

/// The first channel: light of these scenes is grey.
std::vector<float> FirstChannel(std::vector<float> values, int channels)
{
  const std::size_t step = static_cast<std::size_t>(channels), count = values.size() / step;
  for (std::size_t i = 0; i < count; ++i)
  {
    values[i] = values[i * step];
  }
  values.resize(count);
  return values;
}

ReconstructedLight Rebuild(Device& device, Way way, const PhotonLight& light, const Grid& grid)
{
  NoisyLight noisy;
  noisy.channels = light.light.channels;
  noisy.fluence = light.light.fluence.data();
  noisy.meanDirection = light.meanDirection.data();
  ReconstructionSettings settings;
  if (way == Way::AdaptivePublished)
  {
    settings.estimator = ReconstructionSettings::Estimator::Published;
    settings.conserve = false;
    noisy.photonCount = light.photonCount.data();
    noisy.photonWeight = light.photonWeight.data();
  }
  else
  {
    noisy.batches = light.batches;
    noisy.batchFluence = light.batchFluence.data();
  }
  return Reconstruct(device, Domain(grid), noisy, settings);
}
}

const char* NameOf(Way way)
{
  switch (way)
  {
    case Way::Published: return "reference pipeline";
    case Way::Uniform: return "uniform";
    case Way::Smoothed: return "uniform + Gauss";
    case Way::Reconstructed: return "uniform + reconstruction";
    case Way::AdaptivePublished: return "adaptive, as published";
    default: return "adaptive";
  }
}

WayRunner::WayRunner(tyndall::Device& device, PaperScene& scene)
  : Device(device)
  , Scene(scene)
{
}

PhotonMarcher& WayRunner::MarcherFor(Way way)
{
  MarchSettings settings;
  settings.counts = way == Way::AdaptivePublished;
  settings.batches = way == Way::Adaptive || way == Way::Reconstructed;
  std::unique_ptr<PhotonMarcher>& marcher = settings.counts ? this->Counting
    : settings.batches                                      ? this->Batching
                                                            : this->Plain;
  if (!marcher)
  {
    marcher = std::make_unique<PhotonMarcher>(this->Scene.Marcher(this->Device, settings));
  }
  return *marcher;
}

PhotonLight WayRunner::March(Way way)
{
  if (way == Way::Published)
  {
    return MarchPublished(this->Device, Domain(this->Scene.Medium().grid), this->Scene.Medium(), this->Scene.Index(),
      this->Scene.octree.levels.data(), this->Scene.photons);
  }
  return this->MarcherFor(way).March(this->Scene.photons);
}

WayLight WayRunner::Run(Way way, std::size_t photons, std::uint64_t seed)
{
  const Grid& grid = this->Scene.settings.grid;
  PhotonMarcher& marcher = this->MarcherFor(way);
  WayLight result;
  result.photons = photons;
  EmissionSettings emission = { photons, Sampler::Hammersley, seed };
  if (IsAdaptive(way))
  {
    ImportanceSettings settings;
    settings.pilotCount = std::min(Pilots, std::max<std::size_t>(photons / 10, 1));
    settings.seed = seed;
    result.passes.pilot =
      Timed([&] { result.importance = FindImportance(marcher, grid, this->Scene.light, settings); });
    const std::size_t pilots = result.importance.map.Cells() * result.importance.map.lights.size();
    emission.photonCount = photons - std::min(photons - 1, pilots);
    emission.map = result.importance.even ? nullptr : &result.importance.map;
  }
  emission.batches = way == Way::Adaptive || way == Way::Reconstructed ? 2 : 1;
  result.passes.generation =
    Timed([&] { this->Scene.photons = EmitPhotons(grid, this->Scene.light, emission).photons; });
  PhotonLight light;
  result.passes.marching = Timed([&] { light = this->March(way); });
  if (way == Way::Reconstructed || IsAdaptive(way))
  {
    ReconstructedLight rebuilt;
    result.passes.reconstruction = Timed([&] { rebuilt = Rebuild(this->Device, way, light, grid); });
    result.fluence = std::move(rebuilt.fluence);
    result.meanDirection = std::move(rebuilt.meanDirection);
    result.fluenceError = std::move(rebuilt.fluenceError);
    result.mipLevel = std::move(rebuilt.mipLevel);
    return result;
  }
  result.fluence = FirstChannel(std::move(light.light.fluence), light.light.channels);
  if (way == Way::Smoothed)
  {
    result.fluence = Gauss3(std::move(result.fluence), grid);
  }
  result.meanDirection = std::move(light.meanDirection);
  return result;
}

WayLight WayRunner::Time(Way way, std::size_t photons, int runs)
{
  WayLight first = this->Run(way, photons);
  std::array<std::vector<double>, 4> seconds;
  for (int i = 0; i < runs; ++i)
  {
    const Passes passes = this->Run(way, photons).passes;
    const double each[4] = { passes.pilot, passes.generation, passes.marching, passes.reconstruction };
    for (int k = 0; k < 4; ++k)
    {
      seconds[k].push_back(each[k]);
    }
  }
  first.passes = { Median(seconds[0]), Median(seconds[1]), Median(seconds[2]), Median(seconds[3]) };
  return first;
}

PaperScene CubeInFog(int edge)
{
  PaperScene scene = MeshInFog("perturbed cube", shapes::Box({ -0.4, -0.4, -0.4 }, { 0.4, 0.4, 0.4 }), edge);
  scene.solid.material.sigma_s = { 0.8, 0.8, 0.8 };
  scene.settings.perturbation.index = 0.05;
  scene.settings.perturbation.scattering = 0.8;
  scene.settings.perturbation.size = 0.1;
  return scene;
}

PaperScene EvenFog(int edge)
{
  PaperScene scene = BallInFog(edge);
  scene.name = "even fog";
  scene.solid.material = scene.settings.outside;
  Light sun;
  sun.type = LightType::Directional;
  sun.direction = { 0.0, 0.0, -1.0 };
  scene.light.lights = { sun };
  return scene;
}
}
