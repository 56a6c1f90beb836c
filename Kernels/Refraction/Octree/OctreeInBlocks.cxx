#include "Refraction/Octree/OctreeInBlocks.h"
#include "Distribution/SharedMedium.h"

#include "Device/Errors.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/SharedMedium.h"
#include "Numerics/PyramidLayout.h"
#include "Refraction/Octree/OctreeQuantities.h"

#include <algorithm>
#include <chrono>
#include <limits>

namespace tyndall
{
namespace
{
using Place = std::array<int, 3>;

/// Calls act with each place of a box and its number, x fastest.
template <class Act>
void ForPlaces(const VoxelBox& box, const Act& act)
{
  std::size_t number = 0;
  for (int z = box.first[2]; z < EndOf(box, 2); ++z)
  {
    for (int y = box.first[1]; y < EndOf(box, 1); ++y)
    {
      for (int x = box.first[0]; x < EndOf(box, 0); ++x)
      {
        act(Place{ x, y, z }, number++);
      }
    }
  }
}

std::size_t NumberIn(const VoxelBox& box, const Place& place)
{
  const auto within = [&](int axis) { return static_cast<std::size_t>(place[axis] - box.first[axis]); };
  return (within(2) * static_cast<std::size_t>(box.size[1]) + within(1)) * static_cast<std::size_t>(box.size[0]) +
    within(0);
}

/// The nodes of a level whose first voxels, or nodes of the level below, are in a box.
VoxelBox ParentsOf(const VoxelBox& box)
{
  VoxelBox parents;
  for (int axis = 0; axis < 3; ++axis)
  {
    parents.first[axis] = (box.first[axis] + 1) / 2;
    parents.size[axis] = (EndOf(box, axis) + 1) / 2 - parents.first[axis];
  }
  return parents.VoxelCount() > 0 && box.VoxelCount() > 0 ? parents : VoxelBox();
}

/// All that is in nodes of the level above, as far as the level goes.
VoxelBox ChildrenOf(const VoxelBox& parents, const Place& size)
{
  VoxelBox children;
  for (int axis = 0; axis < 3 && parents.VoxelCount() > 0; ++axis)
  {
    children.first[axis] = 2 * parents.first[axis];
    children.size[axis] = std::min(2 * EndOf(parents, axis), size[axis]) - children.first[axis];
  }
  return children;
}

/// The nodes of the level above in which a box has a part.
VoxelBox NodesOver(const VoxelBox& box)
{
  VoxelBox over;
  for (int axis = 0; axis < 3 && box.VoxelCount() > 0; ++axis)
  {
    over.first[axis] = box.first[axis] / 2;
    over.size[axis] = (EndOf(box, axis) - 1) / 2 + 1 - over.first[axis];
  }
  return over;
}

/// The pyramid over a grid in blocks, level by level, and what ranks tell each other of it.
class PyramidInBlocks
{
public:
  PyramidInBlocks(Communicator& communicator, const BlockPartition& voxels)
    : Comm(communicator)
    , Layout(voxels.whole.size)
    , Levels(1, voxels)
  {
    for (int level = 1; level <= this->Layout.Top(); ++level)
    {
      BlockPartition nodes;
      nodes.whole.size = this->Layout.sizes[static_cast<std::size_t>(level)];
      for (const VoxelBox& box : this->Levels.back().blocks)
      {
        nodes.blocks.push_back(ParentsOf(box));
      }
      this->Levels.push_back(std::move(nodes));
    }
  }

  int Top() const { return this->Layout.Top(); }

  /// Levels of the own voxels as one quantity allows them. All ranks call it.
  std::vector<std::uint8_t> LevelsOf(const std::vector<float>& values, const std::vector<float>& tolerances) const
  {
    std::vector<std::vector<float>> ranges(1); // of the levels from 1 on
    for (int level = 1; level <= this->Top(); ++level)
    {
      ranges.push_back(this->RangesAbove(level - 1, level == 1 ? values : ranges.back()));
    }
    std::vector<float> kept; // of the level above: which level its node, or one over it, is kept whole at; 0: none
    for (int level = this->Top(); level >= 1; --level)
    {
      kept =
        this->KeptAt(level, ranges[static_cast<std::size_t>(level)], tolerances[static_cast<std::size_t>(level)], kept);
    }
    return this->OfVoxels(kept);
  }

private:
  const BlockPartition& At(int level) const { return this->Levels[static_cast<std::size_t>(level)]; }
  const VoxelBox& Own(int level) const { return this->At(level).blocks[static_cast<std::size_t>(this->Comm.Rank())]; }

  /// What a rank needs of a level in which others have a part, too.
  template <class Wanted>
  std::vector<float> Fetched(int level, const std::vector<float>& own, int components, const Wanted& wanted) const
  {
    std::vector<VoxelBox> boxes;
    for (int rank = 0; rank < this->Comm.Ranks(); ++rank)
    {
      boxes.push_back(wanted(rank));
    }
    return ValuesInBox(this->Comm, this->At(level), boxes, own, components);
  }

  /// Ranges of the own nodes above a level: least and largest.
  /// @param own  of the level, likewise; of voxels their values
  std::vector<float> RangesAbove(int level, const std::vector<float>& own) const
  {
    const auto wanted = [&](int rank) {
      return ChildrenOf(this->At(level + 1).blocks[static_cast<std::size_t>(rank)], this->At(level).whole.size);
    };
    const VoxelBox box = wanted(this->Comm.Rank()), &nodes = this->Own(level + 1);
    const int components = level == 0 ? 1 : 2;
    const std::vector<float> children = this->Fetched(level, own, components, wanted);
    std::vector<float> ranges;
    for (std::size_t i = 0; i < nodes.VoxelCount(); ++i)
    {
      ranges.insert(ranges.end(), { std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest() });
    }
    ForPlaces(box, [&](const Place& place, std::size_t child) {
      const std::size_t node = NumberIn(nodes, { place[0] / 2, place[1] / 2, place[2] / 2 });
      const float* const of = children.data() + components * child;
      ranges[2 * node] = std::min(ranges[2 * node], of[0]);
      ranges[2 * node + 1] = std::max(ranges[2 * node + 1], of[components - 1]);
    });
    return ranges;
  }

