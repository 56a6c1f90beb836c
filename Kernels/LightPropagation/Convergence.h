#pragma once

#include "Distribution/Domain.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Whether an estimated relative error (ConvergenceRow::residual) is at most settings.tolerance. False if
/// settings.maximumOrders is set: then the number of orders ends the solve.
bool MeetsTolerance(const PropagationSettings& settings, double residual);

/// Estimates the sum of the scattering orders not yet computed. Orders are taken to decrease like a geometric series in
/// the end (numerics.md, Eq. (43)).
class RestOfOrders
{
public:
  /// From the next order on, orders are corrections to a first guess (WarmStart). They decrease at least this slowly in
  /// the end; faster at first.
  /// @param rate  lower bound on the ratio of successive orders; 0: not known
  void BeginWarm(double rate);

  /// Adds the next order to the estimate.
  /// @param now  power of this order, or its magnitude, > 0
  /// @param all  sum over all orders so far, same unit
  /// @return estimated remainder relative to `all`; at most 1 after the first order, which does not show the rate of
  ///   decrease
  double After(double now, double all);
  double Ratio() const { return this->LastRatio; } ///< last order / the one before it

private:
  int Orders = 0;
  bool Warm = false;
  bool Compares = false; ///< the next order can be divided by the last one
  double Last = 0.0, LastRatio = 0.0, Least = 0.0;
};

/// Estimates the remaining error of an iteration in which each step corrects the one before (numerics.md, Eq. (73)).
class RestOfChanges
{
public:
  /// Adds an iteration to the estimate.
  /// @param change  relative change of the light in this iteration
  /// @param guessedRatio  ratio of this change to the previous one, if known from elsewhere; 0: not known
  /// @return estimated relative error; 1 after the first iteration, which does not show the rate of decrease
  double After(double change, double guessedRatio = 0.0);
  double Ratio() const { return this->LastRatio; } ///< last change / the one before it

private:
  int Changes = 0;
  double Last = 1.0, LastRatio = 1.0;
};

/// Power that the next order carries, without light that wraps around periodic axes endlessly, W, of one channel. Such
/// light (for example emission of empty voxels along a periodic axis) is recognised by two signs: it makes up nearly
/// all the power, and it does not decrease from order to order.
/// @param maximumOrders  if above 0, nothing is excluded
/// @param before, onTheWay  power that wraps around periodic axes after the last order but one, and after the last, W
/// @param others  all other power that goes on, W
double GoesOnToItsEnd(int maximumOrders, double before, double onTheWay, double others);

/// As GoesOnToItsEnd, for accelerations whose prediction already includes light that wraps around. `others` is the
/// power of the last order that the acceleration did not predict. Its decrease shows convergence, so light that wraps
/// around is not added.
double GoesOnAsForeseen(double before, double onTheWay, double others);

/// Progress of a solve, in [0, 1]: the orders done over settings.maximumOrders; without such a limit, how far the
/// logarithm of the residual has come towards that of the tolerance, and at least a little more with each iteration.
/// @param residual  of the last iteration; 1 before the first
/// @param iterations  done, including the fraction of the current one
double ProgressOf(const PropagationSettings& settings, double residual, double iterations);

/// Fraction of the first iteration's progress that is attributed to uncollided light.
constexpr double UncollidedPart = 0.5;

/// Adds a warning to `light.doubts` if faces reflect and uncollided light is an input: the cells through which that
/// light leaves are not known, so it is not reflected.
void WarnAboutInputLight(const Domain& domain, const Illumination& illumination, LightField& light);

/// Energy balance check of every conservative solver: all power must be absorbed, escape or be left over. A relative
/// error above 1e-4 adds a warning to `light.doubts`.
/// Collective.
/// @param light  with the balance of the whole domain
/// @param medium  of this rank's block; read only if the balance is off, to find the cause
/// @throws InvalidInput if the relative error is above 1e-2 or NaN, or if more than 1e-2 of the power is impossible:
///   absorbed or escaped power below 0, or more left over than entered
void JudgeBalance(LightField& light, const Domain& domain, const Medium& medium);

/// Sets `light.converged`. Adds a warning to `light.doubts` if the light has not converged, or if too much power is
/// left over.
/// @param accelerates  the solver has an acceleration setting, which the warning then mentions
void JudgeConvergence(const PropagationSettings& settings, LightField& light, bool accelerates = true);
}
