// Volumes that are streamed through a part of the device's memory, beside the same ones as a whole: seconds, bytes on
// the device, and whether it is the same light (Gruson et al., section 4.2 and figure 7).
//
//   TyndallBenchStream [--quick] [edge, or "orders", "converged", "photons", or budget=<MiB>...]
//
// With a budget the whole solve is left out. Kernels are compiled on the way: figures are those of a second run.
//
// photons: each core's own sums, and one sum that all add to by atomics, which is what a budget leaves room for that is
// a twentieth less than what the former take. Both in turns; medians of five and the ratio of each pair's times.

#include "LpmScenes.h"
#include "Measure.h"
#include "Program.h"
#include "Report.h"

#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Marching/PhotonMarcher.h"

#include <cctype>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace bench;
using namespace tyndall;

namespace
{
constexpr std::size_t MiB = std::size_t(1) << 20;
constexpr std::size_t PartOfWhole = 4; ///< budget of streamed solves

struct Asked
{
  std::vector<int> edges;
  std::vector<std::string> cases;
  std::size_t budget = 0; ///< 0: a part of what the whole takes
};

Asked Read(const Arguments& arguments)
{
  Asked asked;
  for (const std::string& word : arguments.words)
  {
    if (word.rfind("budget=", 0) == 0)
    {
      asked.budget = std::stoul(word.substr(7)) * MiB;
    }
    else if (std::isdigit(static_cast<unsigned char>(word[0])))
    {
      asked.edges.push_back(std::stoi(word));
    }
    else
    {
      asked.cases.push_back(word);
    }
  }
  if (asked.edges.empty())
  {
    asked.edges = arguments.quick ? std::vector<int>{ 16 } : std::vector<int>{ 64, 128, 256 };
  }
  if (asked.cases.empty())
  {
    asked.cases = { "orders", "converged", "photons" };
  }
  return asked;
}

struct Run
{
  std::string method;
  double seconds = 0.0, core = 0.0;
  std::size_t onDevice = 0;
  double ofProcess = 0.0;
  LightField light;
};

/// @param copies  the device is taken to have memory of its own
Run Solve(Device& device, const Scene& scene, PropagationSettings settings, std::size_t budget, bool copies)
{
  settings.memoryBudget = budget;
  if (copies)
  {
    setenv("TYNDALL_WITHOUT", "host_memory", 1);
  }
  const std::size_t before = device.BytesInUse();
  device.ResetPeak();
  const PeakMemory memory;
  const double wall = WallSeconds(), core = CoreSeconds();
  Run run;
  run.method = budget == 0 ? "whole" : copies ? "streamed by copies" : "streamed in place";
  run.light = SolveConservative(device, scene.medium, scene.light, settings);
  run.seconds = WallSeconds() - wall;
  run.core = CoreSeconds() - core;
  run.onDevice = device.PeakBytes() - before;
  run.ofProcess = memory.Bytes();
  unsetenv("TYNDALL_WITHOUT");
  return run;
}

void Tell(const Scene& scene, const std::string& which, const Run& run, const Run* whole, Table& table)
{
  JsonLine line;
  line.Add("bench", "stream")
    .Add("case", which)
    .Add("method", run.method)
    .Add("grid", scene.GridName())
    .Add("seconds", run.seconds)
    .Add("core_seconds", run.core)
    .Add("peak_bytes", static_cast<double>(run.onDevice))
    .Add("process_bytes", run.ofProcess)
    .Add("iterations", static_cast<double>(run.light.convergence.size()))
    .Add("balance", run.light.balance.RelativeError(run.light.channels))
    .Add("device", run.light.device);
  std::string same = "-";
  if (whole)
  {
    same = run.light.fluence == whole->light.fluence ? "yes" : "NO";
    line.Add("ratio", run.core / whole->core).Add("against", whole->method).Add("same_bits", same);
  }
  line.Print();
  table.Add({ scene.GridName(), which, run.method, Text("%.2f", run.seconds), Text("%.2f", run.core),
    Text("%.1f", static_cast<double>(run.onDevice) / MiB), Text("%.1f", run.ofProcess / MiB), same });
}

std::vector<Photon> SunOn(const Grid& grid)
{
  // Sums of few voxels are little beside the ends of many photons: a budget could not do without one of them.
  const std::size_t count = std::min<std::size_t>(122000, grid.VoxelCount() / 2);
  Illumination illumination;
  Light sun;
  sun.direction = { -0.5, 0.4, -0.8 };
  illumination.lights = { sun };
  return EmitPhotons(grid, illumination, { count, Sampler::Hammersley, 0 }).photons;
}

/// Of a marcher that has its sums already.
struct MarchTimes
{
  std::size_t onDevice = 0;
  std::vector<double> wall, core;
  std::vector<float> fluence;

