#pragma once

#include "Device/Device.h"
#include "Device/ExactValues.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "LatticeBoltzmann/Steady/LinesOfLinks.h"
#include "Light/LightField.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// Solver for the diffusion limit of a lattice, for fluence / n^2 (numerics.md, Eq. (L12)); preconditioner of
/// SteadyLattice. The matrix is a symmetric positive definite seven-point stencil, solved by conjugate gradients with
/// multigrid.
class LatticeDiffusion
{
public:
  using Values = std::vector<double>;

  /// Collective. `problem` must outlive this.
  LatticeDiffusion(
    Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const LatticeVoxels& voxels);

  /// Solves the diffusion system with `residual` as right-hand side, until the residual of that system has fallen to a
  /// tenth. Collective.
  /// @param residual  residual of the transport equation in each own voxel
  /// @param unit  root mean square of `residual` over all ranks, > 0
  /// @return the solution, fluence / n^2, by own voxel
  Values Solve(const Values& residual, double unit);

private:
  /// Diffusion matrix, in arrays over the block's voxels and their ghost voxels. Conductances, by axis, are those of
  /// the low faces of the block's voxels and of the ghost voxels above them; losses are those of the block's voxels.
  struct Matrix
  {
    std::array<std::vector<float>, 3> conductance;
    std::vector<float> loss;
  };
  Matrix MatrixOf(const LatticeBox& box, const LatticeSettings& settings, const LatticeVoxels& voxels) const;

  const Domain& TheDomain;
  const BlockWithGhosts Block;
  std::unique_ptr<MultigridSolver> Multigrid;
  ExactValues Found; ///< solution of Solve(), by voxel with ghosts
};

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
