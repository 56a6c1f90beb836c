#pragma once

#include "LightPropagation/Angular/RayBundles.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Directions that carry the same light because an axis of the grid has one voxel and is periodic: nothing changes
/// along it, so that mirror images at it are the same, and so are directions with two such axes (of voxels that are
/// square across them) exchanged. One of each class, the one whose components along such axes are positive and fall,
/// stands for all.
class DirectionSymmetry
{
public:
  DirectionSymmetry(const Grid& grid, const std::array<bool, 3>& periodic, const DirectionSet& set);

  bool Any() const { return this->Count() < static_cast<int>(this->ClassOf.size()); } ///< has more than one direction
  int Count() const;                                                                  ///< of classes

  /// The bundles with the directions that stand for others alone, and with the power of all they stand for.
  std::vector<Bundle> Standing(const std::vector<Bundle>& bundles) const;

  /// The directions that `direction` stands for, itself among them.
  const std::vector<int>& AllOf(int direction) const { return this->Classes[this->ClassOf[direction]]; }

private:
  bool IsRepresentative(int direction) const { return direction >= 0 && this->AllOf(direction).front() == direction; }

  std::vector<int> ClassOf;              ///< of each direction
  std::vector<std::vector<int>> Classes; ///< directions; the one that stands for all comes first
};
}
