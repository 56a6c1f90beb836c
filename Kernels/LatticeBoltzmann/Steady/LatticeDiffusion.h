#pragma once

#include "Device/ExactValues.h"
#include "Distribution/Halo.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// Diffusion limit of a lattice for fluence / n^2 (numerics.md, Eq. (L12)), the preconditioner of SteadyLattice: a
/// symmetric positive definite seven-point stencil, solved by multigrid on cells. On one rank the cells are the voxels.
///
/// On several ranks a cell has 2 x 2 x 2 or more voxels, and the first rank solves on the cells. This coarse solve,
/// with damped Jacobi before and after it, preconditions conjugate gradients on all voxels.
class LatticeDiffusion
{
public:
  using Values = std::vector<double>;

  /// Collective. All arguments must outlive this.
  LatticeDiffusion(
    Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const LatticeVoxels& voxels);

  /// Reduces the residual to a tenth. Collective.
  /// @param residual  by own voxel
  /// @return the correction by own voxel
  /// @param unit  root mean square of `residual` over all ranks, > 0
  Values Solve(const Values& residual, double unit);

private:
  void LoadVoxels(const LatticeSettings& settings, const LatticeVoxels& voxels);
  void LoadCells();
  std::size_t CellOf(std::size_t voxel) const;
  std::size_t CellAt(const std::array<int, 3>& inWhole) const;
  std::array<int, 3> InWhole(std::size_t voxel) const;
  Values SolveCells(const Values& residual, double unit);
  Values SolveVoxels(const Values& residual);
  Values Applied(const std::vector<float>& withGhosts) const;
  double Diagonal(std::size_t voxel) const;
  Values ByCells(const Values& residual);
  void AddCells(const Values& byCells, std::vector<float>& withGhosts) const;
  std::vector<float> Preconditioned(const Values& residual);
  double Dot(const Values& a, const std::vector<float>& b) const;

  Device& TheDevice;
  const Domain& TheDomain;
  const LatticeBox& Box;
  const std::array<bool, 3> Periodic;
  const Halo Ghosts; ///< halo of one layer
  /// By own voxel, to the neighbour across each face; 0: no neighbour. On one rank only -x, -y and -z are set.
  std::vector<std::array<float, 6>> Conductance;
  std::vector<float> Loss;
  std::array<int, 3> Halvings;             ///< cells have 2^halvings voxels along each axis
  Grid Cells;                              ///< only its size is used
  std::unique_ptr<MultigridSolver> Solver; ///< on the first rank
  ExactValues Found;
};
}
