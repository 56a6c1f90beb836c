#pragma once

#include <functional>

namespace tyndall
{
/// The steps of conjugate gradients on a residual (Hestenes and Stiefel 1952), whoever holds it.
struct GradientSteps
{
  std::function<double()> precondition;      ///< @return the residual's norm in that of the preconditioner, squared
  std::function<void(double part)> turn;     ///< the next direction: what that found, and `part` of the last one
  std::function<double()> curvature;         ///< of the direction p: p A p
  std::function<double(double length)> goOn; ///< so far along it. @return the square of what is left
};

/// When to end.
struct GradientBounds
{
  double reduction;  ///< of the residual, in the norm of the preconditioner; its root mean square by ten times that
  double leftAtMost; ///< root mean square, besides; infinity: any
  double count;      ///< unknowns
};

/// Goes down until the bounds are met, or nothing is gained any more.
/// @param left  square of the residual
/// @param firstResidual  of the first solve, in the norm of the preconditioner, squared: kept here
/// @return iterations
int SolveCg(const GradientSteps& steps, double left, const GradientBounds& bounds, double& firstResidual);
}
