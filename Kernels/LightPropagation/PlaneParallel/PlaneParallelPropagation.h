#pragma once

#include "Device/Monitor.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>

namespace tyndall
{
/// Axis along which layers are stacked: the only axis that is not periodic; -1 if the other two are not both periodic.
int AxisOfLayers(const std::array<bool, 3>& periodic);

/// Whether SolvePlaneParallel() can solve a scene: two axes are periodic, all columns of voxels are equal, there are at
/// most 8192 layers, and the only external sources are directional lights, sky and faces. Also, the settings may not
/// request what only the voxel solver has: a constant source, plain source iteration, a number of directions or
/// moments, first moments (firstMoments), or leaveOut off.
bool IsPlaneParallel(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);

/// Solves a scene for which IsPlaneParallel() holds by discrete ordinates in the cosine to the axis of the layers,
/// exactly within each layer (numerics.md, section 10 d). Forward scattering beyond the moments that the nodes resolve
/// is treated as unscattered (delta-M). Runs on the host, in a few milliseconds for 64 layers. LightField::leftOut
/// states this solver, and LightField::convergence has one iteration without a residual.
///
/// @param settings  only netFlux, facePower, storeMoments, polarNodes and periodic are used
/// @throws InvalidInput  from Check(domain, medium, illumination, settings)
LightField SolvePlaneParallel(const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor = {});
}
