#pragma once

#include "Distribution/Halo.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Medium/Field.h"

#include <vector>

namespace tyndall
{
/// Replaces negative fluence, which sources of optically thick voxels and diffusion solutions can produce. The power
/// that this adds, sigma_a times the difference, is taken from the six neighbouring voxels in proportion to their
/// absorption, so that the total absorbed power does not change. Collective.
/// @param around   halo of one voxel
/// @param layout   of this rank's voxels
/// @param sigma_a  of this rank's voxels
/// @param fluence  in the layout of the volume; empty on a rank without voxels
/// @param instead  replacement values, >= 0, in the same layout; empty: 0
void CutOffNegative(Communicator& communicator, const Halo& around, const VolumeLayout& layout, const Field& sigma_a,
  std::vector<float>& fluence, const std::vector<float>& instead = {});

/// Total fluence of an accelerated solve (numerics.md, section 7.10): the diffusion solution plus uncollided light.
/// Where the diffusion solution is negative, the fluence of the last sweep replaces it. Collective.
/// @param solved      diffusion solution, W / length^2; becomes the total
/// @param path        path integrals of the last sweep, W length; at least as many values
/// @param uncollided  W / length^2, likewise
void MakeFluence(Communicator& communicator, const Halo& around, const VolumeLayout& layout, const Field& sigma_a,
  std::vector<float>& solved, std::vector<float> path, const std::vector<float>& uncollided);

/// The same for an array on the device.
void CutOffNegative(Communicator& communicator, const Halo& around, const VolumeLayout& layout, const Field& sigma_a,
  Buffer<float>& fluence);
}
