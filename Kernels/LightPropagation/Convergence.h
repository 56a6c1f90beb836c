#pragma once

#include "Distribution/Domain.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Whether an estimated relative error (ConvergenceRow::residual) is as small as was asked for; not where a number of
/// orders was asked for instead.
bool MeetsTolerance(const PropagationSettings& settings, double residual);

/// What is still to come of orders that fall off like a geometric series in the end (numerics.md, Eq. (43)).
class RestOfOrders
{
public:
  /// From the next order on, what falls off is the error of a first guess, by this rate at least (WarmStart): it falls
  /// faster at first.
  /// @param rate  0: not known
  void BeginWarm(double rate);

  /// @param now  power, or a magnitude, of the next order, above 0
  /// @param all  of all orders so far
  /// @return the rest over all; 1 at most after the first order, which does not show how fast they fall
  double After(double now, double all);
  double Ratio() const { return this->LastRatio; } ///< of the last order to the one before

private:
  int Orders = 0;
  bool Warm = false;
  bool Compares = false; ///< the last order can be compared with the next
  double Last = 0.0, LastRatio = 0.0, Least = 0.0;
};

/// What is still to come where each iteration corrects the one before (numerics.md, Eq. (73)).
class RestOfChanges
{
public:
  /// @param change  relative, of an iteration
  /// @param guessedRatio  of it to the one before, where that is known otherwise; 0: it is not
  /// @return estimate of the relative error; 1 after the first iteration, which does not show how fast changes fall
  double After(double change, double guessedRatio = 0.0);
  double Ratio() const { return this->LastRatio; } ///< of the last change to the one before

private:
  int Changes = 0;
  double Last = 1.0, LastRatio = 1.0;
};

/// Of what goes on to the next order, without what never ends: light round periodic axes that is next to all of it and
/// does not become less, as what empty voxels emit along such an axis. W, of one channel.
/// @param maximumOrders  asked for: then all goes on
/// @param before, onTheWay  round periodic axes after the last order but one, and after the last
/// @param others  what goes on besides
double GoesOnToItsEnd(int maximumOrders, double before, double onTheWay, double others);

/// Likewise, where an acceleration counts what is on the way as light to come. `others` is the unforeseen part of what
/// ended in the last order; its decrease tells how much is still to come, so light on the way is not added.
double GoesOnAsForeseen(double before, double onTheWay, double others);

/// Of a solve, [0, 1]: orders of those asked for, else how far the logarithm of the residual has come, and a little
/// more with each iteration.
/// @param residual  of the last iteration, 1 before there is one
/// @param iterations  done, with the part of the one under way
double ProgressOf(const PropagationSettings& settings, double residual, double iterations);

/// Part of the first iteration's progress that uncollided light takes.
constexpr double UncollidedPart = 0.5;

/// Adds to a light's `doubts` what faces that reflect do not know of light that another solver found.
void WarnAboutInputLight(const Illumination& illumination, LightField& light);

/// The energy check of every conservative solver: power is absorbed, escapes or is left over. An error above 1e-4
/// becomes one of the light's `doubts`.
/// @param medium  of this rank's block; read only where the balance is off, to tell why; without voxels: not known
/// @throws InvalidInput where the error is above 1e-2, or not a number; where more than 1e-2 of the power is
///   impossible: absorbed or escaped power below 0, or more left over than came in
void JudgeBalance(LightField& light, const Medium& medium);
/// The same over ranks, each with the balance of all. Collective.
/// @param has  voxels, this rank
void JudgeBalance(LightField& light, Communicator& communicator, bool has, const Medium& ofBlock);
void JudgeBalance(LightField& light, const Domain& domain, const Medium& medium);

/// Sets `converged` of solved light, and adds to its `doubts` where it is not, or where power is left over.
/// @param accelerates  the solver has a setting for it
void JudgeConvergence(const PropagationSettings& settings, LightField& light, bool accelerates = true);
}
