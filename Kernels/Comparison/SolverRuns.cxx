#include "Comparison/ComparedRun.h"

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "DiscreteOrdinates/OrdinatesError.h"
#include "LatticeBoltzmann/DiffusionError.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "LightPropagation/Accuracy/PreviewLight.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Published/ParallelPropagation.h"
#include "LightPropagation/Published/SequentialPropagation.h"

#include <algorithm>
#include <memory>

namespace tyndall
{
namespace
{
/// Settings of propagation that differ between runs.
struct Setting
{
  int directions = 25, map = 1, coarsening = 1, orders = 0;
  /// Number of terms of the phase function, for discrete ordinates; 0: the default number, as far as the quadrature
  /// supports it.
  int terms = 0;
};

std::string InWords(const Setting& setting)
{
  std::string words = std::to_string(setting.directions) + " directions";
  words += setting.map > 1 ? ", map resolution " + std::to_string(setting.map) : "";
  words += setting.coarsening > 1 ? ", voxels x " + std::to_string(setting.coarsening) : "";
  words += setting.orders == 1 ? ", 1 order" : "";
  words += setting.orders > 1 ? ", " + std::to_string(setting.orders) + " orders" : "";
  words += setting.terms > 0 ? ", " + std::to_string(setting.terms) + " terms" : "";
  return words;
}

std::vector<Setting> SettingsToTry(ComparedMethod method, const ComparedSettings& settings)
{
  std::vector<Setting> all;
  for (int coarsening : settings.coarsenings)
  {
    for (int directions : settings.directionsPerFace)
    {
      for (int map : settings.mapResolutions)
      {
        if (map == 1 || (directions >= FewestForFinerMaps && coarsening == 1))
        {
          all.push_back({ directions, map, coarsening, 0 });
        }
      }
    }
  }
  for (int orders : settings.orders)
  {
    all.push_back({ UsualDirections(settings), 1, 1, orders });
  }
  for (int terms : method == ComparedMethod::DiscreteOrdinates ? settings.terms : std::vector<int>())
  {
    all.push_back({ UsualDirections(settings), 1, 1, 0, terms });
  }
  return all;
}

/// Settings of discrete ordinates that correspond to settings of propagation, with `terms` terms of the phase function
/// or, if `terms` is 0, with as many spherical harmonics as the quadrature supports.
OrdinatesSettings AsOrdinates(const PropagationSettings& settings, int terms)
{
  OrdinatesSettings as;
  as.directionsPerFace = settings.directionsPerFace;
  as.maximumOrders = settings.maximumOrders;
  as.tolerance = settings.tolerance;
  as.periodic = settings.periodic;
  as.terms = terms > 0 ? terms : as.terms;
  for (int degree = 4; !ResolvesTerms(settings, as.terms); --degree)
  {
    as.terms = degree * degree;
  }
  return as;
}

/// The solver of a method.
/// @param device  must outlive the solver
/// @param terms  number of terms of the phase function, Setting::terms
PropagationSolver SolverOf(ComparedMethod method, Device& device, int terms)
{
  return
    [method, terms, &device](const SceneBlock& scene, const PropagationSettings& settings, const Monitor& monitor) {
      const Medium& medium = scene.medium;
      const Illumination& illumination = scene.illumination;
      switch (method)
      {
        case ComparedMethod::Published: return SolveParallel(device, medium, illumination, settings, monitor);
        case ComparedMethod::PublishedSequential: return SolveSequential(medium, illumination, settings, monitor);
        case ComparedMethod::DiscreteOrdinates:
          return SolveDiscreteOrdinates(
            device, scene.domain, medium, illumination, AsOrdinates(settings, terms), monitor);
        default: return SolveConservative(device, scene.domain, medium, illumination, settings, monitor);
      }
    };
}

PropagationSettings SettingsOf(
  ComparedMethod method, const Setting& setting, const ComparedScene& scene, const ComparedSettings& settings)
{
  PropagationSettings of;
  of.directionsPerFace = setting.directions;
  of.adaptDirections = false;
  of.mapResolution = setting.map;
  of.maximumOrders = setting.orders;
  of.tolerance = settings.tolerance;
  of.periodic = scene.periodic;
  if (method == ComparedMethod::ConstantSource)
  {
    of.source = PropagationSource::Constant;
    of.acceleration = PropagationAcceleration::None;
  }
  return of;
}

std::string FiltersOf(ComparedMethod method, const Setting& setting, int terms)
{
  if (setting.coarsening > 1)
  {
    return {};
  }
  std::string settings = " DirectionsPerFace=" + std::to_string(setting.directions);
  settings += setting.map > 1 ? " MapResolution=" + std::to_string(setting.map) : "";
  settings += setting.orders > 0 ? " MaximumOrders=" + std::to_string(setting.orders) : "";
  switch (method)
  {
    case ComparedMethod::DiscreteOrdinates: return "DiscreteOrdinates" + settings + " Terms=" + std::to_string(terms);
    case ComparedMethod::ConstantSource: return "LightPropagationMaps" + settings + " Source=0 Acceleration=0";
    case ComparedMethod::Published: return "LightPropagationMaps" + settings + " Scheme=0";
    case ComparedMethod::PublishedSequential: return "LightPropagationMaps" + settings + " Scheme=0 Algorithm=0";
    default: return "LightPropagationMaps" + settings;
  }
}

/// The run of a method with one setting.
/// @param factors  coarsening factor along each axis
ComparedRun RunOf(ComparedMethod method, const Setting& setting, const Factors& factors, Device& device,
  const ComparedScene& scene, const ComparedSettings& settings)
{
  const SceneBlock given = { Domain(scene.medium.grid), scene.medium, scene.illumination };
  const auto scaled =
    setting.coarsening > 1 ? std::make_shared<CoarseScene>(given, Coarsened(scene.medium.grid, factors)) : nullptr;
  const PropagationSolver solver = SolverOf(method, device, setting.terms);
  const PropagationSettings of = SettingsOf(method, setting, scene, settings);
  ComparedRun run;
  run.method = method;
  run.setting = InWords(setting);
  run.filters = FiltersOf(method, setting, AsOrdinates(of, setting.terms).terms);
  run.grid = scaled ? scaled->Scene().medium.grid : scene.medium.grid;
  run.cost = static_cast<double>(run.grid.VoxelCount()) * setting.directions * setting.map * setting.map;
  run.allOrders = setting.orders == 0;
  run.estimates = true;
  run.solve = [=, &device, terms = setting.terms](bool estimate, const Monitor& monitor) {
    const SceneBlock solved = scaled ? scaled->Scene() : given;
    if (!estimate)
    {
      return solver(solved, of, monitor);
    }
    return method == ComparedMethod::DiscreteOrdinates
      ? EstimateOrdinates(device, solved, AsOrdinates(of, terms), monitor)
      : SolveWithErrorEstimate(solved, of, monitor, solver);
  };
  return run;
}

ComparedRun PreviewOf(Device& device, const ComparedScene& scene, const ComparedSettings& settings)
{
  const SceneBlock given = { Domain(scene.medium.grid), scene.medium, scene.illumination };
  const PropagationSolver solver = SolverOf(ComparedMethod::LightPropagationMaps, device, 0);
  PropagationSettings of = SettingsOfPreview({});
  of.tolerance = std::max(of.tolerance, settings.tolerance);
  of.periodic = scene.periodic;
  ComparedRun run;
  run.setting = "preview";
  run.filters = "LightPropagationMaps Preview=1";
  run.grid = scene.medium.grid;
  run.allOrders = false; // so that its short time is not taken for that of a solve
  run.solve = [=](bool, const Monitor& monitor) {
    return SolvePreview(
      given, of, PreviewGrid(given.medium.grid), [&](const SceneBlock& block) { return solver(block, of, monitor); });
  };
  return run;
}

/// Runs in which each count of photons gives the uncollided light, and light propagation maps compute the scattered
/// light.
std::vector<ComparedRun> RunsAfterPhotons(Device& device, const ComparedScene& scene, const ComparedSettings& settings)
{
  std::vector<ComparedRun> runs;
  const Setting setting = { UsualDirections(settings) };
  const PropagationSettings of = SettingsOf(ComparedMethod::PhotonsThenMaps, setting, scene, settings);
  ComparedRun maps;
  maps.method = ComparedMethod::PhotonsThenMaps;
  maps.setting = InWords(setting);
  maps.filters = FiltersOf(maps.method, setting, 0);
  maps.grid = scene.medium.grid;
  maps.cost = static_cast<double>(maps.grid.VoxelCount()) * setting.directions;
  for (int photons : settings.photonCounts)
  {
    const auto solve = [=, &device, &scene](const Illumination& handed, const Monitor& monitor) {
      return SolveConservative(device, scene.medium, handed, of, monitor);
    };
    runs.push_back(AfterPhotons(photons, maps, device, scene, solve));
  }
  return runs;
}
}

std::vector<ComparedRun> PropagationRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings)
{
  if (method == ComparedMethod::PhotonsThenMaps)
  {
    return RunsAfterPhotons(device, scene, settings);
  }
  std::vector<ComparedRun> runs;
  for (const Setting& setting : SettingsToTry(method, settings))
  {
    const std::optional<Factors> factors = CoarseningBy(setting.coarsening, scene.medium.grid);
    if (factors && (setting.map == 1 || method != ComparedMethod::DiscreteOrdinates))
    {
      runs.push_back(RunOf(method, setting, *factors, device, scene, settings));
    }
  }
  if (method == ComparedMethod::LightPropagationMaps && settings.previews)
  {
    runs.push_back(PreviewOf(device, scene, settings));
  }
  return runs;
}

