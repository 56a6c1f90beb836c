// Photons through a refractive medium: the stages of Pfeuti's reference pipeline beside his times, what accumulation costs, how
// paths converge, and what the samplers are worth. How to read it: "seconds" is wall time, the median of several runs;
// "core_seconds" is processor time over the device's compute units, which other programs at work hardly change.
//
//   TyndallBenchPhotons [--quick]

#include "MachineLimits.h"
#include "Measure.h"
#include "Report.h"

#include "../Kernels/MeshShapes.h"
#include "../Kernels/PhotonScene.h"

#include "Device/Device.h"
#include "Device/Errors.h"
#include "Photons/PhotonEmitter.h"
#include "Photons/PublishedPhotons.h"
#include "Refraction/RefractionOctree.h"
#include "Refraction/RefractiveMedium.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>

using namespace bench;
using namespace tyndall;

namespace
{
/// Medians of several runs.
struct Times
{
  double seconds = 0.0;     ///< of the part that the run itself tells
  double coreSeconds = 0.0; ///< of all of it, a compute unit
};

Times Repeat(Device& device, int runs, const std::function<double()>& run)
{
  run(); // compiles, and takes the memory
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

std::string GridName(const Grid& grid)
{
  return std::to_string(grid.size[0]) + "x" + std::to_string(grid.size[1]) + "x" + std::to_string(grid.size[2]);
}

/// The sphere of glass in fog of Pfeuti's Figure 4.7: a lamp above it.
struct PaperScene
{
  RefractiveMediumSettings settings;
  Solid ball;
  Illumination light;
  RefractiveMedium voxels;
  Octree octree;
  std::vector<Photon> photons;

  explicit PaperScene(int edge)
  {
    this->ball = { "ball", shapes::Sphere({ 0.0, 0.0, 0.0 }, 0.5), { 1.5, {}, { 0.02, 0.02, 0.02 }, 0.0 } };
    this->settings.outside = { 1.0, { 0.05, 0.05, 0.05 }, { 0.4, 0.4, 0.4 }, 0.0 };
    this->settings.grid.size = { edge, edge, edge };
    this->settings.grid.spacing = { 2.0 / edge, 2.0 / edge, 2.0 / edge };
    this->settings.grid.origin = { -1.0, -1.0, -1.0 };
    Light lamp;
    lamp.type = LightType::Point;
    lamp.position = { 0.7, 0.4, 4.0 };
    lamp.power = { 100.0, 100.0, 100.0 };
    this->light.lights = { lamp };
  }

  void Voxelize(Device& device) { this->voxels = tyndall::Voxelize(device, { this->ball }, this->settings); }
  void Group() { this->octree = BuildOctree(this->TheMedium(), this->Index(), {}); }
  void Emit(std::size_t count, Sampler sampler = Sampler::Hammersley, std::uint64_t seed = 0)
  {
    this->photons = EmitPhotons(this->settings.grid, this->light, { count, sampler, seed }).photons;
  }

  Medium TheMedium() const
  {
    Medium medium;
    medium.grid = this->settings.grid;
    medium.sigma_a = { this->voxels.sigma_a.data(), this->voxels.components };
    medium.sigma_s = { this->voxels.sigma_s.data(), this->voxels.components };
    return medium;
  }
  Field Index() const { return { this->voxels.ior.data(), 1 }; }
  PhotonMarcher Marcher(Device& device, const MarchSettings& settings, bool octree) const
  {
    return PhotonMarcher(
      device, this->TheMedium(), this->Index(), settings, octree ? this->octree.levels.data() : nullptr);
  }
};

JsonLine Line(const char* what, const std::string& method, const Grid& grid)
{
  return JsonLine().Add("bench", "photons").Add("case", what).Add("method", method).Add("grid", GridName(grid));
}

void PrintMarch(const char* what, const std::string& method, const PaperScene& scene, Device& device,
  const Times& times, const PhotonLight& light)
{
  Line(what, method, scene.settings.grid)
    .Add("photons", static_cast<double>(scene.photons.size()))
    .Add("seconds", times.seconds)
    .Add("core_seconds", times.coreSeconds)
    .Add("peak_bytes", static_cast<double>(device.PeakBytes()))
    .Add("credits", static_cast<double>(light.credits))
    .Add("steps", static_cast<double>(light.steps))
    .Add("credits_per_second", light.credits / times.seconds)
    .Add("balance", light.light.balance.RelativeError(light.light.channels))
    .Print();
}

/// The stages beside the paper's times on a GTX 260, milliseconds.
void Stages(Device& device, PaperScene& scene, int runs)
{
  Table table({ "stage", "", "ms", "core ms", "paper ms" });
  const auto stage = [&](const char* name, double paper, const std::function<double()>& run) {
    const Times times = Repeat(device, runs, run);
    Line("stages", name, scene.settings.grid)
      .Add("seconds", times.seconds)
      .Add("core_seconds", times.coreSeconds)
      .Add("paper_seconds", 1e-3 * paper)
      .Print();
    table.Add(
      { name, "", Text("%.1f", 1e3 * times.seconds), Text("%.1f", 1e3 * times.coreSeconds), Text("%.0f", paper) });
  };
  stage("voxelisation", 25.0, [&] { return Timed([&] { scene.Voxelize(device); }); });
  stage("octree", 5.0, [&] { return Timed([&] { scene.Group(); }); });
  stage("generation", 1.0, [&] { return Timed([&] { scene.Emit(122000); }); });
  PhotonMarcher marcher = scene.Marcher(device, {}, true);
  stage("marching", 110.0, [&] { return marcher.March(scene.photons).secondsMarching; });
  stage("marching with sorting and copies", 110.0, [&] { return marcher.March(scene.photons).seconds; });
  stage("preparing the medium", 0.0, [&] { return Timed([&] { scene.Marcher(device, {}, true); }); });
  table.Print("Stages, 122000 photons (paper: GTX 260)");
}

void Ways(Device& device, const PaperScene& scene, int runs)
{
  Table table({ "marching", "", "ms", "core ms", "steps", "credits/s", "balance" });
  const auto way = [&](const std::string& name, const std::function<PhotonLight()>& march) {
    PhotonLight light;
    device.ResetPeak();
    const Times times = Repeat(device, runs, [&] {
      light = march();
      return light.secondsMarching;
    });
    PrintMarch("marching", name, scene, device, times, light);
    table.Add({ name, "", Text("%.1f", 1e3 * times.seconds), Text("%.1f", 1e3 * times.coreSeconds),
      std::to_string(light.steps), Text("%.2e", light.credits / times.seconds),
      Text("%.1e", light.light.balance.RelativeError(light.light.channels)) });
    return times.seconds;
  };
  const auto sound = [&](const std::string& name, const MarchSettings& settings, bool octree) {
    PhotonMarcher marcher = scene.Marcher(device, settings, octree);
    return way(name, [&] { return marcher.March(scene.photons); });
  };
  MarchSettings settings;
  const double fitting = sound("sound, octree", settings, true);
  sound("sound, voxel by voxel", settings, false);
  settings.order = 4;
  sound("sound, order 4, octree", settings, true);
  settings.order = 2;
  settings.sums = MarchSettings::Sums::Shared;
  sound("sound, shared sums (atomics)", settings, true);
  settings.sums = MarchSettings::Sums::Unsafe;
  const double plain = sound("sound, plain additions that lose some", settings, true);
  Line("accumulation", "fitting against plain", scene.settings.grid)
    .Add("ratio", fitting / plain)
    .Add("against", "plain")
    .Print();
  PackingLoss loss;
  way("as published", [&] {
    return MarchPublished(
      device, scene.TheMedium(), scene.Index(), scene.octree.levels.data(), scene.photons, { 10, false }, &loss);
  });
  Line("packing", "as published", scene.settings.grid)
    .Add("lost", loss.Relative())
    .Add("given_up", static_cast<double>(loss.givenUp))
    .Add("credits", static_cast<double>(loss.credits))
    .Print();
  PaperScene straight = scene;
  std::fill(straight.voxels.ior.begin(), straight.voxels.ior.end(), 1.0f);
  PhotonMarcher marcher = straight.Marcher(device, {}, false);
  way("sound, constant index", [&] { return marcher.March(straight.photons); });
  table.Print("Marching 122000 photons");
}

void Scaling(Device& device, bool quick, int runs)
{
  for (const int edge : quick ? std::vector<int>{ 32 } : std::vector<int>{ 64, 128, 256 })
  {
    PaperScene scene(edge);
    scene.Voxelize(device);
    scene.Group();
    for (const std::size_t count :
      quick ? std::vector<std::size_t>{ 10000 } : std::vector<std::size_t>{ 10000, 122000, 1000000 })
    {
      scene.Emit(count);
      PhotonMarcher marcher = scene.Marcher(device, {}, true);
      PhotonLight light;
      device.ResetPeak();
      const Times times = Repeat(device, runs, [&] {
        light = marcher.March(scene.photons);
        return light.secondsMarching;
      });
      PrintMarch("scaling", "sound, octree", scene, device, times, light);
    }
  }
}

double RelativeError(const std::vector<float>& values, const std::vector<float>& reference)
{
  double difference = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    difference += (values[i] - reference[i]) * (values[i] - reference[i]);
    sum += reference[i] * reference[i];
  }
  return std::sqrt(difference / sum);
}

/// The paper's Figure 4.1 and Table 4.1, with numbers.
void Samplers(Device& device, bool quick, int runs)
{
  const char* const names[] = { "Hammersley", "Halton", "jittered", "grid", "random" };
  const std::vector<std::size_t> counts =
    quick ? std::vector<std::size_t>{ 1000 } : std::vector<std::size_t>{ 10000, 30000, 122000 };
  PaperScene scene(quick ? 16 : 64);
  scene.Voxelize(device);
  scene.Group();
  PhotonMarcher marcher = scene.Marcher(device, {}, true);
  std::vector<std::string> headings = { "sampler", "" };
  for (const std::size_t count : counts)
  {
    headings.push_back(std::to_string(count));
  }
  headings.push_back("core ms");
  Table table(headings);
  scene.Emit(100 * counts.back());
  const std::vector<float> rich = marcher.March(scene.photons).light.fluence;
  for (int sampler = 0; sampler < 5; ++sampler)
  {
    std::vector<std::string> row = { names[sampler], "" };
    Times times;
    for (const std::size_t count : counts)
    {
      scene.Emit(count, static_cast<Sampler>(sampler), 1);
      PhotonLight light;
      times = Repeat(device, runs, [&] {
        light = marcher.March(scene.photons);
        return light.secondsMarching;
      });
      const double error = RelativeError(light.light.fluence, rich);
      Line("samplers", names[sampler], scene.settings.grid)
        .Add("photons", static_cast<double>(count))
        .Add("error_l2", error)
        .Add("seconds", times.seconds)
        .Add("core_seconds", times.coreSeconds)
        .Print();
      row.push_back(Text("%.4f", error));
    }
    row.push_back(Text("%.1f", 1e3 * times.coreSeconds));
    table.Add(row);
  }
  table.Print("Relative L2 error of fluence by photons, against a hundred times the largest number");
}

/// How far paths through a Luneburg lens (index continued beyond its surface) are from the exact ones.
void Convergence(Device& device, bool quick)
{
  PhotonScene scene(quick ? 32 : 128, 1.1);
  scene.SetIndex(luneburg::Endless);
  Table table({ "step, voxels", "corners", "order 1", "order 2", "order 4" });
  for (const double step :
    quick ? std::vector<double>{ 4.0, 2.0 } : std::vector<double>{ 24.0, 12.0, 6.0, 4.0, 2.0, 1.0 })
  {
    std::vector<std::string> row = { Text("%g", step), "" };
    for (const int order : { 1, 2, 4 })
    {
      scene.settings.order = order;
      scene.settings.stepSize = step;
      double worst = 0.0;
      std::size_t corners = 0;
      for (const double b : { 0.3, 0.5, 0.7 })
      {
        const PhotonPath path = scene.Path(device, { -std::sqrt(1.0 - b * b), b, 0.0 }, { 1.0, 0.0, 0.0 });
        worst = std::max(worst, luneburg::WorstCorner(path, b));
        corners = std::max(corners, path.points.size());
      }
      row[1] = std::to_string(corners);
      row.push_back(Text("%.2e", worst));
      Line("luneburg", "order " + std::to_string(order), scene.medium.grid)
        .Add("step", step)
        .Add("iterations", static_cast<double>(corners))
        .Add("error_max", worst)
        .Print();
    }
    table.Add(row);
  }
  table.Print("Luneburg lens of radius 1: largest distance of a path's corners from the exact path");
}

void RunAll(Device& device, bool quick)
{
  const int runs = quick ? 1 : 7;
  const MachineLimits limits = MeasureLimits(device, !quick);
  Line("machine", device.Name(), {}).Add("bytes_per_second", limits.bytes).Add("load", LoadAverage()).Print();
  PaperScene scene(quick ? 32 : 128);
  Stages(device, scene, runs);
  Ways(device, scene, runs);
  Convergence(device, quick);
  Samplers(device, quick, quick ? 1 : 3);
  Scaling(device, quick, quick ? 1 : 3);
}
}

int main(int argc, char* argv[])
{
  const bool quick = std::getenv("TYNDALL_BENCH_QUICK") || (argc > 1 && std::strcmp(argv[1], "--quick") == 0);
  try
  {
    RunAll(*Device::Find(), quick);
    return EXIT_SUCCESS;
  }
  catch (const DeviceError& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return std::getenv("TYNDALL_REQUIRE_DEVICE") ? EXIT_FAILURE : 125;
  }
}
