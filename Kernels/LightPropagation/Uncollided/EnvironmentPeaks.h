#pragma once

#include "LightPropagation/Angular/DirectionSet.h"

namespace tyndall
{
/// Environment split into two parts that add up to the original: a smooth environment that a coarse quadrature
/// resolves, and directional lights for small bright features (the sun's disc, lamps).
struct SplitEnvironment
{
  Environment smooth;
  std::vector<Light> peaks; ///< directional lights, at most 64; power is irradiance, W / length^2
};

/// Finds peaks of an environment in the cell of each direction of `set` (the pixels nearest to it). If the radiance of
/// pixels in the brightest twentieth of a cell's solid angle exceeds four times the mean of the rest of the cell, the
/// excess becomes one directional light from the direction of its centre of power (numerics.md, Eq. (32)), provided
/// that it carries at least 1/500 of the environment's power. Colour and power are conserved exactly.
SplitEnvironment Split(const Environment& environment, const DirectionSet& set);
}