LightField Propagate(Device& device, const ComparedScene& scene, PropagationSettings settings, const Monitor& monitor)
{
  settings.periodic = scene.periodic;
  return SolveConservative(device, scene.medium, scene.illumination, settings, monitor);
}

namespace
{
constexpr int Lattices[] = { 18, 6 }; ///< numbers of directions of the two lattices that are compared

LatticeSettings SettingsOf(int directions, const ComparedScene& scene, const ComparedSettings& settings)
{
  LatticeSettings of;
  of.directions = directions;
  of.tolerance = settings.tolerance;
  of.periodic = scene.periodic;
  return of;
}

ComparedRun RunOf(int directions, const Grid& grid)
{
  ComparedRun run;
  run.method = ComparedMethod::LatticeBoltzmann;
  run.setting = std::to_string(directions) + " directions";
  run.filters = "LatticeBoltzmannLighting Lattice=" + std::to_string(directions);
  run.grid = grid;
  run.cost = static_cast<double>(grid.VoxelCount()) * directions;
  return run;
}

void AddStraight(std::vector<ComparedRun>& runs, int directions, Device& device, const ComparedScene& scene,
  const ComparedSettings& settings)
{
  const LatticeSettings of = SettingsOf(directions, scene, settings);
  for (int coarsening : settings.coarsenings)
  {
    const std::optional<Factors> factors = CoarseningBy(coarsening, scene.medium.grid);
    const bool coarse = coarsening > 1;
    const Grid grid = factors ? Coarsened(scene.medium.grid, *factors) : Grid();
    if (!factors || !HasCubicVoxels(grid))
    {
      continue;
    }
    // The refractive index is constant here, so coarse grids need no array of it. AddBent adds the runs with a varying
    // index.
    const SceneBlock given = { Domain(scene.medium.grid), scene.medium, scene.illumination,
      coarse ? Field() : scene.ior };
    const auto scaled = coarse ? std::make_shared<CoarseScene>(given, grid) : nullptr;
    ComparedRun run = RunOf(directions, grid);
    run.setting += coarse ? ", voxels x " + std::to_string(coarsening) : "";
    run.filters = coarse ? "" : run.filters;
    run.estimates = !coarse; // the estimate does not include the error of voxels
    run.solve = [=, &device](bool estimate, const Monitor& monitor) {
      const SceneBlock solved = scaled ? scaled->Scene() : given;
      LightField light =
        SolveLatticeBoltzmann(device, solved.domain, solved.medium, solved.index, solved.illumination, of, monitor);
      if (estimate)
      {
        // The refractive index, which is constant, is omitted: the error estimate then accepts a coarse grid whose
        // voxels are not cubic.
        const SceneBlock straight = { solved.domain, solved.medium, solved.illumination };
        EstimateDiffusionError(device, straight, of, false, monitor, light);
      }
      return light;
    };
    runs.push_back(std::move(run));
  }
}

void AddBent(std::vector<ComparedRun>& runs, int directions, Device& device, const ComparedScene& scene,
  const ComparedSettings& settings)
{
  if (!HasCubicVoxels(scene.medium.grid))
  {
    return;
  }
  const LatticeSettings of = SettingsOf(directions, scene, settings);
  for (int photons : settings.photonCounts)
  {
    const auto solve = [=, &device, &scene](const Illumination& handed, const Monitor& monitor) {
      return SolveLatticeBoltzmann(device, Domain(scene.medium.grid), scene.medium, scene.ior, handed, of, monitor);
    };
    runs.push_back(AfterPhotons(photons, RunOf(directions, scene.medium.grid), device, scene, solve));
  }
}
}

std::vector<ComparedRun> LatticeRunsOf(Device& device, const ComparedScene& scene, const ComparedSettings& settings)
{
  std::vector<ComparedRun> runs;
  for (int directions : Lattices)
  {
    (scene.BendsLight() ? AddBent : AddStraight)(runs, directions, device, scene, settings);
  }
  return runs;
}
}
