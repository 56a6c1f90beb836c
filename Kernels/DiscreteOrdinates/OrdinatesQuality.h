#pragma once

#include "DiscreteOrdinates/OrdinatesSettings.h"
#include "Distribution/Domain.h"
#include "Light/LightField.h"
#include "Light/Quality.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "Medium/Medium.h"

#include <cstddef>
#include <string>
#include <vector>

namespace tyndall
{
/// Settings of a quality for a medium: directions, terms of its phase function where it has one, and tolerance, as far
/// as `settings` has them at their default values. No more directions than half the smallest memory of all ranks would
/// hold of the whole grid. Collective.
/// @param medium  of this rank's block
/// @param memory  of this rank's device
OrdinatesSettings AtQuality(
  const Domain& domain, Quality quality, OrdinatesSettings settings, const Medium& medium, const DeviceMemory& memory);

/// "Name = value" of each setting that a quality may choose and that plays a part: spiralDirections in place of those
/// of a cube, no terms where every pair of directions is multiplied.
std::vector<std::string> Words(const OrdinatesSettings& settings);
/// The same as the light was solved with: more directions, where a slab needs them (UnvaryingAxes.h).
std::vector<std::string> Words(OrdinatesSettings settings, const LightField& light);
}
