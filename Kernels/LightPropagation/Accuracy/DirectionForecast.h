#pragma once

#include "Distribution/Communicator.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"

namespace tyndall
{
/// Predicts the discretisation error in angle, and the work of a solve, as functions of the number of directions, from
/// two solves on the same grid with few and with more directions. The decrease of the error with the number of
/// directions was measured (measurements.md), separately for uncollided and for scattered light; the two errors are
/// treated as uncorrelated. Each rank passes the light of its block; results are global.
class DirectionForecast
{
public:
  /// Collective.
  /// @param few, more  solutions with `fewDirections` and `moreDirections` directions per cube face, for scattered and
  ///   uncollided light alike
  DirectionForecast(
    Communicator& communicator, const LightField& few, int fewDirections, const LightField& more, int moreDirections);

  /// Contribution of uncollided light to the difference between the two solutions, relative to the whole.
  double UncollidedPart() const;
  /// Separates the errors caused by the directions of uncollided light, including what it scatters, from those of
  /// scattered light. Collective.
  /// @param between  scattered light with the few directions, uncollided light with the more
  void Separate(Communicator& communicator, const LightField& few, const LightField& between, const LightField& more);

  /// Predicted relative root-mean-square error of fluence, on a grid with twice the voxels per axis.
  double Error(const PropagationSettings& settings) const;
  /// That error over the difference between the solutions with `settings` and with `others` on the coarse grid.
  double PartOfDifference(const PropagationSettings& settings, const PropagationSettings& others) const;
  /// Predicted work, in units of a sweep along one direction per cube face.
  double Work(const PropagationSettings& settings) const;
  /// The cheapest settings with an error of at most `error`; if there are none, those with the least error. Only
  /// numbers that have their default values in `settings` are changed. Uncollided light uses the same directions as
  /// scattered light unless Separate() was called.
  PropagationSettings Cheapest(const PropagationSettings& settings, double error) const;
  /// Multiplies predicted errors by the ratio of observed to predicted error.
  void Correct(double factor);

private:
  double Fallen; ///< difference of the two solves over the error of 9 directions on the finer grid
  double OfUncollided = 0.0, OfScattered = 0.0; ///< errors with 9 directions per face
  bool Separated = false;
  double Sweeps = 1.0;
};
}
