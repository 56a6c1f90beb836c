#pragma once

#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Grid.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Classes of directions that carry the same light because the grid has a periodic axis of one voxel. Nothing varies
/// along such an axis, so directions that are mirror images along it carry the same light. With two such axes of equal
/// spacing, directions with these axes exchanged also carry the same light. The representative of a class is the
/// direction whose components along such axes are positive and in decreasing order.
class DirectionSymmetry
{
public:
  DirectionSymmetry(const Grid& grid, const std::array<bool, 3>& periodic, const DirectionSet& set);

  /// Whether any two directions carry the same light, i.e. share a class.
  bool Any() const { return this->Count() < static_cast<int>(this->ClassOf.size()); }
  /// Number of classes of directions that carry the same light.
  int Count() const { return static_cast<int>(this->Classes.size()); }

  /// Copies of `bundles` restricted to one direction of each class, with the power of all directions of its class.
  std::vector<Bundle> Standing(const std::vector<Bundle>& bundles) const;

  /// Indices of all directions that carry the same light as `direction`, including itself.
  const std::vector<int>& AllOf(int direction) const { return this->Classes[this->ClassOf[direction]]; }

private:
  bool IsRepresentative(int direction) const { return direction >= 0 && this->AllOf(direction).front() == direction; }

  std::vector<int> ClassOf; ///< by direction: index of its class, the directions that carry the same light
  /// Indices of the directions of each class, the representative first.
  std::vector<std::vector<int>> Classes;
};

/// A quadrature together with its rays: bundles of directions (RayBundles.h) that sweep a box along each axis. If
/// several directions carry the same light (DirectionSymmetry), only one direction of each class is swept.
class SweptDirections
{
public:
  SweptDirections(const Grid& grid, const PropagationSettings& settings, DirectionSet set, RayStarts starts);

  const DirectionSet& Set() const { return this->Directions; }
  RayStarts Starts() const { return this->WhereRaysStart; }
  /// number of rays, for each direction, that start along one edge of a voxel
  int RaysPerEdge() const { return this->MapResolution; }
  const DirectionSymmetry& Symmetry() const { return this->Mirrors; }
  /// Whether only one direction of each class of directions that carry the same light is swept. False if the net flux
  /// is requested, because it differs between mirror images.
  bool MergesMirrors() const { return this->Merges; }
  /// Values of the basis functions in the directions of the quadrature. If MergesMirrors(), they are means over the
  /// class of each direction, i.e. all directions that carry the same light.
  AngularValues Values(const AngularBasis& basis) const;
  /// Mean of `values`, one per direction, over the class that `direction` represents.
  double Mean(int direction, const std::vector<double>& values) const;
  /// Indices of the directions that `direction` represents, including itself.
  std::vector<int> AllOf(int direction) const;

  std::vector<Bundle> Along(int axis) const;
  /// Bundles of directions along `axis` that march one way (0 forward, 1 backward), restricted to directions for which
  /// isLit is true.
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
