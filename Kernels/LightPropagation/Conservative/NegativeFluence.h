#pragma once

#include "Distribution/Halo.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Medium/Field.h"

#include <vector>

namespace tyndall
{
/// Puts other values in the place of fluence below 0, which sources of thick voxels and solved systems can leave behind
/// them, and takes the power that this adds, sigma_a times the difference, from the six voxels beside, of each in
/// proportion to what it absorbs: what a medium absorbs stays as it was counted. All ranks call it.
/// @param around   a layer of voxels
/// @param layout   of this rank's voxels
/// @param sigma_a  of the same
/// @param fluence  planar, as the layout has it; nothing on a rank without voxels
/// @param instead  values of 0 or more, likewise; empty: 0
void CutOffNegative(Communicator& communicator, const Halo& around, const VolumeLayout& layout, const Field& sigma_a,
  std::vector<float>& fluence, const std::vector<float>& instead = {});

/// Fluence of an accelerated solve (numerics.md, section 7.10): what the system was solved for, or, where that is
/// negative, what the last sweep found, and uncollided light. All ranks call it.
/// @param solved      W / length^2, is added to
/// @param path        W length, of the last sweep; at least as many values
/// @param uncollided  W / length^2, likewise
void MakeFluence(Communicator& communicator, const Halo& around, const VolumeLayout& layout, const Field& sigma_a,
  std::vector<float>& solved, std::vector<float> path, const std::vector<float>& uncollided);

/// CutOffNegative on the device.
void CutOffNegative(Communicator& communicator, const Halo& around, const VolumeLayout& layout, const Field& sigma_a,
  Buffer<float>& fluence);
}
