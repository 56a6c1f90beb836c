#pragma once

#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepWorkspace.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <memory>

namespace tyndall
{
/// The sweep that suits a device: SweepOnGpu on GPUs, for what it can; else SweepInMemory.
/// @param sigma_t, workspace  must stay
std::unique_ptr<SweepOperator> SweepOfDevice(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
  const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace);
}
