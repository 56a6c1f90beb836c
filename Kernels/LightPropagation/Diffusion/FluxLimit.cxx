#include "LightPropagation/Diffusion/FluxLimit.h"

#include "Device/HostThreads.h"

#include <cmath>

namespace tyndall
{
void LimitFlux(const VolumeLayout& layout, const std::vector<float>& fluence, Buffer<float>& ofLight)
{
  const std::size_t stride = layout.Stride();
  std::vector<float> flux = ofLight.Read();
  const double volume = layout.grid.VoxelVolume();
  for (int c = 0; c < layout.channels; ++c)
  {
    InThreads(layout.grid.VoxelCount(), 16384, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
      {
        float* const x = flux.data() + 3 * c * stride + i;
        float* const y = x + stride;
        float* const z = y + stride;
        const double most = fluence[c * stride + i] * volume;
        const double flows = std::hypot(*x, *y, *z);
        const auto part = static_cast<float>(flows > most ? most / flows : 1.0);
        *x *= part;
        *y *= part;
        *z *= part;
      }
    });
  }
  ofLight.Write(flux.data());
}
}
