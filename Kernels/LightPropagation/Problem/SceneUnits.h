#pragma once

#include "Light/LightField.h"
#include "Medium/Medium.h"

#include <vector>

namespace tyndall
{
/// Units of power and length that the solver chooses (numerics.md, Eq. (85)). Light is linear in its power, but floats
/// end at 3e38: rays carry W, path integrals W length. Scenes of powers far from 1 W are solved in a unit of their own,
/// a power of two, so that no digit is lost.

/// W to solve a scene in: 1 where the power of all that shines is not far from that.
double PowerUnitOf(const Medium& medium, const Illumination& illumination);

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
