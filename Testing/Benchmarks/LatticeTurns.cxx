// Photons that march beside the lattice.

#include "LatticeTables.h"
#include "Measure.h"
#include "Report.h"

#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "Light/LeftOut.h"

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace bench
{
using namespace tyndall;

namespace
{
/// A cube full of fog, a lens in its middle, and a spot of photons that comes from below.
struct Cube
{
  Medium medium;
  std::vector<float> sigma_a, sigma_s, ior;
  std::vector<Photon> photons;

  Cube(int edge, double albedo, int photonsAlongAxis)
  {
    constexpr double Thickness = 6.0; // of the cube, in mean free paths
    Grid& grid = this->medium.grid;
    grid.size = { edge, edge, edge };
    grid.spacing = { 1.0 / edge, 1.0 / edge, 1.0 / edge };
    this->sigma_a.assign(grid.VoxelCount(), static_cast<float>(Thickness * (1.0 - albedo)));
    this->sigma_s.assign(grid.VoxelCount(), static_cast<float>(Thickness * albedo));
    for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
    {
      const double e = edge, x = (i % edge + 0.5) / e - 0.5, y = (i / edge % edge + 0.5) / e - 0.5,
                   z = (i / edge / edge + 0.5) / e - 0.5;
      this->ior.push_back(static_cast<float>(1.0 + 0.15 * std::erfc((std::sqrt(x * x + y * y + z * z) - 0.3) * 20.0)));
    }
    this->medium.sigma_a = { this->sigma_a.data() };
    this->medium.sigma_s = { this->sigma_s.data() };
    const int n = photonsAlongAxis;
    for (int i = 0; i < n * n; ++i)
    {
      Photon photon;
      photon.position = { (i % n + 0.5) / n, (i / n + 0.5) / n, 0.0 };
      photon.power = { 1.0f, 1.0f, 1.0f };
      this->photons.push_back(photon);
    }
  }
};

struct Run
{
  std::vector<double> seconds;
  int steps = 0;
  bool overlaps = true;

  void Solve(Device& device, const Cube& cube, const LatticeSettings& settings)
  {
    const double start = WallSeconds();
    const LightField light = SolveLatticeBoltzmann(
      device, Domain(cube.medium.grid), cube.medium, { cube.ior.data(), 1 }, cube.photons, {}, settings);
    this->seconds.push_back(WallSeconds() - start);
    this->steps = light.convergence.back().iteration;
    for (const std::string& what : light.leftOut)
    {
      this->overlaps = this->overlaps && what != left_out::NotSideBySide;
    }
  }
};

/// One after the other, so that what else the machine does falls on both.
void SolveBoth(Device& device, const Cube& cube, LatticeSettings settings, int repetitions, Run& beside, Run& turns)
{
  for (int i = 0; i < repetitions; ++i)
  {
    settings.sideBySide = true;
    beside.Solve(device, cube, settings);
    settings.sideBySide = false;
    turns.Solve(device, cube, settings);
  }
}

void PrintLine(int edge, int stretches, const char* method, const Run& run, const Run& against, const char* what)
{
  JsonLine()
    .Add("bench", "lattice")
    .Add("case", "turns, k " + std::to_string(stretches))
    .Add("method", method)
    .Add("grid", GridText(edge))
    .Add("iterations", run.steps)
    .Add("seconds", Median(run.seconds))
    .Add("ratio", Median(run.seconds) / Median(against.seconds))
    .Add("against", what)
    .Add("load", LoadAverage())
    .Print();
}
}

void PrintTurns(Device& device, bool quick)
{
  const int edge = quick ? 16 : 128, repetitions = quick ? 1 : 3;
  const Cube cube(edge, 0.9, quick ? 20 : 350);
  LatticeSettings settings;
  settings.directions = 6; // as published
  settings.tolerance = 1e-3;
  settings.solvesSteady = false;
  LatticeSettings compiles = settings;
  compiles.interleaves = true;
  compiles.maximumSteps = 2;
  Run().Solve(device, cube, compiles);
  compiles.interleaves = false;
  Run().Solve(device, cube, compiles);
  Run first;
  for (int i = 0; i < repetitions; ++i)
  {
    first.Solve(device, cube, settings);
  }
  Table table({ "k", "steps", "s beside", "s by turns", "beside / by turns", "beside / march first", "published, ms" });
  const std::map<int, const char*> published = { { 2, "86" }, { 4, "81" }, { 8, "73" }, { 16, "70" }, { 32, "79" },
    { 64, "82" } };
  bool overlaps = true;
  for (const auto& [stretches, ms] : published)
  {
    settings.interleaves = true;
    settings.stretches = stretches;
    Run beside, turns;
    SolveBoth(device, cube, settings, repetitions, beside, turns);
    overlaps = beside.overlaps;
    PrintLine(edge, stretches, "side by side", beside, turns, "by turns");
    PrintLine(edge, stretches, "by turns", turns, first, "photons march to their ends first");
    table.Add({ std::to_string(stretches), std::to_string(beside.steps), Text("%.3f", Median(beside.seconds)),
      Text("%.3f", Median(turns.seconds)), Text("%.2f", Median(beside.seconds) / Median(turns.seconds)),
      Text("%.2f", Median(beside.seconds) / Median(first.seconds)), ms });
  }
  table.Add({ "all", std::to_string(first.steps), "-", Text("%.3f", Median(first.seconds)), "-", "1.00", "-" });
  table.Print("Photons march k voxels while their light diffuses 8 steps, " + std::to_string(edge) + "^3, " +
    std::to_string(cube.photons.size()) + " photons" +
    (overlaps ? "" : "; the device does marching and diffusion one after the other"));
}
}
