#include "LightPropagation/Diffusion/ConjugateGradients.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tyndall
{
namespace
{
constexpr int MostIterations = 300;
/// Number of iterations within which the residual must halve; otherwise the iteration stops.
constexpr int Patience = 12;
/// Factor by which the bound on the root mean square is looser than that in the preconditioner's norm.
constexpr double Looser = 10.0;
constexpr double Negligible = 1e-12; ///< residual relative to the first one that is negligible

/// Whether a residual is above its bound and still falling. To be called once per iteration.
class StagnationTest
{
public:
  explicit StagnationTest(double most)
    : Most(most)
  {
  }

  /// @param square  squared norm of the residual
  bool operator()(double square)
  {
    this->SinceHalved = square < 0.25 * this->Smallest ? 0 : this->SinceHalved + 1;
    this->Smallest = this->SinceHalved == 0 ? square : this->Smallest;
    return square > this->Most && this->SinceHalved < Patience;
  }

private:
  double Most; ///< squared
  double Smallest = std::numeric_limits<double>::infinity();
  int SinceHalved = 0; ///< iterations
};
}

int SolveCg(const GradientSteps& steps, double left, const GradientBounds& bounds, double& firstResidual)
{
  double rz = steps.precondition();
  firstResidual = std::max(firstResidual, rz);
  const double enough = std::max(rz * bounds.reduction * bounds.reduction, firstResidual * Negligible * Negligible);
  const double least = Looser * bounds.reduction;
  StagnationTest tooLarge(std::min(bounds.leftAtMost * bounds.leftAtMost * bounds.count, least * least * left));
  bool tooMuchLeft = tooLarge(left);
  double part = 0.0;
  int iteration = 0;
  while (iteration < MostIterations && rz > 0.0 && std::isfinite(rz) && (rz > enough || tooMuchLeft))
  {
    steps.turn(part);
    const double curvature = steps.curvature();
    if (!(curvature > 0.0))
    {
      break;
    }
    left = steps.goOn(rz / curvature);
    tooMuchLeft = tooLarge(left);
    const double next = steps.precondition();
    part = next / rz;
    rz = next;
    ++iteration;
  }
  return iteration;
}
}
