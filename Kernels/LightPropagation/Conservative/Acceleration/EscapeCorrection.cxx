#include "LightPropagation/Conservative/Acceleration/EscapeCorrection.h"

#include "Device/Defines.h"
#include "Device/GroupSize.h"
#include "Device/Sizes.h"
#include "LightPropagation/Scattering/CollectShared.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
EscapeCorrection::EscapeCorrection(TransportParts& parts, const Monitor& monitor)
  : Parts(parts)
{
  const TransportParts::EvenSky sky = parts.FindEvenSky(monitor);
  const Grid& grid = parts.Layout.grid;
  const double thinnest = *std::min_element(grid.spacing.begin(), grid.spacing.end());
  // At most a half of what a voxel takes of its own light, which is about half its optical thickness.
  const double whole = 0.25 * 4.0 * Pi * grid.VoxelVolume();
  const std::vector<float> extra = Planar(parts.Layout, parts.Layout.channels, [&](std::size_t i, int c) {
    const std::size_t at = c * parts.Layout.Stride() + i;
    const double sigma_t = parts.Problem.Scattering().SigmaT(i, c);
    const double most = whole * thinnest * sigma_t / (1.0 + thinnest * sigma_t);
    const double difference = std::clamp<double>(sky.fine.path[at] - sky.usual.path[at], -most, most);
    return sigma_t > 0.0 ? static_cast<float>(difference / sigma_t) : 0.0f;
  });
  this->Extra = Buffer<float>(parts.TheDevice, extra, "what escapes of scattered light");
}

Rgb EscapeCorrection::Apply()
{
  const TransportParts& parts = this->Parts;
  const int channels = parts.Layout.channels;
  cl::Kernel kernel = parts.TheDevice.Kernel("let_escape", kernel_source::EscapeCorrection);
  const std::size_t chunks = PartsOf<std::size_t>(parts.Layout.Stride(), CollectChunk);
  Buffer<float> tally(parts.TheDevice, chunks * channels, "sums");
  With(kernel, parts.Path, parts.Source, this->Extra, parts.OnDevice.SigmaT(), tally, cl_ulong(parts.Layout.Stride()),
    cl_int(parts.Layout.sharedExtinction));
  parts.TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(chunks, channels), GroupOfLargeItems(parts.TheDevice, 2));
  Rgb escaped = {};
  const std::vector<float> sums = tally.Read();
  for (std::size_t i = 0; i < sums.size(); ++i)
  {
    escaped[i / chunks] += sums[i];
  }
  return escaped;
}
}
