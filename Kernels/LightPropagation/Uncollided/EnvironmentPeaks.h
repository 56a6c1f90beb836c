#pragma once

#include "LightPropagation/Angular/DirectionSet.h"

namespace tyndall
{
/// An environment as two parts that add up to it: one that varies slowly enough for a coarse set of directions, and
/// directional lights for the small bright things in it (the sun's disc, lamps).
struct SplitEnvironment
{
  Environment smooth;
  std::vector<Light> peaks; ///< directional, at most 64; power is irradiance, W / length^2
};

/// Looks for peaks in the cells of a direction set. Where the brightest twentieth of a cell's solid angle outshines the
/// rest of it more than fourfold, what is above that becomes one light from its centre of power (numerics.md, Eq.
/// (32)), if it carries at least a five-hundredth of what the environment shines. Colour and power are kept exactly.
SplitEnvironment Split(const Environment& environment, const DirectionSet& set);
}
