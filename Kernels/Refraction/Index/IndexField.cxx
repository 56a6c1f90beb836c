#include "Refraction/Index/IndexField.h"

#include "Device/Device.h"
#include "Device/Errors.h"
#include "Device/HostThreads.h"
#include "Device/Sizes.h"
#include "Numerics/NumberText.h"
#include "Numerics/PyramidLayout.h"
#include "Numerics/Vectors.h"
#include "Refraction/Index/IndexShared.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
constexpr float Rounding = 1e-6f; ///< relative difference of n that counts as rounding
constexpr float Least = static_cast<float>(LeastIndex);
constexpr float Largest = static_cast<float>(LargestIndex);
constexpr int LargestFilter = 65;
/// Maximum number of bytes of the gradient that the device holds at a time.
constexpr std::size_t LayerBytes = std::size_t(32) << 20;

/// Weights of the Gaussian filter for voxels at distances 1, 2, ...; twice their sum plus the weight of the central
/// voxel is 1.
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

void CheckIndex(const Field& ior, const Domain& domain)
{
  const auto fits = [](float index) { return (index >= Least) & (index <= Largest); };
  const std::size_t count = ior.values ? domain.Own().VoxelCount() : 0;
  std::atomic<bool> good(true);
  InThreads(count, 65536, [&](std::size_t begin, std::size_t end) {
    bool all = true; // combined without branches, so that the loop is vectorised
    for (std::size_t i = begin; i < end; ++i)
    {
      all &= fits(ior.values[i]);
    }
    if (!all)
    {
      good = false;
    }
  });
  if (!good)
  {
    const float* const bad = std::find_if_not(ior.values, ior.values + count, fits);
    const std::array<int, 3> voxel = domain.Own().VoxelAt(static_cast<std::size_t>(bad - ior.values));
    throw InvalidInput("ior is " + Text("%g", *bad) + " in voxel " +
      VoxelName(domain.Whole(), domain.Whole().IndexOf(voxel)) +
      " (the first such voxel); a refractive index must be finite and positive, from " + Text("%g", Least) + " to " +
      Text("%g", Largest) + ".");
  }
}

bool IndexRange::Varies() const
{
  return this->largest - this->least > Rounding * this->largest;
}

IndexRange IndexRangeOf(const Field& ior, const Grid& grid)
{
  if (!ior.values)
  {
    return {};
  }
  const auto range = std::minmax_element(ior.values, ior.values + grid.VoxelCount());
  return { *range.first, *range.second };
}

void CheckLevels(const std::uint8_t* levels, const Grid& grid, const Grid& whole)
{
  const int top = PyramidLayout(whole.size).Top();
  const std::size_t count = levels ? grid.VoxelCount() : 0;
  // This loop computes only the largest octree level, so that compilers vectorise it. If that is too high, its voxel is
  // searched for below.
  int highest = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    highest = std::max<int>(highest, levels[i]);
  }
  if (highest > top)
  {
    const std::size_t i =
      static_cast<std::size_t>(std::find_if(levels, levels + count, [&](int level) { return level > top; }) - levels);
    throw InvalidInput("octree_level is " + std::to_string(levels[i]) + " in voxel " + VoxelName(grid, i) +
      " (the first such voxel); a grid of this size has levels 0 to " + std::to_string(top) +
      ". Make them with RefractionOctree.");
  }
}

void CheckFilterSize(int filterSize)
{
  Require(filterSize >= 1 && filterSize <= LargestFilter && filterSize % 2 == 1,
    "The filter is " + std::to_string(filterSize) + " voxels wide; it must be an odd number from 1 to " +
      std::to_string(LargestFilter) + ".");
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

Buffer<float> SquaredIndexCoefficients(Device& device, const Grid& grid, const Buffer<float>& ior)
{
  const IndexGrid size = { { grid.size[0], grid.size[1], grid.size[2] } };
  const auto padded = [&](int axis, int by) { return static_cast<std::size_t>(grid.size[axis] + by); };
  const auto launch = [&](const cl::Kernel& kernel, int by) {
    device.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(padded(0, by), padded(1, by), padded(2, by)));
  };
  const Buffer<float> squares(device, padded(0, 6) * padded(1, 6) * padded(2, 6), "n^2 beyond the grid");
  Buffer<float> coefficients(device, padded(0, 4) * padded(1, 4) * padded(2, 4), "squared index");
  cl::Kernel extend = device.Kernel("extend_squared_index", kernel_source::SquaredIndex);
  With(extend, size, ior, squares);
  launch(extend, 6);
  cl::Kernel combine = device.Kernel("squared_index_coefficients", kernel_source::SquaredIndex);
  With(combine, size, squares, coefficients);
  launch(combine, 4);
  device.Finish();
  return coefficients;
}
}
