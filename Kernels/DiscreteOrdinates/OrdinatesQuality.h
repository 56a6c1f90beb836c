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
/// Settings for a quality level: directions, tolerance and, if scattering is anisotropic, terms of the phase function.
/// Only settings that have their default values are changed. The number of directions is limited so that one channel of
/// their radiance on the whole grid takes at most half of the smallest memory of all ranks. Collective.
/// @param medium  of this rank's block
/// @param memory  of this rank's device
OrdinatesSettings AtQuality(
  const Domain& domain, Quality quality, OrdinatesSettings settings, const Medium& medium, const DeviceMemory& memory);

/// "Name = value" of each setting that a quality level may choose and that has an effect: spiralDirections instead of
/// directionsPerFace if set, no terms with the full matrix.
std::vector<std::string> Words(const OrdinatesSettings& settings);
/// The same with the settings actually used: slabs are solved with more directions (GridAxes.h).
std::vector<std::string> Words(OrdinatesSettings settings, const LightField& light);
}
