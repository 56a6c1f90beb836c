#include "LightPropagation/Sweep/VolumeLayout.h"

namespace tyndall
{
namespace
{
/// Number of voxels that are interleaved at a time: small enough that a cache line of the result stays in the cache
/// until all channels and components have been written to it
constexpr std::size_t AtOnce = 512;
}

std::vector<float> Interleaved(const VolumeLayout& layout, const Buffer<float>& planar, double scale)
{
  const std::size_t stride = layout.Stride(), parts = (planar.Size() - SweepPadding) / std::max(stride, std::size_t(1));
  const std::size_t voxels = layout.grid.VoxelCount();
  std::vector<float> interleaved = Zeros(voxels * parts);
  planar.ReadInPlace([&](const float* values) {
    InThreads(voxels, 16384, [&](std::size_t begin, std::size_t end) {
      for (std::size_t from = begin; from < end; from += AtOnce)
      {
        const std::size_t to = std::min(from + AtOnce, end);
        for (std::size_t p = 0; p < parts; ++p)
        {
          for (std::size_t i = from; i < to; ++i)
          {
            interleaved[i * parts + p] = static_cast<float>(values[p * stride + i] * scale);
          }
        }
      }
    });
  });
  return interleaved;
}
}
