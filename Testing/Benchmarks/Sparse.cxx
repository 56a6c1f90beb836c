// A medium that is mostly empty against one that fills its box.
//
//   TyndallBenchSparse [streaks] [photons] [many] [scattered] [view] [inside] [maps] [EDGE...]
//                                    by default photons, view and maps, at 128 and 256 voxels an edge
//
// Fourteen cloudlets, apart from each other, of which 5% of the voxels are filled, and a haze of the same mean
// extinction over the whole box: from constructing a solver on arrays in memory to its light, or to a picture. `again`:
// once more, of a solver that keeps its medium (other photons, another camera). `by voxel`: the cloudlets as if they
// filled the box. `seconds` is the shorter of two, as large grids take long; kernels were compiled on a small one.
// `peak_bytes` is beyond the scene's own arrays.
//   streaks    instead of cloudlets, long ones with a sun along them, which nobody had in mind when the code was made
//   many       sixteen times the photons: how often what does not depend on their number counts
//   scattered  a twentieth of the photons, followed through all their scatterings
//   inside     pictures from the middle of the box

#include "Measure.h"
#include "Program.h"
#include "Report.h"

#include "Device/Errors.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "Medium/FilledBricks.h"
#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Marching/PhotonMarcher.h"
#include "Viewing/MediumRayCaster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace tyndall;

namespace
{
constexpr double Thickness = 60.0; ///< of the box's edge at density 1: a cloudlet has a sixth
constexpr double Albedo = 0.99;
constexpr std::size_t PhotonCount = 122000;
constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

struct Scene
{
  std::string name;
  std::array<double, 3> sun = { -0.5, 0.4, -0.8 }; ///< where its light goes
  Grid grid;
  std::vector<float> sigma_a, sigma_s, fluence;

