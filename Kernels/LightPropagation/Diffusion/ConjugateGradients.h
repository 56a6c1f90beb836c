#pragma once

#include <functional>

namespace tyndall
{
/// The operations of preconditioned conjugate gradients (Hestenes and Stiefel 1952), on whatever storage the solver
/// uses.
struct GradientSteps
{
  std::function<double()> precondition;  ///< z = M^-1 r. @return r z, the squared residual norm of the preconditioner
  std::function<void(double part)> turn; ///< p = z + part p
  std::function<double()> curvature;     ///< @return p A p
  std::function<double(double length)> goOn; ///< x += length p, r -= length A p. @return r r
};

/// Stopping criteria.
struct GradientBounds
{
  /// Factor by which the residual's norm in that of the preconditioner must fall; its root mean square may be ten times
  /// this.
  double reduction;
  double leftAtMost; ///< additional bound on the residual's root mean square; infinity: none
  double count;      ///< number of unknowns
};

/// Iterates until the bounds are met or the residual stagnates.
/// @param left  r r of the initial residual
/// @param firstResidual  r z of the first solve, updated here: later solves do not reduce the residual below rounding
///   relative to it
/// @return number of iterations
int SolveCg(const GradientSteps& steps, double left, const GradientBounds& bounds, double& firstResidual);
}
