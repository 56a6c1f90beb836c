#pragma once

#include "Distribution/Domain.h"
#include "Light/LightField.h"
#include "Light/Quality.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Spatial discretisation of discrete ordinates.
enum class OrdinatesScheme
{
  Published = 0,   ///< one explicit step along each direction per iteration (Gong et al., Eqs. (7) and (9))
  Conservative = 1 ///< exponential, energy-conserving sweep along each direction (numerics.md, Eq. (D10))
};

/// How the phase function between the D directions is represented.
enum class OrdinatesScattering
{
  Matrix = 0, ///< its value for each pair of directions: D^2 multiplications per voxel
  /// sum of N products from a singular value decomposition, as published: 2 N multiplications per direction
  SingularValues = 1,
  /// sum of N products of spherical harmonics, lowest degrees first: 2 N multiplications per direction, with exact
  /// moments and without a decomposition
  SphericalHarmonics = 2
};

/// Settings of SolveDiscreteOrdinates; the names are those of the filter's properties.
struct OrdinatesSettings
{
  OrdinatesScheme scheme = OrdinatesScheme::Conservative;
  OrdinatesScattering scattering = OrdinatesScattering::SphericalHarmonics;
  /// directions per cube face, a square number; a plane-parallel slab may be solved with more
  int directionsPerFace = 25;
  bool adaptDirections = true; ///< as PropagationSettings::adaptDirections: whether slabs have more directions
  /// Number of directions on a spiral over the unit sphere, at least 16, which replace those of directionsPerFace; 0:
  /// directions of the cube.
  int spiralDirections = 0;
  /// as PropagationSettings::uncollidedDirections, but only for light of the box's faces, and at least
  /// directionsPerFace
  int uncollidedDirections = -1;
  int terms = 25;          ///< number of terms of the phase function, at most the number of directions
  int maximumOrders = 0;   ///< limit on scattering orders (published scheme: steps); 0: iterate to the tolerance
  double tolerance = 1e-4; ///< relative error of fluence at which iterations stop, > 0
  /// Number of orders after which the sum of all later orders is extrapolated as a geometric series (conservative
  /// scheme); 0: no extrapolation.
  int seriesAfter = 0;
  /// Acceleration of the conservative scheme; used only if neither maximumOrders nor seriesAfter is set.
  PropagationAcceleration acceleration = PropagationAcceleration::Automatic;
  std::array<bool, 3> periodic = { false, false, false }; ///< light wraps around these axes
  bool netFlux = false;                                   ///< whether to compute net_flux
  bool leaveOut = true;                                   ///< whether to skip work that the scene does not need
};

/// Checks the ranges of settings; numbers of directions are checked where the directions are made.
/// @throws InvalidInput if a number is out of range
void Check(const OrdinatesSettings& settings);

bool IsPublished(const OrdinatesSettings& settings);

/// Whether there are at least as many directions as terms of the phase function.
inline bool ResolvesTerms(const PropagationSettings& directions, int terms)
{
  return terms <= 6 * directions.directionsPerFace;
}

/// Settings of light propagation maps from which PropagationProblem determines units, channels and axes for a solve by
/// discrete ordinates.
PropagationSettings AsPropagation(const OrdinatesSettings& settings);

/// Sets directions, tolerance and, if scattering is anisotropic, terms of the phase function for a quality level. Only
/// settings that have their default values are changed. The number of directions is limited so that the radiance of one
/// channel on the whole grid takes at most half of the smallest device memory of any rank. Collective.
/// @param medium  of this rank's block
/// @param memory  of this rank's device
OrdinatesSettings AtQuality(
  const Domain& domain, Quality quality, OrdinatesSettings settings, const Medium& medium, const DeviceMemory& memory);

/// Largest number of directions per cube face with which the radiance of one channel on the whole grid takes at most
/// half of the smallest device memory of any rank. A square number, at least 9 and at most `most`. Collective.
/// @param memory  of this rank's device
int DirectionsThatFit(const Domain& domain, int most, const DeviceMemory& memory);

/// "Name = value" of each setting that a quality level may choose and that has an effect: directionsPerFace is not
/// listed if spiralDirections is set, nor terms if scattering is by the full matrix.
std::vector<std::string> Words(const OrdinatesSettings& settings);
/// "Name = value" of the settings that were used for `light`: plane-parallel slabs are solved with more directions
/// (DirectionsPerFaceFor, GridAxes.h).
std::vector<std::string> Words(OrdinatesSettings settings, const LightField& light);
}
