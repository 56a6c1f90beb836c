// Lattice-Boltzmann lighting (Geist et al. 2004; Bernabei et al.): what a step costs beside the machine's bandwidth,
// and how soon light is steady.
//
//   TyndallBenchLattice [--quick] [step] [blocks] [albedo] [isotropy] [diffusion] [turns]
//
//   step    a step of 128^3 voxels over the time that its bytes take at the bandwidth measured in the same run
//   blocks  blocks of 4^3 voxels against all voxels together, steps and seconds (their Figure 6)
//   albedo  steps, and iterations of the steady equations, against albedo (their Figure 11)
//   isotropy   light of a point along axes and diagonals, 18 and 6 directions
//   diffusion  cubes against Monte Carlo, by thickness and albedo: where diffusion can be trusted
//   turns   photons that march k voxels while their light diffuses (their Table I), against taking turns

#include "LatticeTables.h"
#include "MachineLimits.h"
#include "Measure.h"
#include "Program.h"
#include "Report.h"

#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace bench;
using namespace tyndall;

namespace
{
/// Even voxels of one thickness, the sun above them.
struct Box
{
  Medium medium;
  Illumination light;
  std::vector<float> sigma_a, sigma_s;

  Box(int edge, double thickness, double albedo)
  {
    this->medium.grid.size = { edge, edge, edge };
    const std::size_t voxels = this->medium.grid.VoxelCount();
    this->sigma_a.assign(voxels, static_cast<float>(thickness * (1.0 - albedo)));
    this->sigma_s.assign(voxels, static_cast<float>(thickness * albedo));
    this->medium.sigma_a = { this->sigma_a.data() };
    this->medium.sigma_s = { this->sigma_s.data() };
    tyndall::Light sun;
    sun.direction = { 0.0, 0.0, -1.0 };
    this->light.lights.push_back(sun);
  }
};

/// Bytes that a step has to move: densities there and back, and what each voxel is.
double BytesOfStep(const LatticeVoxels& voxels, int directions, std::size_t count)
{
  const double links = (voxels.passesAll ? 0.0 : 1.0) + (voxels.bends ? 1.0 : 0.0);
  return 4.0 * static_cast<double>(count) * (2.0 * directions + 3.0 + links);
}

struct StepCase
{
  const char* name;
  int directions;
  double thickness; ///< above 4/3 links give back light
  bool bends;
};

void TimeStep(Device& device, bool quick, Table& table, const StepCase& of)
{
  const int edge = quick ? 24 : 128, steps = quick ? 2 : 10, repetitions = quick ? 2 : 9;
  Box box(edge, of.thickness, 0.99);
  const std::size_t count = box.medium.grid.VoxelCount();
  std::vector<float> ior(count, 1.0f), direct(count, 1.0f);
  std::fill(ior.begin(), ior.begin() + static_cast<std::ptrdiff_t>(count / 2), 1.3f);
  LatticeSettings settings;
  settings.directions = of.directions;
  Uncollided uncollided;
  uncollided.image.fluence = { direct.data(), 1 };
  const Field index = { of.bends ? ior.data() : nullptr, 1 };
  const LatticeProblem problem(Domain(box.medium.grid), box.medium, index, box.light, settings);
  const LatticeVoxels voxels(problem, settings, uncollided, 0);
  Lattice lattice(device, problem.Box(), settings, voxels);
  const double bytes = BytesOfStep(voxels, of.directions, count);
  std::vector<double> seconds, ratios, bandwidths;
  for (int i = -1; i < repetitions; ++i) // the first compiles
  {
    const MachineLimits limits = MeasureLimits(device, !quick);
    const double start = WallSeconds();
    lattice.Step(steps, false);
    device.Finish();
    const double step = (WallSeconds() - start) / steps;
    if (i >= 0)
    {
      seconds.push_back(step);
      bandwidths.push_back(limits.bytes);
      ratios.push_back(step * limits.bytes / bytes);
    }
  }
  JsonLine()
    .Add("bench", "lattice")
    .Add("case", std::string("step, ") + of.name)
    .Add("method", "lattice, a step")
    .Add("grid", GridText(edge))
    .Add("seconds", Median(seconds))
    .Add("bytes", bytes)
    .Add("bytes_per_second", Median(bandwidths))
    .Add("ratio", Median(ratios))
    .Add("against", "bytes at the bandwidth of the same run")
    .Add("load", LoadAverage())
    .Print();
  table.Add({ of.name, GridText(edge), Text("%.2f", 1e3 * Median(seconds)),
    Text("%.2f", 1e3 * bytes / Median(bandwidths)), Text("%.2f", Median(ratios)) });
}

void PrintStep(Device& device, bool quick)
{
  Table table({ "step", "grid", "ms", "ms of its bytes", "ratio" });
  for (const StepCase& of :
    { StepCase{ "18 directions", 18, 0.5, false }, StepCase{ "18 directions, links give back", 18, 4.0, false },
      StepCase{ "18 directions, index varies", 18, 0.5, true }, StepCase{ "6 directions", 6, 0.5, false } })
  {
    TimeStep(device, quick, table, of);
  }
  table.Print("A step over the time that its bytes take; goal: 2 at most for 18 directions");
}

struct Run
{
  LightField light;
  double seconds = 0.0;

