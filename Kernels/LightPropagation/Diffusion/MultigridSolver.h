#pragma once

#include "Device/ExactValues.h"
#include "LightPropagation/Diffusion/MultigridLayout.h"

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace tyndall
{
/// Solves the system of a diffusion matrix on a box of voxels,
///   sum over faces of conductance (x_i - x_j) + loss_i x_i = b_i,
/// symmetric, with positive conductances and losses: conjugate gradients (Hestenes and Stiefel 1952) from a residual
/// that is found in double, preconditioned by a cycle of multigrid in float (voxels 2 x 2 x 2 together, damped Jacobi,
/// two visits of the first coarser levels), so that its cost hardly grows with the number of voxels (numerics.md,
/// section 7.8).
///
/// Its arrays are rows as MultigridLayout.h has them, which kernels walk along in vectors, or, on a GPU, by voxels: an
/// iteration takes about as long as its bytes take (some 150 a voxel, counted).
class MultigridSolver
{
public:
  /// @param spacing  of voxels: an axis along which they are far shorter is coarsened first
  MultigridSolver(Device& device, const std::array<int, 3>& size, const std::array<double, 3>& spacing);

  const MultigridLevel& Rows() const { return this->Levels.front().layout; } ///< of the arrays below

  /// [axis][rows] of low faces, 0 at the box's end, with ghosts.
  Buffer<float>& Conductance() { return this->Levels.front().conductance; }
  Buffer<float>& Loss() { return this->Levels.front().loss; }
  /// After the two were written.
  void Coarsen();

  /// b, 0 beyond rows' voxels. To be written before each Solve, which spends it.
  Buffer<float>& Right() { return this->Levels.front().right; }
  /// Three arrays of rows whose contents are undefined, for others between solves.
  std::array<const Buffer<float>*, 3> Scratch() const;

  /// Make the residual of `values`, in the norm of the preconditioner, smaller by `reduction`, and its root mean
  /// square by ten times that at most, for that norm hardly counts thin voxels beside thick ones.
  /// @param unit  about as large as the entries of b
  /// @param leftAtMost  and the root mean square at most this, in units
  /// @return iterations
  int Solve(const ExactValues& values, double unit, double reduction,
    double leftAtMost = std::numeric_limits<double>::infinity());

  /// The same of what the last Solve left, where neither matrix nor right-hand side nor values were written since.
  int GoOn(const ExactValues& values, double unit, double reduction, double leftAtMost);

  /// Options of kernels that walk along rows (MultigridRows.cl).
  static std::string RowOptions(const Device& device);
  /// Runs one.
  static void RunRows(Device& device, cl::Kernel& kernel, const MultigridLevel& level);
  /// Groups that it runs in: sums that it leaves.
  static std::size_t GroupsOf(const Device& device, const MultigridLevel& level);

private:
  struct Level
  {
    MultigridLevel layout;
    /// `inverse`: damping over diagonal. `guess` and `better`: before and after a step of Jacobi's method.
    /// `kept`: of the first of two visits; empty where there is one.
    Buffer<float> conductance, loss, inverse, right, guess, better, kept;
  };

  void FindAnswers();
  void Finish(Level& level);

  cl::Kernel Kernel(const char* name) const;
  void Run(cl::Kernel& kernel, const Level& level) { RunRows(this->TheDevice, kernel, level.layout); }
  double Precondition();
  void Visit(std::size_t level);
  void VisitTwice(std::size_t level);
  void Restrict(Level& fine, Level& coarse);
  void Correct(Level& fine, const Level& coarse);
  int Iterate(const ExactValues& values, double left, double unit, double reduction, double leftAtMost);
  double Begin(const ExactValues& values, double unit);
  void Turn(double part);
  double Curvature();
  double Step(const ExactValues& values, double length, double unit);
  double SumOfGroups() const;

  Device& TheDevice;
  std::vector<Level> Levels;
  Buffer<float> Direction;
  Buffer<float> Answers; ///< of the coarsest level, where that is quicker (level_answers); else empty
  ExactValues Sums;
  double FirstResidual = 0.0; ///< of the first solve, in units
};
}
