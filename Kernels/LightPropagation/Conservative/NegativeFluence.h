#pragma once

#include "Distribution/VoxelsAround.h"
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
void CutOffNegative(Communicator& communicator, const VoxelsAround& around, const VolumeLayout& layout,
  const Field& sigma_a, std::vector<float>& fluence, const std::vector<float>& instead = {});

/// The same on the device.
void CutOffNegative(Communicator& communicator, const VoxelsAround& around, const VolumeLayout& layout,
  const Field& sigma_a, Buffer<float>& fluence);
}
