#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"

#include <memory>

namespace tyndall
{
/// Along which directions the unscattered light of faces, sky and environment goes. Chosen by medium and settings,
/// whatever shines, so that lights add up.
struct UncollidedDirections
{
  int perFace = 0; ///< of a cube; 0: the same as for scattered light
  /// Faces alone have them: sky and environment, even or smooth, go along those of scattered light.
  bool ofFacesAlone = false;
  /// What scattered light lets out otherwise than those is made up for (EscapeCorrection.h): three times as dear.
  bool correctsEscape = false;
};

/// The settings', or, where these leave it open (-1), for light of faces as many as make a solve with one face
/// that shines a quarter longer at most, by a forecast of its scattering orders: 36, 49, 64 or 100, where no face
/// reflects. Else 0; so where cells accelerate orders (more directions gain nothing without the correction of what
/// escapes, which would change the light of lamps as well), and in accelerated solves in angular moments, for memory.
/// @param usual  directions of scattered light; only beside fitted ones more of them gain by themselves
/// Collective.
UncollidedDirections UncollidedDirectionsFor(
  const PropagationProblem& problem, const DirectionSet& usual, IterationScheme how);

/// The part of light from outside that comes along finer directions; its lights and environment are not looked at.
Illumination AlongFiner(const UncollidedDirections& finer, const Illumination& shining);
/// The rest, along the usual ones.
Illumination AlongUsual(const UncollidedDirections& finer, const Illumination& shining);

/// Along which that light is swept.
/// @param accelerated  by the whole balance: beside the usual directions, and as they are
std::unique_ptr<const SweptDirections> FinerDirections(
  const Grid& grid, const PropagationSettings& settings, int perFace, bool accelerated);
}
