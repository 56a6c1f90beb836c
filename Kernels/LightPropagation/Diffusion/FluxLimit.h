#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <vector>

namespace tyndall
{
/// Where light is absorbed within a voxel, the mean of the powers through its faces is more than its net flux, which is
/// cut to the fluence.
/// @param fluence  W / length^2, [channel][stride]
/// @param flux  net flux times the voxel's volume, [channel][x, y, z][stride]
void LimitFlux(const VolumeLayout& layout, const std::vector<float>& fluence, Buffer<float>& flux);
}
