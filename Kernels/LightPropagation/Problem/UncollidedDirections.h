#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"

#include <memory>

namespace tyndall
{
/// Directions for the uncollided light of faces, sky and environment. The choice does not depend on which light sources
/// are on, so that solutions can be superposed.
struct UncollidedDirections
{
  int perFace = 0; ///< directions per cube face; 0: the same as for scattered light
  /// Used for light of faces only; sky and environment, which are uniform or smooth, use the directions of scattered
  /// light.
  bool ofFacesAlone = false;
  /// The difference in escape between these and the directions of scattered light is corrected (EscapeCorrection.h);
  /// three times as expensive.
  bool correctsEscape = false;
};

/// The value in the settings or, if they leave it open (-1), the largest of 36, 49, 64 and 100 directions for light of
/// faces with which a solve with one emitting face is predicted to take at most a quarter longer. 0 if a face reflects;
/// with coarse-mesh DSA (more directions gain nothing without the escape correction, which would change the light of
/// lamps as well); and, for memory, in accelerated solves with angular moments.
/// @param usual  quadrature of scattered light; only if it is a fitted one do finer directions alone improve accuracy
/// Collective.
UncollidedDirections UncollidedDirectionsFor(
  const PropagationProblem& problem, const DirectionSet& usual, IterationScheme how);

/// The part of the boundary source that uses the finer directions. Its lights and environment are not to be used.
Illumination AlongFiner(const UncollidedDirections& finer, const Illumination& shining);
/// The remainder, which uses the quadrature of scattered light.
Illumination AlongUsual(const UncollidedDirections& finer, const Illumination& shining);

/// Directions along which that light is swept.
/// @param accelerated  solved with DSA: finer directions are swept in addition to the usual ones, and unmodified
std::unique_ptr<const SweptDirections> FinerDirections(
  const Grid& grid, const PropagationSettings& settings, int perFace, bool accelerated);
}
