#include "PhotonRuns.h"

#include "Measure.h"

#include "../Kernels/MeshShapes.h"

#include <cmath>

namespace bench
{
using namespace tyndall;

namespace
{
constexpr double GlassIndex = 1.5;

std::string GridName(const Grid& grid)
{
  return std::to_string(grid.size[0]) + "x" + std::to_string(grid.size[1]) + "x" + std::to_string(grid.size[2]);
}
}

PhotonTimes Repeat(Device& device, int runs, const std::function<double()>& run)
{
  run();
  std::vector<double> wall, core;
  for (int i = 0; i < runs; ++i)
  {
    const double start = CoreSeconds();
    wall.push_back(run());
    core.push_back((CoreSeconds() - start) / device.ComputeUnits());
  }
  return { Median(wall), Median(core) };
}

double Timed(const std::function<void()>& work)
{
  const double start = WallSeconds();
  work();
  return WallSeconds() - start;
}

void PaperScene::Voxelize(Device& device)
{
  this->voxels = tyndall::Voxelize(device, { this->solid }, this->settings);
}

void PaperScene::Group(double tolerance)
{
  OctreeSettings octreeSettings;
  octreeSettings.tolerance = tolerance;
  this->octree = BuildOctree(Domain(this->Medium().grid), this->Medium(), this->Index(), octreeSettings);
}

void PaperScene::Emit(std::size_t count, Sampler sampler, std::uint64_t seed)
{
  this->photons = EmitPhotons(this->settings.grid, this->light, { count, sampler, seed }).photons;
}

Medium PaperScene::Medium() const
{
  tyndall::Medium medium;
  medium.grid = this->settings.grid;
  medium.sigma_a = { this->voxels.sigma_a.data(), this->voxels.components };
  medium.sigma_s = { this->voxels.sigma_s.data(), this->voxels.components };
  medium.phase = PhaseFunction::HenyeyGreenstein(this->voxels.g);
  if (!this->voxels.gByVoxel.empty())
  {
    medium.phase = medium.phase.WithG({ this->voxels.gByVoxel.data(), this->voxels.components });
  }
  return medium;
}

PhotonMarcher PaperScene::Marcher(Device& device, const MarchSettings& marchSettings, bool withOctree) const
{
  return PhotonMarcher(device, Domain(this->Medium().grid), this->Medium(), this->Index(), marchSettings,
    withOctree ? this->octree.levels.data() : nullptr);
}

PaperScene MeshInFog(const std::string& name, TriangleMesh mesh, int edge)
{
  PaperScene scene;
  scene.name = name;
  scene.solid = { name, std::move(mesh), { GlassIndex, {}, { 0.02, 0.02, 0.02 }, 0.0 } };
  scene.settings.grid = GridAround({ scene.solid }, { edge, edge, edge }, 0.5, scene.settings.filterSize);
  const Grid& grid = scene.settings.grid;
  const double length = grid.Length(0);
  const auto place = [&](int a, double offset) { return grid.origin[a] + (0.5 + offset) * length; };
  scene.settings.outside = { 1.0, { 0.1 / length, 0.1 / length, 0.1 / length },
    { 0.8 / length, 0.8 / length, 0.8 / length }, 0.0 };
  Light lamp;
  lamp.type = LightType::Point;
  lamp.position = { place(0, 0.35), place(1, 0.2), place(2, 2.0) };
  lamp.power = { 100.0, 100.0, 100.0 };
  scene.light.lights = { lamp };
  return scene;
}

PaperScene BallInFog(int edge)
{
  return MeshInFog("ball", shapes::Sphere({ 0.0, 0.0, 0.0 }, 0.5), edge);
}

JsonLine PhotonLine(const char* what, const std::string& method, const Grid& grid)
{
  return JsonLine().Add("bench", "photons").Add("case", what).Add("method", method).Add("grid", GridName(grid));
}

double BytesOfDeposits(const PhotonLight& light)
{
  const int sums = light.light.channels + (light.meanDirection.empty() ? 0 : 3);
  return static_cast<double>(light.deposits) * (2.0 * 8.0 * sums + 4.0);
}

void PrintMarch(const char* what, const std::string& method, const PaperScene& scene, Device& device,
  const PhotonTimes& times, const PhotonLight& light, double bandwidth)
{
  PhotonLine(what, method, scene.settings.grid)
    .Add("photons", static_cast<double>(scene.photons.size()))
    .Add("threads", device.ComputeUnits())
    .Add("seconds", times.seconds)
    .Add("core_seconds", times.coreSeconds)
    .Add("peak_bytes", static_cast<double>(device.PeakBytes()))
    .Add("deposits", static_cast<double>(light.deposits))
    .Add("steps", static_cast<double>(light.steps))
    .Add("deposits_per_second", light.deposits / times.seconds)
    .Add("bytes_per_second", BytesOfDeposits(light) / times.seconds)
    .Add("part_of_bandwidth", BytesOfDeposits(light) / times.seconds / bandwidth)
    .Add("balance", light.light.balance.RelativeError(light.light.channels))
    .Print();
}

double RelativeL2(const std::vector<float>& values, const std::vector<float>& reference)
{
  double difference = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const double off = static_cast<double>(values[i]) - reference[i];
    difference += off * off;
    sum += static_cast<double>(reference[i]) * reference[i];
  }
  return std::sqrt(difference / sum);
}

double ObservedOrder(double before, double now, double ratio)
{
  return std::log(before / now) / std::log(ratio);
}
}
