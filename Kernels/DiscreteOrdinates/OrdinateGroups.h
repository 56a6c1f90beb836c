#pragma once

#include "Numerics/Direction.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace tyndall
{
constexpr int OrdinateLanes = 8; ///< directions that kernels handle at once

/// Voxels from a group's radiance to the next group's: more than there are, and such that the same voxel of different
/// groups does not fall on the same few lines of a cache (a power of two is ten times slower).
constexpr std::size_t OrdinateStride(std::size_t voxels)
{
  return (voxels + 127) / 128 * 128 + 8;
}

/// Eight directions of one octant: they meet the voxels in the same order.
struct OrdinateGroup
{
  std::array<bool, 3> up = {};                   ///< the way along each axis
  std::array<int, OrdinateLanes> direction = {}; ///< indices; a last one may stand in several lanes
  int count = 0;                                 ///< of them that are not repeated
};

/// Directions as kernels see them: radiance is [group][OrdinateStride][lane], voxels x fastest, so that a voxel and a
/// group are one vector, and a row of voxels is one stream.
class OrdinateGroups
{
public:
  explicit OrdinateGroups(std::vector<Direction> directions);

  const std::vector<Direction>& TheDirections() const { return this->Directions; }
  const std::vector<OrdinateGroup>& All() const { return this->Groups; }
  int Count() const { return static_cast<int>(this->Groups.size()); }
  std::size_t Lanes() const { return this->Groups.size() * OrdinateLanes; }
  const Direction& Of(int group, int lane) const { return this->Directions[this->Groups[group].direction[lane]]; }
  /// Solid angle of a lane, sr; 0 of one that repeats another.
  double Weight(int group, int lane) const
  {
    return lane < this->Groups[group].count ? this->Of(group, lane).weight : 0.0;
  }
  /// [group][lane] of a value that group and lane have.
  std::vector<float> Table(const std::function<double(int group, int lane)>& value) const;

private:
  std::vector<Direction> Directions;
  std::vector<OrdinateGroup> Groups;
};
}
