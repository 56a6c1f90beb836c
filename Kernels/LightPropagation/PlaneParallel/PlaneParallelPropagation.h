#pragma once

#include "Device/Monitor.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Plane-parallel solver, for scenes for which IsPlaneParallel (IsPlaneParallel.h) holds: discrete ordinates in the
/// cosine to the axis of the layers, exact within each layer (numerics.md, section 10 d). Forward scattering beyond the
/// moments that the nodes resolve is treated as unscattered (delta-M). Runs on the host, in a few milliseconds for 64
/// layers; leftOut says so. Reports one iteration, without a residual.
///
/// @param settings  only netFlux, facePower, storeMoments, polarNodes and periodic are used
/// @throws InvalidInput  from Check(medium, illumination, settings)
LightField SolvePlaneParallel(const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor = {});
}
