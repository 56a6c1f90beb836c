#pragma once

#include "Numerics/Direction.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace tyndall
{
constexpr int OrdinateLanes = 8; ///< number of directions in a group, which kernels process as one vector

/// Distance in memory, in voxels, from the radiance of one group of directions to that of the next. It is at least the
/// number of voxels of the grid, and chosen so that the values of a voxel in different groups do not map to the same
/// few cache lines (strides that are a power of two make sweeps ten times slower).
constexpr std::size_t OrdinateStride(std::size_t voxels)
{
  return (voxels + 127) / 128 * 128 + 8;
}

/// Eight directions of one octant, whose sweeps visit the voxels in the same order.
struct OrdinateGroup
{
  std::array<bool, 3> up = {}; ///< whether the components of the directions along x, y and z are positive
  /// Indices of the directions; the last one is repeated to fill all eight places.
  std::array<int, OrdinateLanes> direction = {};
  int count = 0; ///< number of distinct directions
};

/// Directions sorted into groups, which define the memory layout of radiance: [group][voxel, x fastest, padded to
/// OrdinateStride][direction of the group]. The radiance of a voxel and a group is one vector, and the vectors of a row
/// of voxels are contiguous.
class OrdinateGroups
{
public:
  explicit OrdinateGroups(std::vector<Direction> directions);

  const std::vector<Direction>& TheDirections() const { return this->Directions; }
  const std::vector<OrdinateGroup>& All() const { return this->Groups; }
  int Count() const { return static_cast<int>(this->Groups.size()); }
  std::size_t Lanes() const { return this->Groups.size() * OrdinateLanes; }
  const Direction& Of(int group, int lane) const { return this->Directions[this->Groups[group].direction[lane]]; }
  /// Solid angle of the direction at place `lane` (0 to 7) of a group, sr; 0 for a repeated direction.
  double Weight(int group, int lane) const
  {
    return lane < this->Groups[group].count ? this->Of(group, lane).weight : 0.0;
  }
  /// Table [group][part][lane] of the values of a function of group, part and lane (place in the group, 0 to 7).
  /// @param parts  number of values of each direction
  std::vector<float> Table(int parts, const std::function<double(int group, int part, int lane)>& value) const;
  /// Table [group][lane].
  std::vector<float> Table(const std::function<double(int group, int lane)>& value) const;

private:
  std::vector<Direction> Directions;
  std::vector<OrdinateGroup> Groups;
};
}
