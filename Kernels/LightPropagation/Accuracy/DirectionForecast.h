#pragma once

#include "Distribution/Communicator.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"

namespace tyndall
{
/// Forecast of the error that directions leave, and of the work of a solve, from two solves of one grid along few and
/// along more directions. How errors fall with the number of directions was measured (measurements.md), those of
/// light that is not scattered yet and of scattered light each by their own number; of two solves they have nothing
/// to do with each other. Light is that of a rank's block, what is made of it of all ranks.
class DirectionForecast
{
public:
  /// All ranks make one together.
  /// @param few, more  along `fewDirections` and `moreDirections` a face, unscattered light along the same
  DirectionForecast(
    Communicator& communicator, const LightField& few, int fewDirections, const LightField& more, int moreDirections);

  /// The part of unscattered light of the difference, over all of it.
  double UncollidedPart() const;
  /// Where unscattered light is off, so is what is scattered of it: tells the two apart.
  /// All ranks call it.
  /// @param between  scattered light along the few, unscattered light along the more
  void Separate(Communicator& communicator, const LightField& few, const LightField& between, const LightField& more);

  /// Relative, root mean square, of fluence, on a grid of twice the voxels an axis.
  double Error(const PropagationSettings& settings) const;
  /// That error over the difference to the light along others, both on the coarse grid.
  double PartOfDifference(const PropagationSettings& settings, const PropagationSettings& others) const;
  /// In sweeps along one direction a face.
  double Work(const PropagationSettings& settings) const;
  /// The settings with the least work whose error is at most `error`, or else those of the least error. Only numbers
  /// that `settings` has at their default values are chosen; unscattered light goes along the same directions where
  /// nothing told its errors apart (Separate).
  PropagationSettings Cheapest(const PropagationSettings& settings, double error) const;
  /// Errors turned out to be so many times those of the forecast.
  void Correct(double factor);

private:
  double Fallen; ///< the difference of the two solves over the error along 9 on the finer grid
  double OfUncollided = 0.0, OfScattered = 0.0; ///< errors of 9 directions a face
  bool Separated = false;
  double Sweeps = 1.0;
};
}
