#pragma once

#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepWorkspace.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <memory>

namespace tyndall
{
/// Creates the sweep that suits the device: SweepOnGpu on a GPU if it supports the request, else SweepInMemory.
/// @param sigma_t, workspace  must outlive the sweep
std::unique_ptr<SweepOperator> SweepOfDevice(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
  const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace);
}
