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
/// The low-order solve of one channel (DiffusionSystem.h, numerics.md, section 7) on a domain. Each rank sets up the
/// balance of its own voxels from its block and ghosts; all ranks solve it together (MultigridSolver.h). Constructor
/// and functions are collective unless stated otherwise.
class DiffusionSolver
{
public:
  /// @param block  must outlive this object
  /// @param pattern  of the whole grid
  /// @param arrays  with ghosts: sigma_t, sigma_a, partialCurrents and passed have their owners' values there, sigma_s
  ///   is below 0 there; the other arrays are not read there
  /// @param incoming  incident power through the faces of the whole grid without that of lamps, W / length^2
  /// @param periodic  which axes of the domain are periodic
  /// @param linear  as in DiffusionLayout
  DiffusionSolver(Device& device, const BlockWithGhosts& block, const DirectionSet& directions,
    const CrossingPattern& pattern, const DiffusionSystem::Arrays& arrays, const std::array<double, 6>& incoming,
    const std::array<bool, 3>& periodic, bool linear);

  /// Solves for the fluence after a sweep.
  /// @param unit  typical power of a voxel, W
  /// @return |found - given| / |found|
  double Correct(double unit);
  /// Continues the solve of the last correction, for more digits.
  void Refine(double unit);
  double Absorbed() const; ///< power absorbed according to the last correction, W
  /// Escaped power through each of the box's faces by the last correction, W; 0 on periodic axes.
  /// @param entered  power that entered in the sweep, W
  /// @param ofSweep  power that left through each face in the sweep, W
  std::array<double, 6> Outflow(double entered, const std::array<double, 6>& ofSweep);
  /// Starts the next correction and the next sweep's source from the solution plus a guess.
  /// @param guessed  added, W / length^2, by voxel with ghosts, as DiffusionSystem::State()
  void BeginBeyond(const std::vector<double>& guessed);

  // Not collective.
  std::vector<double> Found() const; ///< W / length^2, by voxel of the block
  /// The fluence from which the next sweep's source is to be computed, W / length^2.
  const ExactValues& NextFluence();
  void ShapeSource(); ///< DiffusionSystem::ShapeSource(); like the following two, on arrays with ghosts
  void PutNextFlux(const Buffer<float>& path);
  void AddFlux(const Buffer<float>& flux); ///< values in ghosts differ from those of their owners
  /// As DiffusionSystem::PowersAtSurface(), by cell of the block's faces; valid only for cells on the box's faces.
  SurfacePowers PowersAtSurface() const;

private:
  std::vector<double> OwnOf(std::vector<double> held) const;
  void OnSystem(const std::function<void(DiffusionSystem&)>& step) const;

  const BlockWithGhosts& Block;
  const Domain& TheDomain;
  const std::array<bool, 3> Periodic;
  bool ByCells; ///< whether escaped power is known by cell of the box's faces
  std::unique_ptr<MultigridSolver> Solver;
  std::unique_ptr<DiffusionSystem> System; ///< of the block with ghosts; null on a rank without voxels
  ExactValues NoVoxels;                    ///< the solution of a rank without voxels
  ExactValues OwnNext;                     ///< next fluence of the block; empty: the block has no ghosts
  int Corrections = 0;
};
}
