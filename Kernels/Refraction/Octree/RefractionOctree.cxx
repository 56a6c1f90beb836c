#include "Refraction/Octree/RefractionOctree.h"

#include "Refraction/Octree/LevelPyramid.h"
#include "Refraction/Octree/OctreeQuantities.h"

#include <chrono>
#include <memory>
#include <utility>

namespace tyndall
{
namespace
{
bool IsConstant(const float* values, std::size_t count)
{
  std::size_t i = 0;
  while (i < count && values[i] == values[0])
  {
    ++i;
  }
  return i == count;
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
}

Octree BuildOctree(const Medium& medium, const Field& index, const OctreeSettings& settings, const std::string& device,
  const Monitor& monitor)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  Check(settings);
  Check(medium);
  CheckIndex(index, medium.grid, medium.grid, { 0, 0, 0 });
  Report(monitor, 0.0);

  const PyramidLayout layout(medium.grid.size);
  Octree octree;
  octree.topLevel = layout.Top();
  Builder builder(medium.grid, device);
  const std::vector<float> tolerances = IndexTolerances(layout.LevelCount(), settings.tolerance);
  if (!builder.Restrict(index.values, "the refractive index", tolerances))
  {
    octree.leftOut.emplace_back("the refractive index is constant: no pyramid of it");
  }
  const int channels = ExtinctionChannels(medium, settings);
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
