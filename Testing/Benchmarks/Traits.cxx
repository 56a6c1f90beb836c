// What it saves to leave out what a scene does not need: for each trait and solver a scene that has this trait alone,
// solved with LeaveOut and without. Seconds and bytes, and whether it is the same light.
//
//   TyndallBenchTraits [--quick] [case...]

#include "TraitsScenes.h"

#include "Measure.h"
#include "Program.h"
#include "Report.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace bench;
using namespace tyndall;

namespace
{
struct Run
{
  std::vector<double> wall, core;
  double bytes = 0.0; ///< of the device, at most
  std::vector<float> light;
};

void RunOnce(Device& device, const std::function<std::vector<float>()>& solve, Run& run, bool count)
{
  device.ResetPeak();
  const double wall = WallSeconds();
  const double core = CoreSeconds();
  run.light = solve();
  if (count)
  {
    run.wall.push_back(WallSeconds() - wall);
    run.core.push_back(CoreSeconds() - core);
  }
  run.bytes = static_cast<double>(device.PeakBytes());
}

/// Largest difference over the largest value.
double Difference(const std::vector<float>& a, const std::vector<float>& b)
{
  double largest = 0.0, difference = a.size() == b.size() ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
  {
    largest = std::max<double>(largest, std::abs(b[i]));
    difference = std::max<double>(difference, std::abs(static_cast<double>(a[i]) - b[i]));
  }
  return difference > 0.0 ? difference / largest : 0.0;
}

void Compare(Device& device, const TraitCase& trait, int repetitions, Table& table)
{
  Run less, all;
  for (int round = -1; round < repetitions; ++round) // in turns; the first compiles
  {
    RunOnce(
      device, [&] { return trait.solve(true); }, less, round >= 0);
    RunOnce(
      device, [&] { return trait.solve(false); }, all, round >= 0);
  }
  const double ratio = Median(less.core) / Median(all.core);
  const double difference = Difference(less.light, all.light);
  const auto line = [&](const std::string& method, const Run& run) {
    return JsonLine()
      .Add("bench", "traits")
      .Add("case", trait.name)
      .Add("method", trait.solver + method)
      .Add("grid", trait.grid)
      .Add("seconds", Median(run.wall))
      .Add("core_seconds", Median(run.core))
      .Add("peak_bytes", run.bytes);
  };
  line(", " + trait.against, all).Print();
  line("", less).Add("ratio", ratio).Add("against", trait.against).Add("error_max", difference).Print();
  table.Add({ trait.name, trait.solver, trait.grid, Text("%.4f", Median(all.wall)), Text("%.4f", Median(less.wall)),
    Text("%.2f", ratio), Text("%.1f", all.bytes / (1 << 20)), Text("%.1f", less.bytes / (1 << 20)),
    Text("%.1e", difference) });
}

/// What finding traits costs, beside a solve.
void MeasureScan(int edge, int repetitions)
{
  const TraitScene scene({ edge, edge, edge });
  std::vector<double> seconds;
  for (int i = 0; i < std::max(5, repetitions); ++i)
  {
    const double start = WallSeconds();
    const MediumTraits traits = TraitsOf(scene.medium);
    const CommonColour colour = ColourOf(scene.light);
    seconds.push_back(WallSeconds() - start + (traits.grey && colour.IsOne() ? 1e-9 : 0.0));
  }
  JsonLine()
    .Add("bench", "traits")
    .Add("case", "finding traits")
    .Add("method", "one scan")
    .Add("grid", scene.GridName())
    .Add("seconds", Median(seconds))
    .Add("peak_bytes", 0.0)
    .Print();
}

void RunAll(Device& device, const Arguments& arguments)
{
  const int edge = arguments.quick ? 16 : 64;
  const int repetitions = arguments.quick ? 1 : 5;
  Table table({ "trait", "solver", "grid", "all, s", "less, s", "core ratio", "all, MiB", "less, MiB", "difference" });
  for (const TraitCase& trait : TraitCases(device, edge))
  {
    if (arguments.Asks(trait.name))
    {
      Compare(device, trait, repetitions, table);
    }
  }
  MeasureScan(2 * edge, repetitions);
  table.Print(
    "What it saves to leave out what a scene does not need: everything computed and not, medians; the ratio is that "
    "of\n"
    "core seconds, memory the most that the device's buffers take, the difference the largest over the largest value");
}
}

int main(int argc, char* argv[])
{
  return RunOnDevice(argc, argv, RunAll);
}
