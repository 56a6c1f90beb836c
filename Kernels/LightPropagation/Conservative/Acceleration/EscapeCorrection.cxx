#include "LightPropagation/Conservative/Acceleration/EscapeCorrection.h"

#include "Device/Device.h"
#include "Device/Sizes.h"
#include "LightPropagation/Scattering/CollectShared.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
EscapeCorrection::EscapeCorrection(Device& device, const VolumeLayout& layout, const TruncatedScattering& scattering,
  const Buffer<float>& sigma_t, const std::vector<float>& fine, const std::vector<float>& usual)
  : TheDevice(device)
  , Layout(layout)
  , SigmaT(sigma_t)
{
  const Grid& grid = layout.grid;
  const double thinnest = *std::min_element(grid.spacing.begin(), grid.spacing.end());
  // The fraction of a voxel's emitted power that collides in the same voxel is about half the optical thickness of the
  // voxel. The correction is limited to half of the power that collides there.
  const double whole = 0.25 * 4.0 * Pi * grid.VoxelVolume();
  const auto extra = [&](std::size_t i, int c) {
    const std::size_t at = c * layout.Stride() + i;
    const double extinction = scattering.SigmaT(i, c);
    const double most = whole * thinnest * extinction / (1.0 + thinnest * extinction);
    const double difference = std::clamp<double>(fine[at] - usual[at], -most, most);
    return extinction > 0.0 ? static_cast<float>(difference / extinction) : 0.0f;
  };
  this->Extra = PlanarOnDevice(device, layout, layout.channels, extra, "what escapes of scattered light");
}

Rgb EscapeCorrection::Apply(const Buffer<float>& path, const Buffer<float>& source)
{
  const int channels = this->Layout.channels;
  cl::Kernel kernel =
    this->TheDevice.Kernel("let_escape", kernel_source::SourceIteration, SummingOption(this->TheDevice));
  const std::size_t chunks = PartsOf<std::size_t>(this->Layout.Stride(), CollectChunk);
  Buffer<float> tally(this->TheDevice, chunks * channels, "sums");
  With(kernel, path, source, this->Extra, this->SigmaT, tally, cl_ulong(this->Layout.Stride()),
    cl_int(this->Layout.sharedExtinction));
  RunSummingGroups(this->TheDevice, kernel, chunks, channels);
  Rgb escaped = {};
  const std::vector<float> sums = tally.Read();
  for (std::size_t i = 0; i < sums.size(); ++i)
  {
    escaped[i / chunks] += sums[i];
  }
  return escaped;
}
}
