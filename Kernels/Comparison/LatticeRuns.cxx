#include "Comparison/ComparedRun.h"

#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "LatticeBoltzmann/LatticeSettings.h"

#include <memory>

namespace tyndall
{
namespace
{
constexpr int Lattices[] = { 18, 6 }; ///< numbers of directions of the two lattices that are compared

/// Computes uncollided light by photons and scattered light by the lattice Boltzmann method, so that the run time
/// covers both.
LightField SolveWithPhotons(
  Device& device, const ComparedScene& scene, int photons, const LatticeSettings& settings, const Monitor& monitor)
{
  const LightField direct =
    MarchEvenly(device, scene, static_cast<std::size_t>(photons), 1, 1, OfPart(monitor, 0.0, 0.5));
  Illumination handed;
  handed.uncollided.fluence = { direct.fluence.data(), direct.channels };
  handed.uncollided.escaped = direct.facePowerOut;
  return SolveLatticeBoltzmann(
    device, Domain(scene.medium.grid), scene.medium, scene.ior, handed, settings, OfPart(monitor, 0.5, 1.0));
}

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
    // The refractive index is constant here (AddBent adds the runs with a varying one), so that coarse grids need no
    // array of it.
    const SceneBlock given = { Domain(scene.medium.grid), scene.medium, scene.illumination,
      coarse ? Field() : scene.ior };
    const auto scaled = coarse ? std::make_shared<CoarseScene>(given, grid) : nullptr;
    ComparedRun run = RunOf(directions, grid);
    run.setting += coarse ? ", voxels x " + std::to_string(coarsening) : "";
    run.solve = [=, &device](bool, const Monitor& monitor) {
      const SceneBlock solved = scaled ? scaled->Scene() : given;
      return SolveLatticeBoltzmann(
        device, solved.domain, solved.medium, solved.index, solved.illumination, of, monitor);
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
    ComparedRun run = RunOf(directions, scene.medium.grid);
    run.setting += ", uncollided light of " + std::to_string(photons) + " photons";
    run.cost += photons;
    run.solve = [=, &device, &scene](
                  bool, const Monitor& monitor) { return SolveWithPhotons(device, scene, photons, of, monitor); };
    runs.push_back(std::move(run));
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
