#include "Comparison/ComparedRun.h"

#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Importance/PhotonImportance.h"
#include "Photons/Marching/PhotonMarcher.h"
#include "Photons/Published/PublishedPhotons.h"
#include "Reconstruction/PhotonReconstruction.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
const char* NameOf(Sampler sampler)
{
  switch (sampler)
  {
    case Sampler::Hammersley: return "Hammersley";
    case Sampler::Halton: return "Halton";
    case Sampler::Jittered: return "jittered";
    case Sampler::Grid: return "grid";
    default: return "random";
  }
}

double RootOfSquares(const std::vector<float>& values)
{
  double sum = 0.0;
  for (float value : values)
  {
    sum += static_cast<double>(value) * value;
  }
  return std::sqrt(sum);
}

/// Light by Monte Carlo: photons are scattered until they are absorbed or leave.
LightField TraceAllOrders(
  Device& device, const ComparedScene& scene, const EmissionSettings& emission, bool estimate, const Monitor& monitor)
{
  constexpr int Batches = 16;
  MarchSettings marching;
  marching.maximumOrders = 0;
  marching.seed = emission.seed + 1;
  marching.meanDirection = false;
  marching.errorBatches = estimate ? Batches : 0;
  PhotonMarcher marcher(device, Domain(scene.medium.grid), scene.medium, scene.ior, marching, scene.levels);
  const EmittedPhotons emitted =
    EmitPhotons(scene.medium.grid, scene.illumination, emission, OfPart(monitor, 0.0, 0.1));
  LightField light = marcher.March(emitted.photons, OfPart(monitor, 0.1, 1.0)).light;
  const double size = RootOfSquares(light.fluence);
  light.relativeError = size > 0.0 ? RootOfSquares(light.fluenceError) / size : 0.0;
  return light;
}

/// Reconstructs the fluence from batches of photons. Light with fewer than two batches, i.e. without photons in the
/// volume, is returned unchanged.
LightField Rebuilt(Device& device, const Grid& grid, PhotonLight&& photons, const Monitor& monitor)
{
  if (photons.batches < 2)
  {
    return std::move(photons.light);
  }
  NoisyLight noisy;
  noisy.channels = photons.light.channels;
  noisy.fluence = photons.light.fluence.data();
  noisy.meanDirection = photons.meanDirection.empty() ? nullptr : photons.meanDirection.data();
  noisy.batches = photons.batches;
  noisy.batchFluence = photons.batchFluence.data();
  ReconstructedLight rebuilt = Reconstruct(device, Domain(grid), noisy, {}, monitor);
  LightField light = std::move(photons.light);
  const double size = RootOfSquares(rebuilt.fluence);
  light.relativeError = size > 0.0 ? RootOfSquares(rebuilt.fluenceError) / size : 0.0;
  light.fluence = std::move(rebuilt.fluence);
  return light;
}

/// Light by a complete photon run of a method, from the emission of photons to the reconstruction.
LightField Trace(
  Device& device, const ComparedScene& scene, ComparedMethod method, EmissionSettings emission, const Monitor& monitor)
{
  const Grid& grid = scene.medium.grid;
  if (method == ComparedMethod::PublishedPhotons)
  {
    const EmittedPhotons emitted = EmitPhotons(grid, scene.illumination, emission, OfPart(monitor, 0.0, 0.3));
    return MarchPublished(device, Domain(grid), scene.medium, scene.ior, scene.levels, emitted.photons, {}, nullptr,
      OfPart(monitor, 0.3, 1.0))
      .light;
  }
  MarchSettings marching;
  marching.batches = true;
  PhotonMarcher marcher(device, Domain(scene.medium.grid), scene.medium, scene.ior, marching, scene.levels);
  Importance importance;
  if (method == ComparedMethod::AdaptivePhotons)
  {
    ImportanceSettings settings;
    settings.pilotCount = std::min(settings.pilotCount, std::max<std::size_t>(emission.photonCount / 10, 1));
    importance = FindImportance(marcher, grid, scene.illumination, settings, OfPart(monitor, 0.0, 0.1));
    const std::size_t pilots = importance.map.Cells() * importance.map.lights.size();
    // pilot photons are included in the photon count
    emission.photonCount -= std::min(emission.photonCount - 1, pilots);
    emission.map = importance.even ? nullptr : &importance.map;
  }
  emission.batches = 2;
  const EmittedPhotons emitted = EmitPhotons(grid, scene.illumination, emission, OfPart(monitor, 0.1, 0.3));
  return Rebuilt(device, grid, marcher.March(emitted.photons, OfPart(monitor, 0.3, 0.9)), OfPart(monitor, 0.9, 1.0));
}
}

std::vector<ComparedRun> PhotonRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings)
{
  std::vector<int> counts = settings.photonCounts;
  std::sort(counts.begin(), counts.end());
  const int forSamplers = counts.size() > 1 ? counts[counts.size() - 2] : counts.front();
  std::vector<ComparedRun> runs;
  for (Sampler sampler : settings.samplers)
  {
    for (int count : counts)
    {
      if (sampler != settings.samplers.front() && count != forSamplers)
      {
        continue;
      }
      EmissionSettings emission;
      emission.photonCount = static_cast<std::size_t>(count);
      emission.sampler = sampler;
      ComparedRun run;
      run.method = method;
      run.setting = std::to_string(count) + " photons, " + NameOf(sampler);
      run.grid = scene.medium.grid;
      run.cost = count;
      run.estimates = method == ComparedMethod::MonteCarlo;
      run.solve = [=, &device, &scene](bool estimate, const Monitor& monitor) {
        return method == ComparedMethod::MonteCarlo ? TraceAllOrders(device, scene, emission, estimate, monitor)
                                                    : Trace(device, scene, method, emission, monitor);
      };
      runs.push_back(std::move(run));
    }
  }
  return runs;
}

LightField MarchEvenly(Device& device, const ComparedScene& scene, std::size_t photons, int orders, std::uint64_t seed,
  const Monitor& monitor)
{
  MarchSettings marching;
  marching.maximumOrders = orders;
  marching.seed = seed;
  EmissionSettings emission;
  emission.photonCount = photons;
  emission.seed = seed;
  PhotonMarcher marcher(device, Domain(scene.medium.grid), scene.medium, scene.ior, marching, scene.levels);
  const EmittedPhotons emitted =
    EmitPhotons(scene.medium.grid, scene.illumination, emission, OfPart(monitor, 0.0, 0.3));
  return marcher.March(emitted.photons, OfPart(monitor, 0.3, 1.0)).light;
}
}
