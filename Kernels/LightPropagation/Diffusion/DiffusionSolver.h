#pragma once

#include "LightPropagation/Diffusion/BlockWithGhosts.h"
#include "LightPropagation/Diffusion/DiffusionSystem.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// Solver for the diffusion system of one channel on a domain (DiffusionSystem.h; numerics.md, section 7). Each rank
/// assembles the equations of its own voxels from its block and ghost voxels; all ranks solve them together
/// (MultigridSolver.h). Constructor and functions are collective unless stated otherwise.
class DiffusionSolver
{
public:
  /// @param block  must outlive this object
  /// @param model  model of the sweeps through the whole grid
  /// @param arrays  arrays with ghost voxels. In ghost voxels sigma_t, sigma_a, partialCurrents and passed have the
  ///   values of the owners, sigma_s is below 0, and all other arrays are not read.
  /// @param incoming  incident power per area of each face of the whole grid, without lamps, W / length^2
  /// @param periodic  which axes of the domain are periodic
  /// @param linear  as in DiffusionLayout
  DiffusionSolver(Device& device, const BlockWithGhosts& block, const SweepModel& model,
    const DiffusionSystem::Arrays& arrays, const std::array<double, 6>& incoming, const std::array<bool, 3>& periodic,
    bool linear);

  /// After a sweep, solves for the fluence of all scattering orders, and mixes it with previous solutions
  /// (AndersonMixing.h).
  /// @param unit  typical power of a voxel, W
  /// @return change of the fluence by sweep and solve, |found - given| / |found| (numerics.md, Eq. (72))
  double Correct(double unit);
  /// Continues the linear solver's iteration of the last Correct() until it hardly changes the fluence.
  /// @param unit  as in Correct()
  void Refine(double unit);
  double Absorbed() const; ///< absorbed power of the last solution, W
  /// Escaped power through each of the box's faces in the last solution, W; 0 on periodic axes.
  /// @param entered  incident power of the sweep, W
  /// @param ofSweep  escaped power of the sweep through each face, W
  std::array<double, 6> Outflow(double entered, const std::array<double, 6>& ofSweep);
  /// Warm start: adds estimated fluences to the solution from which the next sweep's source and the next correction are
  /// computed.
  /// @param guessed  fluence to add, W / length^2, [voxel of the block with its ghosts]; with angular moments, followed
  ///   by their moments of degree 1, as in DiffusionSystem::State()
  void BeginBeyond(const std::vector<double>& guessed);

  // Functions that are not collective:
  std::vector<double> Found() const; ///< fluence of the last solution, W / length^2, by voxel of the block
  /// Fluence from which the next sweep's source is to be computed, W / length^2, by voxel of the block.
  const ExactValues& NextFluence();
  void ShapeSource(); ///< calls DiffusionSystem::ShapeSource() on this rank
  void PutNextFlux(const Buffer<float>& path);
  /// Calls DiffusionSystem::AddFlux() for the block. The values of ghost voxels in `flux` then differ from those of
  /// their owners.
  void AddFlux(const Buffer<float>& flux);
  /// Power through the cells of the block's faces in the last solution; valid only for cells on the box's faces.
  SurfacePowers PowersAtSurface() const;

private:
  std::vector<double> OwnOf(std::vector<double> held) const;
  void OnSystem(const std::function<void(DiffusionSystem&)>& step) const;

  const BlockWithGhosts& Block;
  const Domain& TheDomain;
  const std::array<bool, 3> Periodic;
  bool ByCells; ///< whether sweeps tally escaped power by cell of the box's faces
  std::unique_ptr<MultigridSolver> Solver;
  std::unique_ptr<DiffusionSystem> System; ///< system of the block with ghosts; null on a rank without voxels
  ExactValues NoVoxels;                    ///< empty; passed to the linear solver on a rank without voxels
  ExactValues OwnNext;                     ///< result of NextFluence(); empty if the block has no ghosts
  /// Whether any voxel next to a thinner one has over 100 mean free paths, but none over 1e9.
  bool OpaqueBesideThin = false;
  Buffer<float> Balance; ///< right-hand side of the last system, if OpaqueBesideThin; else empty
  int Corrections = 0;
};
}
