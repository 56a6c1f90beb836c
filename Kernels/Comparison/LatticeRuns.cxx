#include "Comparison/ComparedRun.h"

#include "LatticeBoltzmann/DiffusionError.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "LatticeBoltzmann/LatticeSettings.h"

#include <memory>

namespace tyndall
{
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
