#include "DiscreteOrdinates/OrdinatesError.h"

#include "Device/Errors.h"
#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "DiscreteOrdinates/OrdinatesTransport.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "LightPropagation/Accuracy/TargetError.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
constexpr int FewestSpiralDirections = 16;
/// Largest number of directions per cube face that the search for a target error tries. The second limit holds if
/// scattering uses the phase function's full matrix or its singular values, because their cost rises with the square of
/// this number.
constexpr int MostDirections = 400, MostWithMatrix = 144;

/// Measured orders of convergence of solves that are not accelerated (numerics.md, section 10 b).
constexpr double OrderInSpace = 1.0, OrderInDirections = 0.4;

/// Settings with which solves on other grids use the same spatial scheme as the solve on the scene's own grid, and the
/// orders of convergence of that scheme. Accelerated solves have the orders of convergence of light propagation maps.
struct SpatialScheme
{
  /// Collective.
  SpatialScheme(Device& device, const SceneBlock& scene, const OrdinatesSettings& given)
    : settings(given)
  {
    if (!AreAccelerated(device, scene, given))
    {
      this->settings.acceleration = PropagationAcceleration::None;
      this->orders = { OrderInSpace, OrderInDirections, OrderInSpace, OrderInSpace };
    }
  }

  OrdinatesSettings settings;
  ErrorOrders orders;
};

/// Number of terms of the phase function for another number of directions: proportional to the number of directions and
/// at most equal to it. It is a square number, as is the number of spherical harmonics up to a degree.
/// @param mayRise  whether the result may exceed the number of terms in `given`
int TermsFor(const OrdinatesSettings& given, int directionsPerFace, bool mayRise)
{
  const double ratio = static_cast<double>(directionsPerFace) / given.directionsPerFace;
  if (ratio == 1.0 || (ratio > 1.0 && !mayRise))
  {
    return given.terms;
  }
  const double most = std::min(ratio * given.terms, 6.0 * directionsPerFace);
  const int rows = std::max(1, static_cast<int>(std::sqrt(most) + 1e-9));
  return rows * rows;
}

/// Copy of `given` with the resolution and tolerance of `how`, which an error estimate has chosen.
/// @param choosesTerms  whether the number of terms is chosen in proportion to the directions
OrdinatesSettings With(const OrdinatesSettings& given, const PropagationSettings& how, bool choosesTerms)
{
  OrdinatesSettings settings = given;
  settings.terms = TermsFor(given, how.directionsPerFace, choosesTerms);
  settings.directionsPerFace = how.directionsPerFace;
  settings.adaptDirections = how.adaptDirections;
  settings.uncollidedDirections = how.uncollidedDirections;
  settings.tolerance = how.tolerance;
  settings.netFlux = how.netFlux;
  if (given.spiralDirections > 0)
  {
    const double part = static_cast<double>(how.directionsPerFace) / given.directionsPerFace;
    settings.spiralDirections =
      std::max(FewestSpiralDirections, static_cast<int>(std::lround(part * given.spiralDirections)));
  }
  return settings;
}

/// The solver as a function of the settings that error estimates choose.
PropagationSolver SolverOf(Device& device, const OrdinatesSettings& given, bool choosesTerms)
{
  return
    [&device, &given, choosesTerms](const SceneBlock& scene, const PropagationSettings& how, const Monitor& monitor) {
      return SolveDiscreteOrdinates(
        device, scene.domain, scene.medium, scene.illumination, With(given, how, choosesTerms), monitor, scene.kept);
    };
}

LightField SolveToTarget(
  Device& device, const SceneBlock& scene, const OrdinatesSettings& settings, double target, const Monitor& monitor)
{
  const int most = settings.scattering == OrdinatesScattering::SphericalHarmonics ? MostDirections : MostWithMatrix;
  SpatialScheme scheme(device, scene, settings);
  scheme.orders.mostDirections = DirectionsThatFit(scene.domain, most, MemoryOf(device));
  const bool choosesTerms = settings.terms == OrdinatesSettings().terms;
  TargetLight found = SolveToTargetError(
    scene, AsPropagation(settings), target, monitor, SolverOf(device, scheme.settings, choosesTerms), scheme.orders);
  std::vector<std::string> used = Words(With(settings, found.settings, choosesTerms), found.light);
  return LightOf(std::move(found), std::move(used));
}
}

LightField EstimateOrdinates(
  Device& device, const SceneBlock& scene, const OrdinatesSettings& settings, const Monitor& monitor)
{
  RefuseAsPublished(IsPublished(settings), "EstimateError");
  const SpatialScheme scheme(device, scene, settings);
  return SolveWithErrorEstimate(
    scene, AsPropagation(settings), monitor, SolverOf(device, scheme.settings, false), scheme.orders);
}

LightField SolveOrdinatesToTarget(
  Device& device, const SceneBlock& scene, const OrdinatesSettings& settings, double target, const Monitor& monitor)
{
  RefuseAsPublished(IsPublished(settings), "TargetError");
  Require(settings.spiralDirections <= 0,
    "TargetError chooses the number of directions per face of a cube, and SpiralDirections is " +
      std::to_string(settings.spiralDirections) + ". Set TargetError or SpiralDirections to 0.");
  return SolveColours(scene, monitor, [&](const SceneBlock& colour, const Monitor& ofColour) {
    return SolveToTarget(device, colour, settings, target, ofColour);
  });
}
}
