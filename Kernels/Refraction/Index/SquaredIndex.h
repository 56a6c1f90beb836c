#pragma once

#include "Device/Buffer.h"
#include "Medium/Grid.h"

namespace tyndall
{
/// Coefficients of the B-spline of n^2 through voxel centres, in the layout of SquaredIndex.cl: the grid with two more
/// at either end of each axis.
/// @param ior  refractive index, one per voxel
/// @throws DeviceError if they do not fit
Buffer<float> SquaredIndexCoefficients(Device& device, const Grid& grid, const Buffer<float>& ior);
}
