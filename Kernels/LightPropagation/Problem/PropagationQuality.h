#pragma once

#include "Light/LightField.h"
#include "Light/Quality.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Settings of a quality for a scene: directions, those of unscattered light, where rays start, tolerance and the error
/// of bright emission, as far as `settings` has them at their default values. What the levels cost and how exact they
/// are was measured (measurements.md).
///
/// Of the scene it matters whether light comes in through faces, sky or environment (only then has unscattered light
/// finer directions), whether anything is scattered (else the directions are those of unscattered light), and whether
/// the box is so thick that scattered light hardly depends on directions.
PropagationSettings AtQuality(
  Quality quality, PropagationSettings settings, const Medium& medium, const Illumination& illumination);

/// What of a scene that matters for.
struct SceneOfQuality
{
  bool isLit = false;     ///< through the box's faces
  bool scatters = false;  ///< the medium does
  double thickness = 0.0; ///< mean free paths across the box, in the mean
};
PropagationSettings AtQuality(Quality quality, PropagationSettings settings, const SceneOfQuality& scene);
bool Scatters(const Medium& medium); ///< in any voxel

/// "Name = value" of each setting that a quality may choose.
std::vector<std::string> Words(const PropagationSettings& settings);
/// The same as SolveConservative used them for the light: more directions, where a slab needs them (UnvaryingAxes.h),
/// and the uncollidedDirections that were chosen, 0 where no light came along them. Layers that were solved in the
/// cosine alone used none of these settings, but "PolarNodes = value".
std::vector<std::string> Words(PropagationSettings settings, const LightField& light);
/// Those that the published scheme uses.
std::vector<std::string> WordsAsPublished(const PropagationSettings& settings);
}
