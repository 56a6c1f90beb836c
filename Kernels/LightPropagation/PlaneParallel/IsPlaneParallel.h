#pragma once

#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>

namespace tyndall
{
/// Axis along which layers are stacked: the only axis that is not periodic; -1 if the other two are not both periodic.
int AxisOfLayers(const std::array<bool, 3>& periodic);

/// Whether a scene is plane-parallel, and can be solved as such: two axes are periodic, all columns of voxels are
/// equal, there are at most 8192 layers, and the only external sources are directional lights, sky and faces. Also, no
/// setting may request what only the voxel solver has: a constant source, plain source iteration, a number of
/// directions or moments, first moments (firstMoments), or leaveOut off.
bool IsPlaneParallel(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);
}
