#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "LatticeBoltzmann/Steady/LatticeDiffusion.h"
#include "LatticeBoltzmann/Steady/LinesOfLinks.h"
#include "Light/LightField.h"

#include <vector>

namespace tyndall
{
/// Steady-state solver for one channel of a lattice with the conservative scheme (numerics.md, Eqs. (L7) to (L12)).
///
/// The unknown is fluence / n^2 by voxel. Streaming between collisions is solved directly along lines of links
/// (LinesOfLinks); the remaining system is symmetric positive definite, and solved by conjugate gradients,
/// preconditioned by the diffusion limit of the same lattice (LatticeDiffusion). The number of iterations therefore
/// hardly depends on optical thickness, albedo or the number of voxels.
class SteadyLattice
{
public:
  /// Collective. All arguments must outlive this.
  /// @param densities  lattice of the block, whose densities Solve() writes; null if the block has no voxels
  SteadyLattice(Device& device, const LatticeProblem& problem, const LatticeSettings& settings,
    const LatticeVoxels& voxels, const Lattice* densities);

  /// Solves for the steady state. Collective.
  /// @param rows  receives one convergence row per iteration
  /// @return steady fluence, W / length^2, by own voxel, never negative
  std::vector<float> Solve(const Monitor& monitor, std::vector<ConvergenceRow>& rows);

private:
  using Values = std::vector<double>;

  /// Fraction of a density that a collision redistributes isotropically and does not absorb, divided by the total
  /// weight of the open directions (LatticeVoxels::OpenWeight).
  double Turns(std::size_t known) const;
  double Dot(const Values& a, const Values& b) const;
  Values EvenOf(const Values& scaled, bool withSources) const;
  Values Arriving(const Values& scaled, bool withSources, bool writes, const Monitor& monitor);
  Values Residual(const Values& scaled, const Monitor& monitor);
  Values Applied(const Values& scaled, const Monitor& monitor);
  Values Preconditioned(const Values& residual);
  void Note(double estimate, double change, int iteration, std::vector<ConvergenceRow>& rows) const;

  const Domain& TheDomain;
  const LatticeBox& Box;
  const LatticeSettings& Settings;
  const LatticeVoxels& Voxels;
  LinesOfLinks Lines;
  LatticeDiffusion Diffusion;
  const std::size_t Count;
  const double CountOfAll;
  double Start;
};
}
