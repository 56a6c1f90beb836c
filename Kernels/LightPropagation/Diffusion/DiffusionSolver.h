#pragma once

#include "LightPropagation/Diffusion/BlockWithGhosts.h"
#include "LightPropagation/Diffusion/DiffusionSystem.h"
#include "LightPropagation/Diffusion/MultigridOverRanks.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// The low-order solve of one channel (DiffusionSystem.h, numerics.md, section 7) on a domain: each rank has the
/// balance of its own voxels, from the values of those beside them, and all solve it together by conjugate gradients
/// and multigrid; a serial domain on its device (MultigridSolver.h), several ranks on their hosts
/// (MultigridOverRanks.h). The same solution but for rounding and what the linear solver leaves. Made and called
/// collectively.
class DiffusionSolver
{
public:
  /// @param block  must stay
  /// @param pattern  of the whole grid
  /// @param arrays  with ghosts: sigma_t, sigma_a, partialCurrents and passed have their owners' values there, sigma_s
  ///   is below 0 there; the others are not read there
  /// @param incoming  W / length^2 through the faces of the whole grid, but that of lights
  /// @param periodic  axes of the domain
  DiffusionSolver(Device& device, const BlockWithGhosts& block, const DirectionSet& directions,
    const CrossingPattern& pattern, const DiffusionSystem::Arrays& arrays, const std::array<double, 6>& incoming,
    const std::array<bool, 3>& periodic, bool linear);

  /// Solves for the light after a sweep.
  /// @param unit  W of a voxel, about
  /// @return |found - given| / |found|
  double Correct(double unit);
  /// Solves on, for what the last correction found to more digits.
  void Refine(double unit);
  double Absorbed() const; ///< W, of what the last correction found
  /// DiffusionSystem::OutflowBy of all ranks.
  std::array<double, 6> Outflow(double entered, const std::array<double, 6>& ofSweep);
  /// Begins the next correction, and the next sweep's source, beyond what was solved for.
  /// @param guessed  W / length^2, by voxel with ghosts, as DiffusionSystem::State
  void BeginBeyond(const std::vector<double>& guessed);

  // Not collective.
  std::vector<double> Found() const; ///< W / length^2, by voxel of the block
  /// The same, on which the next sweep's source is to be built.
  const ExactValues& NextFluence();
  void ShapeSource(); ///< of arrays with ghosts, as those that follow
  void PutNextFlux(const Buffer<float>& path);
  void AddFlux(const Buffer<float>& flux); ///< in ghosts it is not that of their owners
  /// As that of DiffusionSystem, by cells of the block's faces; of those at the box's faces alone it is known.
  SurfacePowers PowersAtSurface() const;

private:
  bool OnDevice() const { return this->System && !this->OverRanks; }
  std::vector<double> OwnOf(const std::vector<double>& held) const;
  void SolveOverRanks(double unit, double reduction);

  const BlockWithGhosts& Block;
  const Domain& TheDomain;
  const std::array<bool, 3> Periodic;
  const Buffer<float>* SigmaA;
  std::size_t First;
  bool ByCells;                                  ///< what leaves through the box's faces is known by cell
  std::unique_ptr<DiffusionSystem> System;       ///< of the block with ghosts; null without voxels
  std::unique_ptr<MultigridOverRanks> OverRanks; ///< null: the system solves on the device
  std::vector<double> Fluence;                   ///< that ranks solved for, with ghosts
  ExactValues OwnNext;                           ///< of the block; empty: it has no ghosts
  int Corrections = 0;
};
}
