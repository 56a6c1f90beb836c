#pragma once

#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Viewing/Scene/ViewShared.h"

#include <vector>

namespace tyndall
{
/// Points and parallel beams that stand for the lights.
std::vector<SmallLight> SmallLights(const std::vector<Light>& lights, const Grid& grid, int rectangleSamples);
}
