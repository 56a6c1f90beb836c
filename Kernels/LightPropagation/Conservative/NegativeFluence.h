#pragma once

#include "Distribution/VoxelsAround.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Medium/Field.h"

#include <vector>

namespace tyndall
{
/// Makes fluence below 0 zero, which sources of thick voxels can leave behind them, and takes the power that it stands
/// for, sigma_a times fluence, from the six voxels beside, of each in proportion to what it absorbs: what a medium
/// absorbs stays as it was counted. All ranks call it.
/// @param around   a layer of voxels
/// @param layout   of this rank's voxels
/// @param sigma_a  of the same
/// @param fluence  planar, as the layout has it
void CutOffNegative(Communicator& communicator, const VoxelsAround& around, const VolumeLayout& layout,
  const Field& sigma_a, Buffer<float>& fluence);
}
