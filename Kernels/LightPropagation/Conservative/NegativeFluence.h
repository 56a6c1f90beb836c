#pragma once

#include "Distribution/Halo.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Medium/Field.h"

#include <vector>

namespace tyndall
{
/// Replaces negative fluence, which sources by octant and diffusion solutions can produce, by `instead`. The absorbed
/// power that this adds, sigma_a times the difference, is subtracted from the six neighbouring voxels in proportion to
/// their absorption, so that the total absorbed power does not change. Collective.
/// @param around   halo of one voxel around this rank's block
/// @param layout   layout of this rank's block
/// @param sigma_a  absorption of this rank's block, 1/length
/// @param fluence  W / length^2, [channel][voxel]; changed; empty on a rank without voxels
/// @param instead  replacement values, W / length^2, >= 0, [channel][voxel]; empty: 0
void CutOffNegative(Communicator& communicator, const Halo& around, const VolumeLayout& layout, const Field& sigma_a,
  std::vector<float>& fluence, const std::vector<float>& instead = {});

/// Total fluence of an accelerated solve (numerics.md, section 7.10): the diffusion solution plus uncollided light.
/// Where the diffusion solution is negative, the fluence of the last sweep replaces it. Collective.
/// @param solved      diffusion solution, W / length^2; replaced by the total fluence
/// @param path        path integrals of the last sweep, W length; at least as many values as `solved`
/// @param uncollided  uncollided fluence, W / length^2; at least as many values as `solved`
void MakeFluence(Communicator& communicator, const Halo& around, const VolumeLayout& layout, const Field& sigma_a,
  std::vector<float>& solved, std::vector<float> path, const std::vector<float>& uncollided);

/// CutOffNegative() of the scattered part of a fluence on the device: fluence is nowhere below its uncollided part.
/// @param uncollided  W / length^2, [voxel][channel], as LightField::fluenceDirect
void CutOffNegative(Communicator& communicator, const Halo& around, const VolumeLayout& layout, const Field& sigma_a,
  const std::vector<float>& uncollided, Buffer<float>& fluence);

/// Scales the net flux down where its magnitude exceeds the fluence, which no radiance can cause. The reasons are that
/// sums over rays are inexact in thick voxels, and that in absorbing voxels the mean of the powers through opposite
/// faces exceeds the flux.
/// @param fluence  W / length^2, [channel][voxel]
/// @param ofLight  net flux times the voxel's volume, [channel][x, y, z][voxel]; changed
void LimitFlux(const VolumeLayout& layout, const std::vector<float>& fluence, Buffer<float>& ofLight);
}
