#include "Reconstruction/LevelReconstruction.h"
#include "Reconstruction/LightPyramid.h"
#include "Reconstruction/WholeRows.h"

#include "TyndallKernelSources.h"

#include "Device/Batches.h"
#include "Device/Defines.h"

#include <algorithm>
#include <limits>

namespace tyndall
{
namespace
{
using Estimator = ReconstructionSettings::Estimator;

constexpr std::size_t FirstPart = std::size_t(1) << 18; // voxels a launch, until it is known how long that takes

/// As ESTIMATOR of LevelReconstruction.cl.
int NumberOf(Estimator estimator)
{
  return estimator == Estimator::Published ? 0 : estimator == Estimator::ConstantRadius ? 1 : 2;
}

std::size_t Count(int number)
{
  return static_cast<std::size_t>(number);
}
}

void ReconstructByLevel(const Reconstruction& task, const HostMappedBuffer<float>& counts,
  const HostMappedBuffer<float>& weights, double weightStep, ReconstructedLight& result)
{
  const NoisyLight& light = task.light;
  const Grid& grid = light.grid;
  const Estimator estimator = task.settings.estimator;
  const bool directions = light.meanDirection != nullptr;
  const int number = NumberOf(estimator);
  const int top = estimator == Estimator::ConstantRadius ? std::min(task.settings.level, task.levels) : task.levels;
  const RowKernels kernels(task.device, RowWidth(task.device, grid));
  const std::string options = Define("CHANNELS", light.channels) + Define("DIRECTIONS", directions) +
    Define("ESTIMATOR", number) + Define("TOP", top);

  LightPyramid smooth(kernels, grid, light.channels + (directions ? 3 : 0), top, "the pyramid of light");
  smooth.Fill({ kernels, task.fluence, grid.size, 1, light.channels, false, "fluence" }, light.channels, 0);
  if (directions)
  {
    smooth.Fill({ kernels, task.direction, grid.size, 1, 3, false, "mean directions" }, 3, light.channels);
  }
  smooth.Build(LightPyramid::Down::Gauss);
  const auto pyramidOf = [&](const HostMappedBuffer<float>& array, bool wanted, LightPyramid::Down down,
                           const char* what) {
    LightPyramid pyramid(kernels, grid, 1, wanted ? top : 0, what);
    if (wanted)
    {
      pyramid.Fill({ kernels, array, grid.size, 1, 1, false, what }, 1, 0);
      pyramid.Build(down);
    }
    return pyramid;
  };
  const LightPyramid photons = pyramidOf(counts, number != 1, LightPyramid::Down::Sum, "the pyramid of photon counts");
  const LightPyramid heavy = pyramidOf(weights, number == 0, LightPyramid::Down::MeanOfLit, "the pyramid of weights");

  const HostMappedBuffer<float> fluence(task.device, result.fluence.data(), result.fluence.size(), "fluence");
  const HostMappedBuffer<float> direction(
    task.device, result.meanDirection.data(), result.meanDirection.size(), "directions");
  const HostMappedBuffer<float> chosen(task.device, result.mipLevel.data(), result.mipLevel.size(), "levels");
  const WholeRows wholeFluence(kernels, fluence, grid.size, 1, light.channels, true, "fluence");
  const WholeRows wholeDirection(kernels, direction, grid.size, directions ? 1 : 0, 3, true, "mean directions");
  const WholeRows wholeChosen(kernels, chosen, grid.size, 1, 1, true, "levels");
  const double parameter = number == 0 ? weightStep : task.settings.nearest;
  cl::Kernel choose = kernels.Kernel("choose_level", kernel_source::LevelReconstruction, options);
  With(choose, smooth.Values(), smooth.Levels(), photons.Values(), heavy.Values(), photons.Levels(),
    cl_float(parameter), wholeFluence.Handle(), wholeDirection.Handle(), wholeChosen.Handle(),
    VoxelLayout(grid.size, kernels.Width()));
  const std::array<int, 3>& size = grid.size;
  Batches parts;
  parts.count = Count(size[2]);
  parts.first = std::max<std::size_t>(FirstPart / (Count(size[0]) * Count(size[1])), 1);
  parts.from = 0.2;
  InBatches(task.device, parts, task.monitor,
    [&](std::size_t first, std::size_t layers) { kernels.Run(choose, size, first, layers); });
  wholeFluence.Fetch();
  const float most = std::numeric_limits<float>::max();
  const std::array<double, 3> total =
    RangeOf(task.device, fluence, result.fluence.data(), result.fluence.size(), light.channels, 0.0f, most).total;
  const std::array<float, 3> factors = task.Conserve(total, result);
  if (task.settings.conserve)
  {
    cl::Kernel scale = kernels.Kernel("scale_light", kernel_source::LevelReconstruction, options);
    With(scale, fluence.Handle(), cl_float4{ { factors[0], factors[1], factors[2], 0.0f } });
    task.device.Queue().enqueueNDRangeKernel(scale, cl::NullRange, cl::NDRange(grid.VoxelCount()), cl::NullRange);
  }
  fluence.Fetch();
  wholeChosen.Fetch();
  if (directions)
  {
    wholeDirection.Fetch();
  }
}
}
