#pragma once

#include "Distribution/Domain.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Whether an estimated relative error (ConvergenceRow::residual) is at most settings.tolerance. False if
/// settings.maximumOrders is set: then the number of orders determines the end of the solve.
bool MeetsTolerance(const PropagationSettings& settings, double residual);

/// Estimates the sum of the scattering orders not yet computed. Orders are assumed to finally decrease like a geometric
/// series (numerics.md, Eq. (43)).
class RestOfOrders
{
public:
  /// Announces that orders from the next one on are corrections to an initial guess (WarmStart). Their ratio is finally
  /// at least `rate`; at first they decrease faster.
  /// @param rate  lower bound on the ratio of successive orders; 0: not known
  void BeginWarm(double rate);

  /// Adds the next scattering order, and estimates the sum of all later ones.
  /// @param now  magnitude of the light of this order, for example its power, > 0
  /// @param all  sum of the magnitudes of all orders so far, in the same unit
  /// @return estimated sum of the later orders, relative to `all`; at most 1 after the first order, which does not show
  ///   the rate of decrease
  double After(double now, double all);
  /// Ratio of the last order's magnitude to that of the order before it.
  double Ratio() const { return this->LastRatio; }

private:
  int Orders = 0;
  bool Warm = false;
  /// Whether the next order may be compared with Last, the magnitude of the last order: false before the first order
  /// and after BeginWarm().
  bool Compares = false;
  double Last = 0.0, LastRatio = 0.0, Least = 0.0;
};

/// Estimates the remaining error of an iteration in which each step corrects the result of the previous step
/// (numerics.md, Eq. (73)).
class RestOfChanges
{
public:
  /// Adds an iteration, and estimates the error.
  /// @param change  relative change of the light in this iteration
  /// @param guessedRatio  ratio of this change to the previous one, if known independently; 0: not known
  /// @return estimated relative error; 1 after the first iteration, which does not show the rate of decrease
  double After(double change, double guessedRatio = 0.0);
  double Ratio() const { return this->LastRatio; } ///< ratio of the last change to the previous one

private:
  int Changes = 0;
  double Last = 1.0, LastRatio = 1.0;
};

/// Power of one channel that the next order carries, W, without light that wraps around periodic axes endlessly. Such
/// light (for example emission of empty voxels along a periodic axis) is recognised by two signs: it makes up nearly
/// all the power, and it does not decrease from order to order.
/// @param maximumOrders  if above 0, no light is excluded
/// @param before, onTheWay  power that wraps around periodic axes after the last order but one, and after the last
///   order, W
/// @param others  all other power that the next order carries, W
double GoesOnToItsEnd(int maximumOrders, double before, double onTheWay, double others);

/// Like GoesOnToItsEnd(), W, for orders that are accelerated: the acceleration's prediction already includes the light
/// that wraps around periodic axes, so the power of this light is added to `others` only if it does not decrease from
/// order to order.
/// @param others  power of the last order that the acceleration did not predict, W
double GoesOnAsForeseen(double before, double onTheWay, double others);

/// Progress of a solve, in [0, 1]. If settings.maximumOrders is set, it is the fraction of completed orders. Otherwise
/// it is the logarithm of the residual divided by the logarithm of the tolerance, or a function that slowly increases
/// with the iterations, whichever is larger.
/// @param residual  residual of the last iteration; 1 before the first one
/// @param iterations  completed iterations, including the fraction of the current one
double ProgressOf(const PropagationSettings& settings, double residual, double iterations);

/// Fraction of the first iteration's progress, as reported to monitors, at which uncollided light has been computed.
constexpr double UncollidedPart = 0.5;

/// Adds a warning to `light.doubts` if faces reflect and uncollided light is given as input: the cells through which
/// that light leaves are not known, so it is not reflected.
void WarnAboutInputLight(const Domain& domain, const Illumination& illumination, LightField& light);

/// Checks the energy balance, for all conservative solvers: all power must be absorbed, escape or be left over. A
/// relative error above 1e-4 adds a warning to `light.doubts`. Collective.
/// @param light  light with the balance of the domain
/// @param medium  medium of this rank's subdomain; read only if the balance is wrong, to find the cause
/// @throws InvalidInput if the relative error is above 1e-2 or NaN, or if more than 1e-2 of the power is impossible:
///   absorbed or escaped power below 0, or more left over than entered
void JudgeBalance(LightField& light, const Domain& domain, const Medium& medium);

/// Sets `light.converged`. Adds a warning to `light.doubts` if the light has not converged, or if too much power is
/// left over.
/// @param accelerates  whether the solver has an acceleration setting, which the warning then mentions
void JudgeConvergence(const PropagationSettings& settings, LightField& light, bool accelerates = true);
}
