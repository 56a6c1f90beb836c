#include "Refraction/Octree/RefractionOctree.h"

#include "Device/HostThreads.h"
#include "Refraction/Octree/LevelPyramid.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace tyndall
{
namespace
{
void CheckSettings(const OctreeSettings& settings)
{
  if (!(settings.tolerance >= 0.0 && settings.tolerance <= 1.0))
  {
    throw InvalidInput("Tolerance is " + std::to_string(settings.tolerance) + "; it must lie in [0, 1].");
  }
  if (!(settings.extinctionTolerance >= 0.0) || std::isinf(settings.extinctionTolerance))
  {
    throw InvalidInput("ExtinctionTolerance is " + std::to_string(settings.extinctionTolerance) +
      "; it must be finite and not negative.");
  }
}

void CheckIndex(const Field& index, const Grid& grid)
{
  if (!index.values || index.components != 1)
  {
    throw InvalidInput("The refractive index must be given, with one component a voxel.");
  }
  const std::size_t count = grid.VoxelCount();
  std::atomic<bool> good(true);
  InThreads(count, 65536, [&](std::size_t begin, std::size_t end) {
    bool all = true;
    for (std::size_t i = begin; i < end; ++i)
    {
      all &= index.values[i] > 0.0f && index.values[i] <= std::numeric_limits<float>::max();
    }
    if (!all)
    {
      good = false;
    }
  });
  for (std::size_t i = 0; !good && i < count; ++i)
  {
    if (!(index.values[i] > 0.0f) || std::isinf(index.values[i]))
    {
      throw InvalidInput("The refractive index is " + std::to_string(index.values[i]) + " in voxel " +
        VoxelName(grid, i) +
        " (the first such voxel); it must be finite and above 0. Clean the input, for example with a "
        "Calculator.");
    }
  }
}

bool IsConstant(const float* values, std::size_t count)
{
  std::size_t i = 0;
  while (i < count && values[i] == values[0])
  {
    ++i;
  }
  return i == count;
}

/// Of sigma_t = sigma_a + sigma_s.
std::vector<float> Extinction(const Medium& medium, int channel)
{
  std::vector<float> extinction(medium.grid.VoxelCount());
  for (std::size_t i = 0; i < extinction.size(); ++i)
  {
    extinction[i] = medium.sigma_a.At(i, channel) + medium.sigma_s.At(i, channel);
  }
  return extinction;
}

/// The float for which float <= AsBound(bound) says the same as float <= bound.
float AsBound(double bound)
{
  const float nearest = static_cast<float>(bound);
  return nearest > bound ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}

/// Builds on a device, which it looks for when the first quantity comes that is not constant.
class Builder
{
public:
  Builder(const Grid& grid, std::string device)
    : TheGrid(grid)
    , DeviceName(std::move(device))
  {
  }

  /// @return whether the quantity restricts nodes: not where it is constant, or the grid is one voxel
  bool Restrict(const float* values, const char* what, const std::vector<float>& tolerances)
  {
    const std::size_t count = this->TheGrid.VoxelCount();
    if (IsConstant(values, count))
    {
      return false;
    }
    if (!this->Levels)
    {
      this->TheDevice = Device::Find(this->DeviceName);
      this->Levels = std::make_unique<LevelPyramid>(*this->TheDevice, this->TheGrid);
    }
    const Buffer<float> onDevice(*this->TheDevice, values, count, what);
    const MinMaxPyramid ranges(*this->TheDevice, this->TheGrid, onDevice);
    this->Levels->Restrict(ranges, tolerances);
    return true;
  }

  void Result(Octree& octree) const
  {
    octree.levels.assign(this->TheGrid.VoxelCount(), static_cast<std::uint8_t>(octree.topLevel));
    if (this->Levels)
    {
      this->Levels->Levels().Read(octree.levels.data());
      octree.device = this->TheDevice->Name();
    }
  }

private:
  Grid TheGrid;
  std::string DeviceName;
  std::shared_ptr<Device> TheDevice;
  std::unique_ptr<LevelPyramid> Levels;
};

/// Largest differences of sigma_t in the nodes of each level.
std::vector<float> ExtinctionTolerances(const Grid& grid, int levelCount, double tolerance)
{
  const double diagonal = std::hypot(grid.spacing[0], grid.spacing[1], grid.spacing[2]);
  std::vector<float> tolerances;
  for (int level = 0; level < levelCount; ++level)
  {
    tolerances.push_back(AsBound(tolerance / std::ldexp(diagonal, level)));
  }
  return tolerances;
}
}

Octree BuildOctree(const Medium& medium, const Field& index, const OctreeSettings& settings, const std::string& device,
  const Monitor& monitor)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  CheckSettings(settings);
  Check(medium);
  CheckIndex(index, medium.grid);
  Report(monitor, 0.0);

  const PyramidLayout layout(medium.grid.size);
  Octree octree;
  octree.topLevel = layout.Top();
  Builder builder(medium.grid, device);
  const std::vector<float> tolerances(layout.LevelCount(), AsBound(settings.tolerance));
  if (!builder.Restrict(index.values, "the refractive index", tolerances))
  {
    octree.leftOut.emplace_back("the refractive index is constant: no pyramid of it");
  }
  const bool coloured = medium.sigma_a.components == 3 || medium.sigma_s.components == 3;
  const int channels = !settings.includeExtinction ? 0 : coloured ? 3 : 1;
  bool uneven = false;
  for (int channel = 0; channel < channels; ++channel)
  {
    Report(monitor, (1.0 + channel) / (1.0 + channels));
    uneven |= builder.Restrict(Extinction(medium, channel).data(), "the extinction",
      ExtinctionTolerances(medium.grid, layout.LevelCount(), settings.extinctionTolerance));
  }
  if (channels > 0 && !uneven)
  {
    octree.leftOut.emplace_back("the extinction is constant: no pyramid of it");
  }
  builder.Result(octree);
  octree.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  Report(monitor, 1.0);
  return octree;
}
}
