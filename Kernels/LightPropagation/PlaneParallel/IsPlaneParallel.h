#pragma once

#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>

namespace tyndall
{
/// The axis that is not periodic; -1 unless it is the only one.
int AxisOfLayers(const std::array<bool, 3>& periodic);

/// Whether nothing varies along two axes: both are periodic, all columns of voxels are equal, there are 8192 layers at
/// most, and all that shines are directional lights, sky and faces; and nothing is asked for that only rays through a
/// box have: a constant source, orders one by one, a number of directions or moments, where light is first lost,
/// all that is not needed.
bool IsPlaneParallel(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);
}
