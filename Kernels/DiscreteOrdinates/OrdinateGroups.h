#pragma once

#include "Numerics/Direction.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace tyndall
{
constexpr int OrdinateLanes = 8; ///< directions that kernels process at once

/// Stride between the radiance arrays of successive groups, in voxels: at least the number of voxels, and such that the
/// same voxel of different groups does not map to the same few cache lines (a power of two is ten times slower).
constexpr std::size_t OrdinateStride(std::size_t voxels)
{
  return (voxels + 127) / 128 * 128 + 8;
}

/// Eight directions of one octant, which visit the voxels in the same order.
struct OrdinateGroup
{
  std::array<bool, 3> up = {};                   ///< whether they go up each axis
  std::array<int, OrdinateLanes> direction = {}; ///< indices; the last may be repeated to fill lanes
  int count = 0;                                 ///< number of distinct directions
};

/// Memory layout of directions in kernels. Radiance is [group][OrdinateStride][lane], voxels x fastest, so that a voxel
/// and a group form one vector, and a row of voxels is contiguous.
class OrdinateGroups
{
public:
  explicit OrdinateGroups(std::vector<Direction> directions);

  const std::vector<Direction>& TheDirections() const { return this->Directions; }
  const std::vector<OrdinateGroup>& All() const { return this->Groups; }
  int Count() const { return static_cast<int>(this->Groups.size()); }
  std::size_t Lanes() const { return this->Groups.size() * OrdinateLanes; }
  const Direction& Of(int group, int lane) const { return this->Directions[this->Groups[group].direction[lane]]; }
  /// Solid angle of a lane, sr; 0 for a repeated direction.
  double Weight(int group, int lane) const
  {
    return lane < this->Groups[group].count ? this->Of(group, lane).weight : 0.0;
  }
  /// Table [group][lane] of a function of group and lane.
  std::vector<float> Table(const std::function<double(int group, int lane)>& value) const;

private:
  std::vector<Direction> Directions;
  std::vector<OrdinateGroup> Groups;
};
}
