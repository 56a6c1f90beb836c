#pragma once

#include "LightPropagation/Angular/AngularValues.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/DirectionSymmetry.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Grid.h"

#include <functional>
#include <vector>

namespace tyndall
{
/// A set of directions as the bundles of rays that sweep a box along each axis. Where mirror images carry the same
/// light, one direction stands for all of them.
class SweptDirections
{
public:
  SweptDirections(const Grid& grid, const PropagationSettings& settings, DirectionSet set, RayStarts starts);

  const DirectionSet& Set() const { return this->Directions; }
  RayStarts Starts() const { return this->WhereRaysStart; }
  int RaysPerEdge() const { return this->MapResolution; } ///< of a voxel
  const DirectionSymmetry& Symmetry() const { return this->Mirrors; }
  bool MergesMirrors() const { return this->Merges; } ///< not where net flux is asked for, which differs
  /// Functions along the directions; of those that stand for others the mean over all of them.
  AngularValues Values(const AngularBasis& basis) const;
  /// The mean, over all that a direction stands for, of values of directions.
  double Mean(int direction, const std::vector<double>& values) const;
  /// Those that `direction` stands for, itself among them.
  std::vector<int> AllOf(int direction) const;

  std::vector<Bundle> Along(int axis) const;
  /// One way (0 forward, 1 backward), the lit ones alone.
  std::vector<Bundle> LitAlong(int axis, int way, const std::function<bool(int)>& isLit) const;

private:
  Grid TheGrid;
  std::array<bool, 3> Periodic;
  int MapResolution;
  DirectionSet Directions;
  RayStarts WhereRaysStart;
  DirectionSymmetry Mirrors;
  bool Merges;
};
}
