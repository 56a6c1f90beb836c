#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"

#include <functional>
#include <memory>

namespace tyndall
{
/// Along which directions the unscattered light of faces, sky and environment goes.
struct UncollidedDirections
{
  int perFace = 0; ///< of a cube; 0: the same as for scattered light
  /// What scattered light lets out otherwise than those is made up for (EscapeCorrection.h): three times as dear.
  bool correctsEscape = false;
};

/// The settings', or, where these leave it open (-1), as many as make a solve a quarter longer at most, by a forecast
/// of its scattering orders and of the directions that are lit: 36, 49, 64 or 100, where faces of the box shine
/// unevenly and none reflects, but not in accelerated solves in angular moments, for memory. Else 0: an even sky and
/// a smooth environment are right along few directions, and so is the light that is scattered many times.
/// @param usual  directions of scattered light; only beside fitted ones more of them gain by themselves
UncollidedDirections UncollidedDirectionsFor(
  const PropagationProblem& problem, const DirectionSet& usual, OrdersAdded how);

/// What that depends on, of a scene that may be spread over ranks.
struct ShiningScene
{
  const PropagationSettings& settings;
  const Illumination& shining;
  bool isSlab, scatters;
  int degree;                           ///< of angular moments
  std::function<double()> ordersNeeded; ///< ScatteringOrders.h; asked for orders that are added up one by one
};
UncollidedDirections UncollidedDirectionsFor(const ShiningScene& scene, const DirectionSet& usual, OrdersAdded how);

/// Along which that light is swept.
/// @param accelerated  by the whole balance: beside the usual directions, and as they are
std::unique_ptr<const SweptDirections> FinerDirections(
  const Grid& grid, const PropagationSettings& settings, int perFace, bool accelerated);
}
