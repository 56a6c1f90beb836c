// Light propagation maps, all ways to solve them side by side in one run: sequential and parallel as published, the
// fused solver, and its control in C++.
//
//   TyndallBenchLpm [--quick] [--sizes 32,64,128,256] [--repetitions N] [--scan build/data/skull_2.9.inr]
//
// --quick (or TYNDALL_BENCH_QUICK in the environment): seconds, small grids, few repetitions. A medium made by chance,
// and the CT scan where its file is there. JSON lines as the figures are found, then tables.

#include "Control.h"
#include "LpmRuns.h"
#include "LpmScenes.h"
#include "LpmTables.h"
#include "MachineLimits.h"
#include "Measure.h"
#include "Report.h"

#include "Device/Errors.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Published/ParallelPropagation.h"
#include "LightPropagation/Published/SequentialPropagation.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

using namespace bench;
using namespace tyndall;

namespace
{
struct Options
{
  bool quick = std::getenv("TYNDALL_BENCH_QUICK") != nullptr;
  std::vector<int> edges;
  int repetitions = 0; ///< of the fast methods; 0: as many as the grid's size allows
  std::string scan = "build/data/skull_2.9.inr";
};

Options ReadOptions(int argc, char* argv[])
{
  Options options;
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    const char* value = i + 1 < argc ? argv[i + 1] : "";
    if (word == "--quick")
    {
      options.quick = true;
      continue;
    }
    ++i;
    if (word == "--sizes")
    {
      std::istringstream edges(value);
      for (std::string edge; std::getline(edges, edge, ',');)
      {
        options.edges.push_back(std::max(16, std::atoi(edge.c_str()) / 16 * 16)); // the control's rule
      }
    }
    else if (word == "--repetitions")
    {
      options.repetitions = std::atoi(value);
    }
    else if (word == "--scan")
    {
      options.scan = value;
    }
    else
    {
      throw std::runtime_error("TyndallBenchLpm: what is " + word + "? See the top of Lpm.cxx.");
    }
  }
  if (options.edges.empty())
  {
    options.edges = options.quick ? std::vector<int>{ 32, 64 } : std::vector<int>{ 32, 64, 128, 256 };
  }
  return options;
}

int Repetitions(const Options& options, double updates)
{
  if (options.repetitions > 0)
  {
    return options.repetitions;
  }
  const int fitting = static_cast<int>(20e9 / updates); // about ten seconds for each fast method
  return std::clamp(fitting, 2, options.quick ? 3 : 15);
}

std::vector<Method> MethodsFor(
  Device& device, const Scene& scene, const PropagationSettings& settings, const Options& options)
{
  const double voxels = static_cast<double>(scene.medium.grid.VoxelCount());
  const int repetitions = Repetitions(options, voxels * scene.channels * 6 * DirectionsPerFace * Orders);
  const Medium& medium = scene.medium;
  const Illumination& light = scene.light;
  std::vector<Method> methods;
  if (voxels <= (options.quick ? 32 * 32 * 32 : 64 * 64 * 64))
  {
    methods.push_back({ Sequential, 1, false, "",
      [&](const Monitor& monitor) { return SolveSequential(medium, light, settings, monitor); } });
  }
  const bool large = voxels > 128 * 128 * 128;
  methods.push_back({ Parallel, large || options.quick ? 1 : std::min(repetitions, 5), !large, Sequential,
    [&](const Monitor& monitor) { return SolveParallel(device, medium, light, settings, monitor); } });
  methods.push_back({ Conservative, repetitions, true, "",
    [&](const Monitor& monitor) { return SolveConservative(device, medium, light, settings, monitor); } });
  const auto control = [&](const std::string& name, const control::Kernels& kernels, bool polynomials) {
    methods.push_back({ name, repetitions, true, Conservative,
      [&medium, &light, &settings, kernels, polynomials](
        const Monitor& monitor) { return control::Solve(kernels, polynomials, medium, light, settings, monitor); } });
  };
  for (const control::Kernels& kernels : control::KernelsHere())
  {
    control("control " + std::string(kernels.name), kernels, true);
    if (!options.quick && !large)
    {
      control("control " + std::string(kernels.name) + ", exp", kernels, false);
    }
  }
  return methods;
}

Case RunCase(Device& device, const Scene& scene, const MachineLimits& limits, const Options& options)
{
  PropagationSettings settings;
  settings.directionsPerFace = DirectionsPerFace;
  settings.maximumOrders = Orders;
  Case result;
  result.scene = scene.name;
  result.grid = scene.GridName();
  result.edge = scene.medium.grid.size[0];
  result.random = scene.name.rfind("random", 0) == 0;
  result.channels = scene.channels;
  result.cores = device.ComputeUnits();
  result.updates = static_cast<double>(scene.medium.grid.VoxelCount()) * scene.channels * 6 * DirectionsPerFace;
  result.work = CountSweepWork(device, scene.medium, DirectionsPerFace, scene.channels);
  result.limits = limits;
  result.figures = RunInterleaved(device, MethodsFor(device, scene, settings, options), Orders);
  PrintJson(result);
  return result;
}

std::vector<Case> RunAll(Device& device, const Options& options)
{
  const MachineLimits limits = MeasureLimits(device, !options.quick);
  PrintJson(device, limits);
  std::vector<Case> cases;
  const bool scan = std::ifstream(options.scan).good();
  for (const int edge : options.edges)
  {
    for (const int channels : { 1, 3 })
    {
      cases.push_back(RunCase(device, RandomScene(edge, channels), limits, options));
      if (edge == 64 && scan)
      {
        cases.push_back(RunCase(device, ScanScene(options.scan, channels), limits, options));
      }
    }
  }
  if (!scan)
  {
    std::fprintf(
      stderr, "There is no CT scan %s: left out (--scan FILE; ./run demo fetches it)\n", options.scan.c_str());
  }
  return cases;
}
}

int main(int argc, char* argv[])
{
  try
  {
    const Options options = ReadOptions(argc, argv);
    const std::shared_ptr<Device> device = Device::Find();
    const std::vector<Case> cases = RunAll(*device, options);
    PrintTables(cases);
    const bool fused = std::all_of(cases.begin(), cases.end(), [](const Case& one) { return one.Find(Conservative); });
    return fused ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  catch (const DeviceError& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return std::getenv("TYNDALL_REQUIRE_DEVICE") ? EXIT_FAILURE : 125;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
