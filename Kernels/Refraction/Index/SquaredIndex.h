#pragma once

#include "Device/Buffer.h"
#include "Medium/Grid.h"

namespace tyndall
{
/// Coefficients of the spline of n^2 through voxel centres, as SquaredIndex.cl has them: two more at either end of each
/// axis.
/// @param ior  of each voxel
/// @throws DeviceError if they do not fit
Buffer<float> SquaredIndexCoefficients(Device& device, const Grid& grid, const Buffer<float>& ior);
}
