#pragma once

#include "Distribution/Communicator.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"

#include <limits>

namespace tyndall
{
/// Predicts the error due to the angular discretisation, and the work of a solve, as functions of the number of
/// directions, from two solves on the same grid with few and with more directions. The decrease of the error with the
/// number of directions was measured (measurements.md), separately for uncollided and for scattered light; the two
/// errors are treated as uncorrelated. Each rank passes the light of its subdomain; results are global.
class DirectionForecast
{
public:
  /// Compares two solutions. Collective.
  /// @param few, more  solutions with `fewDirections` and `moreDirections` directions per cube face, for scattered and
  ///   for uncollided light
  DirectionForecast(
    Communicator& communicator, const LightField& few, int fewDirections, const LightField& more, int moreDirections);

  /// Ratio of the angular error of uncollided light to the angular error of all light.
  double UncollidedPart() const;
  /// Determines two errors separately: the error caused by the directions of uncollided light, including the light
  /// scattered from it, and the error caused by the directions of scattered light. Collective.
  /// @param between  solution with few directions for scattered light and more directions for uncollided light
  void Separate(Communicator& communicator, const LightField& few, const LightField& between, const LightField& more);

  /// Predicted root-mean-square error of the fluence due to the angular discretisation, relative to the fluence, on a
  /// grid with twice as many voxels per axis.
  double Error(const PropagationSettings& settings) const;
  /// Ratio of Error(settings) to the predicted difference between two solutions on the coarse grid, one with `settings`
  /// and one with `others`.
  double PartOfDifference(const PropagationSettings& settings, const PropagationSettings& others) const;
  /// Predicted work, in units of the work of one sweep with one direction per cube face.
  double Work(const PropagationSettings& settings) const;
  /// The settings with the least work whose predicted error is at most `error`; if there are none, the settings with
  /// the least error. Only settings that have their default values are changed. Uncollided light uses the directions of
  /// scattered light unless Separate() was called.
  /// @param most  largest number of directions per cube face that may be chosen
  PropagationSettings Cheapest(
    const PropagationSettings& settings, double error, int most = std::numeric_limits<int>::max()) const;
  /// Multiplies all predicted errors by `factor`, the ratio of observed to predicted error.
  void Correct(double factor);

private:
  /// Ratio of the root-mean-square difference between the two solutions to the error with 9 directions per cube face on
  /// the finer grid
  double Fallen;
  /// Errors of uncollided and of scattered light with 9 directions per cube face, relative to the fluence.
  double OfUncollided = 0.0, OfScattered = 0.0;
  bool Separated = false;
  double Sweeps = 1.0;
};
}
