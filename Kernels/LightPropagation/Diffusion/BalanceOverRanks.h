#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"
#include "LightPropagation/Diffusion/DiffusionSystem.h"
#include "LightPropagation/Diffusion/MultigridOverRanks.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// The diffusion system of one channel (DiffusionSystem.h, numerics.md, section 7) of a grid that is spread over ranks:
/// each has the balance of its own voxels, from the values of those beside them, and all solve it together. The same
/// solution as that of the whole grid, but for rounding and what the linear solver leaves, whatever the blocks.
///
/// All ranks make one and call it together, those without voxels too. What goes wrong on one rank throws on all.
class BalanceOverRanks
{
public:
  /// @param communicator, block  must stay
  /// @param arrays  with ghosts: sigma_t, sigma_a, partialCurrents and passed have the others' values there, sigma_s is
  ///   below 0 there; what the others are is never looked at
  /// @param pattern  of the whole grid
  /// @param incoming  W / length^2 through the faces of the whole grid, but that of lights
  /// @param periodic  axes of the whole grid
  BalanceOverRanks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const BlockWithGhosts& block, const DirectionSet& directions, const CrossingPattern& pattern,
    const DiffusionSystem::Arrays& arrays, const std::array<double, 6>& incoming, const std::array<bool, 3>& periodic,
    bool linear);

  /// As those of DiffusionSystem, of all ranks.
  double Correct(double unit);
  void Refine(double unit);
  double Absorbed() const;
  std::array<double, 6> Outflow(double entered, const std::array<double, 6>& ofSweep);
  /// As DiffusionSystem::Begin.
  /// @param guessed  beyond what was solved for, W / length^2, by voxel with ghosts, as DiffusionSystem::State
  void BeginBeyond(const std::vector<double>& guessed);

  // Of this rank alone.
  std::vector<double> Found() const; ///< W / length^2, by voxel of the block
  /// The same, on which the next sweep's source is to be built.
  std::vector<double> NextFluence() const;
  void ShapeSource();
  void PutNextFlux(const Buffer<float>& path); ///< of arrays with ghosts
  void AddFlux(const Buffer<float>& flux);     ///< with ghosts, which are not those of the others
  /// As that of DiffusionSystem, by cells of the block's faces; of those at the box's faces alone it is known.
  SurfacePowers PowersAtSurface() const;

private:
  std::vector<double> OwnOf(const std::vector<double>& held) const;

  Communicator& Comm;
  const BlockWithGhosts& Block;
  const std::array<bool, 3> Periodic;
  const Buffer<float>* SigmaA;
  std::size_t First;
  std::unique_ptr<DiffusionSystem> System; ///< of the block with ghosts; null without voxels
  std::unique_ptr<MultigridOverRanks> Solver;
  std::vector<double> Fluence; ///< that was solved for, with ghosts
  int Corrections = 0;
};
}
