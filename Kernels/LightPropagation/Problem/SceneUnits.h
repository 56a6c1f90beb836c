#pragma once

#include "Light/LightField.h"
#include "Medium/Medium.h"

#include <vector>

namespace tyndall
{
/// Units of power and length chosen by the solver (numerics.md, Eq. (85)). Light is linear in its power, but floats
/// overflow at 3e38 (rays carry W, path integrals W length) and round. The unit of power is proportional, up to a power
/// of two, to the power of the sources, so that a scene with scaled power is rounded alike and solved by the same
/// steps.

/// Quantities from which the unit of power is computed. Ranks take the maximum of each, since only emission and given
/// uncollided light differ between them.
struct AllThatShines
{
  double power = 0.0; ///< upper bound of the total power, W
  /// A light's power; if there is none a radiance, then emission. 0: no source, or uncollided light is given
  double first = 0.0;
};

/// @param medium  medium of the whole grid, or of a block
AllThatShines ShiningOn(const Grid& grid, const Medium& medium, const Illumination& illumination);

/// Unit of power to solve a scene in, W; between 1 and 2 if the power of the sources is not far from that.
double PowerUnitFor(const AllThatShines& all);

/// A scene converted to another unit of power.
struct SceneInUnits
{
  SceneInUnits(const Medium& medium, const Illumination& illumination, double unit);

  std::vector<float> emission, uncollided;
  Medium medium;             ///< refers to `emission`
  Illumination illumination; ///< refers to `uncollided`
};

/// Converts light from the unit of power back to W.
/// @throws InvalidInput  if a value overflows a float
void ToWatts(LightField& light, double unit);

/// Areas and volumes of voxels must fit in floats, too. Boxes whose voxels are far from size 1 are solved in their own
/// unit of length, a power of two. Radiance and fluence do not depend on the unit.

/// Unit of length to solve a box in; 1 if its longest spacing is not far from 1.
double LengthUnitOf(const Grid& grid);

/// The grid in this unit of length.
Grid InUnit(Grid grid, double unit);

/// A scene converted to another unit of length. Powers in W result divided by the square of the unit (see
/// MultiplyPowers).
struct SceneInLengths
{
  SceneInLengths(const Medium& medium, const Illumination& illumination, double unit);

  std::vector<float> sigma_a, sigma_s, emission;
  Medium medium; ///< refers to these arrays
  Illumination illumination;
};

/// Multiplies all quantities in W by `factor`: the same light in a box whose faces are larger by this factor.
void MultiplyPowers(LightField& light, double factor);
}