  std::vector<float> KeptAbove(int level, const std::vector<float>& kept) const
  {
    return this->Fetched(
      level + 1, kept, 1, [&](int rank) { return NodesOver(this->At(level).blocks[static_cast<std::size_t>(rank)]); });
  }

  std::vector<float> KeptAt(
    int level, const std::vector<float>& ranges, float tolerance, const std::vector<float>& above) const
  {
    const VoxelBox& nodes = this->Own(level);
    const VoxelBox over = NodesOver(nodes);
    const std::vector<float> inherited =
      level < this->Top() ? this->KeptAbove(level, above) : std::vector<float>(over.VoxelCount(), 0.0f);
    std::vector<float> kept(nodes.VoxelCount());
    ForPlaces(nodes, [&](const Place& place, std::size_t i) {
      const float before =
        level < this->Top() ? inherited[NumberIn(over, { place[0] / 2, place[1] / 2, place[2] / 2 })] : 0.0f;
      const bool even = ranges[2 * i + 1] - ranges[2 * i] <= tolerance;
      kept[i] = before > 0.0f ? before : even ? static_cast<float>(level) : 0.0f;
    });
    return kept;
  }

  std::vector<std::uint8_t> OfVoxels(const std::vector<float>& kept) const
  {
    const VoxelBox& voxels = this->Own(0);
    std::vector<std::uint8_t> levels(voxels.VoxelCount(), 0);
    if (this->Top() > 0)
    {
      const VoxelBox over = NodesOver(voxels);
      const std::vector<float> nodes = this->KeptAbove(0, kept);
      ForPlaces(voxels, [&](const Place& place, std::size_t i) {
        levels[i] = static_cast<std::uint8_t>(nodes[NumberIn(over, { place[0] / 2, place[1] / 2, place[2] / 2 })]);
      });
    }
    return levels;
  }

  Communicator& Comm;
  PyramidLayout Layout;
  std::vector<BlockPartition> Levels; ///< nodes of each level, those of level 0 voxels
};

/// Whether all ranks have one value. Those without voxels have none.
bool IsConstant(Communicator& communicator, const std::vector<float>& values)
{
  const float endless = std::numeric_limits<float>::infinity();
  float least = endless, largest = -endless;
  for (const float value : values)
  {
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  const std::vector<double> ends = communicator.Largest({ -least, largest });
  return -ends[0] == ends[1];
}
}

Octree BuildOctreeInBlocks(Communicator& communicator, const BlockPartition& partition, const Medium& medium,
  const Field& index, const OctreeSettings& settings, const Monitor& monitor)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const bool has = partition.blocks[static_cast<std::size_t>(communicator.Rank())].VoxelCount() > 0;
  communicator.Collective([&] {
    partition.Check();
    Check(settings);
    if (has)
    {
      Check(medium);
      CheckIndex(
        index, medium.grid, partition.whole, partition.blocks[static_cast<std::size_t>(communicator.Rank())].first);
    }
    Report(monitor, 0.0);
  });
  RequireSame(communicator, "settings", true,
    { settings.tolerance, 1.0 * settings.includeExtinction, settings.extinctionTolerance });
  const PyramidInBlocks pyramid(communicator, partition);
  const std::size_t voxels = has ? medium.grid.VoxelCount() : 0;
  Octree octree;
  octree.topLevel = pyramid.Top();
  octree.levels.assign(voxels, static_cast<std::uint8_t>(octree.topLevel));
  /// @return whether the quantity restricts nodes
  const auto restrict = [&](const std::vector<float>& values, const std::vector<float>& tolerances) {
    if (IsConstant(communicator, values))
    {
      return false;
    }
    const std::vector<std::uint8_t> levels = pyramid.LevelsOf(values, tolerances);
    std::transform(levels.begin(), levels.end(), octree.levels.begin(), octree.levels.begin(),
      [](std::uint8_t a, std::uint8_t b) { return std::min(a, b); });
    return true;
  };
  const int levelCount = pyramid.Top() + 1;
  const std::vector<float> ofIndex =
    has ? std::vector<float>(index.values, index.values + voxels) : std::vector<float>();
  if (!restrict(ofIndex, IndexTolerances(levelCount, settings.tolerance)))
  {
    octree.leftOut.emplace_back("the refractive index is constant: no pyramid of it");
  }
  const int channels =
    static_cast<int>(communicator.Largest({ has ? 1.0 * ExtinctionChannels(medium, settings) : 0.0 })[0]);
  bool uneven = false;
  for (int channel = 0; channel < channels; ++channel)
  {
    communicator.Collective([&] { Report(monitor, (1.0 + channel) / (1.0 + channels)); });
    const std::vector<float> tolerances =
      ExtinctionTolerances(partition.whole, levelCount, settings.extinctionTolerance);
    uneven |= restrict(has ? Extinction(medium, channel) : std::vector<float>(), tolerances);
  }
  if (channels > 0 && !uneven)
  {
    octree.leftOut.emplace_back("the extinction is constant: no pyramid of it");
  }
  octree.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return octree;
}
}
