#pragma once

#include "Device/ExactValues.h"
#include "Distribution/Domain.h"
#include "LightPropagation/Diffusion/MultigridExchange.h"
#include "LightPropagation/Diffusion/MultigridLayout.h"

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace tyndall
{
/// Compiler options of kernels that process rows (MultigridRows.cl).
std::string RowOptions(const Device& device);
/// Runs a kernel that processes rows.
void RunRowsOf(Device& device, cl::Kernel& kernel, const MultigridLevel& level);
/// Number of work-groups of a kernel that processes rows, and thus of the partial sums that it writes.
std::size_t RowGroups(const Device& device, const MultigridLevel& level);

/// Solver for a linear system with a diffusion matrix on the voxels of a domain,
///   sum over faces of conductance (x_i - x_j) + loss_i x_i = b_i,
/// symmetric, with positive conductances and losses. Method: conjugate gradients (Hestenes and Stiefel 1952), from a
/// residual computed in double, preconditioned by a multigrid cycle in float (coarsening by 2 along each axis, damped
/// Jacobi smoothing, two visits of the first coarse levels). The cost per voxel hardly grows with the number of voxels
/// (numerics.md, section 7.8).
///
/// Each rank holds the voxels of its block and one layer of ghost voxels. The first rank holds the coarser levels of
/// the whole grid, and sums the contributions of all ranks to their cells. The iteration therefore does not depend on
/// the decomposition, except for rounding (numerics.md, section 7.14).
///
/// Arrays are stored in rows (MultigridLevel), which kernels process in vectors or, on a GPU, voxel by voxel. The time
/// of an iteration is limited by memory traffic, about 150 bytes per voxel.
class MultigridSolver
{
public:
  /// @param periodic  which axes are periodic
  MultigridSolver(Device& device, const Domain& domain, const std::array<bool, 3>& periodic);
  /// Solver on one rank without periodic axes.
  /// @param spacing  voxel edges, which determine the axes that are coarsened first (MultigridLevels)
  MultigridSolver(Device& device, const std::array<int, 3>& size, const std::array<double, 3>& spacing)
    : MultigridSolver(device, Domain(Grid{ size, spacing }), {})
  {
  }

  /// Layout of the arrays of the finest level: the block and its ghost voxels (BlockWithGhosts::Held).
  const MultigridLevel& Rows() const { return this->Levels.front().layout; }

  /// Conductances, length^2, of the low faces of the block's voxels and of the ghost voxels above them: for each axis
  /// one array in the row layout of MultigridLevel; 0 at the low end of the box with ghosts, unless the block spans a
  /// periodic axis from end to end.
  Buffer<float>& Conductance() { return this->Levels.front().conductance; }
  Buffer<float>& Loss() { return this->Levels.front().loss; }
  /// Computes the matrices of the coarser levels. To be called after Conductance() and Loss() have been written.
  /// Collective.
  void Coarsen();

  /// Right-hand side b, in the row layout of MultigridLevel; 0 in the padding. To be written before each Solve(), which
  /// overwrites it.
  Buffer<float>& Right() { return this->Levels.front().right; }
  /// Three scratch arrays of the finest level that callers may use between solves; every solve overwrites them.
  std::array<const Buffer<float>*, 3> Scratch() const;

  // Solve() and GoOn() are collective. `values` holds one value per voxel of the block with its ghost voxels, x
  // fastest.

  /// Iterates until the residual has fallen by the factor `reduction` in the norm of the preconditioner, and its root
  /// mean square by ten times that factor; the norm of the preconditioner alone hardly weighs thin voxels next to thick
  /// ones.
  /// @param values  initial guess; replaced by the solution, also at ghost voxels
  /// @param unit  typical magnitude of the entries of b
  /// @param leftAtMost  upper bound on the root mean square of the residual, relative to `unit`
  /// @return number of iterations
  int Solve(
    ExactValues& values, double unit, double reduction, double leftAtMost = std::numeric_limits<double>::infinity());

  /// Continues the last Solve() to a smaller residual. Matrix, right-hand side and `values` must not have been changed
  /// since. Parameters and result as in Solve().
  int GoOn(ExactValues& values, double unit, double reduction, double leftAtMost);

private:
  struct Level
  {
    MultigridLevel layout = {};
    /// Arrays in the row layout of MultigridLevel. `inverse`: damping / diagonal. `guess`, `better`: solution before
    /// and after a Jacobi step. `kept`: correction of the first of two visits; empty if the level is visited once.
    Buffer<float> conductance, loss, inverse, right, guess, better, kept;
  };

  void FindAnswers();
  void Finish(Level& level);

  cl::Kernel Kernel(const char* name) const;
  void Run(cl::Kernel& kernel, const Level& level) { RunRowsOf(this->TheDevice, kernel, level.layout); }
  Level MakeLevel(const MultigridLevel& layout) const;
  bool HasAllLevels() const { return !this->Exchange || this->TheDomain.Rank() == 0; }
  void CoarsenTo(Level& coarse, const Level& fine);
  double Precondition();
  void Visit(std::size_t level);
  void VisitCoarser(std::size_t level);
  void VisitTwice(std::size_t level);
  void Restrict(Level& fine, Level& coarse);
  void Prolong(const Level& coarse, Level& fine);
  void Smooth(Level& level);
  void ScaleAndAdd(const Level& level, const Buffer<float>& added, float part, const Buffer<float>& values);
  int Iterate(ExactValues& values, double left, double unit, double reduction, double leftAtMost);
  double Begin(const ExactValues& values, double unit);
  void Turn(double part);
  double Curvature();
  double Step(const ExactValues& values, double length, double unit);
  double SumAfter(const std::function<void()>& work) const;

  Device& TheDevice;
  const Domain TheDomain;
  std::vector<Level> Levels; ///< finest level of this rank's block; on the first rank also all coarser levels
  std::unique_ptr<MultigridExchange> Exchange; ///< null on one rank
  /// On several ranks: cells of the second level that contain voxels of this rank.
  Level Touched;
  Buffer<float> Direction;
  /// Approximate inverse of the coarsest level's matrix, on devices where it is faster (level_answers); else empty.
  Buffer<float> Answers;
  ExactValues Sums;
  /// Largest squared norm r z, of all solves so far, of the residual r at the start of a solve; z is the preconditioned
  /// residual, and both are divided by the parameter `unit` of Solve(). Later solves stop at residuals that are
  /// rounding errors relative to it.
  double FirstResidual = 0.0;
};
}
