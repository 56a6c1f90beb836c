#include "LightPropagation/Sweep/VolumeLayout.h"

namespace tyndall
{
std::vector<float> Interleaved(const VolumeLayout& layout, const Buffer<float>& planar, double scale)
{
  const std::vector<float> values = planar.Read();
  const std::size_t parts = (values.size() - SweepPadding) / layout.Stride();
  const std::size_t voxels = layout.grid.VoxelCount();
  std::vector<float> interleaved(voxels * parts);
  for (std::size_t p = 0; p < parts; ++p)
  {
    for (std::size_t i = 0; i < voxels; ++i)
    {
      interleaved[i * parts + p] = static_cast<float>(values[p * layout.Stride() + i] * scale);
    }
  }
  return interleaved;
}
}
