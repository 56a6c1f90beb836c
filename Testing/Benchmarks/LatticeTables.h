#pragma once

#include "Device/Device.h"

/// Tables of how right diffusion on a lattice is.
namespace bench
{
/// Cubes of some thicknesses and albedos, lit through one face, against photons that are scattered until they end.
void PrintDiffusion(tyndall::Device& device, bool quick);

/// Light of one voxel that shines in an even medium, along an axis and two diagonals at equal distances.
void PrintIsotropy(tyndall::Device& device, bool quick);
}
