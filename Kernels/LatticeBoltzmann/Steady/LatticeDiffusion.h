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
/// The diffusion of a lattice, of fluence over n^2 (numerics.md, Eq. (L12)): symmetric, positive definite, a
/// seven-point stencil. It is solved by multigrid on cells, which on one rank are the voxels.
///
/// On several ranks cells are of 2 x 2 x 2 or more voxels, and solved by the first rank. Around that go conjugate
/// gradients over all voxels, preconditioned by damped Jacobi before and after the solve on cells.
class LatticeDiffusion
{
public:
  using Values = std::vector<double>;

  /// Collective. All must outlive it.
  LatticeDiffusion(
    Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const LatticeVoxels& voxels);

  /// Of the rank's own voxels, to a tenth of the residual. Collective.
  /// @param unit  root mean square of `residual` over all ranks, above 0
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
  const Halo Ghosts; ///< one layer
  /// By own voxel, to the voxel across each face; 0: there is none. On one rank of -x, -y and -z alone.
  std::vector<std::array<float, 6>> Conductance;
  std::vector<float> Loss;
  std::array<int, 3> Halvings;             ///< cells have 2^halvings voxels along each axis
  Grid Cells;                              ///< their number alone
  std::unique_ptr<MultigridSolver> Solver; ///< on the first rank
  ExactValues Found;
};
}
