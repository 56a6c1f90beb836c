#pragma once

#include "Distribution/Domain.h"
#include "Light/LightField.h"
#include "Light/Quality.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Settings for a quality level and a scene: number of directions, also for uncollided light, where rays start,
/// tolerance, and the error of bright emission. Only settings at their default values are changed. Cost and accuracy of
/// the levels were measured (measurements.md).
///
/// The result depends on whether light is incident through faces, from a sky or an environment (only then uncollided
/// light has finer directions), whether anything scatters (else the directions are those of uncollided light), and
/// whether the box is so thick that scattered light is nearly isotropic.
/// Collective; the quality is the same on all ranks.
/// @param medium  of this rank's block
PropagationSettings AtQuality(const Domain& domain, Quality quality, PropagationSettings settings, const Medium& medium,
  const Illumination& illumination);

/// "Name = value" for each setting that a quality level may choose.
std::vector<std::string> Words(const PropagationSettings& settings);
/// The same with the values that SolveConservative used for `light`: more directions if a slab needs them
/// (GridAxes.h), and the chosen uncollidedDirections, 0 if no light used them. Layers solved in the polar cosine
/// only used none of these settings; the result is then "PolarNodes = value".
std::vector<std::string> Words(PropagationSettings settings, const LightField& light);
/// The settings that the published scheme uses.
std::vector<std::string> WordsAsPublished(const PropagationSettings& settings);
}