  void Add(PhotonMarcher& marcher, const std::vector<Photon>& photons)
  {
    const double start = WallSeconds(), cores = CoreSeconds();
    PhotonLight light = marcher.March(photons);
    this->wall.push_back(WallSeconds() - start);
    this->core.push_back(CoreSeconds() - cores);
    this->fluence = std::move(light.light.fluence);
  }
};

std::vector<double> Ratios(const std::vector<double>& values, const std::vector<double>& to)
{
  std::vector<double> ratios;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    ratios.push_back(values[i] / to[i]);
  }
  return ratios;
}

/// Photons with and without a budget, in turns.
void MarchWithin(Device& device, const Scene& scene, Table& table)
{
  constexpr int Times = 5;
  const std::vector<Photon> photons = SunOn(scene.medium.grid);
  const auto marched = [&](Device& on, MarchTimes& times) {
    const std::size_t before = on.BytesInUse();
    on.ResetPeak();
    auto marcher =
      std::make_unique<PhotonMarcher>(on, Domain(scene.medium.grid), scene.medium, Field{}, MarchSettings{});
    marcher->March(photons);
    times.onDevice = on.PeakBytes() - before;
    return marcher;
  };
  MarchTimes whole, tight;
  const auto first = marched(device, whole);
  Device within(device, { whole.onDevice - whole.onDevice / 20, false, MemoryBudget::NoLimit });
  const auto second = marched(within, tight);
  for (int time = 0; time < Times; ++time)
  {
    whole.Add(*first, photons);
    tight.Add(*second, photons);
  }
  for (const MarchTimes* times : { &whole, &tight })
  {
    const bool isWhole = times == &whole;
    const std::string same = isWhole ? "-" : tight.fluence == whole.fluence ? "yes" : "NO";
    const char* const method = isWhole ? "a sum for each core" : "one sum, within a budget";
    JsonLine line;
    line.Add("bench", "stream")
      .Add("case", "photons")
      .Add("method", method)
      .Add("grid", scene.GridName())
      .Add("seconds", Median(times->wall))
      .Add("core_seconds", Median(times->core))
      .Add("peak_bytes", static_cast<double>(times->onDevice));
    if (!isWhole)
    {
      line.Add("ratio", Median(Ratios(tight.core, whole.core)))
        .Add("ratio_wall", Median(Ratios(tight.wall, whole.wall)))
        .Add("against", "a sum for each core")
        .Add("same_bits", same);
    }
    line.Print();
    table.Add({ scene.GridName(), "photons", method, Text("%.2f", Median(times->wall)),
      Text("%.2f", Median(times->core)), Text("%.1f", static_cast<double>(times->onDevice) / MiB), "-", same });
  }
}

void RunAll(Device& device, const Arguments& arguments)
{
  const Asked asked = Read(arguments);
  Table table({ "grid", "case", "method", "s", "core s", "device, MiB", "process, MiB", "same bits" });
  for (const int edge : asked.edges)
  {
    const Scene scene = RandomScene(edge, 1);
    for (const std::string& which : asked.cases)
    {
      if (which == "photons")
      {
        if (device.IsCpu()) // GPUs have one sum anyhow
        {
          MarchWithin(device, scene, table);
        }
        continue;
      }
      PropagationSettings settings;
      settings.maximumOrders = which == "orders" ? 3 : 0;
      if (asked.budget > 0)
      {
        Tell(scene, which, Solve(device, scene, settings, asked.budget, false), nullptr, table);
        continue;
      }
      const Run whole = Solve(device, scene, settings, 0, false);
      Tell(scene, which, whole, nullptr, table);
      const std::size_t budget = whole.onDevice / PartOfWhole;
      Tell(scene, which, Solve(device, scene, settings, budget, true), &whole, table);
      Tell(scene, which, Solve(device, scene, settings, budget, false), &whole, table);
    }
  }
  table.Print(
    "Volumes as a whole and streamed, grey, 25 directions a face, three orders and converged; what the device "
    "takes (by\ncopies: of its own memory; in place: with the volumes in host memory), and the growth of the "
    "process");
}
}

int main(int argc, char* argv[])
{
  return RunOnDevice(argc, argv, RunAll);
}
