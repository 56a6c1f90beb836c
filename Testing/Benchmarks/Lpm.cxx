// Light propagation maps, all ways to solve them side by side in one run: sequential and parallel as published, and the
// conservative solver, with its share of what the machine can do at most.
//
//   TyndallBenchLpm [--quick] [--sizes 32,64,128,256] [--repetitions N] [--scan build/data/skull_2.9.inr]
//
// --quick (or TYNDALL_BENCH_QUICK in the environment): seconds, small grids, few repetitions. A medium made by chance,
// and the CT scan where its file is there. JSON lines as the figures are found, then tables.

#include "LpmRuns.h"
#include "LpmScenes.h"
#include "LpmTables.h"
#include "MachineLimits.h"
#include "Program.h"

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
  bool quick = false;
  std::vector<int> edges;
  int repetitions = 0; ///< of the fast methods; 0: as many as the grid's size allows
  std::string scan = "build/data/skull_2.9.inr";
};

std::vector<int> Numbers(const std::string& text)
{
  std::vector<int> numbers;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');)
  {
    numbers.push_back(std::max(1, std::atoi(word.c_str())));
  }
  return numbers;
}

Options OptionsOf(const Arguments& arguments)
{
  Options options;
  options.quick = arguments.quick;
  options.edges = options.quick ? std::vector<int>{ 32, 64 } : std::vector<int>{ 32, 64, 128, 256 };
  for (std::size_t i = 0; i < arguments.words.size(); i += 2)
  {
    const std::string& word = arguments.words[i];
    const std::string value = i + 1 < arguments.words.size() ? arguments.words[i + 1] : "";
    if (word == "--sizes")
    {
      options.edges = Numbers(value);
    }
    else if (word == "--repetitions")
    {
      options.repetitions = std::atoi(value.c_str());
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

void RunAll(Device& device, const Arguments& arguments)
{
  const Options options = OptionsOf(arguments);
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
  PrintTables(cases);
  if (!std::all_of(cases.begin(), cases.end(), [](const Case& one) { return one.Find(Conservative); }))
  {
    throw std::runtime_error("The conservative solver failed.");
  }
}
}

int main(int argc, char* argv[])
{
  return RunOnDevice(argc, argv, RunAll);
}
