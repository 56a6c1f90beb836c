#pragma once

#include "Device/ExactValues.h"
#include "LightPropagation/Diffusion/DiffusionShared.h"

#include <array>
#include <limits>
#include <vector>

namespace tyndall
{
/// Solves the system of a diffusion matrix on a box of voxels,
///   sum over faces of conductance (x_i - x_j) + loss_i x_i = b_i,
/// symmetric, with positive conductances and losses: conjugate gradients in double (Hestenes and Stiefel 1952),
/// preconditioned by a V cycle of multigrid in float (voxels 2 x 2 x 2 together, damped Jacobi), so that its cost
/// hardly grows with the number of voxels (numerics.md, section 7.8).
class MultigridSolver
{
public:
  /// @param spacing  of voxels: an axis along which they are far shorter is coarsened first
  MultigridSolver(Device& device, const std::array<int, 3>& size, const std::array<double, 3>& spacing);

  /// [axis][voxel] of low faces, 0 at the box's end.
  Buffer<float>& Conductance() { return this->Levels.front().conductance; }
  Buffer<float>& Loss() { return this->Levels.front().loss; }
  /// After the two were written.
  void Coarsen();

  /// Make the residual of `values`, in the norm of the preconditioner, smaller by `reduction`.
  /// @param unit  about as large as the entries of b
  /// @param leftAtMost  and its root mean square at most this, in units, for that norm hardly counts thin voxels beside
  ///   thick ones
  /// @return iterations
  int Solve(const ExactValues& right, ExactValues& values, double unit, double reduction,
    double leftAtMost = std::numeric_limits<double>::infinity());

  static cl::NDRange Range(const int* size);
  static cl::NDRange Group() { return { 32, 8, 1 }; }

private:
  struct Level
  {
    MultigridLevel layout;
    Buffer<float> conductance, loss, right, values, other;
  };

  cl::Kernel Kernel(const char* name) const;
  void Run(cl::Kernel& kernel, const int* size);
  void Precondition(double perUnit);
  void Smooth(Level& level);
  double Dot(const ExactValues& a, const cl::Buffer& b, bool ofFloats);
  void Multiply(const ExactValues& x, const ExactValues* from, const ExactValues& into);
  double PreconditionedNorm(double unit);
  void Turn(double part);
  void Step(const ExactValues& values, double length);

  Device& TheDevice;
  std::vector<Level> Levels;
  ExactValues Residual, Direction, Applied, Sums;
  std::size_t Count;
  double FirstResidual = 0.0; ///< of the first solve, in units
};
}
