#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <vector>

namespace tyndall
{
/// Limits the net flux to the fluence. In absorbing voxels the mean of the powers through opposite faces overestimates
/// the net flux.
/// @param fluence  W / length^2, [channel][stride]
/// @param flux  net flux times the voxel's volume, [channel][x, y, z][stride]
void LimitFlux(const VolumeLayout& layout, const std::vector<float>& fluence, Buffer<float>& flux);
}
