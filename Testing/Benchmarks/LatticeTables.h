#pragma once

#include "Device/Device.h"

/// Tables of how right diffusion on a lattice is, and of what photons beside it cost.
namespace bench
{
/// Cubes of some thicknesses and albedos, lit through one face, against photons that are scattered until they end.
void PrintDiffusion(tyndall::Device& device, bool quick);

/// Light of one voxel that shines in an even medium, along an axis and two diagonals at equal distances.
void PrintIsotropy(tyndall::Device& device, bool quick);

/// Photons that march while their light diffuses: Table I of Bernabei et al., and what is gained over taking turns.
void PrintTurns(tyndall::Device& device, bool quick);
}