  int Steps() const { return this->light.convergence.back().iteration; }
};

/// After one that compiles.
Run Solve(Device& device, const Box& box, const LatticeSettings& settings)
{
  LatticeSettings compiles = settings;
  compiles.maximumSteps = settings.Solves() ? 0 : 1;
  compiles.tolerance = 0.5;
  SolveLatticeBoltzmann(device, Domain(box.medium.grid), box.medium, {}, box.light, compiles);
  Run run;
  const double start = WallSeconds();
  run.light = SolveLatticeBoltzmann(device, Domain(box.medium.grid), box.medium, {}, box.light, settings);
  run.seconds = WallSeconds() - start;
  return run;
}

double LargestDifference(const std::vector<float>& values, const std::vector<float>& reference)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    largest = std::max(largest, std::abs(values[i] / static_cast<double>(reference[i]) - 1.0));
  }
  return largest;
}

/// Sum of differences over all light: voxels that are almost dark do not count.
double DifferenceOfAll(const std::vector<float>& values, const std::vector<float>& reference)
{
  double differences = 0.0, all = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    differences += std::abs(static_cast<double>(values[i]) - reference[i]);
    all += reference[i];
  }
  return differences / all;
}

void PrintRun(Table& table, int edge, const std::string& scene, const char* method, const Run& run, const Run& against)
{
  const double difference = LargestDifference(run.light.fluence, against.light.fluence);
  const double ofAll = DifferenceOfAll(run.light.fluence, against.light.fluence);
  JsonLine()
    .Add("bench", "lattice")
    .Add("case", scene)
    .Add("method", method)
    .Add("grid", GridText(edge))
    .Add("iterations", run.Steps())
    .Add("seconds", run.seconds)
    .Add("error_max", difference)
    .Add("error_l1", ofAll)
    .Add("left_over", run.light.balance.leftOver[0] / run.light.balance.entered[0])
    .Add("ratio", run.seconds / against.seconds)
    .Add("against", "all voxels together")
    .Add("load", LoadAverage())
    .Print();
  table.Add({ scene, method, std::to_string(run.Steps()), Text("%.3f", run.seconds),
    Text("%.2f", run.seconds / against.seconds), Text("%.1e", difference), Text("%.1e", ofAll) });
}

void PrintBlocks(Device& device, bool quick)
{
  const int edge = quick ? 12 : 64;
  Table table({ "albedo", "method", "steps", "s", "over together", "largest difference", "of all light" });
  for (double albedo : { 0.5, 0.9, 0.999 })
  {
    const Box box(edge, 0.5, albedo);
    LatticeSettings settings;
    settings.directions = 6; // as published
    settings.scheme = LatticeScheme::Published;
    settings.tolerance = 1e-4;
    const Run together = Solve(device, box, settings);
    const std::string scene = "blocks, albedo " + Text("%g", albedo);
    PrintRun(table, edge, scene, "all voxels together", together, together);
    settings.blockSize = 4;
    for (const auto& [steps, name] :
      { std::pair(1, "blocks of 4^3, an exchange each step"), std::pair(4, "blocks of 4^3, an exchange in 4 steps"),
        std::pair(8, "blocks of 4^3, an exchange in 8 steps (as published)") })
    {
      settings.stepsPerExchange = steps;
      PrintRun(table, edge, scene, name, Solve(device, box, settings), together);
    }
  }
  table.Print("Blocks against all voxels together, " + GridText(edge) + ", 6 directions, as published");
}

void PrintAlbedo(Device& device, bool quick)
{
  const int edge = quick ? 12 : 64;
  Table table({ "albedo", "method", "steps", "s", "over together", "largest difference", "of all light" });
  for (double albedo : { 0.1, 0.5, 0.9, 0.99, 0.999, 1.0 })
  {
    const Box box(edge, 0.5, albedo);
    LatticeSettings settings;
    const std::string scene = "albedo " + Text("%g", albedo);
    settings.solvesSteady = false;
    const Run steps = Solve(device, box, settings);
    PrintRun(table, edge, scene, "steps", steps, steps);
    settings.solvesSteady = true;
    PrintRun(table, edge, scene, "steady equations", Solve(device, box, settings), steps);
  }
  table.Print("Steps, and iterations of the steady equations, until the tolerance of 1e-4: " + GridText(edge) +
    ", 18 directions");
}
}

int main(int argc, char* argv[])
{
  return RunOnDevice(argc, argv, [](Device& device, const Arguments& arguments) {
    if (arguments.Asks("step"))
    {
      PrintStep(device, arguments.quick);
    }
    if (arguments.Asks("blocks"))
    {
      PrintBlocks(device, arguments.quick);
    }
    if (arguments.Asks("albedo"))
    {
      PrintAlbedo(device, arguments.quick);
    }
    if (arguments.Asks("isotropy"))
    {
      PrintIsotropy(device, arguments.quick);
    }
    if (arguments.Asks("diffusion"))
    {
      PrintDiffusion(device, arguments.quick);
    }
    if (arguments.Asks("turns"))
    {
      PrintTurns(device, arguments.quick);
    }
  });
}
