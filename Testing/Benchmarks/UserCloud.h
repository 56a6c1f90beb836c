#pragma once

#include "Device/Device.h"

namespace bench
{
/// A cloud of our own making (FractalCloud.h), as a user would light it: pictures against Monte Carlo from the sun's
/// side, from the side and against the sun, and the time of the solve beside the same with isotropic scattering.
/// @param edge  voxels along each edge
/// @param paths  of Monte Carlo a pixel, in each of two independent halves
void ShowUserCloud(tyndall::Device& device, int edge, int paths);
}
