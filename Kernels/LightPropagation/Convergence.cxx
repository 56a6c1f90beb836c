#include "LightPropagation/Convergence.h"

#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double WarmMargin = 1.5;      ///< the error of a guess does not fall evenly
constexpr double MarginOfChanges = 1.5; ///< of the estimated error: changes do not fall off evenly
constexpr double MuchLeftOver = 0.01;   ///< of the power, with the usual tolerance
constexpr double SlowestFall = 1e-4;    ///< from order to order, of light that is waited for round periodic axes
constexpr double NextToAll = 1e-3;      ///< what else there is beside it, at most

/// Of all power, what the solver gave up.
double LeftOver(const EnergyBalance& balance)
{
  const double all = Sum(balance.entered) + Sum(balance.emitted);
  return all > 0.0 ? Sum(balance.leftOver) / all : 0.0;
}
}

bool MeetsTolerance(const PropagationSettings& settings, double residual)
{
  return settings.maximumOrders == 0 && residual <= settings.tolerance;
}

void RestOfOrders::BeginWarm(double rate)
{
  this->Warm = true;
  this->Least = rate;
  this->Compares = false;
}

double RestOfOrders::After(double now, double all)
{
  const double ratio = this->Compares ? now / this->Last : this->Least > 0.0 ? this->Least : 1.0;
  const double growth = this->Orders > 1 ? std::max(0.0, ratio - this->LastRatio) : 0.0;
  const double limit = std::min(std::max(ratio + growth, this->Least), 1.0 - 1e-9);
  const double rest = (this->Warm ? WarmMargin : 1.0) * (now / all * limit / (1.0 - limit));
  this->LastRatio = ratio;
  this->Last = now;
  this->Compares = true;
  ++this->Orders;
  return this->Orders == 1 ? std::min(rest, 1.0) : rest;
}

double RestOfChanges::After(double change, double guessedRatio)
{
  const double measured = this->Changes > 0 && this->Last > 0.0 ? change / this->Last : 1.0;
  const double ratio = guessedRatio > 0.0 ? guessedRatio : measured;
  const double fall = std::clamp(this->Changes > 1 ? std::max(ratio, this->LastRatio) : ratio, 0.5, 0.95);
  const bool first = this->Changes == 0;
  ++this->Changes;
  this->LastRatio = ratio;
  this->Last = change;
  return first && change != 0.0 ? 1.0 : MarginOfChanges * change * fall / (1.0 - fall);
}

double GoesOnToItsEnd(int maximumOrders, double before, double onTheWay, double others)
{
  const bool endless =
    maximumOrders == 0 && before > 0.0 && onTheWay >= (1.0 - SlowestFall) * before && NextToAll * onTheWay >= others;
  return endless ? others : others + onTheWay;
}

double ProgressOf(const PropagationSettings& settings, double residual, double iterations)
{
  if (settings.maximumOrders > 0)
  {
    return iterations / settings.maximumOrders;
  }
  const double creeping = 1.0 - 1.0 / (1.0 + 0.05 * iterations);
  const double tolerance = std::clamp(settings.tolerance, 1e-12, 0.9);
  const double way = std::log(std::clamp(residual, tolerance, 1.0)) / std::log(tolerance);
  return std::min(std::max(creeping, way), 0.99);
}

void DoubtGivenLight(const Illumination& illumination, LightField& light)
{
  if (illumination.uncollided.IsThere() && Reflects(illumination))
  {
    light.doubts.emplace_back("FaceAlbedo gives back scattered light only: through which cells of the faces the light "
                              "of UncollidedLight leaves is not known.");
  }
}

void JudgeConvergence(const PropagationSettings& settings, LightField& light)
{
  const double residual = light.convergence.empty() ? 0.0 : light.convergence.back().residual;
  light.converged = settings.maximumOrders > 0 || MeetsTolerance(settings, residual);
  if (!light.converged)
  {
    light.doubts.push_back("The light has not converged: after " + std::to_string(light.convergence.size()) +
      " sweeps its estimated relative error is " + Text("%.3g", residual) + ", Tolerance is " +
      Text("%.3g", settings.tolerance) +
      ". Set a larger Tolerance, or Acceleration to none, or resample to voxels of more equal edges.");
  }
  const double left = LeftOver(light.balance);
  if (settings.maximumOrders == 0 && left > std::max(MuchLeftOver, settings.tolerance))
  {
    light.doubts.push_back("Of the light's power " + Text("%.3g", 100.0 * left) +
      "% is left over: its rays still go round periodic axes. A light inside a thin periodic box has images without "
      "end: make the box wider, or its axes not periodic.");
  }
}
}
