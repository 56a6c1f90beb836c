#include "LightPropagation/Sweep/SweepOfDevice.h"

#include "LightPropagation/Sweep/OnGpu/SweepOnGpu.h"
#include "LightPropagation/Sweep/SweepInMemory.h"

namespace tyndall
{
std::unique_ptr<SweepOperator> SweepOfDevice(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
  const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace)
{
  if (!device.IsCpu())
  {
    return std::make_unique<SweepOnGpu>(device, layout, sigma_t, periodic, request, workspace);
  }
  return std::make_unique<SweepInMemory>(device, layout, sigma_t, periodic, request, workspace);
}
}
