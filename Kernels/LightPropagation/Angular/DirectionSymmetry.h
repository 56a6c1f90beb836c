#pragma once

#include "LightPropagation/Angular/RayBundles.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Classes of directions that carry the same light because the grid has a periodic axis of one voxel. Nothing varies
/// along such an axis, so mirror images in it carry the same light; with two such axes, so do directions with these
/// axes exchanged (if voxels are square across them). Each class is represented by one direction: that whose components
/// along such axes are positive and decreasing.
class DirectionSymmetry
{
public:
  DirectionSymmetry(const Grid& grid, const std::array<bool, 3>& periodic, const DirectionSet& set);

  /// Whether any class has more than one direction
  bool Any() const { return this->Count() < static_cast<int>(this->ClassOf.size()); }
  int Count() const; ///< number of classes

  /// The bundles restricted to representative directions, each with the power of its whole class.
  std::vector<Bundle> Standing(const std::vector<Bundle>& bundles) const;

  /// The class of `direction`, including itself.
  const std::vector<int>& AllOf(int direction) const { return this->Classes[this->ClassOf[direction]]; }

private:
  bool IsRepresentative(int direction) const { return direction >= 0 && this->AllOf(direction).front() == direction; }

  std::vector<int> ClassOf;              ///< class of each direction
  std::vector<std::vector<int>> Classes; ///< directions of each class; the representative first
};
}
