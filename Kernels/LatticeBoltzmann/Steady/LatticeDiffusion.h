#pragma once

#include "Device/ExactValues.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
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
}
