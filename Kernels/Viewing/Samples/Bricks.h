#pragma once

#include "Device/OpenCL.h"
#include "Viewing/Scene/ViewShared.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Multiplies each brick's kind (1 empty, -1 filled, 0 where rays bend) by the number of king's moves to the nearest
/// brick of another kind, at most 127; two sweeps find it exactly.
void FindDistances(std::vector<cl_char>& bricks, const std::array<int, 3>& count);
}
