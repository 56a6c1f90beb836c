#include "Comparison/ComparedRun.h"

#include "Numerics/NumberText.h"
#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Importance/PhotonImportance.h"
#include "Photons/Marching/PhotonMarcher.h"
#include "Photons/Published/PublishedPhotons.h"
#include "Reconstruction/PhotonReconstruction.h"
#include "Refraction/Octree/RefractionOctree.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

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

/// Emits and marches photons.
PhotonLight March(Device& device, const ComparedScene& scene, const EmissionSettings& emission,
  const MarchSettings& marching, const Monitor& monitor)
{
  PhotonMarcher marcher(device, Domain(scene.medium.grid), scene.medium, scene.ior, marching, scene.levels);
  const EmittedPhotons emitted =
    EmitPhotons(scene.medium.grid, scene.illumination, emission, OfPart(monitor, 0.0, 0.2));
  return marcher.March(emitted.photons, OfPart(monitor, 0.2, 1.0));
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
  LightField light = March(device, scene, emission, marching, monitor).light;
  const double size = RootOfSquares(light.fluence);
  light.relativeError = size > 0.0 ? RootOfSquares(light.fluenceError) / size : 0.0;
  return light;
}

/// Reconstructs the fluence from batches of photons. With fewer than two batches, which happens if no photon reaches
/// the volume, the light is returned unchanged.
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
/// @param levels  octree levels, which replace ComparedScene::levels
LightField Trace(Device& device, const ComparedScene& scene, const std::uint8_t* levels, ComparedMethod method,
  EmissionSettings emission, MarchSettings marching, const Monitor& monitor)
{
  const Grid& grid = scene.medium.grid;
  if (method == ComparedMethod::PublishedPhotons)
  {
    const EmittedPhotons emitted = EmitPhotons(grid, scene.illumination, emission, OfPart(monitor, 0.0, 0.3));
    return MarchPublished(
      device, Domain(grid), scene.medium, scene.ior, levels, emitted.photons, {}, nullptr, OfPart(monitor, 0.3, 1.0))
      .light;
  }
  marching.batches = true;
  PhotonMarcher marcher(device, Domain(scene.medium.grid), scene.medium, scene.ior, marching, levels);
  Importance importance;
  if (method == ComparedMethod::AdaptivePhotons)
  {
    ImportanceSettings settings;
    settings.pilotCount = std::min(settings.pilotCount, std::max<std::size_t>(emission.photonCount / 10, 1));
    importance = FindImportance(marcher, grid, scene.illumination, settings, OfPart(monitor, 0.0, 0.1));
    const std::size_t pilots = importance.map.Cells() * importance.map.lights.size();
    // the photon count includes pilot photons
    emission.photonCount -= std::min(emission.photonCount - 1, pilots);
    emission.map = importance.even ? nullptr : &importance.map;
  }
  emission.batches = 2;
  const EmittedPhotons emitted = EmitPhotons(grid, scene.illumination, emission, OfPart(monitor, 0.1, 0.3));
  return Rebuilt(device, grid, marcher.March(emitted.photons, OfPart(monitor, 0.3, 0.9)), OfPart(monitor, 0.9, 1.0));
}

/// Settings that differ between runs of photons.
struct PhotonSetting
{
  EmissionSettings emission;
  MarchSettings marching;
  std::optional<double> octree; ///< tolerance of an octree that is built first
  int samples = 0;              ///< samples per voxel edge of a mesh that is voxelised first; 0: none is
  int filterSize = 9;           ///< width of the voxelisation's filter
  std::string words, marchProperties;
};

PhotonSetting SettingWith(int count, Sampler sampler)
{
  PhotonSetting setting;
  setting.emission.photonCount = static_cast<std::size_t>(count);
  setting.emission.sampler = sampler;
  setting.words = std::to_string(count) + " photons, " + NameOf(sampler);
  return setting;
}

