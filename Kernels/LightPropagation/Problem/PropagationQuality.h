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
/// Settings with the values of a quality level for a scene: numbers of directions for scattered and for uncollided
/// light, starting positions of rays, tolerance, and error of localised emission. Only settings at their default values
/// are changed. Cost and accuracy of the levels were measured (measurements.md).
///
/// The result depends on whether light is incident through faces, from a sky or an environment (only then uncollided
/// light has finer directions), whether any voxel scatters (else the directions are those of uncollided light), and
/// whether the box is so optically thick that scattered light is nearly isotropic.
/// Collective; `quality` must be the same on all ranks.
/// @param medium  medium of this rank's subdomain
PropagationSettings AtQuality(const Domain& domain, Quality quality, PropagationSettings settings, const Medium& medium,
  const Illumination& illumination);

/// Text "Name = value" for each setting that a quality level may choose.
std::vector<std::string> Words(const PropagationSettings& settings);
/// Text "Name = value" for each setting that a quality level may choose, with the value that SolveConservative used for
/// `light`: more directions if a slab needs them (GridAxes.h), and the chosen uncollidedDirections, 0 if no light used
/// them. SolvePlaneParallel uses none of these settings; for its light the text is "PolarNodes = value".
std::vector<std::string> Words(PropagationSettings settings, const LightField& light);
/// Text "Name = value" for each setting that a quality level may choose and that the published scheme uses.
std::vector<std::string> WordsAsPublished(const PropagationSettings& settings);
}
