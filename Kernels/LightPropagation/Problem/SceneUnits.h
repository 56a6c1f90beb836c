#pragma once

#include "Light/LightField.h"
#include "Medium/Medium.h"

#include <vector>

namespace tyndall
{
/// Units of power and length that the solver chooses (numerics.md, Eq. (85)). Light is linear in its power, but floats
/// end at 3e38: rays carry W, path integrals W length. And they round: a scene is solved in a unit of power that has
/// the digits of what shines in it, so that so many times the power is rounded alike, and solved by the same steps.

/// What the unit of power is made of. Ranks take the largest of each: only what emits, or is given, differs on them.
struct AllThatShines
{
  double power = 0.0; ///< W, at most
  double first = 0.0; ///< a light's power, else a radiance, else emission. 0: nothing shines, or light is given
};

/// @param medium  in all of the grid, or in a block of it
AllThatShines ShiningOn(const Grid& grid, const Medium& medium, const Illumination& illumination);

/// W to solve a scene in: from 1 to 2 where the power of all that shines is not far from that.
double PowerUnitFor(const AllThatShines& all);

/// A scene in another unit of power.
struct SceneInUnits
{
  SceneInUnits(const Medium& medium, const Illumination& illumination, double unit);

  std::vector<float> emission, uncollided;
  Medium medium;             ///< sees `emission`
  Illumination illumination; ///< sees `uncollided`

private:
  void TakeUncollided(double unit);
};

/// Light in units back to W.
/// @throws InvalidInput where it is more than a float holds
void ToWatts(LightField& light, double unit);

/// Areas and volumes of voxels have to be floats, too: boxes of voxels far from 1 are solved in a unit of length of
/// their own, a power of two. Radiance and fluence are the same in every unit.

/// Unit of length to solve a box in: 1 where its longest spacing is not far from that.
double LengthUnitOf(const Grid& grid);

/// A grid in such a unit.
Grid InUnit(Grid grid, double unit);

/// A scene in another unit of length: what is counted in W comes out over the unit's square (MultiplyPowers).
struct SceneInLengths
{
  SceneInLengths(const Medium& medium, const Illumination& illumination, double unit);

  std::vector<float> sigma_a, sigma_s, emission;
  Medium medium; ///< sees them
  Illumination illumination;
};

/// What is counted in W, times `factor`: the same light in a box so many times as large.
void MultiplyPowers(LightField& light, double factor);
}