/// Settings with the integrators and octrees that runs of photons try along bent rays.
/// @param usual  values of all other settings
std::vector<PhotonSetting> AlongBentRays(const PhotonSetting& usual, const ComparedSettings& settings)
{
  const MarchSettings defaults;
  std::vector<PhotonSetting> all;
  for (int order : settings.integratorOrders.empty() ? std::vector<int>{ defaults.order } : settings.integratorOrders)
  {
    for (double step : settings.stepSizes.empty() ? std::vector<double>{ defaults.stepSize } : settings.stepSizes)
    {
      if (order != defaults.order || step != defaults.stepSize)
      {
        all.push_back(usual);
        all.back().marching.order = order;
        all.back().marching.stepSize = step;
        all.back().words += ", order " + std::to_string(order) + ", steps of " + Text("%g", step) + " voxels";
        all.back().marchProperties = " IntegratorOrder=" + std::to_string(order) + " StepSize=" + Text("%g", step);
      }
    }
  }
  for (double tolerance : settings.octreeTolerances)
  {
    all.push_back(usual);
    all.back().octree = tolerance;
    all.back().words += ", octree of " + Text("%g", tolerance);
  }
  return all;
}

std::vector<PhotonSetting> SettingsToTry(
  ComparedMethod method, const ComparedScene& scene, const ComparedSettings& settings)
{
  std::vector<int> counts = settings.photonCounts;
  std::sort(counts.begin(), counts.end());
  const int usual = counts.size() > 1 ? counts[counts.size() - 2] : counts.front();
  std::vector<PhotonSetting> all;
  if (method == ComparedMethod::Voxelizer)
  {
    for (int samples : settings.supersamplings)
    {
      for (int filterSize : settings.filterSizes)
      {
        all.push_back(SettingWith(usual, settings.samplers.front()));
        all.back().samples = samples;
        all.back().filterSize = filterSize;
        all.back().words = "supersampling " + std::to_string(samples) + ", filter " + std::to_string(filterSize) +
          ", " + all.back().words;
      }
    }
    return all;
  }
  for (Sampler sampler : settings.samplers)
  {
    for (int count : counts)
    {
      if (sampler == settings.samplers.front() || count == usual)
      {
        all.push_back(SettingWith(count, sampler));
      }
    }
  }
  if (method == ComparedMethod::Photons && scene.BendsLight())
  {
    const std::vector<PhotonSetting> bent = AlongBentRays(SettingWith(usual, settings.samplers.front()), settings);
    all.insert(all.end(), bent.begin(), bent.end());
  }
  return all;
}

/// Computes the light of one setting. Voxelises the mesh and builds an octree first, if the setting asks for it.
LightField SolveWith(const PhotonSetting& setting, ComparedMethod method, Device& device, const ComparedScene& scene,
  bool estimate, const Monitor& monitor)
{
  if (method == ComparedMethod::MonteCarlo)
  {
    return TraceAllOrders(device, scene, setting.emission, estimate, monitor);
  }
  if (method == ComparedMethod::Voxelizer)
  {
    VoxelizationSettings voxelization;
    voxelization.samples = setting.samples;
    const VoxelizedScene voxels(device, scene, 1, voxelization, setting.filterSize, OfPart(monitor, 0.0, 0.3));
    return Trace(
      device, voxels.Scene(), nullptr, method, setting.emission, setting.marching, OfPart(monitor, 0.3, 1.0));
  }
  if (setting.octree)
  {
    OctreeSettings tree;
    tree.tolerance = *setting.octree;
    const Octree octree =
      BuildOctree(Domain(scene.medium.grid), scene.medium, scene.ior, tree, device.Name(), OfPart(monitor, 0.0, 0.1));
    return Trace(
      device, scene, octree.levels.data(), method, setting.emission, setting.marching, OfPart(monitor, 0.1, 1.0));
  }
  return Trace(device, scene, scene.levels, method, setting.emission, setting.marching, monitor);
}

std::string Numbers(const Rgb& values)
{
  return Text("%.9g", values[0]) + "," + Text("%.9g", values[1]) + "," + Text("%.9g", values[2]);
}

std::string PropertiesOf(const char* side, const Material& material)
{
  const std::string name = std::string(" ") + side;
  return name + "Index=" + Text("%.9g", material.n) + name + "Scattering=" + Numbers(material.sigma_s) + name +
    "Absorption=" + Numbers(material.sigma_a) + name + "MeanCosine=" + Text("%.9g", material.g);
}

