#include "Refraction/Index/IndexField.h"

#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "Numerics/PyramidLayout.h"
#include "Numerics/Vectors.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
constexpr int LargestFilter = 65;
/// Bytes of the gradient that the device holds at a time.
constexpr std::size_t LayerBytes = std::size_t(32) << 20;

/// Weights of the voxels at distances 1, 2, ...; twice their sum plus the weight of the central voxel is 1.
std::vector<float> GaussianWeights(int filterSize)
{
  const double deviation = filterSize / 6.0;
  const auto bell = [&](int away) { return std::exp(-0.5 * away * away / (deviation * deviation)); };
  double sum = bell(0);
  for (int k = 1; k <= filterSize / 2; ++k)
  {
    sum += 2.0 * bell(k);
  }
  std::vector<float> weights(static_cast<std::size_t>(filterSize / 2));
  for (std::size_t k = 0; k < weights.size(); ++k)
  {
    weights[k] = static_cast<float>(bell(static_cast<int>(k) + 1) / sum);
  }
  return weights;
}

cl::NDRange Rounded(std::size_t x, std::size_t y, std::size_t z, std::size_t groupX, std::size_t groupY)
{
  return cl::NDRange(RoundUp(x, groupX), RoundUp(y, groupY), z);
}
}

void CheckFilterSize(int filterSize)
{
  if (filterSize < 1 || filterSize > LargestFilter || filterSize % 2 == 0)
  {
    throw InvalidInput("The filter is " + std::to_string(filterSize) +
      " voxels wide; it must be an odd number from 1 to " + std::to_string(LargestFilter) + ".");
  }
}

void SmoothIndex(Device& device, const Grid& grid, int filterSize, Buffer<float>& index)
{
  CheckFilterSize(filterSize);
  if (filterSize == 1)
  {
    return;
  }
  const int width = device.KernelWidth(8, 8);
  const std::string options = Define("RADIUS", filterSize / 2) + Define("REAL_WIDTH", width);
  cl::Kernel kernel = device.Kernel("smooth_index", kernel_source::IndexField, options);
  const Buffer<float> weights(device, GaussianWeights(filterSize), "the filter");
  Buffer<float> smooth(device, grid.VoxelCount(), "the smoothed ior");
  const std::array<int, 3>& size = grid.size;
  const std::size_t groupX = 8;
  const std::size_t groupY = 8;
  for (int axis = 0; axis < 3; ++axis)
  {
    With(kernel, Int4(size), axis, weights, index, smooth);
    device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
      Rounded(PartsOf(size[0], width), size[1], size[2], groupX, groupY), cl::NDRange(groupX, groupY, 1));
    index.Swap(smooth);
  }
  device.Finish();
}

std::vector<float> IndexGradient(Device& device, const Grid& grid, const Buffer<float>& index, const Monitor& monitor)
{
  cl::Kernel kernel =
    device.Kernel("index_gradient", kernel_source::IndexField, Define("RADIUS", 1) + Define("REAL_WIDTH", 1));
  const std::array<int, 3>& size = grid.size;
  const std::size_t layer = 3 * static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]);
  const int atOnce = static_cast<int>(
    std::clamp<std::size_t>(LayerBytes / (layer * sizeof(float)), 1, static_cast<std::size_t>(size[2])));
  const cl_float4 spacing = Float4(Vector(grid.spacing));
  Buffer<float> part(device, layer * static_cast<std::size_t>(atOnce), "ior_gradient");
  std::vector<float> gradient(3 * grid.VoxelCount());
  for (int first = 0; first < size[2]; first += atOnce)
  {
    Report(monitor, static_cast<double>(first) / size[2]);
    const int layers = std::min(atOnce, size[2] - first);
    With(kernel, Int4(size), first, layers, spacing, index, part);
    device.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, Rounded(size[0], size[1], layers, 32, 4), cl::NDRange(32, 4, 1));
    device.Queue().enqueueReadBuffer(part.Handle(), CL_TRUE, 0,
      layer * static_cast<std::size_t>(layers) * sizeof(float),
      gradient.data() + layer * static_cast<std::size_t>(first));
  }
  return gradient;
}
}
