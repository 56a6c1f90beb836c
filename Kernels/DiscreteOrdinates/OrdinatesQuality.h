#pragma once

#include "DiscreteOrdinates/OrdinatesSettings.h"
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
/// as `settings` has them at their default values. No more directions than half the device's memory holds.
OrdinatesSettings AtQuality(
  Quality quality, OrdinatesSettings settings, const Medium& medium, const DeviceMemory& memory);

/// What of a medium that matters for.
struct MediumOfQuality
{
  std::size_t voxels = 0;  ///< of the whole grid
  bool isIsotropic = true; ///< the phase function
};
OrdinatesSettings AtQuality(
  Quality quality, OrdinatesSettings settings, const MediumOfQuality& medium, const DeviceMemory& memory);

/// "Name = value" of each setting that a quality may choose and that plays a part: spiralDirections in place of those
/// of a cube, no terms where every pair of directions is multiplied.
std::vector<std::string> Words(const OrdinatesSettings& settings);
/// The same as the light was solved with: more directions, where a slab needs them (UnvaryingAxes.h).
std::vector<std::string> Words(OrdinatesSettings settings, const LightField& light);
}