  Medium SeenMedium() const
  {
    Medium medium;
    medium.grid = this->grid;
    medium.sigma_a = { this->sigma_a.data(), 1 };
    medium.sigma_s = { this->sigma_s.data(), 1 };
    return medium;
  }
};

Scene EmptyScene(const char* name, int edge)
{
  Scene scene;
  scene.name = name;
  scene.grid.size = { edge, edge, edge };
  scene.grid.spacing = { 1.0 / edge, 1.0 / edge, 1.0 / edge };
  return scene;
}

void Fill(Scene& scene, std::vector<float>&& density)
{
  scene.fluence.resize(density.size());
  scene.sigma_a.resize(density.size());
  scene.sigma_s = std::move(density);
  for (std::size_t voxel = 0; voxel < scene.sigma_s.size(); ++voxel)
  {
    const double sigma_t = Thickness * scene.sigma_s[voxel];
    scene.sigma_a[voxel] = static_cast<float>((1.0 - Albedo) * sigma_t);
    scene.sigma_s[voxel] = static_cast<float>(Albedo * sigma_t);
    scene.fluence[voxel] = 1.0f + 0.5f * static_cast<float>(voxel % scene.grid.size[0]) / scene.grid.size[0];
  }
}

/// Adds a cloudlet that is densest in its middle.
void AddCloudlet(const Grid& grid, const std::array<double, 3>& middle, const std::array<double, 3>& radii,
  std::vector<float>& density)
{
  const int edge = grid.size[0];
  const auto low = [&](int a) { return std::max(0, static_cast<int>((middle[a] - radii[a]) * edge)); };
  const auto high = [&](int a) { return std::min(edge, static_cast<int>((middle[a] + radii[a]) * edge) + 1); };
  for (int k = low(2); k < high(2); ++k)
  {
    for (int j = low(1); j < high(1); ++j)
    {
      for (int i = low(0); i < high(0); ++i)
      {
        const double x = (i + 0.5) / edge, y = (j + 0.5) / edge, z = (k + 0.5) / edge;
        const double away =
          std::hypot((x - middle[0]) / radii[0], (y - middle[1]) / radii[1], (z - middle[2]) / radii[2]);
        float& here = density[grid.IndexOf({ i, j, k })];
        here = std::max(here, static_cast<float>(std::clamp(3.0 * (1.0 - away), 0.0, 1.0)));
      }
    }
  }
}

Scene Cloudlets(int edge)
{
  Scene scene = EmptyScene("cloudlets", edge);
  std::vector<float> density(scene.grid.VoxelCount(), 0.0f);
  std::mt19937 random(7);
  const auto place = [&] { return 0.1 + 0.8 * static_cast<double>(random()) / 4294967296.0; };
  for (int cloudlet = 0; cloudlet < 14; ++cloudlet)
  {
    const std::array<double, 3> middle = { place(), place(), place() };
    AddCloudlet(scene.grid, middle, { 0.1, 0.1, 0.1 }, density);
  }
  Fill(scene, std::move(density));
  return scene;
}

/// A hundred, of a fifth of the box by 1/30 of it at most.
Scene Streaks(int edge)
{
  Scene scene = EmptyScene("streaks", edge);
  scene.sun = { 1.0, 0.05, -0.2 };
  std::vector<float> density(scene.grid.VoxelCount(), 0.0f);
  std::mt19937 random(2026);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  for (int streak = 0; streak < 100; ++streak)
  {
    const std::array<double, 3> middle = { between(0.0, 1.0), between(0.0, 1.0), between(0.0, 1.0) };
    const std::array<double, 3> radii = { between(0.1, 0.2), between(0.015, 0.035), between(0.015, 0.035) };
    AddCloudlet(scene.grid, middle, radii, density);
  }
  Fill(scene, std::move(density));
  return scene;
}

double MeanDensity(const Scene& scene)
{
  double mean = 0.0;
  for (const float sigma_s : scene.sigma_s)
  {
    mean += sigma_s / (Albedo * Thickness) / static_cast<double>(scene.sigma_s.size());
  }
  return mean;
}

Scene Haze(int edge, double mean, const std::array<double, 3>& sun)
{
  Scene scene = EmptyScene("haze", edge);
  scene.sun = sun;
  std::vector<float> density(scene.grid.VoxelCount());
  for (std::size_t voxel = 0; voxel < density.size(); ++voxel)
  {
    const std::array<int, 3> at = scene.grid.VoxelAt(voxel);
    const double wave = std::sin(37.0 * at[0] / edge) + std::sin(41.0 * at[1] / edge) + std::sin(43.0 * at[2] / edge);
    density[voxel] = static_cast<float>(mean * (1.0 + 0.15 * wave));
  }
  Fill(scene, std::move(density));
  return scene;
}

/// One way to do a thing: `first` makes what `again` uses.
struct Run
{
  std::string method, scene;
  double seconds, again, peak, cores;
};

void MeasureInto(Run& run, const std::function<void()>& first, const std::function<void()>& again)
{
  const bench::PeakMemory memory;
  for (int time = 0; time < 2; ++time)
  {
    const double start = bench::WallSeconds(), cores = bench::CoreSeconds();
    first();
    const double seconds = bench::WallSeconds() - start;
    if (!(seconds > run.seconds)) // nor is it known at first
    {
      run.seconds = seconds;
      run.cores = bench::CoreSeconds() - cores;
    }
  }
  if (again)
  {
    const double second = bench::WallSeconds();
    again();
    run.again = bench::WallSeconds() - second;
  }
  run.peak = memory.Bytes();
}

/// What does not fit into the device's memory says so.
Run Measured(const std::string& method, const Scene& scene, const std::function<void()>& first,
  const std::function<void()>& again = {})
{
  Run run = { method, scene.name, Unknown, Unknown, Unknown, Unknown };
  try
  {
    MeasureInto(run, first, again);
  }
  catch (const DeviceError& error)
  {
    std::printf("%s, %s: %s\n", method.c_str(), scene.name.c_str(), error.what());
  }
  return run;
}

/// The last of them is that of the medium that fills its box, against which the others are.
void PrintRuns(const char* what, int edge, double filledBricks, const std::vector<Run>& runs)
{
  bench::Table table(
    { "method", "medium", "s", "of dense", "again, s", "of dense", "cores, s", "of dense", "MiB", "of dense" });
  const Run& dense = runs.back();
  for (const Run& run : runs)
  {
    bench::JsonLine()
      .Add("bench", "sparse")
      .Add("case", std::string(what) + ", " + run.scene)
      .Add("method", run.method)
      .Add("grid", bench::GridText(edge))
      .Add("seconds", run.seconds)
      .Add("core_seconds", run.cores)
      .Add("seconds_again", run.again)
      .Add("peak_bytes", run.peak)
      .Add("ratio", run.seconds / dense.seconds)
      .Add("ratio_core", run.cores / dense.cores)
      .Add("ratio_again", run.again / dense.again)
      .Add("ratio_memory", run.peak / dense.peak)
      .Add("against", dense.scene)
      .Add("filled_bricks", run.scene == dense.scene ? 1.0 : filledBricks)
      .Add("load", bench::LoadAverage())
      .Print();
    table.Add(
      { run.method, run.scene, bench::Text("%.2f", run.seconds), bench::Text("%.2f", run.seconds / dense.seconds),
        bench::Text("%.2f", run.again), bench::Text("%.2f", run.again / dense.again), bench::Text("%.2f", run.cores),
        bench::Text("%.2f", run.cores / dense.cores), bench::Text("%.0f", run.peak / (1 << 20)),
        bench::Text("%.2f", run.peak / dense.peak) });
  }
  table.Print(std::string(what) + ", " + bench::GridText(edge));
}

/// @param orders  1: photons are followed to where they are first scattered; 0: to their ends
Run MarchOf(Device& device, const Scene& scene, bool byBricks, int orders, std::size_t count)
{
  Illumination illumination;
  Light sun;
  sun.direction = scene.sun;
  illumination.lights = { sun };
  const std::vector<Photon> photons = EmitPhotons(scene.grid, illumination, { count, Sampler::Hammersley, 0 }).photons;
  MarchSettings settings;
  settings.byBricks = byBricks;
  settings.maximumOrders = orders;
  std::unique_ptr<PhotonMarcher> marcher;
  PhotonLight light;
  return Measured(
    byBricks ? "by bricks" : "by voxel", scene,
    [&] {
      light = {};
      marcher.reset();
      marcher =
        std::make_unique<PhotonMarcher>(device, Domain(scene.SeenMedium().grid), scene.SeenMedium(), Field{}, settings);
      light = marcher->March(photons);
    },
    [&] {
      light = {};
      light = marcher->March(photons);
    });
}

Camera CameraOf(const Scene& scene, int view, bool inside)
{
  const double angle = 0.5 + 0.05 * view;
  const std::array<double, 3> from = { std::sin(angle), -std::cos(angle), 0.45 };
  Camera camera = FrameGrid(scene.grid, 4.0 / 3.0, inside ? 90.0 : 30.0, from);
  if (inside)
  {
    camera.position = { 0.5, 0.5, 0.5 };
    camera.focalPoint = { 0.5 - from[0], 0.5 - from[1], 0.5 - from[2] };
  }
  return camera;
}

Run ViewOf(Device& device, const Scene& scene, bool inside)
{
  ViewSettings settings;
  settings.imageSize = { 800, 600 };
  SolvedLight light;
  light.fluence = { scene.fluence.data(), 1 };
  std::unique_ptr<MediumRayCaster> caster;
  return Measured(
    "rays", scene,
    [&] {
      caster.reset();
      caster = std::make_unique<MediumRayCaster>(device, scene.SeenMedium(), light, Illumination(), settings);
      caster->Render(CameraOf(scene, 0, inside));
    },
    [&] { caster->Render(CameraOf(scene, 1, inside)); });
}

Run MapsOf(Device& device, const Scene& scene, int orders)
{
  Illumination illumination;
  illumination.sky = { 0.1, 0.1, 0.1 };
  Light sun;
  sun.direction = scene.sun;
  illumination.lights = { sun };
  PropagationSettings settings;
  settings.maximumOrders = orders;
  return Measured("light propagation maps", scene,
    [&] { SolveConservative(device, scene.SeenMedium(), illumination, settings, {}); });
}

/// What is run of each scene, and what is found.
struct Case
{
  const char* name;
  const char* word; ///< that asks for it
  bool byDefault;
  std::function<Run(const Scene& scene, bool byBricks)> run;
  bool hasBricks = false; ///< sparse scenes run by bricks, too
  std::vector<Run> runs;
};

std::vector<Case> CasesOf(Device& device)
{
  const auto march = [&device](int orders, std::size_t count) {
    return [&device, orders, count](
             const Scene& scene, bool byBricks) { return MarchOf(device, scene, byBricks, orders, count); };
  };
  const auto view = [&device](bool inside) {
    return [&device, inside](const Scene& scene, bool) { return ViewOf(device, scene, inside); };
  };
  const auto maps = [&device](int orders) {
    return [&device, orders](const Scene& scene, bool) { return MapsOf(device, scene, orders); };
  };
  return { { "photons", "photons", true, march(1, PhotonCount), true, {} },
    { "many photons", "many", false, march(1, 16 * PhotonCount), true, {} },
    { "photons that are scattered", "scattered", false, march(0, PhotonCount / 20), false, {} },
    { "view", "view", true, view(false), false, {} }, { "view from inside", "inside", false, view(true), false, {} },
    { "maps, 3 orders", "maps", true, maps(3), false, {} }, { "maps, converged", "maps", true, maps(0), false, {} } };
}

bool Asks(const bench::Arguments& arguments, const Case& what)
{
  const std::vector<std::string>& words = arguments.words;
  const bool named = std::any_of(words.begin(), words.end(),
    [](const std::string& word) { return std::atoi(word.c_str()) == 0 && word != "streaks"; });
  return named ? std::find(words.begin(), words.end(), what.word) != words.end() : what.byDefault;
}

/// Scenes are there one after the other: at 512^3 each takes gigabytes.
void RunAll(Device& device, const bench::Arguments& arguments, int edge, bool print)
{
  std::vector<Case> cases = CasesOf(device);
  const auto run = [&](const Scene& scene, bool dense) {
    for (Case& one : cases)
    {
      for (const bool byBricks : { true, false })
      {
        if (Asks(arguments, one) && (!byBricks || (one.hasBricks && !dense)))
        {
          one.runs.push_back(one.run(scene, byBricks));
        }
      }
    }
  };
  const std::vector<std::string>& words = arguments.words;
  const bool streaks = std::find(words.begin(), words.end(), "streaks") != words.end();
  double mean = 0.0, filledBricks = 0.0;
  std::array<double, 3> sun;
  {
    const Scene sparse = streaks ? Streaks(edge) : Cloudlets(edge);
    mean = MeanDensity(sparse);
    sun = sparse.sun;
    filledBricks = FindFilledBricks(sparse.SeenMedium()).FilledPart();
    run(sparse, false);
  }
  run(Haze(edge, mean, sun), true);
  for (const Case& one : cases)
  {
    if (print && !one.runs.empty())
    {
      PrintRuns(one.name, edge, filledBricks, one.runs);
    }
  }
}

void RunBenchmark(Device& device, const bench::Arguments& arguments)
{
  std::vector<int> edges;
  for (const std::string& word : arguments.words)
  {
    if (std::atoi(word.c_str()) > 0)
    {
      edges.push_back(std::atoi(word.c_str()));
    }
  }
  if (edges.empty())
  {
    edges = arguments.quick ? std::vector<int>{ 96 } : std::vector<int>{ 128, 256 };
  }
  if (!arguments.quick)
  {
    RunAll(device, arguments, 96, false); // compiles, also what only a grid of many bricks needs
  }
  for (const int edge : edges)
  {
    RunAll(device, arguments, edge, true);
  }
}
}

int main(int argc, char* argv[])
{
  return bench::RunOnDevice(argc, argv, RunBenchmark);
}