std::string VoxelizerOf(const PhotonSetting& setting, const ComparedScene& scene)
{
  const Grid& grid = scene.medium.grid;
  std::string bounds, size;
  for (int axis = 0; axis < 3; ++axis)
  {
    bounds +=
      (axis ? "," : "") + Text("%.17g", grid.origin[axis]) + "," + Text("%.17g", grid.origin[axis] + grid.Length(axis));
    size += (axis ? "," : "") + std::to_string(grid.size[axis]);
  }
  return "MeshVoxelizer Input=@Mesh SampleDimensions=" + size + " ModelBounds=" + bounds +
    " SupersamplingFactor=" + std::to_string(setting.samples) + " FilterSize=" + std::to_string(setting.filterSize) +
    PropertiesOf("Inside", scene.mesh->inside.material) + PropertiesOf("Outside", scene.mesh->outside) + " | ";
}

/// The filters that repeat a run of photons, in the format of ComparedRun::filters.
std::string FiltersOf(ComparedMethod method, const PhotonSetting& setting, const ComparedScene& scene)
{
  int made = 0; // filters so far
  const auto output = [](int filter) { return "#" + std::to_string(filter); };
  std::string filters, medium, emission, march;
  if (method == ComparedMethod::Voxelizer)
  {
    filters = VoxelizerOf(setting, scene);
    medium = " Input=" + output(++made);
  }
  if (setting.octree)
  {
    filters = "RefractionOctree Tolerance=" + Text("%g", *setting.octree) + " | ";
    march = " Octree=" + output(++made);
  }
  if (method == ComparedMethod::AdaptivePhotons)
  {
    filters = "PhotonImportance | ";
    emission = " ImportanceMap=" + output(++made);
  }
  const bool rebuilt = method != ComparedMethod::MonteCarlo && method != ComparedMethod::PublishedPhotons;
  filters += "PhotonEmitter" + medium + emission + " PhotonCount=" + std::to_string(setting.emission.photonCount) +
    " Sampler=" + std::to_string(static_cast<int>(setting.emission.sampler)) + (rebuilt ? " Batches=2" : "");
  march = medium + march + " Photons=" + output(++made) + setting.marchProperties;
  march += method == ComparedMethod::MonteCarlo ? " MaximumOrders=0" : "";
  march += method == ComparedMethod::PublishedPhotons ? " Scheme=0" : "";
  filters += " | PhotonMarcher" + march;
  return filters + (rebuilt ? " | PhotonReconstruction Input=" + output(made + 1) : "");
}
}

std::vector<ComparedRun> PhotonRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings)
{
  std::vector<ComparedRun> runs;
  for (const PhotonSetting& setting : SettingsToTry(method, scene, settings))
  {
    ComparedRun run;
    run.method = method;
    run.setting = setting.words;
    run.filters = FiltersOf(method, setting, scene);
    run.grid = scene.medium.grid;
    run.cost = static_cast<double>(setting.emission.photonCount);
    run.estimates = method == ComparedMethod::MonteCarlo;
    run.solve = [=, &device, &scene](bool estimate, const Monitor& monitor) {
      return SolveWith(setting, method, device, scene, estimate, monitor);
    };
    runs.push_back(std::move(run));
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
  return March(device, scene, emission, marching, monitor).light;
}

ComparedRun AfterPhotons(int photons, ComparedRun solver, Device& device, const ComparedScene& scene,
  const std::function<LightField(const Illumination&, const Monitor&)>& solve)
{
  const std::string count = std::to_string(photons);
  solver.setting += ", uncollided light of " + count + " photons";
  solver.filters = "PhotonEmitter PhotonCount=" + count + " | PhotonMarcher Photons=#1 | " + solver.filters +
    " UncollidedLight=#2 Lights= Environment= SkyColor=0,0,0 FaceRadiance=0,0,0,0,0,0 DefaultSky=0";
  solver.cost += photons;
  EmissionSettings emission;
  emission.photonCount = static_cast<std::size_t>(photons);
  solver.solve = [=, &device, &scene](bool, const Monitor& monitor) {
    const PhotonLight direct = March(device, scene, emission, {}, OfPart(monitor, 0.0, 0.5));
    Illumination handed;
    handed.uncollided.fluence = { direct.light.fluence.data(), direct.light.channels };
    handed.uncollided.meanDirection = { direct.meanDirection.data(), 3 };
    handed.uncollided.escaped = direct.light.facePowerOut;
    return solve(handed, OfPart(monitor, 0.5, 1.0));
  };
  return solver;
}
}
