#pragma once

#include "Device/OpenCL.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Edge of a brick in voxels, as in Sampling.cl.
constexpr int BrickEdge = 8;

/// Multiplies each brick's kind (1 empty, -1 filled, 0 where rays bend) by the number of king's moves to the nearest
/// brick of another kind, at most 127; two sweeps find it exactly.
void FindDistances(std::vector<cl_char>& bricks, const std::array<int, 3>& count);
}
