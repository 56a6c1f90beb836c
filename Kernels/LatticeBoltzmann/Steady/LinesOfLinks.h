#pragma once

#include "Device/Device.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
// Lines of links through a box of voxels, by pairs of opposite directions, as LatticeLine.cl follows them.

/// What its kernels are compiled for.
std::string OptionsOfLines(const Device& device, const LatticeSettings& settings, const LatticeVoxels& voxels);

/// Part of a density that goes straight on in each voxel, Eq. (L7).
std::vector<double> GoesStraight(const LatticeBox& box, const LatticeVoxels& voxels);

/// Work-items that follow the lines of a pair of directions, two numbers; some have none.
std::array<std::size_t, 2> LinesOfPair(const std::array<int, 3>& size, int pair);

/// Diffusion of the lattice, of which more counts than of thinner voxels (Eq. (L12)).
/// @return least, as LatticeVoxels::ResistanceWithin takes it
double LeastForDiffusion(const LatticeSettings& settings);
}
