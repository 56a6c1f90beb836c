#pragma once

#include "Device/Monitor.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Light of a scene for which IsPlaneParallel (IsPlaneParallel.h) holds, in the cosine to the axis of the layers alone:
/// discrete ordinates, exact within each layer (numerics.md, section 10 d). What is scattered forwards beyond the
/// moments that the nodes carry goes straight on (delta-M). The host does it, in a few milliseconds for 64 layers;
/// leftOut says so. One iteration, without a residual.
///
/// settings: netFlux, facePower, storeMoments and polarNodes are read, and nothing of the others but `periodic`.
/// @throws InvalidInput what Check(medium, illumination, settings) throws
LightField SolvePlaneParallel(const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor = {});
}
