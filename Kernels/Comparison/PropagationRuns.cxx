#include "Comparison/ComparedRun.h"

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Published/ParallelPropagation.h"
#include "LightPropagation/Published/SequentialPropagation.h"

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace tyndall
{
namespace
{
/// Settings of propagation that differ between runs.
struct Setting
{
  int directions = 25, map = 1, coarsening = 1, orders = 0;
};

std::string InWords(const Setting& setting)
{
  std::string words = std::to_string(setting.directions) + " directions";
  words += setting.map > 1 ? ", map resolution " + std::to_string(setting.map) : "";
  words += setting.coarsening > 1 ? ", voxels x " + std::to_string(setting.coarsening) : "";
  words += setting.orders == 1 ? ", 1 order" : "";
  words += setting.orders > 1 ? ", " + std::to_string(setting.orders) + " orders" : "";
  return words;
}

std::vector<Setting> SettingsToTry(const ComparedSettings& settings)
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
  const auto nearest = std::min_element(settings.directionsPerFace.begin(), settings.directionsPerFace.end(),
    [](int a, int b) { return std::abs(a - 25) < std::abs(b - 25); });
  for (int orders : settings.orders)
  {
    all.push_back({ *nearest, 1, 1, orders });
  }
  return all;
}

/// Settings of discrete ordinates that correspond to those of propagation, with as many spherical harmonics as the
/// quadrature supports.
OrdinatesSettings AsOrdinates(const PropagationSettings& settings)
{
  OrdinatesSettings as;
  as.directionsPerFace = settings.directionsPerFace;
  as.maximumOrders = settings.maximumOrders;
  as.tolerance = settings.tolerance;
  as.periodic = settings.periodic;
  for (int degree = 4; as.terms > 6 * as.directionsPerFace; --degree)
  {
    as.terms = degree * degree;
  }
  return as;
}

/// The solver of a method.
/// @param device  must outlive the solver
PropagationSolver SolverOf(ComparedMethod method, Device& device)
{
  return [method, &device](const SceneBlock& scene, const PropagationSettings& settings, const Monitor& monitor) {
    const Medium& medium = scene.medium;
    const Illumination& illumination = scene.illumination;
    switch (method)
    {
      case ComparedMethod::Published: return SolveParallel(device, medium, illumination, settings, monitor);
      case ComparedMethod::PublishedSequential: return SolveSequential(medium, illumination, settings, monitor);
      case ComparedMethod::DiscreteOrdinates:
        return SolveDiscreteOrdinates(device, scene.domain, medium, illumination, AsOrdinates(settings), monitor);
      default: return SolveConservative(device, scene.domain, medium, illumination, settings, monitor);
    }
  };
}

PropagationSettings SettingsOf(ComparedMethod method, const Setting& setting, const ComparedSettings& settings)
{
  PropagationSettings of;
  of.directionsPerFace = setting.directions;
  of.adaptDirections = false;
  of.mapResolution = setting.map;
  of.maximumOrders = setting.orders;
  of.tolerance = settings.tolerance;
  if (method == ComparedMethod::ConstantSource)
  {
    of.source = PropagationSource::Constant;
    of.acceleration = PropagationAcceleration::None;
  }
  return of;
}
}

std::vector<ComparedRun> PropagationRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings)
{
  const PropagationSolver solver = SolverOf(method, device);
  std::vector<ComparedRun> runs;
  for (const Setting& setting : SettingsToTry(settings))
  {
    const std::optional<Factors> factors = CoarseningBy(setting.coarsening, scene.medium.grid);
    if (!factors || (setting.map > 1 && method == ComparedMethod::DiscreteOrdinates))
    {
      continue;
    }
    const bool coarse = setting.coarsening > 1;
    const SceneBlock given = { Domain(scene.medium.grid), scene.medium, scene.illumination };
    const auto scaled = coarse ? std::make_shared<CoarseScene>(given, Coarsened(scene.medium.grid, *factors)) : nullptr;
    const PropagationSettings of = SettingsOf(method, setting, settings);
    ComparedRun run;
    run.method = method;
    run.setting = InWords(setting);
    run.grid = scaled ? scaled->Scene().medium.grid : scene.medium.grid;
    run.cost = static_cast<double>(run.grid.VoxelCount()) * setting.directions * setting.map * setting.map;
    run.allOrders = setting.orders == 0;
    run.estimates = method != ComparedMethod::DiscreteOrdinates;
    run.solve = [=, &scene](bool estimate, const Monitor& monitor) {
      PropagationSettings now = of;
      now.periodic = scene.periodic;
      const SceneBlock solved = scaled ? scaled->Scene() : given;
      return estimate ? SolveWithErrorEstimate(solved, now, monitor, solver) : solver(solved, now, monitor);
    };
    runs.push_back(std::move(run));
  }
  return runs;
}

LightField Propagate(Device& device, const ComparedScene& scene, PropagationSettings settings, const Monitor& monitor)
{
  settings.periodic = scene.periodic;
  return SolveConservative(device, scene.medium, scene.illumination, settings, monitor);
}
}
