#include "TargetCoverage.h"

#include "Measure.h"
#include "Report.h"
#include "TargetScenes.h"

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "DiscreteOrdinates/OrdinatesError.h"
#include "LatticeBoltzmann/DiffusionError.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "LightPropagation/Accuracy/ResampledScene.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "Medium/Coarsening.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

using namespace tyndall;

namespace bench
{
namespace
{
/// A solver by its name, with or without an estimate of its error.
struct CoveredSolver
{
  std::string name;
  bool needsCubes;
  std::function<LightField(const SceneBlock& scene, bool estimate)> solve;
};

SceneBlock BlockOf(const TargetScene& scene)
{
  return { Domain(scene.medium.grid), scene.medium, scene.light };
}

std::vector<CoveredSolver> SolversOn(Device& device)
{
  const PropagationSolver maps = [&device](const SceneBlock& scene, const PropagationSettings& how, const Monitor&) {
    return SolveConservative(device, scene.domain, scene.medium, scene.illumination, how);
  };
  return { { "maps", false,
             [maps](const SceneBlock& scene, bool estimate) {
               return estimate ? SolveWithErrorEstimate(scene, {}, {}, maps) : maps(scene, {}, {});
             } },
    { "ordinates", false,
      [&device](const SceneBlock& scene, bool estimate) {
        return estimate ? EstimateOrdinates(device, scene, {})
                        : SolveDiscreteOrdinates(device, scene.domain, scene.medium, scene.illumination, {});
      } },
    { "lattice", true, [&device](const SceneBlock& scene, bool estimate) {
       LightField light =
         SolveLatticeBoltzmann(device, scene.domain, scene.medium, scene.index, scene.illumination, {});
       if (estimate)
       {
         EstimateDiffusionError(device, scene, {}, false, {}, light);
       }
       return light;
     } } };
}

/// Light propagation maps in voxels of half the edge, along many directions; forward peaks by moments of high degree.
std::vector<float> Exact(Device& device, const SceneBlock& scene)
{
  const DividedScene divided(scene, DividedScene::Halves(scene.domain.Whole(), {}));
  PropagationSettings settings;
  const bool forwards = !scene.medium.phase.IsIsotropic();
  settings.directionsPerFace = forwards ? 144 : 400;
  settings.uncollidedDirections = 1600;
  settings.angularDegree = forwards ? 9 : -1;
  settings.staggeredRays = true;
  settings.tolerance = 1e-5;
  settings.emissionError = 0.005;
  LightField light = SolveConservative(device, divided.Scene().medium, divided.Scene().illumination, settings);
  divided.Undo(light);
  return light.fluence;
}

/// What a scene says of an estimate.
struct Covered
{
  double error = 0.0, estimate = 0.0; ///< root mean squares, relative to that of fluence
  double within = 0.0;                ///< part of the blocks whose error is below twice the estimate
};

/// @param exact  of 1 or 3 channels, as the light
Covered Compare(const LightField& light, const std::vector<float>& exact, const Grid& grid)
{
  std::vector<float> off(exact.size());
  double errors = 0.0, all = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
  {
    off[i] = light.fluence[i] - exact[i];
    errors += static_cast<double>(off[i]) * off[i];
    all += static_cast<double>(exact[i]) * exact[i];
  }
  const Coarsening blocks(grid);
  const std::vector<float> errorsOfBlocks = blocks.Average(off.data(), light.channels);
  const std::vector<float> estimates = blocks.Average(light.fluenceError.data(), light.channels);
  std::size_t within = 0;
  for (std::size_t i = 0; i < estimates.size(); ++i)
  {
    within += std::abs(errorsOfBlocks[i]) <= 2.0f * estimates[i] ? 1 : 0;
  }
  return { std::sqrt(errors / all), light.relativeError, static_cast<double>(within) / estimates.size() };
}

/// Sums over the scenes of one solver.
struct Totals
{
  std::vector<double> within, ratios;
  double blocks = 0.0, blocksWithin = 0.0, seconds = 0.0, secondsWith = 0.0;
};

double SecondsOf(const std::function<LightField()>& solve, LightField& light)
{
  solve(); // compiles
  const double start = WallSeconds();
  light = solve();
  return WallSeconds() - start;
}

void Measure(const CoveredSolver& solver, const TargetScene& scene, const std::vector<float>& exact, Totals& totals)
{
  const SceneBlock block = BlockOf(scene);
  LightField light;
  const double plain = SecondsOf([&] { return solver.solve(block, false); }, light);
  const double with = SecondsOf([&] { return solver.solve(block, true); }, light);
  const Covered found = Compare(light, exact, scene.medium.grid);
  const std::array<int, 3>& size = scene.medium.grid.size;
  JsonLine()
    .Add("bench", "target")
    .Add("case", scene.name)
    .Add("method", "estimate of " + solver.name)
    .Add("grid", std::to_string(size[0]) + "x" + std::to_string(size[1]) + "x" + std::to_string(size[2]))
    .Add("seconds", plain)
    .Add("seconds_with_estimate", with)
    .Add("error_l2", found.error)
    .Add("estimate", found.estimate)
    .Add("ratio", found.estimate / found.error)
    .Add("within_two", found.within)
    .Print();
  const double blocks = static_cast<double>(light.fluence.size()) / 8.0;
  totals.blocks += blocks;
  totals.blocksWithin += found.within * blocks;
  totals.within.push_back(found.within);
  totals.ratios.push_back(found.estimate / found.error);
  totals.seconds += plain;
  totals.secondsWith += with;
}

std::vector<std::string> RowOf(const std::string& name, const Totals& totals)
{
  const auto withinTwo = static_cast<double>(
    std::count_if(totals.ratios.begin(), totals.ratios.end(), [](double ratio) { return ratio > 0.5 && ratio < 2.0; }));
  return { name, std::to_string(totals.ratios.size()), Text("%.1f", 100.0 * totals.blocksWithin / totals.blocks),
    Text("%.0f", 100.0 * *std::min_element(totals.within.begin(), totals.within.end())),
    Text("%.2f", Median(totals.ratios)), Text("%.2f", *std::min_element(totals.ratios.begin(), totals.ratios.end())),
    Text("%.2f", *std::max_element(totals.ratios.begin(), totals.ratios.end())),
    Text("%.0f", 100.0 * withinTwo / totals.ratios.size()), Text("%.2f", totals.seconds),
    Text("%.2f", totals.secondsWith) };
}
}

void PrintCoverage(Device& device, bool quick, const std::string& only)
{
  const std::vector<TargetScene> scenes = CoverageScenes(false), cubes = CoverageScenes(true);
  const std::vector<CoveredSolver> solvers = SolversOn(device);
  std::vector<Totals> totals(solvers.size());
  for (std::size_t i = 0; i < scenes.size(); i += quick ? 8 : 1)
  {
    const std::vector<float> exact = Exact(device, BlockOf(scenes[i]));
    const bool areCubes = scenes[i].medium.grid.spacing == cubes[i].medium.grid.spacing;
    for (std::size_t k = 0; k < solvers.size(); ++k)
    {
      if (!only.empty() && only != solvers[k].name)
      {
        continue;
      }
      const bool other = solvers[k].needsCubes && !areCubes;
      Measure(solvers[k], other ? cubes[i] : scenes[i], other ? Exact(device, BlockOf(cubes[i])) : exact, totals[k]);
    }
  }
  Table table({ "solver", "scenes", "blocks within two, %", "least by scene, %", "estimate/error, median", "least",
    "largest", "scenes within a factor of 2, %", "s", "s with estimate" });
  for (std::size_t k = 0; k < solvers.size(); ++k)
  {
    if (!totals[k].ratios.empty())
    {
      table.Add(RowOf(solvers[k].name, totals[k]));
    }
  }
  table.Print("Coverage of estimated errors");
}
}
