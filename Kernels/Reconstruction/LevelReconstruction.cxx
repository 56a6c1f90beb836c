#include "Reconstruction/LevelReconstruction.h"

#include "Device/Batches.h"
#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "Reconstruction/LightPyramid.h"
#include "Reconstruction/WholeRows.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <limits>

namespace tyndall
{
namespace
{
using Estimator = ReconstructionSettings::Estimator;

constexpr std::size_t FirstPart = std::size_t(1) << 18; // voxels per launch, until it is known how long that takes

/// Takes the light of each voxel from one level of its pyramid.
class LevelPasses
{
public:
  explicit LevelPasses(const Reconstruction& task)
    : Task(task)
    , Size(task.light.grid.size)
    , HasDirections(task.light.meanDirection != nullptr)
    , Published(task.settings.estimator == Estimator::Published)
    , ConstantRadius(task.settings.estimator == Estimator::ConstantRadius)
    , Top(this->ConstantRadius ? std::min(task.settings.level, task.levels) : task.levels)
    , Kernels(task.device, RowWidth(task.device, task.light.grid))
  {
  }

  void Run(const HostMappedBuffer<float>& counts, const HostMappedBuffer<float>& weights, double weightStep,
    ReconstructedLight& result) const;

private:
  /// Of the light, and of its directions.
  LightPyramid PyramidOfLight() const;
  /// Of one number per voxel; without levels where that is not `wanted`.
  LightPyramid PyramidOf(
    const HostMappedBuffer<float>& array, bool wanted, LightPyramid::Down down, const char* what) const;
  /// Runs a kernel over the grid, in parts.
  void InParts(const cl::Kernel& kernel) const;
  /// Scales the light as the task says.
  void Conserve(const HostMappedBuffer<float>& fluence, ReconstructedLight& result) const;

  cl::Kernel Kernel(const char* name) const
  {
    return this->Kernels.Kernel(name, kernel_source::LevelReconstruction,
      Define("CHANNELS", this->Task.light.channels) + Define("DIRECTIONS", this->HasDirections) +
        Define("PUBLISHED", this->Published) + Define("CONSTANT_RADIUS", this->ConstantRadius) +
        Define("TOP", this->Top));
  }

  const Reconstruction& Task;
  const std::array<int, 3>& Size;
  bool HasDirections, Published, ConstantRadius;
  int Top;
  RowKernels Kernels;
};

LightPyramid LevelPasses::PyramidOfLight() const
{
  const int channels = this->Task.light.channels;
  LightPyramid pyramid(
    this->Kernels, this->Task.light.grid, channels + (this->HasDirections ? 3 : 0), this->Top, "the pyramid of light");
  pyramid.Fill({ this->Kernels, this->Task.fluence, this->Size, 1, channels, false, "fluence" }, channels, 0);
  if (this->HasDirections)
  {
    pyramid.Fill({ this->Kernels, this->Task.direction, this->Size, 1, 3, false, "mean directions" }, 3, channels);
  }
  pyramid.Build(LightPyramid::Down::Gauss);
  return pyramid;
}

LightPyramid LevelPasses::PyramidOf(
  const HostMappedBuffer<float>& array, bool wanted, LightPyramid::Down down, const char* what) const
{
  LightPyramid pyramid(this->Kernels, this->Task.light.grid, 1, wanted ? this->Top : 0, what);
  if (wanted)
  {
    pyramid.Fill({ this->Kernels, array, this->Size, 1, 1, false, what }, 1, 0);
    pyramid.Build(down);
  }
  return pyramid;
}

void LevelPasses::InParts(const cl::Kernel& kernel) const
{
  Batches parts;
  parts.count = Count(this->Size[2]);
  parts.first = std::max<std::size_t>(FirstPart / (Count(this->Size[0]) * Count(this->Size[1])), 1);
  parts.from = 0.2;
  InBatches(this->Task.device, parts, this->Task.monitor,
    [&](std::size_t first, std::size_t layers) { this->Kernels.Run(kernel, this->Size, first, layers); });
}

void LevelPasses::Conserve(const HostMappedBuffer<float>& fluence, ReconstructedLight& result) const
{
  const ArrayRange range = RangeOf(this->Task.device, fluence, result.fluence.data(), result.fluence.size(),
    this->Task.light.channels, 0.0f, std::numeric_limits<float>::max());
  const std::array<float, 3> factors = this->Task.Conserve(range.total, result);
  if (this->Task.settings.conserve)
  {
    cl::Kernel scale = this->Kernel("scale_light");
    With(scale, fluence.Handle(), cl_float4{ { factors[0], factors[1], factors[2], 0.0f } });
    this->Task.device.Queue().enqueueNDRangeKernel(
      scale, cl::NullRange, cl::NDRange(this->Task.light.grid.VoxelCount()), cl::NullRange);
  }
}

void LevelPasses::Run(const HostMappedBuffer<float>& counts, const HostMappedBuffer<float>& weights, double weightStep,
  ReconstructedLight& result) const
{
  const LightPyramid smooth = this->PyramidOfLight();
  const LightPyramid photons =
    this->PyramidOf(counts, !this->ConstantRadius, LightPyramid::Down::Sum, "the pyramid of photon counts");
  const LightPyramid heavy =
    this->PyramidOf(weights, this->Published, LightPyramid::Down::MeanOfLit, "the pyramid of weights");

  Device& device = this->Task.device;
  const int channels = this->Task.light.channels;
  const HostMappedBuffer<float> fluence(device, result.fluence.data(), result.fluence.size(), "fluence");
  const HostMappedBuffer<float> direction(
    device, result.meanDirection.data(), result.meanDirection.size(), "directions");
  const HostMappedBuffer<float> chosen(device, result.mipLevel.data(), result.mipLevel.size(), "levels");
  const WholeRows fluenceRows(this->Kernels, fluence, this->Size, 1, channels, true, "fluence");
  const WholeRows directionRows(
    this->Kernels, direction, this->Size, this->HasDirections ? 1 : 0, 3, true, "mean directions");
  const WholeRows chosenRows(this->Kernels, chosen, this->Size, 1, 1, true, "levels");

  cl::Kernel choose = this->Kernel("choose_level");
  With(choose, smooth.Values(), smooth.Levels(), photons.Values(), heavy.Values(), photons.Levels(),
    cl_float(this->Published ? weightStep : this->Task.settings.nearest), fluenceRows.Handle(), directionRows.Handle(),
    chosenRows.Handle(), VoxelLayout(this->Size, this->Kernels.Width()));
  this->InParts(choose);
  fluenceRows.Fetch();
  this->Conserve(fluence, result);
  fluence.Fetch();
  chosenRows.Fetch();
  if (this->HasDirections)
  {
    directionRows.Fetch();
  }
}
}

void ReconstructByLevel(const Reconstruction& task, const HostMappedBuffer<float>& counts,
  const HostMappedBuffer<float>& weights, double weightStep, ReconstructedLight& result)
{
  LevelPasses(task).Run(counts, weights, weightStep, result);
}
}
