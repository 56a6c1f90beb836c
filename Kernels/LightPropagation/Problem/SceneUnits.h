#pragma once

#include "Light/LightField.h"
#include "Medium/Medium.h"

#include <vector>

namespace tyndall
{
/// Units of power and length chosen by the solver (numerics.md, Eq. (85)). Light is linear in the power of its sources,
/// but floats overflow at 3e38 (rays carry W, path integrals W length) and round. The unit of power is proportional, up
/// to a power of two, to the power of the sources, so that a scene with scaled power has the same rounding errors and
/// takes the same steps of the solver.

/// Quantities from which the unit of power is computed. Over several ranks it is computed from the maximum of each,
/// since only emission and given uncollided light differ between ranks.
struct AllThatShines
{
  double power = 0.0; ///< upper bound of the total power, W
  /// Power of the first light; if there is none, the first boundary radiance or the largest emission; 0: no source, or
  /// uncollided light is given.
  double first = 0.0;
};

/// Computes the quantities of AllThatShines for a scene.
/// @param grid  grid of the domain
/// @param medium  medium of the domain, or of a subdomain
AllThatShines ShiningOn(const Grid& grid, const Medium& medium, const Illumination& illumination);

/// Unit of power in which a scene is solved, W; between 1 and 2 if the power of the sources is between 2^-40 W and 2^40
/// W.
double PowerUnitFor(const AllThatShines& all);

/// Checks that light is not too faint for floats.
/// @param grid  grid of the domain, in the unit of length of `all`
/// @throws InvalidInput  if no voxel can have a fluence of 1.2e-38 W / length^2, the least normal float
void CheckBrightness(const Grid& grid, const AllThatShines& all);

/// A scene whose powers are expressed as multiples of `unit`, W.
struct SceneInUnits
{
  SceneInUnits(const Medium& medium, const Illumination& illumination, double unit);

  std::vector<float> emission, uncollided;
  Medium medium;             ///< the medium, whose emission refers to the member `emission`
  Illumination illumination; ///< the illumination, whose given uncollided light refers to `uncollided`
};

/// Converts the powers of light from multiples of `unit` back to W.
/// @throws InvalidInput  if a value overflows a float
void ToWatts(LightField& light, double unit);

/// Areas and volumes of voxels must fit in floats, too. Boxes whose voxels are far from size 1 are therefore solved in
/// another unit of length, a power of two. Radiance and fluence do not depend on this unit.

/// Unit of length in which a box is solved, in units of the grid; 1 if its longest spacing is between 2^-20 and 2^20.
double LengthUnitOf(const Grid& grid);

/// Copy of a grid with lengths expressed as multiples of `unit`.
Grid InUnit(Grid grid, double unit);

/// A scene whose lengths are expressed as multiples of `unit`. Powers of the converted scene are those of the original
/// one divided by the square of the unit (see MultiplyPowers).
struct SceneInLengths
{
  SceneInLengths(const Medium& medium, const Illumination& illumination, double unit);

  std::vector<float> sigma_a, sigma_s, emission;
  Medium medium; ///< the medium, which refers to the members sigma_a, sigma_s and emission
  Illumination illumination;
};

/// Multiplies all powers of a LightField (W) by `factor`: the same light in a box whose faces are larger by this
/// factor.
void MultiplyPowers(LightField& light, double factor);
}
