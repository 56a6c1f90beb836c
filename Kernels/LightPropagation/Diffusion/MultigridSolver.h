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
/// Options of kernels that process rows (MultigridRows.cl).
std::string RowOptions(const Device& device);
/// Runs a kernel that processes rows.
void RunRowsOf(Device& device, cl::Kernel& kernel, const MultigridLevel& level);
/// Number of work-groups of such a kernel, and thus of the partial sums that it writes.
std::size_t RowGroups(const Device& device, const MultigridLevel& level);

/// Solves the linear system of a diffusion matrix on the voxels of a domain,
///   sum over faces of conductance (x_i - x_j) + loss_i x_i = b_i,
/// which is symmetric, with positive conductances and losses, by conjugate gradients (Hestenes and Stiefel 1952) from a
/// residual computed in double, preconditioned by a multigrid cycle in float (2 x 2 x 2 voxels joined, damped Jacobi,
/// two visits of the first coarse levels), so that the cost per voxel hardly grows with the number of voxels
/// (numerics.md, section 7.8).
///
/// Each rank holds the voxels of its block and one layer of ghost voxels. The coarser levels, of all cells of the whole
/// grid, are on the first rank, which receives the other ranks' contributions to the cells that their voxels touch. The
/// iteration therefore does not depend on the blocks, except for rounding (numerics.md, section 7.14).
///
/// Arrays are stored in rows (MultigridLevel), which kernels process in vectors or, on a GPU, voxel by voxel. The time
/// of an iteration is about that of its memory traffic (some 150 bytes a voxel, counted).
class MultigridSolver
{
public:
  /// @param periodic  axes that wrap around
  MultigridSolver(Device& device, const Domain& domain, const std::array<bool, 3>& periodic);
  /// On one rank.
  /// @param spacing  of voxels: an axis along which they are far shorter is coarsened first
  MultigridSolver(Device& device, const std::array<int, 3>& size, const std::array<double, 3>& spacing)
    : MultigridSolver(device, Domain(Grid{ size, spacing }), {})
  {
  }

  /// Layout of the arrays below: the block and its ghost voxels (BlockWithGhosts::Held).
  const MultigridLevel& Rows() const { return this->Levels.front().layout; }

  /// Conductances of low faces, [axis][rows]: of the block's voxels and of the ghost voxels above it; 0 at the low end
  /// of the arrays' box, unless the block spans a periodic axis from end to end.
  Buffer<float>& Conductance() { return this->Levels.front().conductance; }
  Buffer<float>& Loss() { return this->Levels.front().loss; }
  /// Computes the matrices of the coarser levels. To be called after conductances and losses were written. Collective.
  void Coarsen();

  /// The right-hand side b, 0 in the padding of rows. To be written before each Solve(), which overwrites it.
  Buffer<float>& Right() { return this->Levels.front().right; }
  /// Three scratch arrays of rows, free for other use between solves; their contents are undefined.
  std::array<const Buffer<float>*, 3> Scratch() const;

  // The following two are collective. `values` are those of the block and its ghost voxels, x fastest.

  /// Reduces the residual of `values` by the factor `reduction` in the norm of the preconditioner, and its root mean
  /// square by at least a tenth of that factor, since that norm hardly weighs thin voxels next to thick ones.
  /// @param values  initial guess; replaced by the solution, also at ghost voxels
  /// @param unit  typical magnitude of the entries of b
  /// @param leftAtMost  additional bound on the residual's root mean square, in units
  /// @return number of iterations
  int Solve(
    ExactValues& values, double unit, double reduction, double leftAtMost = std::numeric_limits<double>::infinity());

  /// Continues the last Solve(); matrix, right-hand side and values must not have been written since.
  int GoOn(ExactValues& values, double unit, double reduction, double leftAtMost);

private:
  struct Level
  {
    MultigridLevel layout = {};
    /// `inverse`: damping / diagonal. `guess`, `better`: before and after a Jacobi step. `kept`: correction of the
    /// first of two visits; empty if the level is visited once.
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
  std::vector<Level> Levels; ///< this rank's part of the finest one and, on the first rank, the coarser ones
  std::unique_ptr<MultigridExchange> Exchange; ///< null: on one rank
  Level Touched;                               ///< on several ranks: cells of the second level at this rank's voxels
  Buffer<float> Direction;
  /// Inverse of the coarsest level as a matrix, where that is faster (level_answers); else empty.
  Buffer<float> Answers;
  ExactValues Sums;
  /// Largest r z at the begin of a solve, in units: later solves do not reduce the residual below its rounding error
  double FirstResidual = 0.0;
};
}
