#include "LightPropagation/Diffusion/LampPassing.h"

#include "Device/ExactValues.h"
#include "LightPropagation/Diffusion/DiffusionSystem.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
void PassLampLight(Device& device, const Grid& grid, const std::array<bool, 3>& periodic, const LampLight& light)
{
  DiffusionLayout layout = LayoutOf(grid, periodic, light);
  layout.linear = true;
  cl::Kernel pass = device.Kernel("pass_lamp_light", kernel_source::LampPassing, ExactOption(device));
  With(pass, layout, *light.sigma_t, *light.sigma_a, *light.sigma_s, *light.swept, *light.path, *light.firstMoments,
    *light.passed, *light.allPath);
  RunVoxels(device, pass, layout);
}
}
